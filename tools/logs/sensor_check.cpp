// SPDX-License-Identifier: MIT
#include "logs/sensor_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <utility>

#include "logs/log_checks.hpp"
#include "logs/specific_force.hpp"
#include "pinnquad/data/motion_checks.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/regression/block_regression.hpp"

namespace pinnquad::logs {
namespace {

constexpr std::array<const char*, 3> axes = {"x", "y", "z"};

/// Steps of a flight without a gap in time, one after the other, each of `size` rows.
struct StepsOfFlight {
  std::size_t size = 0;
  double duration_s = 0;
  std::vector<std::size_t> begins;
};

StepsOfFlight steps_of(const Flight& flight, double period_s, double step_s) {
  StepsOfFlight steps;
  steps.size = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(step_s / period_s)));
  steps.duration_s = static_cast<double>(steps.size) * period_s;
  for (std::size_t row = 0; row + steps.size < flight.size();) {
    const double taken_s = flight[row + steps.size].time_s - flight[row].time_s;
    const bool whole = std::abs(taken_s - steps.duration_s) < 0.6 * period_s;
    if (whole) steps.begins.push_back(row);
    row += whole ? steps.size : 1;
  }
  return steps;
}

/// A flight's rows in axes of the world, turned once for all checks.
struct InWorld {
  std::vector<Quaternion<double>> attitude;
  std::vector<Vector3<double>> velocity, force;

  explicit InWorld(const Flight& flight) : attitude(detail::attitudes_of(flight)) {
    velocity.reserve(flight.size());
    force.reserve(flight.size());
    for (std::size_t row = 0; row < flight.size(); ++row) {
      velocity.push_back(body_to_world<double>(attitude[row], flight[row].velocity_m_s));
      force.push_back(body_to_world<double>(attitude[row], specific_force_m_s2(flight[row])));
    }
  }

  /// Rotation vector from one row to another.
  Vector3<double> turn(std::size_t first, std::size_t last) const {
    return detail::turn_vector(conjugate(attitude[first]) * attitude[last]);
  }
};

/// Mean over the rows of a step, its ends by half.
template <class Of>
Vector3<double> mean_of(std::size_t begin, std::size_t size, const Of& of) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (std::size_t row = begin; row <= begin + size; ++row) {
    sum += (row == begin || row == begin + size ? 0.5 : 1.0) * of(row);
  }
  return sum / static_cast<double>(size);
}

/// Adds expected - measured = r x measured + others of one step: three rows, one to an axis.
template <std::size_t Unknowns, class Others>
void add_step(BlockRegression& regression, std::size_t block, const Vector3<double>& expected,
              const Vector3<double>& measured, const Others& others) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    const auto at = [](const Vector3<double>& v, std::size_t i) { return v[static_cast<Eigen::Index>(i)]; };
    std::array<double, Unknowns> x{};
    x[next] = at(measured, last);
    x[last] = -at(measured, next);
    others(axis, x);
    regression.add(block, x.data(), at(expected, axis) - at(measured, axis));
  }
}

/// The unknowns of `Unknowns` by all steps of a flight; nothing where they are too few.
template <std::size_t Unknowns, class Add>
std::optional<BlockSolution> solved(const StepsOfFlight& steps, const Add& add) {
  constexpr std::size_t most_blocks = 20, fewest_blocks = 8;
  const std::size_t count = steps.begins.size(), blocks = std::min(most_blocks, count / 2);
  if (blocks < fewest_blocks) return std::nullopt;
  BlockRegression regression(Unknowns, 0, blocks);
  for (std::size_t step = 0; step < count; ++step) add(regression, step * blocks / count, steps.begins[step]);
  return regression.solve();
}

/// True where the whole interval is further from zero than that.
bool is_beyond(const Estimate& estimate, double most) { return std::abs(estimate.value) - estimate.half_width > most; }

Estimate positive(const Estimate& estimate) { return {std::abs(estimate.value), estimate.half_width}; }

/// A finding for each of the first `count` axes about which one is turned against the other.
void check_rotation(const BlockSolution& found, std::size_t count, const std::string& what, const std::string& cause,
                    std::vector<SensorFinding>& findings) {
  constexpr double most_rad = 5 / degrees_per_radian;
  for (std::size_t axis = 0; axis < count; ++axis) {
    const Estimate turned = found.estimate(axis);
    if (!is_beyond(turned, most_rad) || turned.half_width > most_rad) continue;
    findings.push_back({what + " turned by " + with_interval(positive(turned) * degrees_per_radian, "degrees") +
                            " about " + axes[axis] + cause,
                        false});
  }
}

