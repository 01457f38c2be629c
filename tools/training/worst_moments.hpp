// SPDX-License-Identifier: MIT
// The moments of held-out flights in which a model is most wrong, and what was happening then.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "page/text.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "training/flight_errors.hpp"
#include "training/hold_out.hpp"

namespace programs {

/// A row of a held-out flight, and the error about it.
struct WorstMoment {
  const pinnquad::Flight* flight = nullptr;
  std::size_t fold = 0;
  std::size_t row = 0;       ///< of the flight
  std::size_t held_out = 0;  ///< the same, of the parting's held-out rows
  double error = 0;          ///< root mean square over half a second and all motors
  std::size_t motor = 0;     ///< the one that is most off there
};

namespace detail {

inline constexpr double moment_s = 0.5;       ///< over which an error is one moment
inline constexpr double moments_apart_s = 3;  ///< closer ones are told once

/// Squared errors of a row that counts.
struct RowSquares {
  double time_s;
  std::size_t row;
  MotorFigures of_motor;
};

/// The worst moments of one piece of a parting's held-out rows, the worst first.
inline std::vector<WorstMoment> moments_of(const pinnquad::FlightRows& piece, std::size_t fold, std::size_t first,
                                           const Predictions& predictions, const std::vector<bool>& counts) {
  std::vector<RowSquares> squares;
  for (std::size_t i = piece.rows.begin; i < piece.rows.end; ++i) {
    const std::size_t at = first + i - piece.rows.begin;
    if (!counts[at]) continue;
    RowSquares square{(*piece.flight)[i].time_s, i, {}};
    for (std::size_t motor = 0; motor < square.of_motor.size(); ++motor) {
      const double error = predictions[at][motor] - (*piece.flight)[i].commands[motor];
      square.of_motor[motor] = error * error;
    }
    squares.push_back(square);
  }
  std::vector<WorstMoment> moments;
  std::size_t begin = 0, end = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    while (end < squares.size() && squares[end].time_s <= squares[i].time_s + moment_s / 2) ++end;
    while (squares[begin].time_s < squares[i].time_s - moment_s / 2) ++begin;
    MotorFigures sum{};  // anew: a running sum keeps what a wild value rounded off
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t motor = 0; motor < sum.size(); ++motor) sum[motor] += squares[k].of_motor[motor];
    }
    double all = 0;
    for (const double of_motor : sum) all += of_motor;
    const double count = static_cast<double>(end - begin) * static_cast<double>(sum.size());
    WorstMoment moment{piece.flight,           fold, squares[i].row, first + squares[i].row - piece.rows.begin,
                       std::sqrt(all / count), 0};
    moment.motor = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
    moments.push_back(moment);
  }
  std::sort(moments.begin(), moments.end(),
            [](const WorstMoment& a, const WorstMoment& b) { return a.error > b.error; });
  return moments;
}

}  // namespace detail

/// Speed, tilt and the rest at a row.
struct MomentFacts {
  double speed_m_s = 0, tilt_deg = 0, altitude_m = 0, turning_rad_s = 0, angular_acceleration_rad_s2 = 0;
};

inline MomentFacts facts_at(const pinnquad::Sample& sample) {
  MomentFacts facts;
  facts.speed_m_s = sample.velocity_m_s.norm();
  facts.tilt_deg = pinnquad::degrees_per_radian *
                   std::acos(std::clamp(std::cos(sample.roll_rad) * std::cos(sample.pitch_rad), -1.0, 1.0));
  facts.altitude_m = sample.altitude_m;
  facts.turning_rad_s = sample.body_rates_rad_s.norm();
  facts.angular_acceleration_rad_s2 = sample.angular_acceleration_rad_s2.norm();
  return facts;
}

