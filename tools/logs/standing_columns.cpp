// SPDX-License-Identifier: MIT
#include "logs/standing_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

#include "logs/log_checks.hpp"
#include "logs/specific_force.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/data/row_set.hpp"

namespace pinnquad::logs {
namespace {

using Series = std::vector<double>;

/// Greatest less smallest value in some rows.
double range_of(const Series& series, const IndexRange& rows) {
  const auto at = series.begin();
  const auto [least, most] =
      std::minmax_element(at + static_cast<std::ptrdiff_t>(rows.begin), at + static_cast<std::ptrdiff_t>(rows.end));
  return *most - *least;
}

/// The columns that are watched, and running integrals of what they should change by.
struct WatchedFlight {
  std::array<Series, 3> angles, rates, force, world_velocity, body_velocity;
  std::array<Series, 3> turned;       ///< sum of the attitude's turns from row to row, body axes, rad
  std::array<Series, 3> rotated;      ///< integral of the rates, rad
  std::array<Series, 3> accelerated;  ///< integral of the acceleration in the world, m/s
  Series climbed;                     ///< integral of the velocity upwards, m
  Series altitude, time_s, sum_of_commands;
  std::array<Series, rotor_count> commands;

  /// The first rows of a flight.
  WatchedFlight(const Flight& flight, std::size_t rows) {
    for (auto* const of : {&angles, &rates, &force, &world_velocity, &body_velocity, &turned, &rotated, &accelerated}) {
      for (Series& axis : *of) axis.reserve(rows);
    }
    for (Series* const of : {&climbed, &altitude, &time_s, &sum_of_commands}) of->reserve(rows);
    for (Series& of_rotor : commands) of_rotor.reserve(rows);
    Quaternion<double> before;
    Vector3<double> turns = Vector3<double>::Zero(), integral = turns, speed = turns;
    double climb = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const Sample& sample = flight[row];
      const double step_s = row > 0 ? sample.time_s - flight[row - 1].time_s : 0;
      const Quaternion<double> q = attitude(sample);
      const Vector3<double> f = specific_force_m_s2(sample), v = body_to_world(q, sample.velocity_m_s);
      if (row > 0) turns += detail::turn_vector(conjugate(before) * q);
      before = q;
      integral += step_s * sample.body_rates_rad_s;
      speed += step_s * (body_to_world(q, f) + Vector3<double>(0, 0, standard_gravity_m_s2<double>));
      climb -= step_s * v[2];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        rates[k].push_back(sample.body_rates_rad_s[axis]);
        force[k].push_back(f[axis]);
        world_velocity[k].push_back(v[axis]);
        body_velocity[k].push_back(sample.velocity_m_s[axis]);
        turned[k].push_back(turns[axis]);
        rotated[k].push_back(integral[axis]);
        accelerated[k].push_back(speed[axis]);
      }
      angles[0].push_back(sample.roll_rad);
      angles[1].push_back(sample.pitch_rad);
      angles[2].push_back(sample.yaw_rad);
      climbed.push_back(climb);
      altitude.push_back(sample.altitude_m);
      time_s.push_back(sample.time_s);
      sum_of_commands.push_back(0);
      for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
        commands[rotor].push_back(sample.commands[rotor]);
        sum_of_commands.back() += sample.commands[rotor];
      }
    }
  }

  double widest(const std::array<Series, 3>& of, const IndexRange& rows) const {
    return std::max({range_of(of[0], rows), range_of(of[1], rows), range_of(of[2], rows)});
  }
};

/// Columns that stand still together, and what contradicts it.
struct Watch {
  std::string columns;    ///< "w_x, w_y, w_z"
  std::string goes_with;  ///< "the attitude turns"
  std::size_t field = 0;  ///< the first of them
  std::vector<const Series*> parts;
  double same;  ///< what rounding makes of a value that stands still
  std::function<bool(const IndexRange&)> contradicted;
};

