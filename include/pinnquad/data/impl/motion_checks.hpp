// SPDX-License-Identifier: MIT
// Bodies of motion_checks.hpp.
#pragma once

#include "pinnquad/data/impl/velocity_readings.hpp"
#include "pinnquad/data/motion_checks.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY std::string field_name(std::size_t first, Eigen::Index axis) {
  return std::string(sample_field_names[first + static_cast<std::size_t>(axis)]);
}

/// "3.6 times"
PINNQUAD_BODY std::string times_text(double factor) {
  return number_text(factor < 1 ? std::round(factor * 1e4) / 1e4 : std::round(factor * 100) / 100) + " times";
}

PINNQUAD_BODY bool BestReading::takes(const MotionBlocks& read, double enough) {
  const double so = read.agreement(moving_);
  const bool is_better = so > most_ && so > enough && 1 - so < far_better * (1 - as_it_stands_);
  if (!is_better || !sums_.agrees_less_than(read, moving_)) return false;
  most_ = so;
  return true;
}

PINNQUAD_BODY std::string BestReading::evidence() const {
  return "; agreement " + hundredths(as_it_stands_) + " as it stands, " + hundredths(most_) + " so";
}

PINNQUAD_BODY Vector3<double> turn_vector(const Quaternion<double>& q) {
  const double shorter_way = q.w < 0 ? -1 : 1;
  const Vector3<double> v = shorter_way * Vector3<double>(q.x, q.y, q.z);
  const double sine = v.norm();
  return v * (sine > 1e-12 ? 2 * std::atan2(sine, shorter_way * q.w) / sine : 2.0);
}

