// SPDX-License-Identifier: MIT
// Bodies of airframe_writer.hpp.
#pragma once

#include <array>
#include <locale>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "pinnquad/deploy/airframe_writer.hpp"

namespace pinnquad {

PINNQUAD_BODY void write_airframe(std::ostream& stream, const std::string& struct_name, const std::string& name,
                                  const Airframe<double>& airframe) {
  detail::require_identifier(struct_name);
  if (check_airframe(airframe) != Status::ok || Rotors<double>(airframe).status() != Status::ok) {
    throw std::invalid_argument("export: the airframe '" + name + "' can't fly");
  }
  std::ostringstream out;
  out.imbue(std::locale::classic());
  const auto scalar = [](double value) { return "Scalar(" + detail::literal(value) + ")"; };
  const auto assign = [&](const std::string& member, double value) {
    out << "    a." << member << " = " << scalar(value) << ";\n";
  };
  const auto triple = [&](const std::string& member, const std::array<double, 3>& v) {
    out << "    a." << member << " = {" << scalar(v[0]) << ", " << scalar(v[1]) << ", " << scalar(v[2]) << "};\n";
  };
  out << "struct " << struct_name << " {\n"
      << "  static constexpr const char* name = " << detail::quoted(name) << ";\n\n"
      << "  template <class Scalar>\n"
      << "  static constexpr pinnquad::Airframe<Scalar> value() {\n"
      << "    pinnquad::Airframe<Scalar> a{};\n";
  assign("mass_kg", airframe.mass_kg);
  triple("inertia_kg_m2", airframe.inertia_kg_m2);
  if (!has_diagonal_inertia(airframe)) triple("inertia_products_kg_m2", airframe.inertia_products_kg_m2);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<double>& r = airframe.rotors[i];
    const RotorMount<double> plain{};
    const std::string rotor = "rotors[" + std::to_string(i) + "]";
    out << "    a." << rotor << " = {" << scalar(r.x_m) << ", " << scalar(r.y_m)
        << ", pinnquad::Spin::" << (r.spin == Spin::clockwise ? "clockwise" : "counter_clockwise") << "};\n";
    const auto unlike = [&](const char* member, double value, double usual) {
      if (value != usual) assign(rotor + "." + member, value);
    };
    unlike("z_m", r.z_m, plain.z_m);
    if (!is_upright(r)) triple(rotor + ".axis", r.axis);
    unlike("thrust_scale", r.thrust_scale, plain.thrust_scale);
    unlike("thrust_curve", r.thrust_curve, plain.thrust_curve);
    unlike("rise_time_constant_s", r.rise_time_constant_s, plain.rise_time_constant_s);
    unlike("fall_time_constant_s", r.fall_time_constant_s, plain.fall_time_constant_s);
  }
  assign("thrust_coefficient", airframe.thrust_coefficient);
  assign("power_coefficient", airframe.power_coefficient);
  assign("propeller_diameter_m", airframe.propeller_diameter_m);
  assign("max_rotor_speed_rev_s", airframe.max_rotor_speed_rev_s);
  assign("rotor_time_constant_s", airframe.rotor_time_constant_s);
  triple("drag_area_m2", airframe.drag_area_m2);
  assign("drag_deadband_m_s", airframe.drag_deadband_m_s);
  out << "    return a;\n  }\n};\n";
  stream << out.str();
}

}  // namespace pinnquad
