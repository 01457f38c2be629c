// SPDX-License-Identifier: MIT
// Lists the airframes that the program knows, checks one from a file, writes one as a file or as a C++ struct.
//   pinnquad airframe list | check FILE.toml | convert NAME|FILE.toml --out FILE.toml|FILE.hpp
#include "airframe/airframe_command.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "airframe/toml_writer.hpp"
#include "command_line/commands.hpp"
#include "command_line/file_roles.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/io/atomic_file.hpp"

namespace {

using namespace pinnquad;

constexpr const char* airframe_exit_codes = "Exit codes: 0; 2 bad input or a file that can't be read or written.";

std::string footer(const std::string& examples) { return "Examples:\n" + examples + airframe_exit_codes; }

struct AirframeOptions {
  std::string airframe;
  std::string out;
  std::string struct_name = "MyQuadrotor";
};

int check(const AirframeOptions& options) {
  const programs::NamedAirframe airframe = programs::chosen_airframe(options.airframe);
  const Airframe<double>& a = airframe.value;
  std::printf("%s: %.3f kg, rotors up to %.0f rpm, thrust-to-weight %.3f\n", printable(airframe.name).c_str(),
              a.mass_kg, 60 * a.max_rotor_speed_rev_s, a.thrust_to_weight());
  const auto signs = motor_torque_signs(a);
  for (std::size_t rotor = 0; rotor < signs.size(); ++rotor) {
    std::printf("  u%zu at x %+.3f m, y %+.3f m, %s: roll %+d, pitch %+d, yaw %+d\n", rotor + 1, a.rotors[rotor].x_m,
                a.rotors[rotor].y_m, a.rotors[rotor].spin == Spin::clockwise ? "clockwise" : "counter-clockwise",
                signs[rotor][0], signs[rotor][1], signs[rotor][2]);
  }
  return 0;
}

int convert(const AirframeOptions& options) {
  const bool as_struct = std::filesystem::path(options.out).extension() == ".hpp";
  if (!as_struct && !programs::is_airframe_file(options.out)) {
    throw std::invalid_argument("--out " + options.out + ": a name that ends in .toml or .hpp was expected");
  }
  programs::FileRoles roles;
  if (programs::is_airframe_file(options.airframe)) roles.reads("airframe", options.airframe);
  roles.writes("--out", options.out);
  const programs::NamedAirframe airframe = programs::chosen_airframe(options.airframe);
  AtomicFile file(options.out);
  if (as_struct) {
    file.stream() << "#pragma once\n\n#include \"pinnquad/flight.hpp\"\n\n";
    write_airframe(file.stream(), options.struct_name, airframe.name, airframe.value);
  } else {
    file.stream() << programs::airframe_toml(airframe);
  }
  file.commit();
  return 0;
}

}  // namespace

programs::Command programs::airframe_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand("airframe", "Lists, checks and converts airframes");
  line->footer(
      footer("  pinnquad airframe list\n"
             "  pinnquad airframe convert racer_5_inch --out mine.toml      to begin one's own\n"
             "  pinnquad airframe check mine.toml\n"));
  const auto options = std::make_shared<AirframeOptions>();
  const std::string known = "a file, or one of: " + airframe_names();

  CLI::App* list =
      line->add_subcommand("list", "The airframes that the program knows, and where their values are from");
  list->footer(footer("  pinnquad airframe list\n"));
  CLI::App* one = line->add_subcommand("check", "Says what an airframe is, or what is wrong with its file");
  one->footer(footer("  pinnquad airframe check mine.toml\n"));
  add_path(*one, "airframe", options->airframe, "NAME|FILE.toml", known)->required();
  CLI::App* other = line->add_subcommand("convert", "Writes an airframe as a file (.toml) or as a C++ struct (.hpp)");
  add_path(*other, "airframe", options->airframe, "NAME|FILE.toml", known)->required();
  add_path(*other, "--out", options->out, "FILE.toml|FILE.hpp", "what to write; its ending says as what")->required();
  other->add_option("--name", options->struct_name, "name of the struct")->type_name("NAME")->capture_default_str();
  other->footer(
      footer("  pinnquad airframe convert racer_5_inch --out mine.toml      to begin one's own\n"
             "  pinnquad airframe convert mine.toml --out mine.hpp --name MyQuadrotor\n"));
  const std::vector<Command> commands = {{list,
                                          [] {
                                            list_airframes();
                                            return 0;
                                          }},
                                         {one, [options] { return check(*options); }},
                                         {other, [options] { return convert(*options); }}};
  return {line, [commands] { return run_chosen(commands); }};
}