std::vector<Watch> watches_of(const WatchedFlight& flight, const HasQuantities& has) {
  using namespace detail;
  constexpr double same_angle_rad = 1e-6, same_rate = 1e-9, same_force = 1e-5, same_velocity = 1e-6, same_m = 1e-6;
  constexpr double same_command = 1e-9;
  constexpr double turns_rad = 0.03, one_turns_rad = 0.1, heading_turns_rad = 0.5;
  constexpr double least_force = 1, commanded = 0.02, tilts_rad = 0.05, accelerates_m_s = 0.3, climbs_m = 0.3;
  using Triple = std::array<Series, 3>;
  const auto all = [](const Triple& of) { return std::vector<const Series*>{&of[0], &of[1], &of[2]}; };
  const auto names = [](std::size_t field) {
    return field_name(field, 0) + ", " + field_name(field, 1) + ", " + field_name(field, 2);
  };
  // by a rate that stands still the attitude turns evenly
  const auto turns_by = [&flight](std::size_t axis, const IndexRange& rows) {
    const double rate = flight.rates[axis][rows.begin];
    double least = 0, most = 0;
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
      const double off = flight.turned[axis][row] - flight.turned[axis][rows.begin] -
                         rate * (flight.time_s[row] - flight.time_s[rows.begin]);
      least = std::min(least, off);
      most = std::max(most, off);
    }
    return most - least;
  };
  const auto tilts = [&flight](const IndexRange& rows) {
    return range_of(flight.angles[0], rows) > tilts_rad || range_of(flight.angles[1], rows) > tilts_rad;
  };
  const auto commands_move = [&flight](const IndexRange& rows) {
    for (const Series& u : flight.commands) {
      if (range_of(u, rows) > commanded) return true;
    }
    return false;
  };
  std::vector<Watch> watches;
  watches.push_back({names(angles_field), "the body rates turn", angles_field, all(flight.angles), same_angle_rad,
                     [&flight](const IndexRange& rows) { return flight.widest(flight.rotated, rows) > turns_rad; }});
  watches.push_back({names(rates_field), "the attitude turns", rates_field, all(flight.rates), same_rate,
                     [=](const IndexRange& rows) {
                       return turns_by(0, rows) > turns_rad || turns_by(1, rows) > turns_rad ||
                              turns_by(2, rows) > turns_rad;
                     }});
  watches.push_back({names(linear_field) + " (specific force)", "the commands change", linear_field, all(flight.force),
                     same_force, [&flight, commands_move](const IndexRange& rows) {
                       const std::size_t at = rows.begin;
                       const double norm = std::hypot(flight.force[0][at], flight.force[1][at], flight.force[2][at]);
                       return norm < least_force || commands_move(rows);
                     }});
  const auto accelerates = [&flight, tilts](const IndexRange& rows) {
    return flight.widest(flight.accelerated, rows) > accelerates_m_s || tilts(rows);
  };
  if (has.velocity) {
    for (const Triple* const velocity : {&flight.world_velocity, &flight.body_velocity}) {
      watches.push_back({names(velocity_field), "the vehicle accelerates", velocity_field, all(*velocity),
                         same_velocity, accelerates});
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr std::array<const char*, 3> along = {"north", "east", "down"};
      watches.push_back({names(velocity_field) + " along " + along[axis],
                         "the vehicle accelerates",
                         velocity_field,
                         {&flight.world_velocity[axis]},
                         same_velocity,
                         [&flight, axis](const IndexRange& rows) {
                           return range_of(flight.accelerated[axis], rows) > accelerates_m_s &&
                                  flight.widest(flight.world_velocity, rows) > accelerates_m_s;
                         }});
    }
  }
  if (has.altitude) {
    watches.push_back({"altitude",
                       has.velocity ? "the velocity climbs" : "the commands change",
                       altitude_field,
                       {&flight.altitude},
                       same_m,
                       [&flight, has, commands_move](const IndexRange& rows) {
                         return has.velocity ? range_of(flight.climbed, rows) > climbs_m : commands_move(rows);
                       }});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<Eigen::Index>(axis);
    watches.push_back({field_name(angles_field, index),
                       "the body rates turn",
                       angles_field + axis,
                       {&flight.angles[axis]},
                       same_angle_rad,
                       [&flight, axis](const IndexRange& rows) {
                         const double least = axis == 2 ? heading_turns_rad : one_turns_rad;
                         return range_of(flight.rotated[axis], rows) > least;
                       }});
    watches.push_back({field_name(rates_field, index),
                       "the attitude turns",
                       rates_field + axis,
                       {&flight.rates[axis]},
                       same_rate,
                       [=, &flight](const IndexRange& rows) {
                         const bool heads = axis < 2 || range_of(flight.angles[2], rows) > one_turns_rad;
                         return heads && turns_by(axis, rows) > one_turns_rad;
                       }});
    watches.push_back({field_name(linear_field, index) + " (specific force)",
                       axis == 2 ? "the commands change" : "the vehicle tilts",
                       linear_field + axis,
                       {&flight.force[axis]},
                       same_force,
                       [&flight, axis, tilts](const IndexRange& rows) {
                         if (axis == 2) return range_of(flight.sum_of_commands, rows) > 2 * commanded;
                         return range_of(flight.force[1 - axis], rows) > least_force && tilts(rows);
                       }});
  }
  if (!has.motors) return watches;
  const auto turns = [&flight](const IndexRange& rows) { return flight.widest(flight.rotated, rows) > one_turns_rad; };
  watches.push_back({"u1, u2, u3, u4", "the body rates turn", first_command_field, {}, same_command, turns});
  for (const Series& u : flight.commands) watches.back().parts.push_back(&u);
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
    const auto& u = flight.commands[rotor];
    const auto [least, most] = std::minmax_element(u.begin(), u.end());
    const double low = u.empty() ? 0 : *least, high = u.empty() ? 0 : *most;
    watches.push_back({"u" + std::to_string(rotor + 1),
                       "the other commands change",
                       first_command_field + rotor,
                       {&u},
                       same_command,
                       [&flight, &u, rotor, low, high](const IndexRange& rows) {
                         const double at = u[rows.begin];
                         const bool limit = high > low && (at <= low || at >= high);  // saturated_rows() has these
                         if (limit) return false;
                         for (std::size_t other = 0; other < rotor_count; ++other) {
                           if (other != rotor && range_of(flight.commands[other], rows) > commanded) return true;
                         }
                         return false;
                       }});
  }
  return watches;
}

