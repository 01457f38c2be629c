// SPDX-License-Identifier: MIT
// An airframe by name, or from a TOML file: every key has its unit in its name, and what is wrong is said with line and
// column. examples/airframes/ has one file for each airframe of the library.
#pragma once

#include <stdexcept>
#include <string>

#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad::logs {

/// An airframe that was given, and what to call it.
struct NamedAirframe {
  std::string name;
  Airframe<double> value;
};

/// True where every number of two airframes is the same.
bool same_numbers(const Airframe<double>& a, const Airframe<double>& b);

/// True for the name of a file rather than that of an airframe.
bool is_airframe_file(const std::string& name);

/// The airframe of a file. Throws InputError, one line, for a file that can't be read, is no TOML, has a key that is
/// unknown, missing or of another type, and for values that no quadrotor has.
NamedAirframe read_airframe_file(const std::string& path);

/// The airframe of that name or file. Throws InputError (the file) and std::invalid_argument (no such name), one line.
NamedAirframe chosen_airframe(const std::string& name_or_file);

/// The refusal of a name that is none.
std::invalid_argument no_airframe(const std::string& name);

}  // namespace pinnquad::logs
