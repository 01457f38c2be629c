// SPDX-License-Identifier: MIT
// The airframe that an exported header brings with it (deploy/airframe_writer.hpp), read as text.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "airframe/file.hpp"
#include "model/header_file.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace programs {

/// The struct as it stands in the header, empty where its vehicle is one of the library. Throws InputError where it is
/// neither.
inline std::string airframe_struct(const HeaderFile& header) {
  const std::string& type = header.text("Vehicle");
  if (type.compare(0, 10, "pinnquad::") == 0) return "";
  const std::string text = header_text(header.path()), head = "\nstruct " + type + " {\n", tail = "\n};\n";
  const std::size_t begin = text.find(head), end = text.find(tail, std::min(begin, text.size()));
  if (!pinnquad::is_identifier(type) || begin == std::string::npos || end == std::string::npos) {
    header.refuse("Vehicle", "an airframe of the library or of the header", "`" + pinnquad::printable(type) + "`");
  }
  return text.substr(begin, end + tail.size() - begin);
}

namespace detail {

/// The numbers of "{Scalar(0.2), Scalar(-0.2), pinnquad::Spin::clockwise}". Empty if one is none.
inline std::vector<double> scalars_of(std::string_view value) {
  constexpr std::string_view mark = "Scalar(";
  std::vector<double> all;
  for (std::size_t at = value.find(mark); at != std::string_view::npos; at = value.find(mark, at)) {
    at += mark.size();
    double number = 0;
    const auto read = std::from_chars(value.data() + at, value.data() + value.size(), number);
    if (read.ec != std::errc() || read.ptr == value.data() + value.size() || *read.ptr != ')') return {};
    all.push_back(number);
  }
  return all;
}

/// The members that write_airframe() writes, by name.
inline std::map<std::string, std::vector<double*>> airframe_members(pinnquad::Airframe<double>& a) {
  const auto triple = [](std::array<double, 3>& v) { return std::vector<double*>{&v[0], &v[1], &v[2]}; };
  std::map<std::string, std::vector<double*>> members = {{"mass_kg", {&a.mass_kg}},
                                                         {"inertia_kg_m2", triple(a.inertia_kg_m2)},
                                                         {"inertia_products_kg_m2", triple(a.inertia_products_kg_m2)},
                                                         {"thrust_coefficient", {&a.thrust_coefficient}},
                                                         {"power_coefficient", {&a.power_coefficient}},
                                                         {"propeller_diameter_m", {&a.propeller_diameter_m}},
                                                         {"max_rotor_speed_rev_s", {&a.max_rotor_speed_rev_s}},
                                                         {"rotor_time_constant_s", {&a.rotor_time_constant_s}},
                                                         {"drag_area_m2", triple(a.drag_area_m2)},
                                                         {"drag_deadband_m_s", {&a.drag_deadband_m_s}}};
  for (std::size_t i = 0; i < pinnquad::rotor_count; ++i) {
    pinnquad::RotorMount<double>& rotor = a.rotors[i];
    const std::string name = "rotors[" + std::to_string(i) + "]";
    members[name] = {&rotor.x_m, &rotor.y_m};
    members[name + ".z_m"] = {&rotor.z_m};
    members[name + ".axis"] = triple(rotor.axis);
    members[name + ".thrust_scale"] = {&rotor.thrust_scale};
    members[name + ".thrust_curve"] = {&rotor.thrust_curve};
    members[name + ".rise_time_constant_s"] = {&rotor.rise_time_constant_s};
    members[name + ".fall_time_constant_s"] = {&rotor.fall_time_constant_s};
  }
  return members;
}

}  // namespace detail

/// None where the header's vehicle is one of the library. Throws InputError for a struct that write_airframe() has not
/// written, and for an airframe that can't fly.
inline std::optional<NamedAirframe> own_airframe(const HeaderFile& header) {
  const std::string text = airframe_struct(header);
  if (text.empty()) return {};
  const auto refuse = [&header](const std::string& found) {
    header.refuse("Vehicle", "an airframe as pinnquad train writes it", "`" + pinnquad::printable(found) + "`");
  };
  NamedAirframe own;
  own.name = header.quoted("vehicle_name");
  auto members = detail::airframe_members(own.value);
  std::size_t assigned = 0;
  constexpr std::string_view begin = "\n    a.";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    at += begin.size();
    const std::size_t equals = text.find(" = ", at), end = text.find(";\n", at);
    if (equals == std::string::npos || end == std::string::npos || equals > end) refuse(text.substr(at, 40));
    const std::string name = text.substr(at, equals - at), value = text.substr(equals + 3, end - equals - 3);
    const auto member = members.find(name);
    const std::vector<double> numbers = detail::scalars_of(value);
    if (member == members.end() || numbers.size() != member->second.size()) refuse(name + " = " + value);
    for (std::size_t i = 0; i < numbers.size(); ++i) *member->second[i] = numbers[i];
    const bool clockwise = value.find("Spin::clockwise") != std::string::npos;
    if (clockwise || value.find("Spin::counter_clockwise") != std::string::npos) {
      own.value.rotors[std::size_t(name[7] - '0')].spin =
          clockwise ? pinnquad::Spin::clockwise : pinnquad::Spin::counter_clockwise;
    }
    ++assigned;
  }
  if (assigned == 0 || pinnquad::check_airframe(own.value) != pinnquad::Status::ok ||
      pinnquad::Rotors<double>(own.value).status() != pinnquad::Status::ok) {
    refuse("one that can't fly");
  }
  return own;
}

}  // namespace programs