std::string columns_of(const Watch& watch) {
  return (watch.columns.find(',') == std::string::npos ? "column " : "columns ") + watch.columns;
}

bool stands(const Watch& watch, std::size_t from, std::size_t row) {
  return std::all_of(watch.parts.begin(), watch.parts.end(),
                     [&](const Series* part) { return std::abs((*part)[row] - (*part)[from]) <= watch.same; });
}

/// Rows one after the other, without a gap, that hold one value.
std::vector<IndexRange> runs_of(const Watch& watch, const Series& time_s, double period_s) {
  std::vector<IndexRange> runs;
  for (std::size_t begin = 0, end = 0; begin < time_s.size(); begin = end) {
    for (end = begin + 1;
         end < time_s.size() && stands(watch, begin, end) && time_s[end] - time_s[end - 1] <= 1.5 * period_s;) {
      ++end;
    }
    runs.push_back({begin, end});
  }
  return runs;
}

}  // namespace

std::optional<detail::Implausible> find_standing_column(const Flight& flight, const HasQuantities& has) {
  constexpr std::size_t few = 1000;  // of a flight that is one all columns move
  if (flight.size() < 2) return std::nullopt;
  const auto stands_still = [](const Watch& watch, std::size_t rows) {
    std::size_t row = 1;
    while (row < rows && stands(watch, 0, row)) ++row;
    return row == rows;
  };
  const std::size_t first = std::min(few, flight.size());
  const WatchedFlight begin(flight, first);
  const std::vector<Watch> of_begin = watches_of(begin, has);
  if (std::none_of(of_begin.begin(), of_begin.end(), [&](const Watch& watch) { return stands_still(watch, first); })) {
    return std::nullopt;
  }
  const WatchedFlight watched(flight, flight.size());
  for (const Watch& watch : watches_of(watched, has)) {
    if (!stands_still(watch, flight.size()) || !watch.contradicted({0, flight.size()})) continue;
    return detail::Implausible{
        0, watch.field, columns_of(watch) + " that change while " + watch.goes_with,
        "the same in all " + std::to_string(flight.size()) + " rows: a sensor that is off or has stopped"};
  }
  return std::nullopt;
}

