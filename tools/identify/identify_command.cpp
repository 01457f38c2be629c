// SPDX-License-Identifier: MIT
// Finds the vehicle that flew flights or logs: thrust, turning, drag, lag, each with an interval; writes it as an
// airframe file.
//   pinnquad identify flight.ulg --mass 1.2 --out vehicle.toml
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "command_line/command.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/like_warnings.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "identify/told_vehicle.hpp"
#include "identify/vehicle_verdict.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/logs/dataset_folder.hpp"

namespace {

namespace logs = pinnquad::logs;

struct IdentifyOptions {
  std::vector<std::string> flights;
  logs::LogSettings settings;
  programs::SaidOfVehicle said{{}, {}, {}, {}, false, "--mass", "--arm"};
  std::string out, name = "identified";
  bool json = false;
};

logs::ImportedDataset read(const IdentifyOptions& options) {
  programs::JobLine progress;
  logs::LogSettings settings = options.settings;
  settings.lag_s = 0;
  settings.keep_saturated = true;
  settings.on_progress = [&progress](const std::string& job, double share) { progress.update(job, share); };
  logs::ImportedDataset dataset = logs::read_source(options.flights, settings);
  if (settings.mapping.empty() && logs::kind_of_source(options.flights.front()) == logs::SourceKind::dataset) {
    dataset.sources.clear();  // what is refused is a file of the folder
    for (const std::string& file : logs::flight_files(dataset)) {
      dataset.sources.push_back(options.flights.front() + "/" + file);
    }
  }
  return dataset;
}

programs::SaidOfVehicle said_by(const IdentifyOptions& options) {
  programs::SaidOfVehicle said = options.said;
  if (!options.settings.airframe.empty()) said.airframe = programs::chosen_airframe(options.settings.airframe);
  return said;
}

void print_json(const programs::ToldVehicle& vehicle, const logs::ImportedDataset& dataset, const std::string& out) {
  const nlohmann::json all = {{"format", 1},
                              {"duration_s", vehicle.found.duration_s},
                              {"blocks", vehicle.found.blocks},
                              {"flights", dataset.flights.size()},
                              {"lag_removed_s", dataset.lag_removed_s},
                              {"numbers", programs::numbers_json(vehicle.numbers)},
                              {"assumed", vehicle.assumed},
                              {"warnings", dataset.warnings},
                              {"airframe", out.empty() ? nlohmann::json() : nlohmann::json(out)}};
  std::printf("%s\n", all.dump(2).c_str());
}

void print_table(const programs::ToldVehicle& vehicle, const logs::ImportedDataset& dataset) {
  for (const std::string& taken : dataset.taken) programs::print_message(taken);
  if (!dataset.curve.told.empty()) programs::print_message(dataset.curve.told);
  for (const std::string& warning : programs::collapsed(dataset.warnings, "--json prints all")) {
    programs::print_message("warning: " + warning);
  }
  programs::print_entry("flights", programs::in_words("%zu, %.1f s, in %zu blocks", dataset.flights.size(),
                                                      vehicle.found.duration_s, vehicle.found.blocks));
  std::printf("%-38s %10s  %-22s %-8s %s\n", "number", "value", "95 % interval", "unit", "excitation");
  for (const programs::IdentifiedNumber& number : vehicle.numbers) {
    std::printf("%-38s %10.4g  %-22s %-8s %s\n", number.words.c_str(), number.estimate.value,
                programs::interval_text(number.estimate).c_str(), number.unit.c_str(),
                programs::excitation_words(number));
  }
  for (const programs::IdentifiedNumber& number : vehicle.numbers) {
    if (programs::is_told(number)) continue;
    programs::print_line("not determined: " + number.words + " (" + number.moved + "); fly: " + number.flight);
  }
  std::printf("flights show ratios only (thrust/mass, torque/inertia); not from the flights:\n");
  for (const std::string& one : vehicle.assumed) programs::print_line(one, 2);
}

int run(const IdentifyOptions& options) {
  programs::FileRoles roles;
  for (const std::string& flight : options.flights) roles.reads("FLIGHTS", flight);
  const std::string &airframe = options.settings.airframe, &mapping = options.settings.mapping;
  if (programs::is_airframe_file(airframe)) roles.reads("--airframe", airframe);
  if (programs::is_airframe_file(mapping)) roles.reads("--mapping", mapping);  // a .toml too
  roles.writes("--out", options.out);
  if (!options.out.empty() && !programs::is_airframe_file(options.out)) {
    throw std::invalid_argument("--out " + options.out + ": a name that ends in .toml was expected");
  }
  logs::ImportedDataset dataset = read(options);
  if (options.said.thrust_curve) dataset.curve.told.clear();
  const programs::ToldVehicle vehicle =
      programs::told_vehicle(dataset, said_by(options), !mapping.empty() || !dataset.taken.empty());
  if (!vehicle.airframe) {
    if (!options.json) programs::print_verdict(programs::vehicle_verdict(vehicle, options.out));
    programs::complain("identify", vehicle.why_not);
    return programs::exit_failed;
  }
  if (!options.out.empty()) {
    pinnquad::AtomicFile file(options.out);
    file.stream() << programs::vehicle_toml(vehicle, options.name);
    file.commit();
  }
  if (options.json) {
    print_json(vehicle, dataset, options.out);
  } else {
    programs::print_verdict(programs::vehicle_verdict(vehicle, options.out));
    print_table(vehicle, dataset);
    if (!options.out.empty()) programs::print_entry("wrote", options.out);
  }
  return 0;
}

}  // namespace

