// SPDX-License-Identifier: MIT
// Flies a model from its block, as feed-forward in a closed loop: no compiler is asked. Or the controllers that one
// ships, under conditions that they do not know of.
//   pinnquad loop my_model/model.block --trajectory circle --column battery_voltage=15.2
//   pinnquad loop my_model/model.block --controllers adaptive,indi --conditions calm,payload
// Or vehicles that nobody knows, by what is guessed or learnt of them.
//   pinnquad loop --vehicles 20 --controllers start,true_inverse --out flown
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "flight/block_loop.hpp"
#include "flight/loop_figures.hpp"
#include "flight/waypoints.hpp"
#include "loop/controlled_loop.hpp"
#include "loop/loop_flights.hpp"
#include "loop/loop_model.hpp"
#include "loop/loop_spread.hpp"
#include "loop/vehicles.hpp"
#include "model/model_evidence.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_table.hpp"

namespace {

using namespace pinnquad;

struct LoopOptions : programs::LoopModelOptions {
  std::string trajectory = programs::loop_trajectories.front();
  std::string guard = "envelope";
  std::vector<std::string> controllers, conditions;
  programs::VehiclesOptions unknown;
  std::optional<int> seeds;
  std::optional<double> duration_s;
  bool json = false;
};

void print_flight(const char* name, const TrackingResult<double>& flown) {
  std::printf("  %-20s %8.2f %8.2f %9.2f", name, 100 * flown.rmse_m, 100 * flown.max_error_m, flown.max_speed_m_s);
  if (flown.fallback.asked > 0) {
    std::printf("   %.2f %% of %u", 100 * programs::answered_share(flown.fallback), flown.fallback.asked);
  }
  const Status ended = flown.status != Status::ok ? flown.status : flown.declined;
  if (ended != Status::ok) std::printf("   %s after %.1f s", to_string(ended), flown.flown_s);
  std::printf("\n");
}

void print_table(const LoopOptions& options, const programs::LoopModel& given, const programs::ModelFlight& flown) {
  const BlockModel& model = given.model;
  const std::vector<double>& columns = given.columns;
  const programs::LoopFlights& flights = flown.flights;
  programs::print_entry("model", printable(model.path()) + ", for " + model.airframe_name());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnName column = model.columns()[i];
    if (flights.last_voltage_V > 0 && column.name == BatteryVoltage::name) continue;
    programs::print_entry("column",
                          printable(column.name) + programs::in_words(" %g ", columns[i]) + printable(column.unit));
  }
  if (!options.battery.pack.empty()) {
    programs::print_entry(
        "battery",
        options.battery.pack + programs::in_words(", %g %% at the start", options.battery.charge_percent) +
            (flights.last_voltage_V > 0 ? programs::in_words(", %.2f V at the end", flights.last_voltage_V) : ""));
  }
  programs::print_entry(
      "trajectory", programs::in_words("%s, period %.1f s, %.2f to %.2f m above the ground%s, flown by %s for %.0f s",
                                       printable(options.trajectory).c_str(), flights.period_s, flights.lowest_m,
                                       flights.highest_m, flights.near_ground ? ", in ground effect" : "",
                                       printable(given.airframe.name).c_str(), flights.duration_s));
  std::printf("  %-20s %8s %8s %9s   %s\n", "feed-forward", "RMSE cm", "max cm", "speed m/s", "answered by the model");
  print_flight("model", flights.model);
  print_flight("analytic inverse", flights.analytic_inverse);
  print_flight("the same, no jerk", flights.without_jerk);
  std::string reasons;
  for (const auto& [status, ticks] : flown.report["model"]["declined"].items()) {
    programs::add_to_list(reasons, std::to_string(ticks.get<unsigned>()) + " " + status);
  }
  if (!reasons.empty()) programs::print_line("the analytic inverse flew in place of the model: " + reasons, 2);
}

