// SPDX-License-Identifier: MIT
// Flies a model from its block, as feed-forward in a closed loop: no compiler is asked. Or the controllers that one
// ships, under conditions that they do not know of.
//   pinnquad loop my_model/model.block --trajectory circle --column battery_voltage=15.2
//   pinnquad loop my_model/model.block --controllers adaptive,indi --conditions calm,payload
// Or vehicles that nobody knows, by what is guessed or learnt of them.
//   pinnquad loop --vehicles 20 --controllers start,true_inverse --out flown
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "command_line/parallel.hpp"
#include "flight/block_loop.hpp"
#include "flight/loop_figures.hpp"
#include "loop/controlled_loop.hpp"
#include "loop/loop_model.hpp"
#include "loop/vehicles.hpp"
#include "pinnquad/exported/model.hpp"

namespace {

using namespace pinnquad;

struct LoopOptions : programs::LoopModelOptions {
  std::string trajectory = programs::loop_trajectories.front();
  std::string guard = "envelope";
  std::vector<std::string> controllers, conditions;
  programs::VehiclesOptions unknown;
  bool json = false;
};

/// Ticks that the model did not answer, by the reason.
nlohmann::json declined(const FallbackCount& count) {
  nlohmann::json by_status = nlohmann::json::object();
  for (int i = 0; i < status_count; ++i) {
    const auto status = static_cast<Status>(i);
    if (count.of(status) == 0 || has_output(status)) continue;
    by_status[to_string(status)] = count.of(status);
  }
  return by_status;
}

nlohmann::json report_of(const LoopOptions& options, const BlockModel& model, const std::string& airframe,
                         const std::vector<double>& columns, const programs::LoopFlights& flights) {
  nlohmann::json report = {{"path", model.path()},
                           {"answer", model.answer()},
                           {"airframe", airframe},
                           {"guard", options.guard},
                           {"columns", nlohmann::json::object()},
                           {"trajectory", options.trajectory},
                           {"half_length_m", flights.half_length_m},
                           {"period_s", flights.period_s},
                           {"altitude_m", {flights.lowest_m, flights.highest_m}},
                           {"model", programs::loop_figures(flights.model)},
                           {"analytic_inverse", programs::loop_figures(flights.analytic_inverse)},
                           {"without_jerk", programs::loop_figures(flights.without_jerk)}};
  for (std::size_t i = 0; i < columns.size(); ++i) report["columns"][model.columns()[i].name] = columns[i];
  if (flights.last_voltage_V > 0) report["columns"][BatteryVoltage::name] = flights.last_voltage_V;
  report["model"]["asked"] = flights.model.fallback.asked;
  report["model"]["answered_share"] = programs::answered_share(flights.model.fallback);
  report["model"]["declined"] = declined(flights.model.fallback);
  return report;
}

void print_flight(const char* name, const TrackingResult<double>& flown) {
  std::printf("  %-20s %8.2f %8.2f %9.2f", name, 100 * flown.rmse_m, 100 * flown.max_error_m, flown.max_speed_m_s);
  if (flown.fallback.asked > 0) {
    std::printf("   %.2f %% of %u", 100 * programs::answered_share(flown.fallback), flown.fallback.asked);
  }
  const Status ended = flown.status != Status::ok ? flown.status : flown.declined;
  if (ended != Status::ok) std::printf("   %s after %.1f s", to_string(ended), flown.flown_s);
  std::printf("\n");
}

void print_table(const LoopOptions& options, const BlockModel& model, const std::string& airframe,
                 const std::vector<double>& columns, const programs::LoopFlights& flights) {
  std::printf("model       %s, for %s\n", printable(model.path()).c_str(), model.airframe_name().c_str());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnName column = model.columns()[i];
    if (flights.last_voltage_V > 0 && column.name == BatteryVoltage::name) continue;
    std::printf("column      %s %g %s\n", printable(column.name).c_str(), columns[i], printable(column.unit).c_str());
  }
  if (!options.battery.pack.empty()) {
    std::printf("battery     %s, %g %% at the start", options.battery.pack.c_str(), options.battery.charge_percent);
    if (flights.last_voltage_V > 0) std::printf(", %.2f V at the end", flights.last_voltage_V);
    std::printf("\n");
  }
  std::printf("trajectory  %s, period %.1f s, %.2f to %.2f m above the ground%s, flown by %s for %.0f s\n",
              options.trajectory.c_str(), flights.period_s, flights.lowest_m, flights.highest_m,
              flights.near_ground ? ", in ground effect" : "", printable(airframe).c_str(),
              TrackingPlan<double>{}.duration_s);
  std::printf("  %-20s %8s %8s %9s   %s\n", "feed-forward", "RMSE cm", "max cm", "speed m/s", "answered by the model");
  print_flight("model", flights.model);
  print_flight("analytic inverse", flights.analytic_inverse);
  print_flight("the same, no jerk", flights.without_jerk);
  const nlohmann::json by_status = declined(flights.model.fallback);
  std::string reasons;
  for (const auto& [status, ticks] : by_status.items()) {
    programs::add_to_list(reasons, std::to_string(ticks.get<unsigned>()) + " " + status);
  }
  if (!reasons.empty()) std::printf("  the analytic inverse stood in for the model: %s\n", reasons.c_str());
}

