// SPDX-License-Identifier: MIT
// Bodies of smoothed_flights.hpp.
#pragma once

#include "pinnquad/regression/smoothed_flights.hpp"

namespace pinnquad::detail {

PINNQUAD_BODY std::size_t half_window(double window_s, double period_s) {
  return std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(0.5 * window_s / period_s)));
}

PINNQUAD_BODY std::vector<double> window_weights(std::size_t half) {
  constexpr double tau = 6.283185307179586;
  std::vector<double> weights;
  const std::size_t count = 2 * half;
  for (std::size_t k = 0; k < count; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    weights.push_back((1 - std::cos(tau * share)) / static_cast<double>(count));
  }
  return weights;
}

PINNQUAD_BODY std::vector<double> means_between_rows(const std::vector<double>& u) {
  std::vector<double> result(u.size() - 1);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto [a, b, c, d] = rows_around(u, i);
    result[i] = (13 * (b + c) - a - d) / 24;
  }
  return result;
}

PINNQUAD_BODY SmoothedFlights::SmoothedFlights(const RowSet& rows, double window_s) : period_s_(sample_period_s(rows)) {
  if (!(period_s_ > 0)) return;
  half_ = half_window(window_s, period_s_);
  stride_ = std::max<std::size_t>(1, half_ / 4);
  weights_ = window_weights(half_);
  for (const FlightRows& piece : rows.pieces()) take(piece);
  const auto moves = [](const Series& series) {
    return std::any_of(series.begin(), series.end(), [](double v) { return v != 0; });
  };
  if (std::none_of(velocities_.begin(), velocities_.end(), moves)) kinematic_forces_ = {};
}

PINNQUAD_BODY std::size_t SmoothedFlights::steps_per_row() const noexcept {
  constexpr double longest_step_s = 0.005;
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(period_s_ / longest_step_s - 1e-9)));
}

PINNQUAD_BODY SmoothedFlights::Wanted SmoothedFlights::wanted(double curve, double delay_s) const {
  const std::size_t parts = steps_per_row();
  const double step = 1 / static_cast<double>(parts);  // in rows
  const double late = delay_s / period_s_;
  Wanted result;
  for (const Stretch& stretch : stretches_) {
    const auto wanted_at = [&](double row) {
      return thrust_fraction(AllRotors(curve), clip_command(at_row(stretch.commands, row - late)));
    };
    const std::size_t rows = stretch.commands.size() - 1;
    std::vector<AllRotors>& all = result.stretches_.emplace_back();
    all.reserve(1 + rows * parts);
    all.push_back(wanted_at(0));
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t part = 0; part < parts; ++part) {
        all.push_back(wanted_at(static_cast<double>(row) + (static_cast<double>(part) + 0.5) * step));
      }
    }
  }
  return result;
}

PINNQUAD_BODY std::array<SmoothedFlights::Series, rotor_count> SmoothedFlights::followed(
    const Wanted& wanted_fractions, const RotorResponse& response) const {
  std::array<Series, rotor_count> result;
  for (Series& of_rotor : result) of_rotor.reserve(size());
  const std::size_t parts = steps_per_row();
  const double step = 1 / static_cast<double>(parts);
  // what is left of a distance at the end of a step, and in the mean over it
  struct Approach {
    AllRotors end, mean;
  };
  const auto approach = [step_s = period_s_ * step](double lag_s) {
    const double end = lag_factor(lag_s, step_s);
    return Approach{AllRotors(end), AllRotors((1 - end) * lag_s / step_s)};
  };
  const Approach rise = approach(response.rise_s), fall = approach(response.fall_s);
  std::vector<AllRotors> thrust;
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const Stretch& stretch = stretches_[k];
    const AllRotors* next = wanted_fractions.stretches_[k].data();
    thrust.resize(stretch.commands.size() - 1);
    AllRotors now = *next++;
    for (AllRotors& of_row : thrust) {
      AllRotors sum(0);
      for (std::size_t part = 0; part < parts; ++part) {
        const AllRotors wanted = *next++;
        const auto rising = wanted >= now;
        sum += wanted + select(rising, rise.mean, fall.mean) * (now - wanted);
        now = wanted + select(rising, rise.end, fall.end) * (now - wanted);
      }
      of_row = sum * AllRotors(step);
    }
    smooth(thrust, stretch.instants, stretch.first, [&result](const AllRotors& fractions) {
      for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
        result[rotor].push_back(fractions.lane(static_cast<int>(rotor)));
      }
    });
  }
  return result;
}

