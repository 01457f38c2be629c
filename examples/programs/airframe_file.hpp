// SPDX-License-Identifier: MIT
// An airframe from a TOML file: every key has its unit in its name, and what is wrong is said with line and column.
// examples/airframes/ has one file for each airframe of the library.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "pinnquad/data/file_error.hpp"
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

/// A table of the file: asks for its keys one by one, and in the end for those that nobody asked for.
class AirframeTable {
 public:
  AirframeTable(const std::string& path, const toml::table& table) : path_(path), table_(table) {}

  double number(const char* key) { return as_number(required(key, "a number"), "a number"); }
  double number(const char* key, double otherwise) {
    const toml::node* node = optional(key);
    return node ? as_number(*node, "a number") : otherwise;
  }
  std::array<double, 3> triple(const char* key) { return as_triple(required(key, three_numbers)); }
  std::array<double, 3> triple(const char* key, const std::array<double, 3>& otherwise) {
    const toml::node* node = optional(key);
    return node ? as_triple(*node) : otherwise;
  }
  std::string text(const char* key, const char* expected) {
    const toml::node& node = required(key, expected);
    if (!node.is_string()) refuse(node, expected, described(node));
    return node.as_string()->get();
  }
  const toml::node& required(const char* key, const std::string& expected) {
    const toml::node* node = optional(key);
    if (!node) refuse(table_, "`" + std::string(key) + "`, " + expected, "no such key");
    return *node;
  }
  void require_no_more() const {
    for (const auto& [key, node] : table_) {
      if (known_.count(std::string(key.str())) == 0) {
        refuse(key.source(), "a key of an airframe", "`" + std::string(key.str()) + "`");
      }
    }
  }
  [[noreturn]] void refuse(const toml::node& node, const std::string& expected, const std::string& found) const {
    refuse(node.source(), expected, found);
  }

  /// A node as the one-line messages name it: its value, or its kind.
  static std::string described(const toml::node& node) {
    if (const auto* text = node.as_string()) return "\"" + text->get() + "\"";
    if (node.is_number()) return std::to_string(*node.value<double>());
    if (node.is_array()) return "an array of " + std::to_string(node.as_array()->size());
    return node.is_table() ? "a table" : node.is_boolean() ? "a truth value" : "a date or time";
  }

 private:
  static constexpr const char* three_numbers = "an array of three numbers";

  const toml::node* optional(const char* key) {
    known_.insert(key);
    return table_.get(key);
  }
  double as_number(const toml::node& node, const char* expected) const {
    if (!node.is_number()) refuse(node, expected, described(node));
    return *node.value<double>();
  }
  std::array<double, 3> as_triple(const toml::node& node) const {
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) refuse(node, three_numbers, described(node));
    return {as_number((*array)[0], "a number"), as_number((*array)[1], "a number"), as_number((*array)[2], "a number")};
  }
  [[noreturn]] void refuse(const toml::source_region& where, const std::string& expected,
                           const std::string& found) const {
    throw pinnquad::InputError(path_, where.begin.line, where.begin.column, expected, found);
  }

  const std::string& path_;
  const toml::table& table_;
  std::set<std::string> known_;
};

inline pinnquad::RotorMount<double> rotor_of(const std::string& path, const toml::table& table) {
  AirframeTable rotor(path, table);
  pinnquad::RotorMount<double> r;
  r.x_m = rotor.number("x_m");
  r.y_m = rotor.number("y_m");
  const char* spins = "\"clockwise\" or \"counter_clockwise\", seen from above";
  const std::string spin = rotor.text("spin", spins);
  if (spin != "clockwise" && spin != "counter_clockwise") {
    rotor.refuse(rotor.required("spin", spins), spins, "\"" + spin + "\"");
  }
  r.spin = spin == "clockwise" ? pinnquad::Spin::clockwise : pinnquad::Spin::counter_clockwise;
  r.z_m = rotor.number("z_m", r.z_m);
  r.axis = rotor.triple("axis", r.axis);
  r.thrust_scale = rotor.number("thrust_scale", r.thrust_scale);
  r.thrust_curve = rotor.number("thrust_curve", r.thrust_curve);
  r.rise_time_constant_s = rotor.number("rise_time_constant_s", r.rise_time_constant_s);
  r.fall_time_constant_s = rotor.number("fall_time_constant_s", r.fall_time_constant_s);
  rotor.require_no_more();
  if (!pinnquad::detail::plausible_rotor(r)) {
    rotor.refuse(table,
                 "a rotor that can be built: an axis of length 1, a thrust scale above 0, a thrust curve in 0..1, no "
                 "negative time constant",
                 "one that can't");
  }
  return r;
}

}  // namespace detail

