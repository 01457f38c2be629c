// SPDX-License-Identifier: MIT
// Reference trajectories with closed-form derivatives up to snap, as flatness needs them.
// Contract: a small value with `TrajectoryPoint<Scalar> sample(Scalar time_s) const noexcept`.
#pragma once

#include <array>
#include <cmath>

#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// A point of a reference trajectory: position and its derivatives in NED, yaw (Euler ZYX) and its derivatives.
template <class Scalar>
struct TrajectoryPoint {
  Vector3<Scalar> position_m = Vector3<Scalar>::Zero();
  Vector3<Scalar> velocity_m_s = Vector3<Scalar>::Zero();
  Vector3<Scalar> acceleration_m_s2 = Vector3<Scalar>::Zero();  ///< without gravity: zero in hover
  Vector3<Scalar> jerk_m_s3 = Vector3<Scalar>::Zero();
  Vector3<Scalar> snap_m_s4 = Vector3<Scalar>::Zero();
  Scalar yaw_rad = Scalar(0);
  Scalar yaw_rate_rad_s = Scalar(0);
  Scalar yaw_acceleration_rad_s2 = Scalar(0);
};

namespace detail {

/// A value and its first four derivatives with respect to time.
template <class Scalar>
using Derivatives = std::array<Scalar, 5>;

/// Phase of a periodic motion that starts at rest: 2 pi / period times an inner clock, whose rate rises from 0 to 1
/// over `ramp_s` as 35 x^4 - 84 x^5 + 70 x^6 - 20 x^7, x = t / ramp_s. The phase has four continuous derivatives, all
/// zero at the start. Before t = 0 the phase is 0. A ramp of zero or less starts at full rate.
template <class Scalar>
Derivatives<Scalar> smooth_phase(Scalar time_s, Scalar period_s, Scalar ramp_s) noexcept {
  const Scalar rate = Scalar(6.283185307179586) / period_s;
  if (time_s < Scalar(0)) return {};
  if (!(time_s < ramp_s)) {
    const Scalar lost_s = ramp_s > Scalar(0) ? ramp_s / Scalar(2) : Scalar(0);  // the ramp covers half its time
    return {rate * (time_s - lost_s), rate, Scalar(0), Scalar(0), Scalar(0)};
  }
  const Scalar x = time_s / ramp_s;
  const Scalar x2 = x * x;
  const Scalar x3 = x2 * x;
  const Scalar x4 = x2 * x2;
  const Scalar step = x4 * (Scalar(35) + x * (Scalar(-84) + x * (Scalar(70) - Scalar(20) * x)));
  const Scalar integral = x4 * x * (Scalar(7) + x * (Scalar(-14) + x * (Scalar(10) - Scalar(2.5) * x)));
  const Scalar first = x3 * (Scalar(140) + x * (Scalar(-420) + x * (Scalar(420) - Scalar(140) * x)));
  const Scalar second = x2 * (Scalar(420) + x * (Scalar(-1680) + x * (Scalar(2100) - Scalar(840) * x)));
  const Scalar third = x * (Scalar(840) + x * (Scalar(-5040) + x * (Scalar(8400) - Scalar(4200) * x)));
  return {rate * ramp_s * integral, rate * step, rate * first / ramp_s, rate * second / (ramp_s * ramp_s),
          rate * third / (ramp_s * ramp_s * ramp_s)};
}

/// amplitude sin(multiple phase + offset) and its time derivatives, by the chain rule (Faa di Bruno).
template <class Scalar>
Derivatives<Scalar> harmonic(const Derivatives<Scalar>& phase, Scalar amplitude, Scalar multiple,
                             Scalar offset_rad = Scalar(0)) noexcept {
  using std::cos;
  using std::sin;
  const Scalar s = amplitude * sin(multiple * phase[0] + offset_rad);
  const Scalar c = amplitude * cos(multiple * phase[0] + offset_rad);
  const Scalar p1 = multiple * phase[1], p2 = multiple * phase[2], p3 = multiple * phase[3], p4 = multiple * phase[4];
  const Scalar three(3), four(4), six(6);
  return {s, c * p1, c * p2 - s * p1 * p1, c * p3 - three * s * p1 * p2 - c * p1 * p1 * p1,
          c * p4 - s * (three * p2 * p2 + four * p1 * p3) - six * c * p1 * p1 * p2 + s * p1 * p1 * p1 * p1};
}

template <class Scalar>
TrajectoryPoint<Scalar> assembled(const Vector3<Scalar>& center_m, const Derivatives<Scalar>& north,
                                  const Derivatives<Scalar>& east, const Derivatives<Scalar>& down,
                                  const Derivatives<Scalar>& yaw) noexcept {
  const auto order = [&](std::size_t n) noexcept { return Vector3<Scalar>(north[n], east[n], down[n]); };
  return {center_m + order(0), order(1), order(2), order(3), order(4), yaw[0], yaw[1], yaw[2]};
}

}  // namespace detail

