// SPDX-License-Identifier: MIT
// Writes the airframes of the folder given, and one with nothing equal, as structs: written_airframes.hpp of the
// driver.
#include <cstdio>
#include <fstream>
#include <string>

#include "airframe/choice.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "support/uneven_airframe.hpp"

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  const std::string folder = arguments[1];
  std::ofstream out(arguments[2]);
  out << "#pragma once\n#include \"pinnquad/flight.hpp\"\n";
  const programs::NamedAirframe racer = programs::read_airframe_file(folder + "/racer_5_inch.toml");
  const programs::NamedAirframe crazyflie = programs::read_airframe_file(folder + "/crazyflie_2_1.toml");
  pinnquad::write_airframe(out, "WrittenRacer", racer.name, racer.value);
  pinnquad::write_airframe(out, "WrittenCrazyflie", crazyflie.name, crazyflie.value);
  pinnquad::write_airframe(out, "WrittenUneven", "uneven \"one\"", pinnquad::test::uneven_airframe<double>());
  return out.flush() ? 0 : 1;
}
