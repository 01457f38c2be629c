// SPDX-License-Identifier: MIT
// Features of a motion that is asked for, of which four rotors along one axis can make a part: what a structured model is shown.
#pragma once

#include "pinnquad/features/motion_parts.hpp"

namespace pinnquad {

/// The specific force along the thrust axis: the part of it that the rotors make.
/// The other two parts are what the air does. On recorded flights they stay within some tenths of a m/s^2; a motion that is asked
/// for has more, wherever the attitude still lags what the acceleration needs, and no command makes it. A model that is shown
/// them as SpecificForce is asked outside its envelope then, for nothing: on the demo's figure-eight 80 % of the time.
struct ThrustAxisForce : detail::MotionPart<ThrustAxisForce> {
  static constexpr int size = 1;
  static constexpr std::array<const char*, 1> names = {"s_z"};
  static constexpr std::array<const char*, 1> units = {"m/s^2"};

  /// Fills x[0]. The inputs must have passed check().
  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& in, Scalar* x) noexcept {
    x[0] = SpecificForce::of<Scalar>(in)[2];
  }
};

/// PhysicsFeatures with the specific force along the thrust axis alone.
struct InverseFeatures
    : Joined<ThrustAxisForce, AngularAcceleration, BodyRates, RateProducts, DownVector, BodyVelocity, SquaredVelocity> {
};

/// And the altitude: for a vehicle near the ground.
struct InverseFeaturesWithAltitude : WithAltitude<InverseFeatures> {};

}  // namespace pinnquad
