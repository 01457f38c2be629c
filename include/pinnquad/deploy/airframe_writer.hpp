// SPDX-License-Identifier: MIT
// Writes an airframe value as a C++ struct that fulfils the airframe contract (dynamics/airframe.hpp): a vehicle known
// only when a program runs becomes a type for the next compiler. Every number reads back bit for bit in double.
#pragma once

#include <iosfwd>
#include <string>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// Writes `struct <struct_name>` with the airframe's `name` and `value<Scalar>()`; what includes it needs
/// pinnquad/dynamics/airframe_value.hpp, which pinnquad/flight.hpp has. Values of a plain rotor are left out.
/// Throws std::invalid_argument, and writes nothing, for a name that no struct may have and an airframe that can't fly.
void write_airframe(std::ostream& stream, const std::string& struct_name, const std::string& name,
                    const Airframe<double>& airframe);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/airframe_writer.hpp"
#endif