void print_json(const nlohmann::json& value) {
  std::printf("%s\n", value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

/// The verdict on the model with its columns and battery, worse where a controller that flies it loses the vehicle.
programs::FlightVerdict controllers_verdict(const programs::LoopModel& given,
                                            const std::vector<programs::LoopSpread>& spreads) {
  programs::ModelEvidence evidence = programs::evidence_of(given.model, false);
  evidence.flown = programs::eight_of(given.model, given.columns, given.battery);
  programs::FlightVerdict verdict = programs::model_verdict(evidence);
  for (const programs::LoopSpread& each : spreads) {
    const bool by_model = each.controller.find("structured") == 0 || each.controller == "adaptive";
    if (!by_model || each.lost == 0) continue;
    const std::string times =
        each.flights() == 1 ? "" : programs::in_words(" in %zu of %zu flights", each.lost, each.flights());
    verdict.refuse(each.controller + " loses the vehicle under " + each.condition + times, programs::livelier_flight);
  }
  return verdict;
}

/// Controllers down, conditions across: of one seed.
void print_errors(const std::vector<programs::LoopSpread>& spreads, std::size_t conditions) {
  constexpr std::size_t beside = 5;  // conditions in one table: no line is too wide
  for (std::size_t first = 0; first < conditions; first += beside) {
    const std::size_t last = std::min(conditions, first + beside);
    std::printf("  %-18s", "");
    for (std::size_t c = first; c < last; ++c) std::printf(" %15s", spreads[c].condition.c_str());
    std::printf("\n");
    for (const std::size_t begin : programs::best_first(spreads, conditions)) {
      std::printf("  %-18s", spreads[begin].controller.c_str());
      for (std::size_t c = first; c < last; ++c) {
        const programs::LoopSpread& each = spreads[begin + c];
        std::printf(" %15s", each.lost > 0 ? "lost" : programs::in_words("%.2f", each.rmse_cm.front()).c_str());
      }
      std::printf("\n");
    }
  }
}

/// The figures of a spread: name, and share of the flights with less error.
constexpr std::array<std::pair<const char*, double>, 4> spread_figures = {
    {{"5 %", 0.05}, {"median", 0.5}, {"95 %", 0.95}, {"worst", 1}}};

/// How the errors of many seeds are spread.
void print_spreads(const std::vector<programs::LoopSpread>& spreads, std::size_t conditions) {
  std::printf("  %-18s %-16s", "", "");
  for (const auto& [name, share] : spread_figures) std::printf(" %8s", name);
  std::printf(" %12s\n", "lost");
  for (const std::size_t begin : programs::best_first(spreads, conditions)) {
    for (std::size_t c = 0; c < conditions; ++c) {
      const programs::LoopSpread& each = spreads[begin + c];
      std::printf("  %-18s %-16s", each.controller.c_str(), each.condition.c_str());
      for (const auto& [name, share] : spread_figures) std::printf(" %8.2f", programs::quantile(each.rmse_cm, share));
      std::printf(" %5zu of %zu\n", each.lost, each.flights());
    }
  }
}

nlohmann::json spread_json(const programs::LoopSpread& spread) {
  nlohmann::json rmse_cm;  // NaN, where all are lost, is written as null
  for (const auto& [name, share] : spread_figures) rmse_cm[name] = programs::quantile(spread.rmse_cm, share);
  return {{"controller", spread.controller},
          {"condition", spread.condition},
          {"flights", spread.flights()},
          {"lost", spread.lost},
          {"rmse_cm", rmse_cm}};
}

/// A line for each flight, in their order; the same bits whatever the machine, so that two folders can be compared.
void write_rows(const std::string& path, const std::vector<nlohmann::json>& rows) {
  constexpr std::array<const char*, 18> columns = {
      "controller",     "condition",     "trajectory",      "seed",           "rmse_cm",       "worst_cm",
      "recovery_s",     "crashed",       "saturated_share", "answered_share", "effort_1_s",    "bias_at_bound_share",
      "wind_north_m_s", "wind_east_m_s", "mass_factor",     "inertia_factor", "thrust_factor", "rotor_factor"};
  AtomicFile file(path);
  for (const char* name : columns) file.stream() << (name == columns.front() ? "" : ",") << name;
  for (const nlohmann::json& row : rows) {
    for (const char* name : columns) {
      const nlohmann::json& value = row[name];
      file.stream() << (name == columns.front() ? '\n' : ',');
      if (value.is_string()) file.stream() << pinnquad::detail::csv_cell(value.get<std::string>());
      if (!value.is_string() && !value.is_null()) file.stream() << value;
    }
  }
  file.stream() << '\n';
  file.commit();
}

/// True where it flies controllers; else the model as feed-forward.
bool compares_controllers(const LoopOptions& options) {
  return !options.controllers.empty() || !options.conditions.empty() || options.seeds || options.duration_s ||
         !options.unknown.out.empty();
}

/// With a line where the model must not fly.
int exit_code(const BlockModel& model, const programs::FlightVerdict& verdict) {
  if (verdict.may_fly() != programs::MayFly::no) return 0;
  programs::complain("loop", model.path() + ": " + verdict.why());
  return programs::exit_failed;
}

/// Controllers side by side, each under each condition, of each seed.
int fly_controllers(const LoopOptions& options, const programs::LoopModel& given) {
  programs::LoopSetting setting{given.model, given.columns, given.airframe.value, given.battery};
  setting.duration_s = options.duration_s.value_or(setting.duration_s);
  if (programs::is_waypoint_file(options.trajectory)) setting.waypoints = options.trajectory;
  const programs::ControlledLoop loop(setting);
  const auto conditions = programs::names_or(options.conditions, {"calm"});
  std::vector<programs::LoopFlight> flights;
  for (const std::string& controller :
       programs::names_or(options.controllers, {"pid", "formula", "indi", "structured", "adaptive"})) {
    for (const std::string& condition : conditions) {
      for (int seed = 1; seed <= options.seeds.value_or(1); ++seed) {
        flights.push_back({controller, condition, options.trajectory, "equal", seed});
      }
    }
  }
  static_cast<void>(loop.trajectory(options.trajectory, 1));  // refused before there is a folder
  const std::string& out = options.unknown.out;
  std::optional<programs::LoopJournal> journal;
  if (!out.empty()) journal.emplace(out, programs::plan_of(loop.setting(), given.airframe.name));
  const std::vector<nlohmann::json> rows =
      programs::rows_of(flights, journal ? &*journal : nullptr, std::max(1U, std::thread::hardware_concurrency()),
                        [&](const programs::LoopFlight& flight) {
                          nlohmann::json row = loop.fly(flight, {}, programs::loop_policy);
                          row.erase("series");
                          return row;
                        });
  const std::vector<programs::LoopSpread> spreads = programs::loop_spreads(rows);
  const programs::FlightVerdict verdict = controllers_verdict(given, spreads);
  nlohmann::json report = {{"path", given.model.path()},
                           {"verdict", programs::verdict_json(verdict)},
                           {"airframe", given.airframe.name},
                           {"trajectory", options.trajectory},
                           {"duration_s", loop.setting().duration_s},
                           {"summary", nlohmann::json::array()},
                           {"rows", rows}};
  for (const programs::LoopSpread& each : spreads) report["summary"].push_back(spread_json(each));
  if (!out.empty()) {
    write_rows(out + "/rows.csv", rows);
    AtomicFile file(out + "/loop.json");
    file.stream() << report.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    file.commit();
  }
  if (options.json) {
    print_json(report);
    return exit_code(given.model, verdict);
  }
  programs::print_verdict(verdict);
  programs::print_entry(
      "trajectory", programs::in_words("%s, flown by %s for %.0f s, with noise in what controllers see",
                                       printable(options.trajectory).c_str(), printable(given.airframe.name).c_str(),
                                       loop.setting().duration_s));
  programs::print_line(programs::in_words("RMSE of the position in cm, of what comes after %.0f s",
                                          programs::ControlledLoop::settled_s));
  if (options.seeds.value_or(1) == 1) {
    print_errors(spreads, conditions.size());
  } else {
    print_spreads(spreads, conditions.size());
  }
  for (const std::string& line : programs::bias_warnings(rows)) programs::print_message("warning: " + line);
  if (!out.empty()) programs::print_line("each flight: " + printable(out) + "/rows.csv");
  return exit_code(given.model, verdict);
}

/// Throws std::invalid_argument, one line, for a name that `mode` does not fly.
void require_names(const std::string& option, const std::vector<std::string>& names,
                   const std::vector<std::string>& known, const std::string& mode) {
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw std::invalid_argument(option + ": " + name + " is none of those that " + mode +
                                " flies: " + programs::listed(known));
  }
}

/// Vehicles that nobody knows.
int fly_unknown(const LoopOptions& options) {
  programs::VehiclesOptions unknown = options.unknown;
  if (!options.model.empty()) {
    throw std::invalid_argument("--vehicles: a model was given, which these flights don't fly");
  }
  if (unknown.out.empty())
    throw std::invalid_argument(
        "--out is required with --vehicles, the folder of loop.json: pinnquad loop --vehicles 20 --out flown");
  require_names("--controllers", options.controllers, programs::vehicle_controllers(), "--vehicles");
  require_names("--conditions", options.conditions, programs::vehicle_conditions(), "--vehicles");
  unknown.controllers = programs::names_or(options.controllers, programs::vehicle_controllers());
  unknown.conditions = programs::names_or(options.conditions, {"calm"});
  unknown.json = options.json;
  if (unknown.drawn >= unknown.vehicles) {
    throw std::invalid_argument("--draw: expected a vehicle from 0 to " + std::to_string(unknown.vehicles - 1) +
                                ", found " + std::to_string(unknown.drawn));
  }
  return programs::fly_vehicles(unknown);
}

int loop(const LoopOptions& options) {
  if (options.unknown.vehicles > 0) return fly_unknown(options);
  if (options.model.empty())
    throw std::invalid_argument(
        "a model is required: pinnquad loop my_model/model.block, or pinnquad loop --vehicles 20 --out flown");
  require_names("--controllers", options.controllers, programs::names_of(programs::loop_controllers), "a model");
  require_names("--conditions", options.conditions, programs::names_of(programs::loop_conditions), "a model");
  const programs::LoopModel given = programs::read_loop_model(options);
  const BlockModel& model = given.model;
  if (compares_controllers(options)) return fly_controllers(options, given);
  const programs::ModelFlight flown = programs::fly_model(model, given, options.trajectory, options.guard);
  if (options.json) {
    print_json(flown.report);
  } else {
    programs::print_verdict(flown.verdict);
    print_table(options, given, flown);
  }
  return exit_code(model, flown.verdict);
}

}  // namespace