/// `use` with what motion_steps() takes. `logged`: the attitudes of the columns as they stand.
template <class Use>
auto read_turning(const Flight& flight, const std::vector<Quaternion<double>>& logged, const TurningReading& reading,
                  const Use& use) {
  const auto read = [&](std::size_t row) {
    EulerAngles<double> angles = angles_of(flight[row]);
    if (reading.degrees[0]) angles.roll_rad /= degrees_per_radian;
    if (reading.degrees[1]) angles.pitch_rad /= degrees_per_radian;
    if (reading.degrees[2]) angles.yaw_rad /= degrees_per_radian;
    return angles;
  };
  const bool degrees = reading.degrees[0] || reading.degrees[1] || reading.degrees[2];
  const std::vector<Quaternion<double>> converted = attitudes(degrees ? flight.size() : 0, read);
  const std::vector<Quaternion<double>>& attitude = degrees ? converted : logged;
  const auto of_angles = [&](std::size_t row, const Vector3<double>& turn) {
    const EulerAngles<double> begin = read(row);
    const double sr = std::sin(begin.roll_rad), cr = std::cos(begin.roll_rad);
    const double across = sr * turn[1] + cr * turn[2];
    return Vector3<double>(turn[0] + std::tan(begin.pitch_rad) * across, cr * turn[1] - sr * turn[2],
                           across / std::cos(begin.pitch_rad));
  };
  const auto change = [&](std::size_t row) -> Vector3<double> {
    const Quaternion<double>& q = attitude[row];
    const Vector3<double> turn = turn_vector(conjugate(q) * attitude[row + 1]) * reading.rates_unit;
    switch (reading.rates) {
      case TurningReading::of_world: return body_to_world(q, turn);
      case TurningReading::of_enu_world: return swap_enu_ned(body_to_world(q, turn));
      case TurningReading::of_world_as_flu: return swap_flu_frd(body_to_world(q, turn));
      case TurningReading::of_enu_world_as_flu: return swap_flu_frd(swap_enu_ned(body_to_world(q, turn)));
      case TurningReading::of_angles_as_flu: return swap_flu_frd(of_angles(row, turn));
      case TurningReading::of_angles: return of_angles(row, turn);
      case TurningReading::of_flu_body: return swap_flu_frd(turn);
      case TurningReading::reversed: return -turn;
      case TurningReading::of_body: break;
    }
    return turn;
  };
  return use([&](std::size_t row) { return flight[row].time_s; }, change,
             [&](std::size_t row) -> const Vector3<double>& { return flight[row].body_rates_rad_s; });
}
PINNQUAD_BODY MotionBlocks turning_sums(const Flight& flight, const std::vector<Quaternion<double>>& attitude,
                                        const TurningReading& reading) {
  return read_turning(flight, attitude, reading, [&](const auto& time_s, const auto& change, const auto& rate) {
    return motion_steps(flight.size(), time_s, change, rate, turning_step_s).sums();
  });
}
/// The sentence of a reading that is not the flight's: angles and rates share the blame for a factor of 57.
PINNQUAD_BODY Implausible misread_turning(const TurningReading& reading, const std::string& evidence) {
  for (std::size_t angle = 0; angle < 3; ++angle) {
    if (!reading.degrees[angle]) continue;
    const std::string name = field_name(angles_field, static_cast<Eigen::Index>(angle));
    return {0, angles_field + angle, "radians in column " + name,
            "degrees, by how they change with the body rates w_x, w_y, w_z (multiply by pi / 180), or these 57 times "
            "too small" +
                evidence};
  }
  if (reading.rates_unit > 1) {
    return {0, rates_field, "radians per second in columns w_x, w_y, w_z",
            "degrees per second, by how roll, pitch and yaw change (multiply by pi / 180), or these 57 times too "
            "small" +
                evidence};
  }
  return {0, rates_field, "rates in the body's axes in columns w_x, w_y, w_z",
          turning_rate_texts[reading.rates] + evidence};
}
/// True where this body rate stands still: a sensor that has stopped fits no attitude, whatever its unit.
PINNQUAD_BODY bool is_frozen_rate(const Flight& flight, Eigen::Index axis) {
  const double first = flight.front().body_rates_rad_s[axis];
  return std::all_of(flight.begin(), flight.end(), [&](const Sample& sample) {
    return !(sample.body_rates_rad_s[axis] < first) && !(sample.body_rates_rad_s[axis] > first);
  });
}
/// Rates that have stopped, if one of them should not have.
PINNQUAD_BODY std::optional<Implausible> find_stopped_rate(const Flight& flight, const MotionBlocks& sums) {
  constexpr double turns = 0.5, least = 1e-3;  // rad over a step
  std::string stopped;
  std::size_t first = 0;
  bool contradicted = false;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (!is_frozen_rate(flight, axis)) continue;
    const double both = sums.changes[axis] + sums.integrals[axis];
    // roll and pitch alone turn less about another axis: a heading that a file holds at 0 is no gyro's fault
    const bool moves = both > least * least * sums.steps && sums.changes[axis] > sums.changes.maxCoeff() / 16;
    const bool plain = is_plain(sums.each([&](const MotionSums& block) { return block.changes[axis]; }));
    contradicted = contradicted || (moves && plain && 2 * sums.products(axis, axis) < turns * both);
    if (stopped.empty()) first = rates_field + static_cast<std::size_t>(axis);
    stopped += (stopped.empty() ? "" : ", ") + field_name(rates_field, axis);
  }
  if (!contradicted) return std::nullopt;
  return Implausible{0, first, "body rates that change, as the attitude does, in columns " + stopped,
                     "the same in all " + std::to_string(flight.size()) + " rows"};
}
/// A rate that turns the attitude about another axis, or the other way.
PINNQUAD_BODY Implausible wrong_rate(const MotionBlocks& sums, const AxisMistake& mistake) {
  const std::size_t field = rates_field + static_cast<std::size_t>(mistake.column);
  const std::string rate = field_name(rates_field, mistake.column), angle = field_name(angles_field, mistake.column);
  const std::string evidence = ", correlation " + hundredths(sums.correlation(mistake.axis, mistake.column));
  const std::string expected =
      "the turning of roll, pitch and yaw about " + std::string(1, "xyz"[mistake.column]) + " in column " + rate;
  if (mistake.axis == mistake.column) {
    return {0, field, expected, "that negated" + evidence + " (" + rate + " or " + angle + " is negated)"};
  }
  return {0, field, expected,
          std::string("that about ") + "xyz"[mistake.axis] + (mistake.negated ? " negated" : "") + evidence + " (" +
              angle + " and " + field_name(angles_field, mistake.axis) + ", or " + rate + " and " +
              field_name(rates_field, mistake.axis) + ", are exchanged)"};
}