void check_rates(const Flight& flight, const InWorld& world, double period_s, std::vector<SensorFinding>& findings) {
  constexpr double step_s = 0.2, most_late_s = 0.02;
  constexpr std::array<double, 3> most_rad_s = {0.04, 0.04, 0.012};
  constexpr std::size_t bias = 3, late = 6, unknowns = 7;
  const StepsOfFlight steps = steps_of(flight, period_s, step_s);
  const auto rates = [&](std::size_t row) -> const Vector3<double>& { return flight[row].body_rates_rad_s; };
  const std::size_t end_rows = std::max<std::size_t>(1, steps.size / 8);  // their mean has less noise
  const auto found = solved<unknowns>(steps, [&](BlockRegression& regression, std::size_t block, std::size_t row) {
    const std::size_t last = row + steps.size;
    const Vector3<double> turned = world.turn(row, last);
    const Vector3<double> integral = mean_of(row, steps.size, rates) * steps.duration_s;
    Vector3<double> change = Vector3<double>::Zero();
    for (std::size_t i = 0; i < end_rows; ++i) {
      change += (rates(last - i) - rates(row + i)) / static_cast<double>(end_rows);
    }
    add_step<unknowns>(regression, block, turned, integral, [&](std::size_t axis, std::array<double, unknowns>& x) {
      x[bias + axis] = -steps.duration_s;
      x[late] = change[static_cast<Eigen::Index>(axis)];
    });
  });
  if (!found) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Estimate off = found->estimate(bias + axis);
    if (!is_beyond(off, most_rad_s[axis])) continue;
    findings.push_back({std::string("column w_") + axes[axis] + ": on average " +
                            with_interval(positive(off), "rad/s") + (off.value > 0 ? " more" : " less") +
                            " than the attitude turns by: a gyro's bias" +
                            (axis == 2 ? ", or a heading (yaw) that drifts" : ""),
                        axis == 2});
  }
  const Estimate late_ms = found->estimate(late) * 1e3;
  if (late_ms.low() > 1e3 * most_late_s) {
    findings.push_back(
        {"columns w_x to w_z: the rates come " + with_interval(late_ms, "ms") +
             " after the turning of the attitude, and so do the angular accelerations, where filters of a "
             "gyro take 2 to 10 ms: a low-pass, or a topic's clock",
         false});
  }
  check_rotation(*found, 3, "columns w_x to w_z: the rates are",
                 " against the attitude: the gyro is mounted askew, or one of the two is in other axes", findings);
}

void check_force(const Flight& flight, const InWorld& world, double period_s, std::vector<SensorFinding>& findings) {
  constexpr double step_s = 0.4;
  constexpr std::size_t unknowns = 3;
  const StepsOfFlight steps = steps_of(flight, period_s, step_s);
  const auto found = solved<unknowns>(steps, [&](BlockRegression& regression, std::size_t block, std::size_t row) {
    const Vector3<double> gravity(0, 0, standard_gravity_m_s2<double>);
    const Vector3<double> expected =
        (world.velocity[row + steps.size] - world.velocity[row]) / steps.duration_s - gravity;
    const Vector3<double> measured =
        mean_of(row, steps.size, [&](std::size_t at) -> const Vector3<double>& { return world.force[at]; });
    const Quaternion<double>& middle = world.attitude[row + steps.size / 2];
    add_step<unknowns>(regression, block, world_to_body<double>(middle, expected),
                       world_to_body<double>(middle, measured), [](std::size_t, const auto&) {});
  });
  // about z: the heading against the velocity's world, which few flights tell
  if (found) {
    check_rotation(*found, 2, "columns vdot_bx to vdot_bz: the specific force is",
                   " against attitude and velocity: the accelerometer is mounted askew, or has an offset", findings);
  }
}

/// A second of the log in seconds, by what changes over time: y = rate * x + offset for each of `axes_of` axes.
template <std::size_t Axes, class ChangeAndIntegral>
Estimate clock_rate(const StepsOfFlight& steps, const ChangeAndIntegral& of) {
  const auto found = solved<1 + Axes>(steps, [&](BlockRegression& regression, std::size_t block, std::size_t row) {
    const std::array<Vector3<double>, 2> step = of(row, row + steps.size);
    for (std::size_t axis = 3 - Axes; axis < 3; ++axis) {
      std::array<double, 1 + Axes> x{};
      x[0] = step[1][static_cast<Eigen::Index>(axis)];
      x[1 + axis - (3 - Axes)] = steps.duration_s;
      regression.add(block, x.data(), step[0][static_cast<Eigen::Index>(axis)]);
    }
  });
  return found && found->told(0) ? found->estimate(0) : Estimate{};
}