PINNQUAD_BODY std::array<SmoothedFlights::Series, rotor_count> SmoothedFlights::thrust_fractions(
    double curve, const RotorResponse& response) const {
  return followed(wanted(curve, response.delay_s), response);
}

PINNQUAD_BODY SmoothedFlights::AllRotors SmoothedFlights::at_row(const std::vector<AllRotors>& u, double row) noexcept {
  const auto last = static_cast<double>(u.size() - 1);
  if (row <= 0) return u.front();
  if (row >= last) return u.back();
  const auto i = static_cast<std::size_t>(row);
  const AllRotors s(row - static_cast<double>(i)), two(2), three(3), four(4), five(5);
  const auto [a, b, c, d] = rows_around(u, i);
  return b + AllRotors(0.5) * s * (c - a + s * (two * a - five * b + four * c - d + s * (three * (b - c) + d - a)));
}

PINNQUAD_BODY SmoothedFlights::Series SmoothedFlights::differences(const Series& u) const {
  Series result(u.size() - 1);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (u[i + 1] - u[i]) / period_s_;
  return result;
}

PINNQUAD_BODY void SmoothedFlights::take(const FlightRows& piece) {
  const Flight& flight = *piece.flight;
  std::size_t begin = piece.rows.begin;
  for (std::size_t row = piece.rows.begin + 1; row <= piece.rows.end; ++row) {
    if (row < piece.rows.end && flight[row].time_s - flight[row - 1].time_s < 1.5 * period_s_) continue;
    take_stretch(flight, {begin, row});
    begin = row;
  }
}

PINNQUAD_BODY void SmoothedFlights::take_stretch(const Flight& flight, const IndexRange& rows) {
  const auto settling = static_cast<std::size_t>(std::ceil(settling_s / period_s_));
  const std::size_t first = settling + half_;
  if (rows.size() < first + half_ + 1) return;
  Stretch stretch;
  stretch.first = first;
  stretch.instants = (rows.size() - 1 - half_ - first) / stride_ + 1;
  std::array<Series, 18> series;
  const ExtraColumn* const battery = flight.column("battery_voltage");
  Series voltage;
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    const Sample& sample = flight[row];
    AllRotors commands(0);
    for (std::size_t k = 0; k < rotor_count; ++k) commands.set_lane(static_cast<int>(k), sample.commands[k]);
    stretch.commands.push_back(commands);
    const MotionInputs<double> motion = sample_inputs<MotionInputs<double>>(sample);
    const Vector3<double> force = SpecificForce::of(motion);
    const Vector3<double>& w = sample.body_rates_rad_s;
    const Vector3<double>& v = sample.velocity_m_s;
    const Vector3<double> but_derivative = force - sample.linear_acceleration_m_s2;  // omega x v - R^T g
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      series[axis].push_back(w[i]);
      series[3 + axis].push_back(w[(i + 1) % 3] * w[(i + 2) % 3]);
      series[6 + axis].push_back(force[i]);
      series[9 + axis].push_back(v[i]);
      series[12 + axis].push_back(std::abs(v[i]) * v[i]);
      series[15 + axis].push_back(but_derivative[i]);
    }
    if (battery != nullptr) voltage.push_back(battery->values[row]);
  }
  const auto add = [&](const Series& intervals, Series& result) {
    smooth(intervals, stretch.instants, first, [&result](double sum) { result.push_back(sum); });
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    add(means_between_rows(series[axis]), rates_[axis]);
    add(differences(series[axis]), derivatives_[axis]);
    add(means_between_rows(series[3 + axis]), products_[axis]);
    add(means_between_rows(series[6 + axis]), forces_[axis]);
    add(means_between_rows(series[9 + axis]), velocities_[axis]);
    add(means_between_rows(series[12 + axis]), squares_[axis]);
    Series kinematic = means_between_rows(series[15 + axis]);
    const Series derivative = differences(series[9 + axis]);
    for (std::size_t i = 0; i < kinematic.size(); ++i) kinematic[i] += derivative[i];
    add(kinematic, kinematic_forces_[axis]);
  }
  has_voltage_ = has_voltage_ && battery != nullptr;
  if (has_voltage_) add(means_between_rows(voltage), voltage_);
  if (!has_voltage_) voltage_.clear();
  stretch_.insert(stretch_.end(), stretch.instants, stretches_.size());
  stretches_.push_back(std::move(stretch));
}

}  // namespace pinnquad::detail