PINNQUAD_BODY std::optional<Implausible> find_turning_mistake(const Flight& flight,
                                                              const std::vector<Quaternion<double>>& attitude) {
  constexpr double follows = 0.6, clearly = 0.4;
  const MotionBlocks sums = turning_sums(flight, attitude);
  BestReading reading(sums);
  const double as_it_stands = reading.as_it_stands();
  if (as_it_stands < agrees) {
    if (auto stopped = find_stopped_rate(flight, sums)) return stopped;
  }
  TurningReading best;
  const auto judge = [&](const TurningReading& so) {
    if (reading.takes(turning_sums(flight, attitude, so))) best = so;
  };
  if (as_it_stands < in_time) {
    for (const auto rates : {TurningReading::of_angles, TurningReading::of_angles_as_flu}) judge({{}, 1, rates});
  }
  if (as_it_stands < agrees) {
    for (unsigned choice = 1; choice < 16; ++choice) {
      judge(
          {{(choice & 1u) != 0, (choice & 2u) != 0, (choice & 4u) != 0}, (choice & 8u) != 0 ? degrees_per_radian : 1});
    }
    for (const auto rates :
         {TurningReading::of_world, TurningReading::of_enu_world, TurningReading::of_flu_body, TurningReading::reversed,
          TurningReading::of_world_as_flu, TurningReading::of_enu_world_as_flu}) {
      judge({{}, 1, rates});
    }
  }
  if (reading.found()) return misread_turning(best, reading.evidence());
  if (as_it_stands < agrees) {
    if (const auto mistake = find_axis_mistake(sums, follows, clearly)) {
      if (mistake->axis != mistake->column || mistake->negated) return wrong_rate(sums, *mistake);
      constexpr double about = 1.5;
      TurningReading unit;
      if (mistake->factor > degrees_per_radian / about) unit.rates_unit = degrees_per_radian;
      if (mistake->factor < about / degrees_per_radian) unit.degrees[0] = true;
      if (unit.rates_unit > 1 || unit.degrees[0])
        return misread_turning(unit, "; the rates are " + times_text(mistake->factor) + " the turning");
    }
  }
  if (!(as_it_stands < in_time)) return std::nullopt;
  const auto lateness = [&](const auto& time_s, const auto& change, const auto& rate) {
    return motion_lateness_s(flight.size(), time_s, change, rate, turning_step_s);
  };
  if (const auto late_s = read_turning(flight, attitude, {}, lateness)) {
    const bool angles = *late_s > 0;
    return Implausible{0, angles ? angles_field : rates_field, "roll, pitch and yaw at the times of w_x, w_y and w_z",
                       (angles ? "roll, pitch and yaw " : "w_x, w_y and w_z ") + late_text(*late_s) +
                           ", by how the one turns with the other"};
  }
  return std::nullopt;
}

/// The first of three accelerations that follows another axis, or its own against the sign, or in another unit.
PINNQUAD_BODY std::optional<Implausible> wrong_axis(const MotionBlocks& sums, std::size_t first_field,
                                                    std::size_t first_integrated_field) {
  constexpr double follows = 0.35, better = 0.25;  // correlations
  const auto mistake = find_axis_mistake(sums, follows, better);
  if (!mistake) return std::nullopt;
  const std::size_t field = first_field + static_cast<std::size_t>(mistake->column);
  const bool of_unit = mistake->axis == mistake->column && !mistake->negated;
  const std::string found =
      of_unit ? "about " + times_text(mistake->factor) + " that (its unit?)"
              : "that of " + field_name(first_integrated_field, mistake->axis) + (mistake->negated ? " negated" : "");
  return Implausible{0, field,
                     "the derivative of " + field_name(first_integrated_field, mistake->column) + " " + "in column " +
                         field_name(first_field, mistake->column),
                     found + ", by how rates and velocity change from row to row"};
}

