// SPDX-License-Identifier: MIT
// A recorded sample as the raw inputs of a feature set: the bridge from logs to what flies.
// A feature set with an Inputs struct of its own specialises SampleInputs for it.
#pragma once

#include "pinnquad/data/sample.hpp"
#include "pinnquad/features/features.hpp"

namespace pinnquad {

/// `static Inputs from(const Sample&)`.
template <class Inputs>
struct SampleInputs;

template <class Scalar>
struct SampleInputs<MotionInputs<Scalar>> {
  static MotionInputs<Scalar> from(const Sample& sample) {
    const Quaternion<double> q = from_euler(EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
    MotionInputs<Scalar> inputs;
    inputs.linear_acceleration_m_s2 = sample.linear_acceleration_m_s2.cast<Scalar>();
    inputs.angular_acceleration_rad_s2 = sample.angular_acceleration_rad_s2.cast<Scalar>();
    inputs.velocity_m_s = sample.velocity_m_s.cast<Scalar>();
    inputs.body_rates_rad_s = sample.body_rates_rad_s.cast<Scalar>();
    inputs.attitude = {Scalar(q.w), Scalar(q.x), Scalar(q.y), Scalar(q.z)};
    return inputs;
  }
};

template <class Scalar>
struct SampleInputs<MotionInputsWithAltitude<Scalar>> {
  static MotionInputsWithAltitude<Scalar> from(const Sample& sample) {
    MotionInputsWithAltitude<Scalar> inputs;
    static_cast<MotionInputs<Scalar>&>(inputs) = SampleInputs<MotionInputs<Scalar>>::from(sample);
    inputs.altitude_m = Scalar(sample.altitude_m);
    return inputs;
  }
};

/// Feature vector X of a sample, physical units.
template <class Features, class Scalar>
std::array<Scalar, static_cast<std::size_t>(Features::size)> sample_features(const Sample& sample) {
  std::array<Scalar, static_cast<std::size_t>(Features::size)> x{};
  Features::extract(SampleInputs<typename Features::template Inputs<Scalar>>::from(sample), x.data());
  return x;
}

}  // namespace pinnquad