void print_json(const nlohmann::json& value) {
  std::printf("%s\n", value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void print_errors(const LoopOptions& options, const std::vector<std::string>& conditions,
                  const std::vector<nlohmann::json>& rows, const std::string& airframe, double duration_s) {
  std::printf(
      "trajectory  %s, flown by %s for %.0f s, with noise in what controllers see\n"
      "RMSE of the position in cm, of what comes after %.0f s\n  %-18s",
      options.trajectory.c_str(), printable(airframe).c_str(), duration_s, programs::ControlledLoop::settled_s, "");
  for (const std::string& condition : conditions) std::printf(" %15s", condition.c_str());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const nlohmann::json& row = rows[i];
    if (i % conditions.size() == 0) std::printf("\n  %-18s", row["controller"].get<std::string>().c_str());
    if (row["crashed"].get<bool>()) {
      std::printf(" %15s", "lost");
    } else {
      std::printf(" %15.2f", row["rmse_cm"].get<double>());
    }
  }
  std::printf("\n");
  for (const std::string& line : programs::bias_warnings(rows)) std::printf("warning: %s\n", line.c_str());
}

/// Controllers side by side, each under each condition.
int fly_controllers(const LoopOptions& options, const programs::LoopModel& given) {
  const programs::LoopSetting setting{given.model, given.columns, given.airframe.value, given.battery};
  const programs::ControlledLoop loop(setting);
  const auto conditions = programs::names_or(options.conditions, {"calm"});
  std::vector<programs::LoopFlight> flights;
  for (const std::string& controller :
       programs::names_or(options.controllers, {"pid", "formula", "indi", "structured", "adaptive"})) {
    for (const std::string& condition : conditions) {
      flights.push_back({controller, condition, options.trajectory, "equal"});
    }
  }
  static_cast<void>(loop.trajectory(options.trajectory, 1));
  std::vector<nlohmann::json> rows(flights.size());
  std::atomic<std::size_t> finished{0};
  programs::run_parallel(
      std::to_string(flights.size()) + " flights", flights.size(), std::max(1u, std::thread::hardware_concurrency()),
      [&] { return static_cast<double>(finished.load()) / static_cast<double>(flights.size()); },
      [&](std::size_t i) {
        programs::stop_if_interrupted();
        rows[i] = loop.fly(flights[i], {}, programs::loop_policy);
        rows[i].erase("series");
        ++finished;
      });
  programs::stop_if_interrupted();
  if (options.json) {
    print_json({{"path", given.model.path()},
                {"airframe", given.airframe.name},
                {"trajectory", options.trajectory},
                {"duration_s", setting.duration_s},
                {"rows", rows}});
  } else {
    print_errors(options, conditions, rows, given.airframe.name, setting.duration_s);
  }
  return 0;
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
  if (unknown.out.empty()) throw std::invalid_argument("--out is required with --vehicles: the folder of loop.json");
  require_names("--controllers", options.controllers, programs::vehicle_controllers(), "--vehicles");
  require_names("--conditions", options.conditions, programs::vehicle_conditions(), "--vehicles");
  unknown.controllers = programs::names_or(options.controllers, programs::vehicle_controllers());
  unknown.conditions = programs::names_or(options.conditions, {"calm"});
  unknown.json = options.json;
  return programs::fly_vehicles(unknown);
}

int loop(const LoopOptions& options) {
  if (options.unknown.vehicles > 0) return fly_unknown(options);
  if (options.model.empty()) throw std::invalid_argument("a model is required, or --vehicles");
  require_names("--controllers", options.controllers, programs::names_of(programs::loop_controllers), "a model");
  require_names("--conditions", options.conditions, programs::names_of(programs::loop_conditions), "a model");
  const programs::LoopModel given = programs::read_loop_model(options);
  const BlockModel& model = given.model;
  if (!options.controllers.empty() || !options.conditions.empty()) return fly_controllers(options, given);
  const programs::LoopFlights flights = programs::fly_loop(
      model, {options.trajectory, given.airframe.value, options.guard == "envelope", given.columns, given.battery});
  programs::stop_if_interrupted();
  const nlohmann::json report = report_of(options, model, given.airframe.name, given.columns, flights);
  if (options.json) {
    print_json(report);
  } else {
    print_table(options, model, given.airframe.name, given.columns, flights);
  }
  const auto failed = [&](const char* why) {
    programs::complain("loop", model.path() + ": " + why);
    return programs::exit_failed;
  };
  if (programs::lost_vehicle(report)) return failed("loses the vehicle");
  if (!(programs::answered_share(flights.model.fallback) > 0)) return failed("answers nothing on this trajectory");
  return 0;
}

}  // namespace