inline constexpr const char* expected_derivative =
    "the derivative of the velocity in the body's axes in column vdot_bx";

/// Velocities that are negated along one axis of the world, of another unit, or late.
PINNQUAD_BODY std::optional<Implausible> find_velocity_mistake(const Flight& flight,
                                                               const std::vector<Quaternion<double>>& attitude) {
  constexpr double follows = 0.8, better = 0.25, straight = 0.9, alike = 1.3;
  constexpr double fits = 0.95;  // an acceleration in other axes agrees with such a velocity by less
  constexpr std::array<const char*, 3> along = {"north", "east", "down"};
  const MotionBlocks sums = world_velocity_sums(flight, attitude);
  const std::string expected =
      "a velocity that changes by the accelerations vdot_bx to vdot_bz in columns v_bx, v_by, v_bz";
  if (const auto mistake = find_axis_mistake(sums, follows, better)) {
    const Eigen::Index axis = mistake->column;
    const auto own = [&](Eigen::Index of) { return sums.correlation(of, of); };
    const Eigen::Index other = (axis + 1) % 3, third = (axis + 2) % 3;
    if (mistake->negated && mistake->axis == axis && own(other) > follows && own(third) > follows) {
      return Implausible{0, velocity_field, expected,
                         std::string("one that is negated along ") + along[static_cast<std::size_t>(axis)] +
                             ", correlation " + hundredths(own(axis))};
    }
    const auto factor = [&](Eigen::Index of) { return sums.changes[of] / sums.products(of, of); };
    const double factors[] = {factor(0), factor(1), factor(2)};
    const auto [least, most] = std::minmax_element(std::begin(factors), std::end(factors));
    const bool one_unit = own(0) > straight && own(1) > straight && own(2) > straight && *most < alike * *least;
    if (one_unit)
      return Implausible{0, velocity_field, expected, times_text(factors[0]) + " that (km/h is 3.6 times m/s)"};
  }
  BestReading reading(sums);
  const double as_it_stands = reading.as_it_stands();
  Implausible best{0, velocity_field, expected, ""};
  const auto judge = [&](const VelocityReading& so, const std::string& text) {
    const bool of_force = so.acceleration.kind != AccelerationReading::kinematic;
    const bool in_other_axes = of_force || so.of_columns + so.of_world > 0;
    if (!reading.takes(world_velocity_sums(flight, attitude, so), in_other_axes ? fits : related)) return;
    best = {0, of_force ? linear_field : velocity_field, of_force ? expected_derivative : expected, text};
  };
  for (std::size_t axes = 0; axes < axes_kinds && as_it_stands < in_time; ++axes) {
    // over gaps and between rows that are far apart the body turns: steps of a row hide this one then
    const AccelerationReading force{AccelerationReading::world_force, axes};
    judge({1, 0, 0, force}, force.text());
  }
  for (std::size_t axes = 0; axes < axes_kinds && as_it_stands < agrees; ++axes) {
    judge({0, axes, 0}, "velocities in the world's axes (turn them into the body)");
    judge({2, 0, axes}, "velocities in the body's axes that were turned into them once more");
    if (axes > 0) judge({1, 0, axes}, "velocities in another world's axes (ENU for NED, or z up)");
    if (axes > 0) judge({1, axes, 0}, "velocities in other axes of the body (x forward, y left, z up for FRD)");
  }
  if (reading.found()) {
    best.found += reading.evidence();
    return best;
  }
  if (!(as_it_stands < in_time)) return std::nullopt;
  const auto lateness = [&](const auto& time_s, const auto& change, const auto& rate) {
    return motion_lateness_s(flight.size(), time_s, change, rate, turning_step_s);
  };
  if (const auto late_s = read_world_velocity(flight, attitude, {}, lateness)) {
    return Implausible{0, *late_s > 0 ? velocity_field : linear_field, expected,
                       (*late_s > 0 ? "velocities " : "accelerations ") + late_text(*late_s) + " against the other"};
  }
  return std::nullopt;
}

