// SPDX-License-Identifier: MIT
// The two things that the trainer gives a loss: the context (features, airframe, outputs, their standardisation, the
// epoch) and the mini-batch. The airframe is a type, or a value given at run time, from a file for instance.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "pinnquad/core/types.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

/// An airframe that is a value: `Context<Features, GivenAirframe>`, made of a `GivenAirframe{name, airframe}`.
class GivenAirframe {
 public:
  /// Throws std::invalid_argument for an airframe that can't fly.
  GivenAirframe(std::string name, const Airframe<double>& value) : name_(std::move(name)), value_(value) {
    if (check_airframe(value) != Status::ok || Rotors<double>(value).status() != Status::ok) {
      throw std::invalid_argument("the airframe '" + name_ + "' can't fly");
    }
  }
  const std::string& airframe_name() const noexcept { return name_; }
  template <class Scalar>
  Airframe<Scalar> airframe() const noexcept {
    return airframe_in<Scalar>(value_);
  }
  /// Signs of the commands in the torque about an axis: a row of Eq. (2) for this airframe.
  template <class Axis, class Scalar = double>
  std::array<Scalar, rotor_count> signs() const noexcept {
    return allocation_signs(airframe<Scalar>(), Axis::axis);
  }
  /// Setting of an output schema: its third input beside features and outputs.
  template <class Schema, class Scalar>
  auto output_setting() const noexcept {
    return OutputMap<Schema>::setting(airframe<Scalar>());
  }

 private:
  std::string name_;
  Airframe<double> value_;
};

/// An airframe that the compiler knows as a value.
template <class VehicleType>
GivenAirframe given_airframe() {
  return GivenAirframe(VehicleType::name, airframe_value<VehicleType, double>());
}

namespace detail {
/// An airframe that the compiler knows.
template <class VehicleType>
struct KnownAirframe {
  static_assert(is_airframe<VehicleType>,
                "pinnquad: Context's second argument is not an airframe (dynamics/airframe.hpp)");
  constexpr KnownAirframe() = default;
  constexpr KnownAirframe(const VehicleType& /*vehicle*/) noexcept {}

  static constexpr const char* airframe_name() noexcept { return VehicleType::name; }
  template <class Scalar>
  static constexpr Airframe<Scalar> airframe() noexcept {
    return airframe_value<VehicleType, Scalar>();
  }
  template <class Axis, class Scalar = double>
  static constexpr std::array<Scalar, rotor_count> signs() noexcept {
    constexpr auto worked_out = allocation_signs(airframe<Scalar>(), Axis::axis);
    return worked_out;
  }
  template <class Schema, class Scalar>
  static constexpr auto output_setting() noexcept {
    constexpr auto worked_out = OutputMap<Schema>::setting(airframe_value<VehicleType, Scalar>());
    return worked_out;
  }
};

/// The airframe of a context: a GivenAirframe, or one made of a value of the Vehicle's type or of nothing.
template <class VehicleType>
using ContextAirframe =
    std::conditional_t<std::is_same_v<VehicleType, GivenAirframe>, GivenAirframe, KnownAirframe<VehicleType>>;
}  // namespace detail

/// The knowledge that a loss is given. It is the airframe, too: airframe_name(), airframe<Scalar>(), signs<Axis>(),
/// output_setting<Schema, Scalar>().
template <class FeatureSet, class VehicleType, class Schema = CommandOutputs>
struct Context : detail::ContextAirframe<VehicleType> {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: Context's first argument is not a feature set (features/features.hpp)");
  static_assert(is_output_schema<Schema>,
                "pinnquad: Context's third argument is not an output schema; it needs size, names, units, commands(), "
                "from_commands(), and slopes() or linear = true (outputs/output_schema.hpp)");
  static_assert(base_reads<FeatureSet, Schema>(),
                "pinnquad: the base of Context's outputs reads a feature that the feature set has not, or not there "
                "(outputs/base.hpp)");
  using Features = FeatureSet;
  using Vehicle = VehicleType;
  using Outputs = Schema;

  static constexpr int output_count = OutputMap<Outputs>::size;

  Scaler<double, Features::size> input{};  ///< physical -> standardised, by the training set
  Scaler<double, output_count> output{};
  std::array<double, 3> signed_sum_deviation{1.0, 1.0, 1.0};  ///< standard deviations of the signed command sums
  Progress progress{};

  /// Throws std::invalid_argument unless every mean is finite and every standard deviation is finite and above 0. A
  /// NaN here would make every weight NaN.
  constexpr void check() const {
    check_scaler("Context::input", input.mean, input.standard_deviation);
    check_scaler("Context::output", output.mean, output.standard_deviation);
    check_scaler("Context::signed_sum_deviation", std::array<double, 3>{}, signed_sum_deviation);
  }

 private:
  template <class Values>
  static constexpr void check_scaler(const char* setting, const Values& mean, const Values& deviation) {
    for (std::size_t i = 0; i < deviation.size(); ++i) {
      detail::expect_finite(setting, mean[i]);
      if (!(deviation[i] > 0.0)) detail::refuse_setting(setting, "a standard deviation above 0", deviation[i]);
      detail::expect_finite(setting, deviation[i]);
    }
  }
};

namespace detail {
/// One mini-batch as a loss sees it: a sample is a column, and each quantity's samples stand side by side in memory. No
/// heap: `MaxSize` is the capacity.
template <class ScalarType, int InputCount, int OutputCount, int MaxSize>
struct LossBatch {
  using Scalar = ScalarType;
  template <int Rows>
  using Samples =
      Eigen::Matrix<Scalar, Rows, Eigen::Dynamic, int(Eigen::RowMajor) | int(Eigen::DontAlign), Rows, MaxSize>;
  using Gradient = Samples<OutputCount>;
  static constexpr int inputs = InputCount;
  static constexpr int outputs = OutputCount;
  static constexpr int max_size = MaxSize;

  Samples<InputCount> features;     ///< standardised X
  Samples<OutputCount> prediction;  ///< standardised network output
  Samples<OutputCount> target;      ///< standardised Y

  int size() const noexcept { return static_cast<int>(prediction.cols()); }
  void resize(int samples) {
    features.resize(Eigen::NoChange, samples);
    prediction.resize(Eigen::NoChange, samples);
    target.resize(Eigen::NoChange, samples);
  }
};
}  // namespace detail

}  // namespace pinnquad
