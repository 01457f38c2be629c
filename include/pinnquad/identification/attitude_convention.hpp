// SPDX-License-Identifier: MIT
// Is a quaternion (w, x, y, z), from body FRD to world NED? Asked of the motion: it turns with the body rates, and the specific
// force that it turns into the world holds the vehicle up on average.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "pinnquad/core/rotation.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/identification/finding.hpp"

namespace pinnquad {

namespace detail {

inline constexpr std::size_t attitude_conventions = 8;
inline constexpr std::array<const char*, attitude_conventions> attitude_sentences = {
    "",
    "the quaternion is in the order x, y, z, w",
    "the quaternion turns the world into the body: conjugate it",
    "the quaternion is in the order x, y, z, w and turns the world into the body",
    "the attitude is that of x forward, y left, z up in east, north, up (ENU, FLU)",
    "the attitude is that of ENU, FLU with the quaternion in the order x, y, z, w",
    "the attitude is that of ENU, FLU, from the world into the body",
    "the attitude is that of ENU, FLU, from the world into the body, in the order x, y, z, w"};

/// Four numbers read under a convention.
inline Quaternion<double> read_attitude(const std::array<double, 4>& q, std::size_t convention) {
  Quaternion<double> result =
      (convention & 1u) != 0 ? Quaternion<double>{q[3], q[0], q[1], q[2]} : Quaternion<double>{q[0], q[1], q[2], q[3]};
  if ((convention & 2u) != 0) result = conjugate(result);
  if ((convention & 4u) != 0) result = swap_enu_flu_ned_frd(result);
  return result;
}

}  // namespace detail

/// Series on one uniform clock, rows with a NaN left out. In each convention: the share of the body rates' squares that the turning
/// of the attitude over 0.2 s leaves, and the distance of the mean specific force in the world to -g, in g (at most 1 each). A
/// finding where the convention as it is misses by 0.5 or more in sum, and another by less than a third of that. number: the sum.
/// Limits: a vehicle that neither turns nor tilts says only which way is up; heading is not judged (no magnetic field is known).
inline std::optional<Finding> check_attitude(double period_s, const std::array<const std::vector<double>*, 4>& q,
                                             const std::array<const std::vector<double>*, 3>& body_rates_rad_s,
                                             const std::array<const std::vector<double>*, 3>& specific_force_m_s2) {
  constexpr double step_s = 0.2, misses = 0.5, better = 1.0 / 3, smallest_rates = 1e-3;
  constexpr std::size_t fewest_steps = 20;
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(step_s / period_s)));
  const std::size_t rows = q[0]->size();
  std::array<double, detail::attitude_conventions> left{};
  std::array<Vector3<double>, detail::attitude_conventions> force;
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
    for (std::size_t i = 0; i < 4; ++i) {
      at[0][i] = (*q[i])[first];
      at[1][i] = (*q[i])[first + step / 2];
      at[2][i] = (*q[i])[first + step];
      whole = whole && std::isfinite(at[0][i]) && std::isfinite(at[1][i]) && std::isfinite(at[2][i]);
    }
    whole = whole && rate.allFinite() && held.allFinite();
    if (!whole) continue;
    steps += 1;
    rates += rate.squaredNorm();
    for (std::size_t c = 0; c < left.size(); ++c) {
      const Quaternion<double> a = detail::read_attitude(at[0], c), b = detail::read_attitude(at[2], c);
      const Quaternion<double> turn = conjugate(a) * b;
      const Vector3<double> v = (turn.w < 0 ? -1.0 : 1.0) * Vector3<double>(turn.x, turn.y, turn.z);
      const double sine = v.norm();
      const double angle = 2 * std::atan2(sine, std::abs(turn.w));
      const double to_rate = sine > 1e-12 ? angle / (sine * static_cast<double>(step) * period_s) : 0;
      left[c] += (rate - v * to_rate).squaredNorm();
      force[c] += body_to_world(normalized(detail::read_attitude(at[1], c)), held);
    }
  }
  if (steps < fewest_steps) return std::nullopt;
  const auto count = static_cast<double>(steps);
  std::array<double, detail::attitude_conventions> miss{};
  for (std::size_t c = 0; c < miss.size(); ++c) {
    const Vector3<double> up(0, 0, -standard_gravity_m_s2<double>);
    const double turning = rates > smallest_rates * count ? std::min(1.0, left[c] / rates) : 0;
    miss[c] = turning + std::min(1.0, (force[c] / count - up).norm() / standard_gravity_m_s2<double>);
  }
  const auto best = static_cast<std::size_t>(std::min_element(miss.begin(), miss.end()) - miss.begin());
  if (!(miss[0] >= misses) || !(miss[best] < better * miss[0])) return std::nullopt;
  return Finding{"attitude_convention", miss[0], "1",
                 std::string(detail::attitude_sentences[best]) +
                     ", by how it turns with the body rates and where it points the specific force"};
}

}  // namespace pinnquad