namespace programs {

Command loop_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "loop", "Flies a model in the simulator beside other controllers, or random vehicles learnt in flight");
  const auto options = std::make_shared<LoopOptions>();
  add_loop_model(*line, *options);
  line->get_option("model")->required(false);  // of vehicles that nobody knows there is none
  const std::vector<std::string> ready(loop_trajectories.begin(), loop_trajectories.end());
  const auto refused = [ready](const std::string& text) {
    const bool known = is_waypoint_file(text) || std::find(ready.begin(), ready.end(), text) != ready.end();
    return known ? "" : "expected " + listed(ready) + " or a .csv file, found '" + text + "'";
  };
  line->add_option("--trajectory", options->trajectory,
                   "as large and fast as airframe and training range allow; or waypoints: t,x,y,z[,yaw], s, m NED, rad")
      ->type_name("eight|yaw_eight|circle|FILE.csv")
      ->capture_default_str()
      ->check(CLI::Validator(refused, ""));
  CLI::Option* guard =
      line->add_option("--guard", options->guard, "envelope: beyond it the analytic inverse flies; none: the model")
          ->capture_default_str()
          ->check(CLI::IsMember({"envelope", "none"}));
  const std::vector<std::string> of_model = names_of(loop_controllers), under = names_of(loop_conditions);
  const auto with = [](std::vector<std::string> names, const std::vector<std::string>& more) {
    for (const std::string& name : more) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
  };
  add_names(*line, "--controllers", options->controllers, with(of_model, vehicle_controllers()),
            "fly these (default: pid,formula,indi,structured,adaptive): " + listed(of_model))
      ->excludes(guard);
  add_names(*line, "--conditions", options->conditions, with(under, vehicle_conditions()),
            "fly controllers under these (default: calm): " + listed(under))
      ->excludes(guard);
  CLI::Option* seeds = add_number(*line, "--seeds", options->seeds, 1, 1'000'000,
                                  "flights of each controller, each with its own noise, wind, vehicle");
  CLI::Option* duration = add_number(*line, "--duration", options->duration_s, 15.0, 3600.0,
                                     "of their flights (default: 40), s; errors are of what comes after 10 s");
  seeds->excludes(guard);
  duration->excludes(guard);
  VehiclesOptions& unknown = options->unknown;
  CLI::Option* vehicles = add_number(*line, "--vehicles", unknown.vehicles, std::size_t{1}, std::size_t{10'000},
                                     "fly so many unknown vehicles by " + listed(vehicle_controllers()) + "; under " +
                                         listed(vehicle_conditions()))
                              ->default_str("");
  for (const char* other : {"--column", "--airframe", "--battery", "--battery-charge", "--trajectory", "--guard",
                            "--seeds", "--duration"}) {
    vehicles->excludes(line->get_option(other));
  }
  add_number(*line, "--seed", unknown.seed, std::uint64_t{0}, most_seed, "of these vehicles, their noise and wind")
      ->needs(vehicles);
  line->add_option("--start", unknown.start, "first guess: numbers within 40 %, or by mass and propeller")
      ->capture_default_str()
      ->check(CLI::IsMember({"forty", "laws"}))
      ->needs(vehicles);
  add_number(*line, "--frozen", unknown.frozen_s, 1.0, 3600.0, "learning ends at this time, s")->needs(vehicles);
  add_number(*line, "--draw", unknown.drawn, std::size_t{0}, std::size_t{9'999},
             "vehicle whose learnt slopes are drawn, from 0 on")
      ->needs(vehicles);
  add_path(*line, "--out", unknown.out, "FOLDER",
           "folder of loop.json (of a model rows.csv too); the same command goes on in it")
      ->excludes(guard);
  line->add_flag("--json", options->json, "the figures as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad loop trained.block --battery 3x2200 --battery-charge 40\n"
      "  pinnquad loop trained.block --controllers adaptive --conditions drawn --seeds 1000 --out flown\n"
      "  pinnquad loop --vehicles 20 --out flown\n"
      "Exit codes: 0; 1 do not fly (docs/log_training.md, The verdict); 2 bad input or a file that can't be read; 130\n"
      "interrupted.");
  return {line, [options] { return loop(*options); }};
}

}  // namespace programs
