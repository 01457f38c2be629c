// SPDX-License-Identifier: MIT
// The inverse of a ForwardModel as it flies: each signed sum is an affine map of features of the motion asked for. A
// block written of it on the ground (deploy/learnt_model.hpp) has the same numbers and rounds where this rounds.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/control/onboard/forward_model.hpp"
#include "pinnquad/nn/kernel/portable.hpp"

namespace pinnquad::detail {

/// y = constant + by . x + by_turn wdot, of one signed sum. x: s_z, the own body rate and the product of the two others
/// (roll, pitch, yaw; none of thrust), v_x, v_y, v_z, v_z |v_z|. wdot: the own angular acceleration. In that order and
/// by multiply_add(): the bits of an AxisAligned (model/axis_aligned.hpp), which adds products of 0 between.
template <class Scalar>
struct AffineSum {
  enum Feature : std::size_t { force_z, own_rate, rate_product, v_x, v_y, v_z, vv_z, feature_count };

  Scalar constant{0};
  std::array<Scalar, feature_count> by{};
  Scalar by_turn{0};
  Scalar by_total{0};  ///< that of the sum of thrust, which is in the others already; a bias of it is not

  /// `k`: which sum it is.
  Scalar of(std::size_t k, const SumMotion<Scalar>& motion) const noexcept {
    const Vector3<Scalar>&v = motion.velocity_m_s, &w = motion.body_rates_rad_s;
    const auto axis = k == 0 ? 0 : static_cast<int>(k) - 1;
    const std::array<Scalar, feature_count> x{motion.accelerations[0],
                                              w[axis],
                                              w[(axis + 1) % 3] * w[(axis + 2) % 3],
                                              v[0],
                                              v[1],
                                              v[2],
                                              v[2] < Scalar(0) ? -v[2] * v[2] : v[2] * v[2]};
    Scalar sum = constant;
    for (std::size_t i = 0; i < x.size(); ++i) sum = multiply_add(by[i], x[i], sum);
    return k == 0 ? sum : multiply_add(by_turn, motion.accelerations[k], sum);
  }
};

template <class Scalar>
using AffineInverse = std::array<AffineSum<Scalar>, 4>;

/// y_k = (a_k - theta_k0 - theta_k1 x_k1 - .. - theta_k4 x_k4) / slope_k, where nothing rises; of roll, pitch and yaw
/// x_k4 = y_0.
template <class Scalar>
AffineInverse<Scalar> affine_inverse(const ForwardModel<Scalar>& model) noexcept {
  using Sum = AffineSum<Scalar>;
  AffineInverse<Scalar> inverse{};
  std::array<std::array<Scalar, rise_term>, 4> by_term{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Scalar by_own = Scalar(1) / model[k].slope();
    for (std::size_t i = 0; i < rise_term; ++i) by_term[k][i] = -model[k].theta[i] * by_own;
    inverse[k].constant = by_term[k][0];
    inverse[k].by_turn = by_own;
  }
  Sum& thrust = inverse[0];
  thrust.by = {thrust.by_turn, Scalar(0), Scalar(0), by_term[0][3], by_term[0][4], by_term[0][1], by_term[0][2]};
  thrust.by_turn = Scalar(0);
  for (std::size_t k = 1; k < 4; ++k) {
    Sum& sum = inverse[k];
    sum.by_total = by_term[k][4];
    sum.by[Sum::own_rate] = by_term[k][1];
    sum.by[Sum::rate_product] = by_term[k][2];
    sum.by[k == 2 ? Sum::v_x : Sum::v_y] = by_term[k][3];
    sum.constant = multiply_add(sum.by_total, thrust.constant, sum.constant);
    for (std::size_t i = 0; i < thrust.by.size(); ++i) {
      sum.by[i] = multiply_add(sum.by_total, thrust.by[i], sum.by[i]);
    }
  }
  return inverse;
}

}  // namespace pinnquad::detail
