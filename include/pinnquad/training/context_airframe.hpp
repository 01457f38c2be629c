// SPDX-License-Identifier: MIT
// The airframe of a training: a type known to the compiler, or a value given at run time, from a file for instance.
// It is a base of Context and TrainedModel.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/outputs/output_schema.hpp"

namespace pinnquad {

/// In place of an airframe's type: the airframe is a value.
struct GivenAirframe {};

/// The airframe of a type.
template <class VehicleType>
struct ContextAirframe {
  static_assert(is_airframe<VehicleType>,
                "pinnquad: Context's second argument is not an airframe (dynamics/airframe.hpp)");
  static constexpr const char* airframe_name() noexcept { return VehicleType::name; }
  template <class Scalar>
  static constexpr Airframe<Scalar> airframe() noexcept {
    return airframe_value<VehicleType, Scalar>();
  }
  /// Signs of the commands in the torque about an axis: a row of Eq. (2) for this airframe.
  template <class Axis, class Scalar = double>
  static constexpr std::array<Scalar, rotor_count> signs() noexcept {
    constexpr auto worked_out = allocation_signs(airframe<Scalar>(), Axis::axis);
    return worked_out;
  }
  /// Setting of an output schema: its third input beside features and outputs.
  template <class Schema, class Scalar>
  static constexpr auto output_setting() noexcept {
    constexpr auto worked_out = OutputMap<Schema>::setting(airframe_value<VehicleType, Scalar>());
    return worked_out;
  }
};

/// An airframe that was given.
template <>
struct ContextAirframe<GivenAirframe> {
  /// Throws std::invalid_argument for an airframe that can't fly.
  ContextAirframe(std::string name, const Airframe<double>& value) : name_(std::move(name)), value_(value) {
    if (check_airframe(value) != Status::ok || Rotors<double>(value).status() != Status::ok) {
      throw std::invalid_argument("the airframe '" + name_ + "' can't fly");
    }
  }
  const std::string& airframe_name() const noexcept { return name_; }
  template <class Scalar>
  Airframe<Scalar> airframe() const noexcept {
    return airframe_in<Scalar>(value_);
  }
  template <class Axis, class Scalar = double>
  std::array<Scalar, rotor_count> signs() const noexcept {
    return allocation_signs(airframe<Scalar>(), Axis::axis);
  }
  template <class Schema, class Scalar>
  auto output_setting() const noexcept {
    return OutputMap<Schema>::setting(airframe<Scalar>());
  }

 private:
  std::string name_;
  Airframe<double> value_;
};

}  // namespace pinnquad
