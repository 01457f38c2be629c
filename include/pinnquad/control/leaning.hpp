// SPDX-License-Identifier: MIT
// The point that a vehicle leans into: what acts across the thrust is taken from the motion that is asked for. A loop
// (control/tracking_controller.hpp) and the autopilots' core fly it.
#pragma once

#include <cmath>

#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/flatness.hpp"
#include "pinnquad/control/trajectory.hpp"
#include "pinnquad/core/rotation.hpp"

namespace pinnquad {

namespace detail {

template <class Policy>
using AcrossVariesCall = decltype(std::declval<const Policy&>().across_varies());
/// False for a policy behind one type of many whose across_varies() says that it is the same in every state.
template <class Policy>
bool varies_at_run_time([[maybe_unused]] const Policy& policy) noexcept {
  if constexpr (is_detected<AcrossVariesCall, Policy>) return policy.across_varies();
  return true;
}

/// Across the thrust, a time after the point, on the trajectory: velocity of the point, attitude and body rates of one
/// that leans.
template <class Scalar, class Policy>
Vector3<Scalar> across_at(const Policy& policy, const State<Scalar>& state, const TrajectoryPoint<Scalar>& leans,
                          const FlatMotion<Scalar>& flat, const TrajectoryPoint<Scalar>& point, Scalar gravity_m_s2,
                          Scalar time_s) noexcept {
  using std::cos;
  using std::sin;
  const Scalar half_square = Scalar(0.5) * time_s * time_s;
  State<Scalar> there = state;
  there.velocity_m_s = point.velocity_m_s + time_s * point.acceleration_m_s2 + half_square * point.jerk_m_s3;
  Vector3<Scalar> force = leans.acceleration_m_s2 + time_s * leans.jerk_m_s3 + half_square * leans.snap_m_s4;
  force[2] -= gravity_m_s2;
  const Scalar yaw = point.yaw_rad + time_s * point.yaw_rate_rad_s;
  Matrix<Scalar, 3, 3> axes;
  there.attitude = flat.attitude;
  if (body_axes(force, Heading<Scalar>{sin(yaw), cos(yaw)}, axes) == Status::ok) {
    there.attitude = from_rotation_matrix(axes);
  }
  there.body_rates_rad_s = flat.body_rates_rad_s + time_s * flat.angular_acceleration_rad_s2;
  return across_of(policy, there);
}

}  // namespace detail

/// The acceleration across the thrust that the policy knows of is taken from the one asked for; its change along the
/// trajectory, from jerk and snap: differences over 20 ms before and after, of the motion that the point says. NED, SI
/// units. A policy that knows of none: the point.
template <class Scalar, class Policy>
TrajectoryPoint<Scalar> leaning(const Policy& policy, const State<Scalar>& state, const TrajectoryPoint<Scalar>& point,
                                Scalar gravity_m_s2) noexcept {
  TrajectoryPoint<Scalar> leans = point;
  if constexpr (knows_across<Policy, Scalar>) {
    leans.acceleration_m_s2 -= across_of(policy, state);
    if constexpr (across_varies<Policy, Scalar>) {
      if (!detail::varies_at_run_time(policy)) return leans;
      constexpr Scalar h = Scalar(0.02);
      FlatMotion<Scalar> flat;
      if (flat_motion(leans, gravity_m_s2, flat) != Status::ok) return leans;
      const auto at = [&](Scalar time_s) noexcept {
        return detail::across_at(policy, state, leans, flat, point, gravity_m_s2, time_s);
      };
      const Vector3<Scalar> before = at(-h), now = at(Scalar(0)), after = at(h);
      leans.jerk_m_s3 -= (after - before) / (Scalar(2) * h);
      leans.snap_m_s4 -= (after - Scalar(2) * now + before) / (h * h);
    }
  } else {
    static_cast<void>(policy), static_cast<void>(state), static_cast<void>(gravity_m_s2);
  }
  return leans;
}

}  // namespace pinnquad