/// An altitude that falls where the velocity rises, or rises by another unit.
PINNQUAD_BODY std::optional<Implausible> find_altitude_mistake(const Flight& flight,
                                                               const std::vector<Quaternion<double>>& attitude) {
  constexpr double follows = 0.8;
  const MotionBlocks sums =
      motion_steps(
          flight.size(), [&](std::size_t row) { return flight[row].time_s; },
          [&](std::size_t row) { return Vector3<double>(flight[row + 1].altitude_m - flight[row].altitude_m, 0, 0); },
          [&](std::size_t row) {
            return Vector3<double>(-body_to_world(attitude[row], flight[row].velocity_m_s)[2], 0, 0);
          },
          turning_step_s)
          .sums();
  const auto mistake = find_axis_mistake(sums, follows, follows);
  if (!mistake) return std::nullopt;
  return Implausible{0, altitude_field, "a height that rises with the velocity v_bx to v_bz in column altitude",
                     mistake->negated
                         ? "one that falls with it, correlation " + hundredths(sums.correlation(0, 0)) +
                               " (altitude or the velocity along down is negated)"
                         : "a velocity of " + times_text(mistake->factor) + " its slope (km/h is 3.6 times m/s)"};
}

PINNQUAD_BODY std::optional<Implausible> find_acceleration_mistake(const Flight& flight,
                                                                   const std::vector<Quaternion<double>>& attitude) {
  constexpr double unexplained = 0.1, better = 0.25;
  const auto sums = [&](const auto& value, const auto& rate) {
    return motion_steps(
               flight.size(), [&](std::size_t row) { return flight[row].time_s; },
               [&](std::size_t row) { return Vector3<double>(value(row + 1) - value(row)); }, rate, acceleration_step_s)
        .sums();
  };
  const MotionBlocks angular =
      sums([&](std::size_t row) -> const Vector3<double>& { return flight[row].body_rates_rad_s; },
           [&](std::size_t row) -> const Vector3<double>& { return flight[row].angular_acceleration_rad_s2; });
  if (auto mistake = wrong_axis(angular, angular_field, rates_field)) return mistake;
  if (auto mistake = find_velocity_mistake(flight, attitude)) return mistake;
  if (auto mistake = find_altitude_mistake(flight, attitude)) return mistake;
  const auto left_of = [](const MotionSums& block) {
    return block.changes.sum() + block.integrals.sum() - 2 * block.products.trace();
  };
  std::vector<AccelerationReading::Row> rows;  // in one place: they are read in many ways
  rows.reserve(flight.size());
  for (std::size_t row = 0; row < flight.size(); ++row) {
    rows.emplace_back(flight[row], attitude[row]);
  }
  const auto read_as = [&](const AccelerationReading& reading) {
    return sums([&](std::size_t row) -> const Vector3<double>& { return rows[row].velocity; },
                [&](std::size_t row) { return reading.body_derivative(rows[row]); });
  };
  const MotionBlocks linear = read_as({});
  const double left = left_of(linear);
  if (left > unexplained * linear.changes.sum()) {
    using Reading = AccelerationReading;
    double least = std::min(better * left, related * linear.changes.sum());
    std::string best;
    const auto judge = [&](const Reading& reading) {
      const MotionBlocks read = read_as(reading);
      const double left_so = left_of(read);
      std::vector<double> gains = linear.each(left_of);
      for (std::size_t block = 0; block < gains.size(); ++block) gains[block] -= left_of(read.blocks[block]);
      if (!(left_so < least) || !is_plain(gains)) return;
      least = left_so;
      best = reading.text();
    };
    for (const auto kind : {Reading::without_turning, Reading::no_gravity, Reading::accelerometer}) judge({kind, 0});
    for (std::size_t axes = 0; axes < axes_kinds; ++axes) {
      for (const auto kind : {Reading::world_derivative, Reading::world, Reading::world_force}) judge({kind, axes});
    }
    if (!best.empty()) {
      return Implausible{0, linear_field, expected_derivative,
                         best + ", by how rates and velocity change from row to row"};
    }
  }
  return wrong_axis(linear, linear_field, velocity_field);
}

}  // namespace detail
}  // namespace pinnquad
