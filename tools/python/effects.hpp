// SPDX-License-Identifier: MIT
// Effects of Python (tools/python/pinnquad/effects.py) as values.
#pragma once

#include "python/bindings.hpp"
#include "python/switched_vehicle.hpp"

namespace python {

/// Throws TypeError for what is no Effects, ValueError for a value that makes no sense, one line.
Effects effects_of(py::handle given);

/// The vehicle at the paper's site. Throws pinnquad.Error where airframe and effects can't fly together.
SwitchedQuadrotor vehicle_of(const NamedAirframe& airframe, const Effects& effects);

}  // namespace python
