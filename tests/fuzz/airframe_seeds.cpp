// SPDX-License-Identifier: MIT
// Writes airframe files, sound and not, into a folder, for the fuzzer to begin with: airframe_seeds DIR
#include <string>

#include "fuzz/seeds.hpp"

int main(int argument_count, char** arguments) {
  const std::string numbers =
      "name = \"quad\"\nmass_kg = 1.0\ninertia_kg_m2 = [0.01, 0.012, 0.02]\nthrust_coefficient = 0.1\n"
      "power_coefficient = 0.05\npropeller_diameter_m = 0.25\nmax_rotor_speed_rev_s = 120.0\n"
      "rotor_time_constant_s = 0.03\ndrag_area_m2 = [0.001, 0.001, 0.002]\ndrag_deadband_m_s = 0.1\n";
  const auto rotors = [](const std::string& more) {
    const char* places[] = {"x_m = 0.2\ny_m = 0.2\nspin = \"counter_clockwise\"\n",
                            "x_m = -0.2\ny_m = -0.2\nspin = \"counter_clockwise\"\n",
                            "x_m = 0.2\ny_m = -0.2\nspin = \"clockwise\"\n",
                            "x_m = -0.2\ny_m = 0.2\nspin = \"clockwise\"\n"};
    std::string all;
    for (const char* place : places) all += std::string("[[rotor]]\n") + place + more;
    return all;
  };
  return pinnquad_test::write_seeds(
      argument_count, arguments,
      {numbers + rotors(""),
       numbers + "inertia_products_kg_m2 = [0.0001, 0.0, 0.0]\n" +
           rotors("z_m = -0.01\naxis = [0.0, 0.0, -1.0]\nthrust_scale = 0.97\nthrust_curve = 0.5\n"
                  "rise_time_constant_s = 0.02\nfall_time_constant_s = 0.04\n"),
       numbers, "mass_kg = -1\n", "[[rotor"});
}
