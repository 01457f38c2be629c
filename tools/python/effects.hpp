// SPDX-License-Identifier: MIT
// Effects of Python (tools/python/pinnquad/effects.py) as values.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "pinnquad/simulation/switched_quadrotor.hpp"
#include "python/bindings.hpp"

namespace python {

inline constexpr std::array<const char*, 4> ground_effects = {"none", "cheeseman_bennett", "conyers", "rotors"};

/// Numbers of a row of pinnquad.effects.Motion, in its order: position, velocity and velocity through the air (NED),
/// attitude, body rates, rotor speeds, time.
inline constexpr std::size_t motion_numbers = 21;
void write_motion(double* row, const pinnquad::Vector3<double>& position_m,
                  const pinnquad::Vector3<double>& velocity_m_s, const pinnquad::Vector3<double>& through_air_m_s,
                  const pinnquad::Quaternion<double>& attitude, const pinnquad::Vector3<double>& body_rates_rad_s,
                  const std::array<double, pinnquad::rotor_count>& rotor_speeds_rev_s, double time_s);

/// Wind of a callable, borrowed from an Effects that lives longer, added to that of other effects. Called with the GIL
/// or without. An exception of the callable is kept for throw_failure(), and the step is refused.
struct OwnWind {
  PyObject* called = nullptr;
  void surroundings(pinnquad::Surroundings<double>& air) const noexcept;
};

/// The same of a force and a torque.
struct OwnWrench {
  PyObject* called = nullptr;
  void surroundings(pinnquad::Surroundings<double>& air) const noexcept;
  pinnquad::Wrench<double> wrench(const pinnquad::RotorCondition<double>& condition,
                                  const pinnquad::Airframe<double>& airframe) const noexcept;
};

/// True once a callable has thrown in this thread.
bool failed() noexcept;
/// Throws what a callable has thrown in this thread, once. With the GIL.
void throw_failure();

using Vectors = std::vector<pinnquad::Vector3<double>>;
/// `count` rows of three finite numbers, of as many or of one for all. Throws TypeError and ValueError, one line.
Vectors vectors_of(const char* name, const py::object& given, std::size_t count);
/// A callable's wind (NED) at times and places, and its forces (NED) and torques (FRD) for rows of motion_numbers.
Vectors wind_of(py::handle called, const py::array_t<double>& time_s, const py::array_t<double>& position_m);
std::pair<Vectors, Vectors> wrenches_of(py::handle called, const py::array_t<double>& motions);

using FlownEffects = decltype(std::tuple_cat(std::tuple<pinnquad::Switched<OwnWind, pinnquad::Usually::off>,
                                                        pinnquad::Switched<OwnWrench, pinnquad::Usually::off>>(),
                                             pinnquad::SwitchedEffects()));
using FlownQuadrotor = decltype(pinnquad::quadrotor_with(
    std::declval<FlownEffects>(), std::declval<pinnquad::Airframe<double>>(), std::declval<pinnquad::Site<double>>()));

inline bool calls_python(const FlownEffects& effects) { return std::get<0>(effects).on || std::get<1>(effects).on; }
/// The effects that no callable of Python makes.
inline pinnquad::SwitchedEffects of_the_library(const FlownEffects& effects) {
  return std::apply([](const auto&, const auto&, const auto&... others) { return std::tuple(others...); }, effects);
}

/// Throws TypeError for what is no Effects, ValueError for a value that makes no sense, one line.
FlownEffects effects_of(py::handle given);

/// The vehicle at the paper's site. Throws pinnquad.Error where airframe and effects can't fly together.
FlownQuadrotor vehicle_of(const NamedAirframe& airframe, const FlownEffects& effects);

}  // namespace python