namespace programs {

Command identify_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand("identify",
                                          "Estimates the vehicle that flew: thrust, control effectiveness, drag and "
                                          "lag with intervals; writes an airframe file");
  const auto options = std::make_shared<IdentifyOptions>();
  add_sources(*line, options->flights, options->settings.mapping);
  add_number(*line, "--rate", options->settings.rate_hz, 10.0, 2000.0, "rows per second of logs (default: see import)")
      ->default_str("");
  add_time_range(*line, options->settings);
  line->add_option("--airframe", options->settings.airframe,
                   "gives mass, arms, motor order and propeller; else 1 kg, 0.2 m, PX4's order: a file, or one of: " +
                       airframe_names())
      ->type_name("NAME|FILE.toml");
  add_number(*line, "--mass", options->said.mass_kg, 1e-3, 1e3, "mass, kg: flights cannot determine it")
      ->default_str("");
  add_number(*line, "--arm", options->said.arm_m, 1e-3, 1e2,
             "distance of each rotor from the centre along x and y, m: flights cannot determine it")
      ->default_str("");
  const auto take_curve = [options](const std::string& text) {
    double curve = 0;
    options->said.fit_thrust_curve = text == "fit";
    if (options->said.fit_thrust_curve) return;
    if (!parse_decimal(text, 0.0, 1.0, curve)) {
      throw CLI::ValidationError("--thrust-curve", "expected fit, or a number from 0 to 1, found '" + text + "'");
    }
    options->said.thrust_curve = curve;
  };
  line->add_option_function<std::string>("--thrust-curve", take_curve,
                                         "from thrust proportional to the command, 0, to its square, 1; fit finds it "
                                         "(default: that of the airframe; of logs without one as import finds it)")
      ->type_name("0..1|fit");
  add_path(*line, "--out", options->out, "FILE.toml", "the airframe file to write");
  line->add_option("--name", options->name, "name in the airframe file")->capture_default_str();
  line->add_flag("--json", options->json, "the numbers as JSON, and nothing else, on stdout");
  line->footer(
      "Examples:\n"
      "  pinnquad identify logs --mass 1.2 --arm 0.18 --out vehicle.toml\n"
      "  pinnquad identify my_logs --airframe mine.toml --json\n"
      "  pinnquad identify d1.csv\n"
      "Exit codes: 0; 1 the flights do not tell thrust, roll or pitch, or the commands turn the vehicle the other "
      "way;\n"
      "2 bad input or a file that can't be read or written; 130 interrupted. Then nothing was written.");
  return {line, [options] {
            const bool are_logs =
                !options->settings.mapping.empty() ||
                (!options->flights.empty() && logs::kind_of_source(options->flights.front()) == logs::SourceKind::logs);
            if (options->settings.rate_hz && !are_logs) {
              throw std::invalid_argument("--rate goes with logs: other rows have their own");
            }
            require_time_range(options->settings, are_logs);
            return run(*options);
          }};
}

}  // namespace programs