/// A gyro's scale may be off, and an accelerometer's: a clock shows in two or more alike.
void check_clock_rate(const Flight& flight, const InWorld& world, double period_s, bool has_velocity, bool has_altitude,
                      std::vector<SensorFinding>& findings) {
  constexpr double step_s = 0.2, least_off = 0.006, told = 0.006, alike = 0.002;
  const StepsOfFlight steps = steps_of(flight, period_s, step_s);
  const auto integral = [&](std::size_t first, std::size_t last, const auto& of) {
    return Vector3<double>(mean_of(first, last - first, of) * steps.duration_s);
  };
  using Step = std::array<Vector3<double>, 2>;  // change and integral
  std::vector<std::pair<const char*, Estimate>> rates;
  rates.emplace_back("attitude and body rates", clock_rate<3>(steps, [&](std::size_t first, std::size_t last) {
                       return Step{world.turn(first, last), integral(first, last, [&](std::size_t row) {
                                     return flight[row].body_rates_rad_s;
                                   })};
                     }));
  if (has_velocity) {
    rates.emplace_back("velocity and specific force", clock_rate<3>(steps, [&](std::size_t first, std::size_t last) {
                         return Step{world.velocity[last] - world.velocity[first],
                                     integral(first, last, [&](std::size_t row) { return world.force[row]; })};
                       }));
  }
  if (has_velocity && has_altitude) {
    rates.emplace_back(
        "altitude and velocity", clock_rate<1>(steps, [&](std::size_t first, std::size_t last) {
          const Vector3<double> fallen(0, 0, flight[first].altitude_m - flight[last].altitude_m);
          return Step{fallen, integral(first, last, [&](std::size_t row) { return world.velocity[row]; })};
        }));
  }
  for (std::size_t i = 0; i < rates.size(); ++i) {
    for (std::size_t k = i + 1; k < rates.size(); ++k) {
      const Estimate &a = rates[i].second, &b = rates[k].second;
      const auto off = [](const Estimate& rate) {
        return rate.half_width < told && is_beyond({rate.value - 1, rate.half_width}, least_off);
      };
      const double wide = std::max(alike, std::hypot(a.half_width, b.half_width));
      if (!off(a) || !off(b) || std::abs(a.value - b.value) > wide) continue;
      const Estimate& best = a.half_width < b.half_width ? a : b;
      char scale[32];
      std::snprintf(scale, sizeof scale, "%.4f", best.value);
      findings.push_back(
          {std::string("column t: a second of the log lasts ") + scale + " s, by " + rates[i].first + " and by " +
               rates[k].first +
               " alike: its clock runs wrong (a Crazyflie's uSD deck before August 2026: 85/84 = 1.0119); "
               "scale = " +
               scale + " in [time] of the mapping puts it right",
           false});
      return;
    }
  }
}

}  // namespace

std::vector<SensorFinding> check_sensors(const Flight& flight, bool has_velocity, bool has_altitude) {
  std::vector<SensorFinding> findings;
  const double period_s = sample_period_s(RowSet(flight, {0, flight.size()}));
  if (!(period_s > 0)) return findings;
  const InWorld world(flight);
  check_rates(flight, world, period_s, findings);
  if (has_velocity) check_force(flight, world, period_s, findings);
  check_clock_rate(flight, world, period_s, has_velocity, has_altitude, findings);
  return findings;
}

std::optional<detail::Implausible> find_turning_of_other_size(const Flight& flight) {
  using namespace detail;
  constexpr double most = 4.0 / 3, related = 0.6;
  const MotionBlocks sums = turning_sums(flight, attitudes_of(flight));
  const double product = sums.products.trace(), turned = sums.changes.sum(), integrated = sums.integrals.sum();
  if (!(product > related * std::sqrt(turned * integrated)) || !(product > 0)) return std::nullopt;
  // noise of the rates makes product / integrated small, noise of the attitude turned / product large
  const bool small = turned<product / most, large = product> most * integrated;
  const auto gain = [&](const MotionSums& block) {
    return small ? block.products.trace() / most - block.changes.sum()
                 : block.products.trace() - most * block.integrals.sum();
  };
  if (!(small || large) || !is_plain(sums.each(gain))) return std::nullopt;
  return Implausible{0, angles_field, "an attitude that turns by the integral of the body rates w_x, w_y, w_z",
                     "one that turns by " + short_number(small ? turned / product : product / integrated) +
                         " times that: the scale of the quaternion or the angles, or the range of the gyro"};
}

}  // namespace pinnquad::logs