namespace programs {

Command loop_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("loop", "Flies a model in a closed loop in the simulator, or vehicles that nobody knows");
  const auto options = std::make_shared<LoopOptions>();
  add_loop_model(*line, *options);
  line->get_option("model")->required(false);  // of vehicles that nobody knows there is none
  line->add_option("--trajectory", options->trajectory, "as large as airframe and envelope hold")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(loop_trajectories.begin(), loop_trajectories.end())));
  CLI::Option* guard =
      line->add_option(
              "--guard", options->guard,
              "what flies outside of the model's training envelope: the analytic inverse, or the model too (none)")
          ->capture_default_str()
          ->check(CLI::IsMember({"envelope", "none"}));
  const std::vector<std::string> of_model = names_of(loop_controllers), under = names_of(loop_conditions);
  const auto with = [](std::vector<std::string> names, const std::vector<std::string>& more) {
    names.insert(names.end(), more.begin(), more.end());
    return names;
  };
  add_names(*line, "--controllers", options->controllers, with(of_model, vehicle_controllers()),
            "fly these (docs/loop.md; default: pid,formula,indi,structured,adaptive): " + listed(of_model))
      ->excludes(guard);
  add_names(*line, "--conditions", options->conditions, with(under, vehicle_conditions()),
            "fly controllers under these (docs/loop.md; default: calm): " + listed(under))
      ->excludes(guard);
  VehiclesOptions& unknown = options->unknown;
  CLI::Option* vehicles = add_number(*line, "--vehicles", unknown.vehicles, std::size_t{1}, std::size_t{10'000},
                                     "fly so many vehicles that nobody knows, no model (docs/onboard.md), by " +
                                         listed(vehicle_controllers()) + "; under " + listed(vehicle_conditions()))
                              ->default_str("");
  for (const char* other : {"--column", "--airframe", "--battery", "--battery-charge", "--trajectory", "--guard"}) {
    vehicles->excludes(line->get_option(other));
  }
  add_number(*line, "--seed", unknown.seed, std::uint64_t{0}, most_seed, "of vehicles, noise and wind")
      ->needs(vehicles);
  line->add_option("--start", unknown.start, "what is guessed: numbers within 40 %, or laws of mass and propeller")
      ->capture_default_str()
      ->check(CLI::IsMember({"forty", "laws"}))
      ->needs(vehicles);
  add_number(*line, "--frozen", unknown.frozen_s, 1.0, 3600.0, "a model learnt on board is frozen then, s")
      ->needs(vehicles);
  add_path(*line, "--out", unknown.out, "FOLDER", "where loop.json of these vehicles goes")->needs(vehicles);
  line->add_flag("--json", options->json, "the figures as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad loop trained.block --battery 3x2200 --battery-charge 40\n"
      "  pinnquad loop trained.block --controllers adaptive,indi --conditions calm,payload\n"
      "  pinnquad loop --vehicles 20 --out flown\n"
      "Exit codes: 0; 1 the model loses the vehicle, or answers nothing; 2 bad input or a file that can't be read; "
      "130\n"
      "interrupted.");
  return {line, [options] { return loop(*options); }};
}

}  // namespace programs
