// SPDX-License-Identifier: MIT
// The vehicle that is learnt on board: the acceleration that each signed sum of thrust fractions makes, by itself, as a
// sum of seven terms. It is regressed this way round, as the noise is in the accelerations, and inverted to fly.
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

namespace detail {

/// Terms of a sum. That of the sum's own thrusts is the last; the one before is how fast they rise: a state that comes
/// later, or sooner, than the lag says. The lag changes those from lag_terms(k) on.
inline constexpr std::size_t term_count = 7, own_term = term_count - 1, rise_term = own_term - 1;
constexpr std::size_t lag_terms(std::size_t k) noexcept { return k == 0 ? rise_term : rise_term - 1; }
template <class Scalar>
using Terms = std::array<Scalar, term_count>;

/// A motion as the sums see it, FRD, SI units.
template <class Scalar>
struct SumMotion {
  /// The specific force along z, then the three angular accelerations.
  std::array<Scalar, 4> accelerations{};
  Vector3<Scalar> velocity_m_s = Vector3<Scalar>::Zero(), body_rates_rad_s = Vector3<Scalar>::Zero();
};

/// A motion, measured or asked for, as the sums see it.
template <class Scalar>
SumMotion<Scalar> sum_motion(const MotionInputs<Scalar>& motion) noexcept {
  const Vector3<Scalar>& turn = motion.angular_acceleration_rad_s2;
  const Scalar along = SpecificForce::of<Scalar>(motion)[2];
  return {{along, turn[0], turn[1], turn[2]}, motion.velocity_m_s, motion.body_rates_rad_s};
}

/// x of sum k: 1, four terms, the rise of its own thrusts, these. Thrust: v_z, v_z |v_z|, v_x, v_y. Roll, pitch, yaw:
/// its own rate, the product of the two others, the velocity across (0 of yaw), the total sum (a centre of gravity that
/// is off).
template <class Scalar>
Terms<Scalar> terms_of(std::size_t k, const SumMotion<Scalar>& motion, Scalar total,
                       const Followed<Scalar>& own) noexcept {
  const Vector3<Scalar>&v = motion.velocity_m_s, &w = motion.body_rates_rad_s;
  const Scalar rise = own.rise_1_s, sum = own.sum, one(1);
  switch (k) {
    case 0: return {one, v[2], v[2] < Scalar(0) ? -v[2] * v[2] : v[2] * v[2], v[0], v[1], rise, sum};
    case 1: return {one, w[0], w[1] * w[2], v[1], total, rise, sum};
    case 2: return {one, w[1], w[2] * w[0], v[0], total, rise, sum};
    default: return {one, w[2], w[0] * w[1], Scalar(0), total, rise, sum};
  }
}

/// a = theta . x, for thrust fractions behind a lag.
template <class Scalar>
struct ForwardSum {
  Terms<Scalar> theta{};
  LagPlace<Scalar> lag{};

  /// Acceleration for each unit of the sum, m/s^2 (thrust) or rad/s^2.
  Scalar slope() const noexcept { return theta[own_term]; }
  /// The sum that a motion needs, y = (a - the other terms) / slope, where it rises so fast.
  Scalar needed(std::size_t k, const SumMotion<Scalar>& motion, Scalar total, Scalar rise_1_s) const noexcept {
    const Terms<Scalar> x = terms_of(k, motion, total, {Scalar(0), rise_1_s});
    Scalar own = motion.accelerations[k];
    for (std::size_t i = 0; i < own_term; ++i) own -= theta[i] * x[i];
    return own / slope();
  }
};

template <class Scalar>
using ForwardModel = std::array<ForwardSum<Scalar>, 4>;

}  // namespace detail

