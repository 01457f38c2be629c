// SPDX-License-Identifier: MIT
#include "logs/airframe_file.hpp"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "logs/airframe_doubts.hpp"
#include "logs/airframe_names.hpp"
#include "logs/toml_table.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad::logs {
namespace {

constexpr const char* airframe_key = "a key of an airframe";

RotorMount<double> rotor_of(const std::string& path, const toml::table& table) {
  TomlTable rotor(path, table, airframe_key);
  RotorMount<double> r;
  r.x_m = rotor.number("x_m", of_either_sign);
  r.y_m = rotor.number("y_m", of_either_sign);
  const char* spins = "\"clockwise\" or \"counter_clockwise\", seen from above";
  const toml::node& node = rotor.required("spin", spins);
  const std::string spin = rotor.as_text(node, spins);
  if (spin != "clockwise" && spin != "counter_clockwise") rotor.refuse(node, spins, described(node));
  r.spin = spin == "clockwise" ? Spin::clockwise : Spin::counter_clockwise;
  r.z_m = rotor.number("z_m", of_either_sign, r.z_m);
  r.axis = rotor.triple("axis", of_either_sign, r.axis);
  if (!has_unit_axis(r)) {
    rotor.refuse(rotor.required("axis", ""), "a vector of length 1",
                 "[" + number_text(r.axis[0]) + ", " + number_text(r.axis[1]) + ", " + number_text(r.axis[2]) + "]");
  }
  r.thrust_scale = rotor.number("thrust_scale", above_zero, r.thrust_scale);
  r.thrust_curve = rotor.number("thrust_curve", zero_to_one, r.thrust_curve);
  r.rise_time_constant_s = rotor.number("rise_time_constant_s", from_zero, r.rise_time_constant_s);
  r.fall_time_constant_s = rotor.number("fall_time_constant_s", from_zero, r.fall_time_constant_s);
  rotor.require_no_more();
  return r;
}

/// Refuses numbers that no quadrotor can have.
void require_buildable(TomlTable& table, const Airframe<double>& a) {
  constexpr double most_thrust_to_weight = 40;
  const auto rounded = [](double value) { return number_text(std::round(value * 1e3) / 1e3); };
  if (!(tip_speed_m_s(a) < speed_of_sound_m_s)) {
    table.refuse(table.required("max_rotor_speed_rev_s", ""),
                 "rev/s (a sixtieth of rev/min) at which the blades' tips stay below the speed of sound",
                 "tips at " + rounded(tip_speed_m_s(a)) + " m/s");
  }
  if (!(a.propeller_diameter_m < 2 * rotor_distance_m(a))) {
    table.refuse(
        table.required("propeller_diameter_m", ""),
        "a propeller, in m, that does not reach the hub of the nearest, " + rounded(rotor_distance_m(a)) + " m away",
        rounded(a.propeller_diameter_m) + " m");
  }
  if (!(a.thrust_to_weight() < most_thrust_to_weight)) {
    table.refuse(table.required("mass_kg", ""),
                 "a thrust-to-weight ratio below " + number_text(most_thrust_to_weight) +
                     " (rotor speed in rev/s, mass in kg, thrust coefficient by rho n^2 D^4)",
                 rounded(a.thrust_to_weight()));
  }
}

}  // namespace

bool same_numbers(const Airframe<double>& a, const Airframe<double>& b) {
  const auto numbers_of = [](const Airframe<double>& of) {
    std::vector<double> numbers;
    each_number(of, [&](auto number) { numbers.push_back(static_cast<double>(number)); });
    return numbers;
  };
  return numbers_of(a) == numbers_of(b);
}

std::invalid_argument no_airframe(const std::string& name) {
  return std::invalid_argument("no airframe named '" + name + "'; known: " + airframe_names() +
                               ", or a file whose name ends in .toml");
}

bool is_airframe_file(const std::string& name) { return std::filesystem::path(name).extension() == ".toml"; }

NamedAirframe read_airframe_file(const std::string& path) {
  const toml::table root = read_toml_file(path, "an airframe");
  TomlTable table(path, root, airframe_key);
  NamedAirframe result;
  Airframe<double>& a = result.value;
  result.name = table.line("name");
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
  for (std::size_t i = 0; i < a.rotors.size(); ++i) a.rotors[i] = rotor_of(path, *(*list)[i].as_table());
  table.require_no_more();
  if (!(a.thrust_to_weight() > 1)) {
    table.refuse(table.required("mass_kg", ""), "an airframe that can hover",
                 "a thrust-to-weight ratio of " + number_text(a.thrust_to_weight()));
  }
  if (check_airframe(a) != Status::ok) {
    Airframe<double> without = a;
    without.inertia_products_kg_m2 = {};
    const bool diagonal = check_airframe(without) != Status::ok;
    table.refuse(table.required(diagonal ? "inertia_kg_m2" : "inertia_products_kg_m2", ""),
                 "an inertia that a body can have (no principal moment above the sum of the other two)",
                 "one that none has");
  }
  if (Rotors<double>(a).status() != Status::ok) {
    table.refuse(rotors, "rotors that make thrust and three torques independently", "an allocation without inverse");
  }
  require_buildable(table, a);
  return result;
}

NamedAirframe chosen_airframe(const std::string& name_or_file) {
  if (is_airframe_file(name_or_file)) return read_airframe_file(name_or_file);
  std::optional<NamedAirframe> airframe;
  with_airframe(name_or_file, [&airframe](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    airframe = NamedAirframe{Vehicle::name, airframe_value<Vehicle, double>()};
  });
  if (!airframe) throw no_airframe(name_or_file);
  return *airframe;
}

}  // namespace pinnquad::logs
