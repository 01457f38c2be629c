// SPDX-License-Identifier: MIT
// An airframe as a TOML file that read_airframe_file() takes: the same numbers bit for bit.
#pragma once

#include <array>
#include <string>

#include "airframe/choice.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {

namespace detail {

/// A number that TOML reads as one of floating point.
inline std::string toml_text(double value) {
  const std::string text = pinnquad::number_text(value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

inline std::string toml_text(const std::array<double, 3>& v) {
  return "[" + toml_text(v[0]) + ", " + toml_text(v[1]) + ", " + toml_text(v[2]) + "]";
}

/// A text of one line between quotes.
inline std::string toml_quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace detail

/// Leaves out values of a plain rotor and a plain body.
inline std::string airframe_toml(const NamedAirframe& airframe) {
  const pinnquad::Airframe<double>& a = airframe.value;
  std::string text =
      "# Units are in the keys; FRD, about the centre of gravity; rotors in the order of the commands.\n";
  const auto line = [&text](const char* key, const auto& value, const char* comment = "") {
    text += std::string(key) + " = " + detail::toml_text(value) + comment + "\n";
  };
  text += "name = " + detail::toml_quoted(airframe.name) + "\n";
  line("mass_kg", a.mass_kg);
  line("inertia_kg_m2", a.inertia_kg_m2, "  # Jx, Jy, Jz");
  if (!pinnquad::has_diagonal_inertia(a)) line("inertia_products_kg_m2", a.inertia_products_kg_m2);
  line("thrust_coefficient", a.thrust_coefficient, "  # C_T = thrust / (rho n^2 D^4), n in rev/s, rho = 1.225 kg/m^3");
  line("power_coefficient", a.power_coefficient, "  # C_P = 2 pi torque / (rho n^2 D^5)");
  line("propeller_diameter_m", a.propeller_diameter_m);
  line("max_rotor_speed_rev_s", a.max_rotor_speed_rev_s, "  # at command 1");
  line("rotor_time_constant_s", a.rotor_time_constant_s);
  line("drag_area_m2", a.drag_area_m2, "  # k of F = -k rho |v| v");
  line("drag_deadband_m_s", a.drag_deadband_m_s);
  const pinnquad::RotorMount<double> plain{};
  for (const pinnquad::RotorMount<double>& r : a.rotors) {
    text += "\n[[rotor]]\n";
    line("x_m", r.x_m);
    line("y_m", r.y_m);
    text +=
        std::string("spin = \"") + (r.spin == pinnquad::Spin::clockwise ? "clockwise" : "counter_clockwise") + "\"\n";
    const auto unlike = [&line](const char* key, const auto& value, const auto& usual) {
      if (value != usual) line(key, value);
    };
    unlike("z_m", r.z_m, plain.z_m);
    unlike("axis", r.axis, plain.axis);
    unlike("thrust_scale", r.thrust_scale, plain.thrust_scale);
    unlike("thrust_curve", r.thrust_curve, plain.thrust_curve);
    unlike("rise_time_constant_s", r.rise_time_constant_s, plain.rise_time_constant_s);
    unlike("fall_time_constant_s", r.fall_time_constant_s, plain.fall_time_constant_s);
  }
  return text;
}

}  // namespace programs