/// A lying eight: center + (length sin p, width sin 2p, height sin p), p = detail::smooth_phase(). Starts at rest in
/// its center. Highest speed in the crossing: 2 pi / period sqrt(length^2 + 4 width^2 + height^2); 4.8 m/s by default.
template <class Scalar>
struct FigureEight {
  Vector3<Scalar> center_m = Vector3<Scalar>::Zero();  ///< NED
  Scalar half_length_m = Scalar(4);                    ///< north
  Scalar half_width_m = Scalar(2);                     ///< east
  Scalar half_height_m = Scalar(0.5);                  ///< down, in step with north
  Scalar yaw_amplitude_rad = Scalar(0);                ///< yaw = amplitude sin p
  Scalar period_s = Scalar(7.5);
  Scalar ramp_s = Scalar(4);

  TrajectoryPoint<Scalar> sample(Scalar time_s) const noexcept {
    const auto phase = detail::smooth_phase(time_s, period_s, ramp_s);
    return detail::assembled(
        center_m, detail::harmonic(phase, half_length_m, Scalar(1)), detail::harmonic(phase, half_width_m, Scalar(2)),
        detail::harmonic(phase, half_height_m, Scalar(1)), detail::harmonic(phase, yaw_amplitude_rad, Scalar(1)));
  }
};

/// A level circle, clockwise seen from above: center + radius (cos p, sin p). Starts at rest, north of the center.
/// Speed: 2 pi radius / period; 4.2 m/s by default.
template <class Scalar>
struct Circle {
  Vector3<Scalar> center_m = Vector3<Scalar>::Zero();  ///< NED
  Scalar radius_m = Scalar(4);
  Scalar yaw_amplitude_rad = Scalar(0);  ///< yaw = amplitude sin p
  Scalar period_s = Scalar(6);
  Scalar ramp_s = Scalar(4);

  TrajectoryPoint<Scalar> sample(Scalar time_s) const noexcept {
    constexpr Scalar quarter_turn = Scalar(1.5707963267948966);
    const auto phase = detail::smooth_phase(time_s, period_s, ramp_s);
    return detail::assembled(center_m, detail::harmonic(phase, radius_m, Scalar(1), quarter_turn),
                             detail::harmonic(phase, radius_m, Scalar(1)), detail::Derivatives<Scalar>{},
                             detail::harmonic(phase, yaw_amplitude_rad, Scalar(1)));
  }
};

/// The position, velocity, acceleration and yaw of a point alone: without jerk, snap and yaw rate, the feedback has to
/// turn the vehicle.
template <class Scalar>
TrajectoryPoint<Scalar> without_jerk(const TrajectoryPoint<Scalar>& point) noexcept {
  const Vector3<Scalar> none = Vector3<Scalar>::Zero();
  return {point.position_m, point.velocity_m_s, point.acceleration_m_s2, none, none, point.yaw_rad};
}

}  // namespace pinnquad