/// The model of an airframe: rotors of equal strength around a centre of gravity in their middle.
template <class Scalar>
detail::ForwardModel<Scalar> forward_model(const Airframe<Scalar>& airframe) noexcept {
  detail::ForwardModel<Scalar> model{};
  const AllocationMatrix<Scalar> matrix = allocation(airframe);
  const auto& j = airframe.inertia_kg_m2;
  const detail::LagPlace<Scalar> lag = detail::lag_place(airframe.rotor_time_constant_s);
  for (std::size_t k = 0; k < model.size(); ++k) {
    Scalar reach(0);
    for (const Scalar entry : matrix[k]) reach += entry < Scalar(0) ? -entry : entry;
    reach /= Scalar(rotor_count);
    model[k].theta[detail::own_term] = k == 0 ? -reach / airframe.mass_kg : reach / j[k - 1];
    model[k].lag = lag;
  }
  model[0].theta[2] = -airframe.drag_area_m2[2] * rated_air_density_kg_m3<Scalar> / airframe.mass_kg;
  model[1].theta[2] = (j[1] - j[2]) / j[0];
  model[2].theta[2] = (j[2] - j[0]) / j[1];
  model[3].theta[2] = (j[0] - j[1]) / j[2];
  return model;
}

namespace detail {

/// Widths of what may be, around the start: wide on constants, narrow on what velocities and rates do, which little in
/// a first minute tells from the own slope (docs/onboard.md).
template <class Scalar>
Terms<Scalar> prior_deviations(std::size_t k, const ForwardSum<Scalar>& start) noexcept {
  constexpr Scalar delay_s = Scalar(0.004);
  const Scalar slope = start.slope() < Scalar(0) ? -start.slope() : start.slope();
  if (k == 0) {
    return {Scalar(5), Scalar(0.5), Scalar(0.05), Scalar(0.05), Scalar(0.05), delay_s * slope, slope};
  }
  const Scalar product = k == 3 ? Scalar(0.25) : Scalar(0.7);  // (J_x - J_y) / J_z, J_z about J_x + J_y
  return {Scalar(20), Scalar(2.5), product, Scalar(1), Scalar(0.2) * slope, delay_s * slope, slope};
}

/// Columns: the terms, then the acceleration that they explain.
inline constexpr std::size_t output_column = term_count;
template <class Scalar>
using SumTriangle = Triangle<Scalar, output_column + 1>;
template <class Scalar, std::size_t shared>
using SumTriangles = SharedTriangle<Scalar, shared, term_count - shared, lag_count>;

/// Solution of a sum, and what is known of its slope.
template <class Scalar>
struct SumSolution {
  Terms<Scalar> theta{};
  Scalar standard_error{0};  ///< of the slope, residuals taken for white
  Scalar left_square{0};     ///< mean square of what the terms leave of the acceleration, in these rows
};

/// Least squares with a prior, which is added here and is never forgotten: a term of which nothing is said any more
/// goes back to it. `repeats`: so many of the rows say the same; the prior weighs against them as one of their number.
/// The triangle is used up: a copy more would be the deepest of a core's stack.
template <class Scalar>
SumSolution<Scalar> solved(SumTriangle<Scalar>&& triangle, Scalar rows, const Terms<Scalar>& mean,
                           const Terms<Scalar>& deviations, Scalar repeats) noexcept {
  using std::sqrt;
  SumSolution<Scalar> result;
  const Scalar left = triangle.at(output_column, output_column);
  result.left_square = rows > Scalar(0) ? left * left / rows : Scalar(0);
  const Scalar weight = sqrt(repeats * result.left_square + Scalar(1e-12));
  for (std::size_t i = 0; i < term_count; ++i) {
    typename SumTriangle<Scalar>::Row row{};
    row[i] = weight / deviations[i];
    row[output_column] = row[i] * mean[i];
    triangle.turn_in(row, Scalar(1), i);
  }
  for (std::size_t i = term_count; i-- > 0;) {
    Scalar right = triangle.at(i, output_column);
    for (std::size_t j = i + 1; j < term_count; ++j) right -= triangle.at(i, j) * result.theta[j];
    result.theta[i] = right / triangle.at(i, i);
  }
  const Scalar own = triangle.at(own_term, own_term);
  result.standard_error = weight / (own < Scalar(0) ? -own : own);
  return result;
}

}  // namespace detail

}  // namespace pinnquad
