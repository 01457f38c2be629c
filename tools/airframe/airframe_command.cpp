// SPDX-License-Identifier: MIT
// Lists the airframes that the program knows, checks one from a file, writes one as a file or as a C++ struct.
//   pinnquad airframe list | check FILE.toml | convert NAME|FILE.toml --out FILE.toml|FILE.hpp
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "airframe/estimate.hpp"
#include "airframe/toml_writer.hpp"
#include "command_line/command.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/in_columns.hpp"
#include "command_line/options.hpp"
#include "logs/airframe_doubts.hpp"
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
  programs::KnownOfAirframe known;
};

void tell(const programs::NamedAirframe& airframe) {
  const Airframe<double>& a = airframe.value;
  std::printf("%s: %.3f kg, rotors up to %.0f rpm, thrust-to-weight %.3f\n", printable(airframe.name).c_str(),
              a.mass_kg, 60 * a.max_rotor_speed_rev_s, a.thrust_to_weight());
  const auto signs = motor_torque_signs(a);
  for (std::size_t rotor = 0; rotor < signs.size(); ++rotor) {
    std::printf("  u%zu at x %+.3f m, y %+.3f m, %s: roll %+d, pitch %+d, yaw %+d\n", rotor + 1, a.rotors[rotor].x_m,
                a.rotors[rotor].y_m, a.rotors[rotor].spin == Spin::clockwise ? "clockwise" : "counter-clockwise",
                signs[rotor][0], signs[rotor][1], signs[rotor][2]);
  }
  const std::array<double, 3> turn = logs::greatest_turn_rad_s2(a);
  std::printf("  hovers at command %.3f; greatest angular acceleration roll %.0f, pitch %.0f, yaw %.1f rad/s^2\n",
              logs::hover_command(a), turn[0], turn[1], turn[2]);
  for (const std::string& doubt : logs::airframe_doubts(a)) programs::print_message("warning: " + doubt, 2);
}

int check(const AirframeOptions& options) {
  tell(programs::chosen_airframe(options.airframe));
  return 0;
}

int estimate(const AirframeOptions& options) {
  const bool by_thrust = options.known.thrust_g > 0;
  if (by_thrust == (options.known.kv > 0 && options.known.cells > 0)) {
    throw std::invalid_argument("either --thrust, or --kv and --cells, was expected");
  }
  if (!programs::is_airframe_file(options.out)) {
    throw std::invalid_argument("--out " + options.out + ": a name that ends in .toml was expected");
  }
  programs::KnownOfAirframe known = options.known;
  known.name = std::filesystem::path(options.out).stem().string();
  const programs::NamedAirframe airframe = programs::estimated_airframe(known);
  AtomicFile file(options.out);
  file.stream() << programs::estimated_toml(airframe, by_thrust);
  file.commit();
  tell(programs::chosen_airframe(options.out));
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
    file.stream() << "#pragma once\n\n" << pinnquad::detail::flight_include << '\n';
    write_airframe(file.stream(), options.struct_name, airframe.name, airframe.value);
  } else {
    file.stream() << programs::airframe_toml(airframe);
  }
  file.commit();
  return 0;
}

}  // namespace

namespace programs {

Command airframe_command(CLI::App& program) {
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
  CLI::App* guess = line->add_subcommand("estimate", "Estimates an airframe from mass, arm, propeller and motor");
  KnownOfAirframe& known_of = options->known;
  add_number(*guess, "--mass", known_of.mass_kg, 0.01, 100.0, "all-up weight, kg")->required();
  add_number(*guess, "--arm", known_of.arm_m, 0.01, 3.0, "from the centre to a motor, m")->required();
  add_number(*guess, "--propeller", known_of.propeller_in, 0.5, 60.0, "diameter, inches")->required();
  add_number(*guess, "--thrust", known_of.thrust_g, 1.0, 1e5, "of one motor at full throttle, grams");
  add_number(*guess, "--kv", known_of.kv, 10.0, 1e5, "of a motor, rev/min per V; with --cells in place of --thrust");
  add_number(*guess, "--cells", known_of.cells, 1.0, 24.0, "of lithium polymer in series");
  add_path(*guess, "--out", options->out, "FILE.toml", "what to write; its name names the airframe")->required();
  guess->footer(
      footer("  pinnquad airframe estimate --mass 0.65 --arm 0.11 --propeller 5 --thrust 1200 --out mine.toml\n"
             "  pinnquad airframe estimate --mass 2 --arm 0.25 --propeller 10 --kv 920 --cells 4 --out mine.toml\n"));
  CLI::App* other = line->add_subcommand("convert", "Writes an airframe as a file (.toml) or as a C++ struct (.hpp)");
  add_path(*other, "airframe", options->airframe, "NAME|FILE.toml", known)->required();
  add_path(*other, "--out", options->out, "FILE.toml|FILE.hpp", "file to write: .toml or .hpp")->required();
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
                                         {guess, [options] { return estimate(*options); }},
                                         {other, [options] { return convert(*options); }}};
  return {line, [commands] { return run_chosen(commands); }};
}

}  // namespace programs
