// SPDX-License-Identifier: MIT
// Effects of Python (tools/python/pinnquad/effects.py) as values.
#pragma once

#include "pinnquad/simulation/switched_quadrotor.hpp"
#include "python/bindings.hpp"

namespace python {

inline constexpr std::array<const char*, 4> ground_effects = {"none", "cheeseman_bennett", "conyers", "rotors"};

/// Throws TypeError for what is no Effects, ValueError for a value that makes no sense, one line.
pinnquad::SwitchedEffects effects_of(py::handle given);

/// The vehicle at the paper's site. Throws pinnquad.Error where airframe and effects can't fly together.
pinnquad::SwitchedQuadrotor vehicle_of(const NamedAirframe& airframe, const pinnquad::SwitchedEffects& effects);

}  // namespace python