/// The worst moments of all held-out rows, at most `count`, the worst first, none within seconds of another.
/// `predictions[fold]` and `counts[fold]` are of the parting's held-out rows.
inline std::vector<WorstMoment> worst_moments(const std::vector<Fold>& folds,
                                              const std::vector<const Predictions*>& predictions,
                                              const std::vector<std::vector<bool>>& counts, std::size_t count) {
  std::vector<WorstMoment> all;
  for (std::size_t fold = 0; fold < folds.size(); ++fold) {
    std::size_t first = 0;
    for (const pinnquad::FlightRows& piece : folds[fold].split.test.pieces()) {
      const auto of_piece = detail::moments_of(piece, fold, first, *predictions[fold], counts[fold]);
      std::vector<WorstMoment> kept;
      for (const WorstMoment& moment : of_piece) {
        const double time_s = (*moment.flight)[moment.row].time_s;
        const bool near = std::any_of(kept.begin(), kept.end(), [&](const WorstMoment& other) {
          return std::abs((*other.flight)[other.row].time_s - time_s) < detail::moments_apart_s;
        });
        if (!near) kept.push_back(moment);
        if (kept.size() == count) break;
      }
      all.insert(all.end(), kept.begin(), kept.end());
      first += piece.rows.size();
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const WorstMoment& a, const WorstMoment& b) { return a.error > b.error; });
  all.resize(std::min(count, all.size()));
  return all;
}

/// Everything unusual for that flight within half a second of the moment, in a few words; "nothing that stands out"
/// else.
inline std::string what_happened(const WorstMoment& moment, const pinnquad::logs::ImportedDataset& dataset) {
  constexpr double unusual = 0.95, nearly_full = 0.97, nearly_idle = 0.03;
  const pinnquad::Flight& flight = *moment.flight;
  std::vector<MomentFacts> all;
  for (const pinnquad::Sample& sample : flight) all.push_back(facts_at(sample));
  double most_command = 0, least_command = 1, longest_gap_s = 0;
  MomentFacts peak;
  const double time_s = flight[moment.row].time_s;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    if (std::abs(flight[row].time_s - time_s) > detail::moment_s) continue;
    for (const double u : flight[row].commands) {
      most_command = std::max(most_command, u);
      least_command = std::min(least_command, u);
    }
    if (row > 0) longest_gap_s = std::max(longest_gap_s, flight[row].time_s - flight[row - 1].time_s);
    peak.speed_m_s = std::max(peak.speed_m_s, all[row].speed_m_s);
    peak.tilt_deg = std::max(peak.tilt_deg, all[row].tilt_deg);
    peak.turning_rad_s = std::max(peak.turning_rad_s, all[row].turning_rad_s);
    peak.angular_acceleration_rad_s2 = std::max(peak.angular_acceleration_rad_s2, all[row].angular_acceleration_rad_s2);
  }
  const auto usual = [&](double MomentFacts::*of) {
    std::vector<double> values;
    for (const MomentFacts& facts : all) values.push_back(facts.*of);
    const auto place = static_cast<std::ptrdiff_t>(unusual * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
  };
  std::string told;
  const auto say = [&told](const std::string& what) { add_to_list(told, what); };
  if (most_command > nearly_full) say("a motor at full (" + shown::number(most_command, 2) + ")");
  if (least_command < nearly_idle) say("a motor at idle (" + shown::number(least_command, 2) + ")");
  if (dataset.sample_period_s > 0 && longest_gap_s > 1.5 * dataset.sample_period_s) {
    say(shown::number(longest_gap_s, 2) + " s of rows missing (not logged, or dropped by the import)");
  }
  const auto stands_out = [&](double MomentFacts::*of) { return peak.*of > usual(of); };
  if (!dataset.lacks("velocity") && stands_out(&MomentFacts::speed_m_s)) say("among the fastest 5 % of the flight");
  if (stands_out(&MomentFacts::tilt_deg)) say("tilted to " + shown::number(peak.tilt_deg, 0) + "°");
  if (stands_out(&MomentFacts::turning_rad_s)) say("turning at " + shown::number(peak.turning_rad_s, 1) + " rad/s");
  if (stands_out(&MomentFacts::angular_acceleration_rad_s2)) {
    say("angular acceleration up to " + shown::number(peak.angular_acceleration_rad_s2, 0) + " rad/s²");
  }
  return told.empty() ? "nothing that stands out" : told;
}

}  // namespace programs