/// The airframe of a file. Throws InputError, one line, for a file that can't be read, is no TOML, has a key that is unknown,
/// missing or of another type, and for values that no quadrotor has.
inline NamedAirframe read_airframe_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw pinnquad::InputError(path, 0, 0, "an airframe file", "none that can be read");
  const std::string content{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  toml::table root;
  try {
    root = toml::parse(content, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw pinnquad::InputError(path, at.line, at.column, "TOML", std::string(error.description()));
  }
  detail::AirframeTable table(path, root);
  NamedAirframe result;
  pinnquad::Airframe<double>& a = result.value;
  result.name = table.text("name", "a text");
  a.mass_kg = table.number("mass_kg");
  a.inertia_kg_m2 = table.triple("inertia_kg_m2");
  a.inertia_products_kg_m2 = table.triple("inertia_products_kg_m2", a.inertia_products_kg_m2);
  a.thrust_coefficient = table.number("thrust_coefficient");
  a.power_coefficient = table.number("power_coefficient");
  a.propeller_diameter_m = table.number("propeller_diameter_m");
  a.max_rotor_speed_rev_s = table.number("max_rotor_speed_rev_s");
  a.rotor_time_constant_s = table.number("rotor_time_constant_s");
  a.drag_area_m2 = table.triple("drag_area_m2", a.drag_area_m2);
  a.drag_deadband_m_s = table.number("drag_deadband_m_s", a.drag_deadband_m_s);
  const std::string four = "four tables [[rotor]], in the order of the commands";
  const toml::node& rotors = table.required("rotor", four);
  const toml::array* list = rotors.as_array();
  if (!list || list->size() != a.rotors.size() || !list->is_homogeneous<toml::table>()) {
    table.refuse(rotors, four, list ? std::to_string(list->size()) : detail::AirframeTable::described(rotors));
  }
  for (std::size_t i = 0; i < a.rotors.size(); ++i) a.rotors[i] = detail::rotor_of(path, *(*list)[i].as_table());
  table.require_no_more();
  const auto positive = [&](const char* key, double value) {
    if (!pinnquad::detail::plausible(value)) {
      const toml::node& node = *root.get(key);
      table.refuse(node, "a value above 0", detail::AirframeTable::described(node));
    }
  };
  positive("mass_kg", a.mass_kg);
  positive("thrust_coefficient", a.thrust_coefficient);
  positive("power_coefficient", a.power_coefficient);
  positive("propeller_diameter_m", a.propeller_diameter_m);
  positive("max_rotor_speed_rev_s", a.max_rotor_speed_rev_s);
  if (!(a.thrust_to_weight() > 1)) {
    table.refuse(*root.get("mass_kg"), "an airframe that can hover",
                 "a thrust-to-weight ratio of " + std::to_string(a.thrust_to_weight()));
  }
  if (pinnquad::check_airframe(a) != pinnquad::Status::ok) {
    table.refuse(
        *root.get("inertia_kg_m2"),
        "an inertia that a body can have (no principal moment above the sum of the other two), a lag and a drag "
        "of 0 or more",
        "values that no quadrotor has");
  }
  if (pinnquad::Rotors<double>(a).status() != pinnquad::Status::ok) {
    table.refuse(rotors, "rotors that make thrust and three torques independently", "an allocation without inverse");
  }
  return result;
}

}  // namespace programs
