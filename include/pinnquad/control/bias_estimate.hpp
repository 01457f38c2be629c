// SPDX-License-Identifier: MIT
// The bias of a model: the acceleration that a vehicle has besides the one asked for, from a weak battery, a payload,
// steady wind. Slow and bounded. A controller subtracts it from what it asks for.
#pragma once

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// Settings of a BiasEstimate.
template <class Scalar>
struct BiasSettings {
  Scalar bandwidth_1_s = Scalar(5.5);  ///< both poles of the estimate; 0: no estimate
  Scalar max_bias_m_s2 = Scalar(3);    ///< the length of the estimate
};

/// An observer of the velocity with a constant disturbance, NED:
///   v_p' = a_expected + b + 2 w (v - v_p),  b' = w^2 (v - v_p),  |b| <= max
/// It sees velocities and expected accelerations, no set points: a step of the set point does not move it.
/// A number that is not finite is ignored.
template <class Scalar>
class BiasEstimate {
 public:
  explicit constexpr BiasEstimate(const BiasSettings<Scalar>& settings = {}) noexcept : settings_(settings) {}

  constexpr const BiasSettings<Scalar>& settings() const noexcept { return settings_; }
  const Vector3<Scalar>& acceleration_m_s2() const noexcept { return bias_; }
  const Vector3<Scalar>& predicted_velocity_m_s() const noexcept { return predicted_; }
  /// True within 1 % of the bound; never without a bound.
  bool at_bound() const noexcept {
    const Scalar length = Scalar(0.99) * settings_.max_bias_m_s2;
    return length > Scalar(0) && bias_.squaredNorm() >= length * length;
  }

  /// One step in flight, in which `expected_m_s2` was asked for through the model. A step above 0.25 / bandwidth
  /// freezes.
  void update(const Vector3<Scalar>& velocity_m_s, const Vector3<Scalar>& expected_m_s2, Scalar step_s) noexcept {
    const Scalar w = settings_.bandwidth_1_s;
    if (!(step_s > Scalar(0) && w > Scalar(0) && step_s * w <= Scalar(0.25)) || !all_finite(expected_m_s2)) {
      freeze(velocity_m_s);
      return;
    }
    if (!all_finite(velocity_m_s)) return;
    const Vector3<Scalar> error = velocity_m_s - predicted_;
    const Vector3<Scalar> bias = bias_ + error * (step_s * w * w);
    predicted_ += (expected_m_s2 + bias_ + error * (Scalar(2) * w)) * step_s;
    const Scalar length = bias.norm();
    bias_ = length > settings_.max_bias_m_s2 ? Vector3<Scalar>(bias * (settings_.max_bias_m_s2 / length)) : bias;
  }

  /// For the ground, an actuator's end, other hands: the estimate stays, the velocity is followed.
  void freeze(const Vector3<Scalar>& velocity_m_s) noexcept {
    if (all_finite(velocity_m_s)) predicted_ = velocity_m_s;
  }

  /// Goes on from what was logged.
  void resume(const Vector3<Scalar>& bias_m_s2, const Vector3<Scalar>& predicted_velocity_m_s) noexcept {
    if (!(all_finite(bias_m_s2) && all_finite(predicted_velocity_m_s))) return;
    bias_ = bias_m_s2;
    predicted_ = predicted_velocity_m_s;
  }

 private:
  BiasSettings<Scalar> settings_;
  Vector3<Scalar> bias_ = Vector3<Scalar>::Zero();
  Vector3<Scalar> predicted_ = Vector3<Scalar>::Zero();
};

}  // namespace pinnquad
