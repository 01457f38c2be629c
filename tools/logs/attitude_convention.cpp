// SPDX-License-Identifier: MIT
#include "logs/attitude_convention.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad::logs {
namespace {

constexpr std::size_t attitude_conventions = 16;

AttitudeConvention attitude_convention(std::size_t index) {
  return {(index & 1u) != 0, (index & 2u) != 0, (index & 4u) != 0, (index & 8u) != 0};
}

std::size_t index_of(const AttitudeConvention& of) {
  return (of.scalar_last ? 1u : 0u) | (of.world_to_body ? 2u : 0u) | (of.enu ? 4u : 0u) | (of.flu ? 8u : 0u);
}

/// In what a log is other than it was read as.
std::string difference_sentence(const AttitudeConvention& log, const AttitudeConvention& read) {
  std::string text;
  const auto say = [&text](const std::string& what) { text += (text.empty() ? "" : " and ") + what; };
  if (log.scalar_last != read.scalar_last)
    say(log.scalar_last ? "is in the order x, y, z, w" : "is in the order w, x, y, z");
  if (log.world_to_body != read.world_to_body) {
    say(log.world_to_body ? "turns the world into the body" : "turns the body into the world");
  }
  if (log.enu != read.enu)
    say(log.enu ? "has a world of east, north, up (ENU)" : "has a world of north, east, down (NED)");
  if (log.flu != read.flu)
    say(log.flu ? "has a body of x forward, y left, z up (FLU)" : "has a body of x forward, y right, z down (FRD)");
  return "the attitude " + text;
}

}  // namespace

Quaternion<double> read_attitude(const std::array<double, 4>& numbers, const AttitudeConvention& as) {
  const auto& n = numbers;
  Quaternion<double> q =
      as.scalar_last ? Quaternion<double>{n[3], n[0], n[1], n[2]} : Quaternion<double>{n[0], n[1], n[2], n[3]};
  if (as.world_to_body) q = conjugate(q);
  if (as.enu) q = swap_world_enu_ned(q);
  return as.flu ? swap_body_flu_frd(q) : q;
}

std::array<double, 4> written_attitude(Quaternion<double> q, const AttitudeConvention& as) {
  if (as.flu) q = swap_body_flu_frd(q);
  if (as.enu) q = swap_world_enu_ned(q);
  if (as.world_to_body) q = conjugate(q);
  if (as.scalar_last) return {q.x, q.y, q.z, q.w};
  return {q.w, q.x, q.y, q.z};
}

std::optional<std::string> check_attitude(double period_s, const AttitudeConvention& read,
                                          const std::array<const std::vector<double>*, 4>& q,
                                          const std::array<const std::vector<double>*, 3>& body_rates_rad_s,
                                          const std::array<const std::vector<double>*, 3>& specific_force_m_s2) {
  constexpr double step_s = 0.2, misses = 0.5, better = 1.0 / 3, smallest_rates = 1e-3;
  constexpr std::size_t fewest_steps = 20;
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(step_s / period_s)));
  const std::size_t rows = q[0]->size();
  std::array<double, attitude_conventions> left{};
  std::array<Vector3<double>, attitude_conventions> force;
  force.fill(Vector3<double>::Zero());
  double rates = 0;
  std::size_t steps = 0;
  for (std::size_t first = 0; first + step < rows; first += step) {
    Vector3<double> rate = Vector3<double>::Zero(), held = rate;
    bool whole = true;
    for (std::size_t row = first; row <= first + step; ++row) {
      const double weight = row == first || row == first + step ? 0.5 : 1.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<Eigen::Index>(i);
        rate[axis] += weight * (*body_rates_rad_s[i])[row] / static_cast<double>(step);
        held[axis] += weight * (*specific_force_m_s2[i])[row] / static_cast<double>(step);
      }
    }
    std::array<std::array<double, 4>, 3> at{};  // begin, middle, end
    const std::array<std::size_t, 3> rows_of = {first, first + step / 2, first + step};
    for (std::size_t k = 0; k < at.size(); ++k) {
      const std::size_t row = rows_of[k];
      at[k] = written_attitude({(*q[0])[row], (*q[1])[row], (*q[2])[row], (*q[3])[row]}, read);
      for (const double number : at[k]) whole = whole && std::isfinite(number);
    }
    whole = whole && rate.allFinite() && held.allFinite();
    if (!whole) continue;
    steps += 1;
    rates += rate.squaredNorm();
    for (std::size_t c = 0; c < left.size(); ++c) {
      const AttitudeConvention as = attitude_convention(c);
      const Quaternion<double> a = read_attitude(at[0], as), b = read_attitude(at[2], as);
      const Quaternion<double> turn = conjugate(a) * b;
      const Vector3<double> v = (turn.w < 0 ? -1.0 : 1.0) * Vector3<double>(turn.x, turn.y, turn.z);
      const double sine = v.norm();
      const double angle = 2 * std::atan2(sine, std::abs(turn.w));
      const double to_rate = sine > 1e-12 ? angle / (sine * static_cast<double>(step) * period_s) : 0;
      left[c] += (rate - v * to_rate).squaredNorm();
      force[c] += body_to_world(normalized(read_attitude(at[1], as)), held);
    }
  }
  if (steps < fewest_steps) return std::nullopt;
  const auto count = static_cast<double>(steps);
  std::array<double, attitude_conventions> miss{};
  for (std::size_t c = 0; c < miss.size(); ++c) {
    const Vector3<double> up(0, 0, -standard_gravity_m_s2<double>);
    const double turning = rates > smallest_rates * count ? std::min(1.0, left[c] / rates) : 0;
    miss[c] = turning + std::min(1.0, (force[c] / count - up).norm() / standard_gravity_m_s2<double>);
  }
  const auto best = static_cast<std::size_t>(std::min_element(miss.begin(), miss.end()) - miss.begin());
  const double missed = miss[index_of(read)];
  if (!(missed >= misses) || !(miss[best] < better * missed)) return std::nullopt;
  return difference_sentence(attitude_convention(best), read) +
         ", by how it turns with the body rates and where it points the specific force";
}

std::optional<std::string> check_thrust_direction(const std::vector<double>& specific_force_z_m_s2, bool read_as_flu) {
  constexpr double clearly = 0.3;
  double sum = 0;
  std::size_t count = 0;
  for (const double z : specific_force_z_m_s2) {
    if (!std::isfinite(z)) continue;
    sum += z;
    ++count;
  }
  const double mean = count > 0 ? sum / (static_cast<double>(count) * standard_gravity_m_s2<double>) : 0;
  if (mean < clearly) return std::nullopt;
  return std::string("the specific force points along +z of the body, which is down: the log's body is x forward, y ") +
         (read_as_flu ? "right, z down (FRD)" : "left, z up (FLU)") + ", or its accelerometer has the other sign";
}

}  // namespace pinnquad::logs
