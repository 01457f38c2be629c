// SPDX-License-Identifier: MIT
// An airframe from a TOML file: every key has its unit in its name, and what is wrong is said with line and column.
// examples/airframes/ has one file for each airframe of the library.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "command_line/toml_table.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace programs {

/// An airframe that a program was given, and what to call it.
struct NamedAirframe {
  std::string name;
  pinnquad::Airframe<double> value;
};

/// True for the name of a file rather than that of an airframe.
inline bool is_airframe_file(const std::string& name) {
  const std::string ending = ".toml";
  return name.size() > ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

namespace detail {

inline constexpr const char* airframe_key = "a key of an airframe";

inline pinnquad::RotorMount<double> rotor_of(const std::string& path, const toml::table& table) {
  TomlTable rotor(path, table, airframe_key);
  pinnquad::RotorMount<double> r;
  r.x_m = rotor.number("x_m", of_either_sign);
  r.y_m = rotor.number("y_m", of_either_sign);
  const char* spins = "\"clockwise\" or \"counter_clockwise\", seen from above";
  const std::string spin = rotor.text("spin", spins);
  if (spin != "clockwise" && spin != "counter_clockwise") {
    const toml::node& node = rotor.required("spin", spins);
    rotor.refuse(node, spins, described(node));
  }
  r.spin = spin == "clockwise" ? pinnquad::Spin::clockwise : pinnquad::Spin::counter_clockwise;
  r.z_m = rotor.number("z_m", of_either_sign, r.z_m);
  r.axis = rotor.triple("axis", of_either_sign, r.axis);
  if (!pinnquad::has_unit_axis(r)) {
    rotor.refuse(rotor.required("axis", ""), "a vector of length 1",
                 "[" + pinnquad::number_text(r.axis[0]) + ", " + pinnquad::number_text(r.axis[1]) + ", " +
                     pinnquad::number_text(r.axis[2]) + "]");
  }
  r.thrust_scale = rotor.number("thrust_scale", above_zero, r.thrust_scale);
  r.thrust_curve = rotor.number("thrust_curve", zero_to_one, r.thrust_curve);
  r.rise_time_constant_s = rotor.number("rise_time_constant_s", from_zero, r.rise_time_constant_s);
  r.fall_time_constant_s = rotor.number("fall_time_constant_s", from_zero, r.fall_time_constant_s);
  rotor.require_no_more();
  return r;
}

}  // namespace detail

/// The airframe of a file. Throws InputError, one line, for a file that can't be read, is no TOML, has a key that is
/// unknown, missing or of another type, and for values that no quadrotor has.
inline NamedAirframe read_airframe_file(const std::string& path) {
  const toml::table root = read_toml_file(path, "an airframe");
  TomlTable table(path, root, detail::airframe_key);
  NamedAirframe result;
  pinnquad::Airframe<double>& a = result.value;
  const char* one_line = "a text on one line";
  result.name = table.text("name", one_line);
  if (result.name.empty() || result.name != pinnquad::printable(result.name)) {
    const toml::node& node = table.required("name", one_line);
    table.refuse(node, one_line, described(node));
  }
  a.mass_kg = table.number("mass_kg", above_zero);
  a.inertia_kg_m2 = table.triple("inertia_kg_m2", above_zero);
  a.inertia_products_kg_m2 = table.triple("inertia_products_kg_m2", of_either_sign, a.inertia_products_kg_m2);
  a.thrust_coefficient = table.number("thrust_coefficient", above_zero);
  a.power_coefficient = table.number("power_coefficient", above_zero);
  a.propeller_diameter_m = table.number("propeller_diameter_m", above_zero);
  a.max_rotor_speed_rev_s = table.number("max_rotor_speed_rev_s", above_zero);
  a.rotor_time_constant_s = table.number("rotor_time_constant_s", from_zero);
  a.drag_area_m2 = table.triple("drag_area_m2", from_zero, a.drag_area_m2);
  a.drag_deadband_m_s = table.number("drag_deadband_m_s", from_zero, a.drag_deadband_m_s);
  const std::string four = "four tables [[rotor]], in the order of the commands";
  const toml::node& rotors = table.required("rotor", four);
  const toml::array* list = rotors.as_array();
  if (!list || list->size() != a.rotors.size() || !list->is_homogeneous<toml::table>()) {
    table.refuse(rotors, four,
                 list && list->is_homogeneous<toml::table>() ? std::to_string(list->size()) : described(rotors));
  }
  for (std::size_t i = 0; i < a.rotors.size(); ++i) a.rotors[i] = detail::rotor_of(path, *(*list)[i].as_table());
  table.require_no_more();
  if (!(a.thrust_to_weight() > 1)) {
    table.refuse(table.required("mass_kg", ""), "an airframe that can hover",
                 "a thrust-to-weight ratio of " + pinnquad::number_text(a.thrust_to_weight()));
  }
  if (pinnquad::check_airframe(a) != pinnquad::Status::ok) {
    pinnquad::Airframe<double> without = a;
    without.inertia_products_kg_m2 = {};
    const bool diagonal = pinnquad::check_airframe(without) != pinnquad::Status::ok;
    table.refuse(table.required(diagonal ? "inertia_kg_m2" : "inertia_products_kg_m2", ""),
                 "an inertia that a body can have (no principal moment above the sum of the other two)",
                 "one that none has");
  }
  if (pinnquad::Rotors<double>(a).status() != pinnquad::Status::ok) {
    table.refuse(rotors, "rotors that make thrust and three torques independently", "an allocation without inverse");
  }
  return result;
}

}  // namespace programs