std::optional<detail::Implausible> find_wrong_gravity(const Flight& flight) {
  constexpr double least = 0.6, most = 5, shortest_s = 5;
  if (flight.size() < 2 || flight[flight.size() - 1].time_s - flight[0].time_s < shortest_s) return std::nullopt;
  Series sizes;
  sizes.reserve(flight.size());
  for (const Sample& sample : flight) sizes.push_back(specific_force_m_s2(sample).norm());
  const double usual = detail::median_of(std::move(sizes)), in_g = usual / standard_gravity_m_s2<double>;
  if (in_g >= least && in_g <= most) return std::nullopt;
  return detail::Implausible{
      0, detail::linear_field,
      "a specific force near 9.8 m/s^2 in columns " + detail::field_name(detail::linear_field, 0) + ", " +
          detail::field_name(detail::linear_field, 1) + ", " + detail::field_name(detail::linear_field, 2) +
          ", as gravity asks of what stays in the air",
      "one of " + short_number(usual) + " m/s^2 in most rows: " +
          (in_g < least ? "an accelerometer that is off, without gravity, or in g (unit = \"g\")"
                        : "another unit (unit = \"mg\", \"cm/s^2\", or a scale)")};
}

StandingRows standing_rows(const Flight& flight, const HasQuantities& has, double period_s, double begin_s) {
  constexpr double shortest_s = 0.5, longer = 5, margin_s = 0.1;
  constexpr std::size_t fewest_rows = 10, fewest_runs = 20, usual = 3;  // the longest but three
  StandingRows result;
  result.out.assign(flight.size(), false);
  if (flight.empty()) return result;
  const WatchedFlight watched(flight, flight.size());
  for (const Watch& watch : watches_of(watched, has)) {
    const std::vector<IndexRange> runs = runs_of(watch, watched.time_s, period_s);
    if (runs.size() < fewest_runs) continue;
    std::vector<std::size_t> lengths;
    for (const IndexRange& run : runs) lengths.push_back(run.size());
    std::nth_element(lengths.begin(), lengths.begin() + usual, lengths.end(), std::greater<>());
    const double longest_s = std::max(shortest_s, longer * static_cast<double>(lengths[usual]) * period_s);
    double sum_s = 0, first_s = 0;
    std::size_t found = 0;
    for (const IndexRange& run : runs) {
      const double lasts_s = watched.time_s[run.end - 1] - watched.time_s[run.begin];
      if (run.size() < fewest_rows || lasts_s < longest_s || !watch.contradicted(run)) continue;
      if (std::all_of(result.out.begin() + static_cast<std::ptrdiff_t>(run.begin),
                      result.out.begin() + static_cast<std::ptrdiff_t>(run.end), [](bool out) { return out; })) {
        continue;  // of columns that were told
      }
      if (found++ == 0) first_s = watched.time_s[run.begin] - begin_s;
      sum_s += lasts_s;
      for (std::size_t row = 0; row < flight.size(); ++row) {
        if (watched.time_s[row] >= watched.time_s[run.begin] - margin_s &&
            watched.time_s[row] <= watched.time_s[run.end - 1] + margin_s) {
          result.out[row] = true;
        }
      }
    }
    if (found == 0) continue;
    result.told.push_back(columns_of(watch) + ": the same for " + short_number(sum_s) + " s in " +
                          std::to_string(found) + (found == 1 ? " stretch" : " stretches") + ", first at " +
                          short_number(first_s) + " s, while " + watch.goes_with + ": left out");
  }
  return result;
}

}  // namespace pinnquad::logs
