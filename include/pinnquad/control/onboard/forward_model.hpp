// SPDX-License-Identifier: MIT
// The vehicle that is learnt on board: the acceleration that each signed sum of thrust fractions makes, by itself, as a
// sum of six terms. It is regressed this way round, as the noise is in the accelerations, and inverted to fly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/control/onboard/lag_bank.hpp"
#include "pinnquad/control/onboard/triangle.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/features/motion_parts.hpp"

namespace pinnquad {

/// Terms of a sum. That of the sum's own thrusts is the last.
inline constexpr std::size_t term_count = 6, own_term = term_count - 1;
template <class Scalar>
using Terms = std::array<Scalar, term_count>;

/// A motion as the sums see it, FRD, SI units.
template <class Scalar>
struct SumMotion {
  /// The specific force along z, then the three angular accelerations.
  std::array<Scalar, 4> accelerations{};
  Vector3<Scalar> velocity_m_s = Vector3<Scalar>::Zero(), body_rates_rad_s = Vector3<Scalar>::Zero();
};

template <class Scalar>
SumMotion<Scalar> sum_motion(const MotionInputs<Scalar>& motion) noexcept {
  const Vector3<Scalar>& turn = motion.angular_acceleration_rad_s2;
  const Scalar along = SpecificForce::of<Scalar>(motion)[2];
  return {{along, turn[0], turn[1], turn[2]}, motion.velocity_m_s, motion.body_rates_rad_s};
}

/// x of sum k: 1, four terms, its own thrusts. Thrust: v_z, v_z |v_z|, v_x, v_y. Roll, pitch, yaw: the total sum (a
/// centre of gravity that is off), its own rate, the product of the two others, the velocity across (0 of yaw).
template <class Scalar>
Terms<Scalar> terms_of(std::size_t k, const SumMotion<Scalar>& motion, Scalar total, Scalar own) noexcept {
  const Vector3<Scalar>&v = motion.velocity_m_s, &w = motion.body_rates_rad_s;
  switch (k) {
    case 0: return {Scalar(1), v[2], v[2] < Scalar(0) ? -v[2] * v[2] : v[2] * v[2], v[0], v[1], own};
    case 1: return {Scalar(1), total, w[0], w[1] * w[2], v[1], own};
    case 2: return {Scalar(1), total, w[1], w[2] * w[0], v[0], own};
    default: return {Scalar(1), total, w[2], w[0] * w[1], Scalar(0), own};
  }
}

/// a = theta . x, for thrust fractions behind a lag of the bank.
template <class Scalar>
struct ForwardSum {
  Terms<Scalar> theta{};
  std::uint8_t lag{0};

  /// Acceleration for each unit of the sum, m/s^2 (thrust) or rad/s^2.
  Scalar slope() const noexcept { return theta[own_term]; }
  /// The sum that a motion needs: y = (a - the other terms) / slope.
  Scalar needed(std::size_t k, const SumMotion<Scalar>& motion, Scalar total) const noexcept {
    const Terms<Scalar> x = terms_of(k, motion, total, Scalar(0));
    Scalar own = motion.accelerations[k];
    for (std::size_t i = 0; i < own_term; ++i) own -= theta[i] * x[i];
    return own / slope();
  }
};

template <class Scalar>
using ForwardModel = std::array<ForwardSum<Scalar>, 4>;

/// That of an airframe: rotors of equal strength around a centre of gravity in their middle.
template <class Scalar>
ForwardModel<Scalar> forward_model(const Airframe<Scalar>& airframe) noexcept {
  ForwardModel<Scalar> model{};
  const AllocationMatrix<Scalar> matrix = allocation(airframe);
  const auto& j = airframe.inertia_kg_m2;
  const std::uint8_t lag = nearest_lag(airframe.rotor_time_constant_s);
  for (std::size_t k = 0; k < model.size(); ++k) {
    Scalar reach(0);
    for (const Scalar entry : matrix[k]) reach += entry < Scalar(0) ? -entry : entry;
    reach /= Scalar(rotor_count);
    model[k].theta[own_term] = k == 0 ? -reach / airframe.mass_kg : reach / j[k - 1];
    model[k].lag = lag;
  }
  model[0].theta[2] = -airframe.drag_area_m2[2] * rated_air_density_kg_m3<Scalar> / airframe.mass_kg;
  model[1].theta[3] = (j[1] - j[2]) / j[0];
  model[2].theta[3] = (j[2] - j[0]) / j[1];
  model[3].theta[3] = (j[0] - j[1]) / j[2];
  return model;
}

/// Widths of what may be, around a start of one to a factor of five: wide on constants, narrow on what velocities and
/// rates do, which little in a first minute tells from the own slope (docs/onboard.md).
template <class Scalar>
TrianglePrior<Scalar, term_count> prior_of(std::size_t k, const ForwardSum<Scalar>& start) noexcept {
  const Scalar slope = start.slope() < Scalar(0) ? -start.slope() : start.slope();
  if (k == 0) {
    return {start.theta, {Scalar(5), Scalar(0.5), Scalar(0.05), Scalar(0.05), Scalar(0.05), slope}};
  }
  return {start.theta, {Scalar(20), Scalar(0.2) * slope, Scalar(1), Scalar(0.7), Scalar(1), slope}};
}

}  // namespace pinnquad
