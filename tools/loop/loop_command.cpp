// SPDX-License-Identifier: MIT
// Flies a model from its block, as feed-forward in a closed loop: no compiler is asked. Or controllers that are
// compared under conditions.
//   pinnquad loop my_model/model.block --trajectory circle --column battery_voltage=15.2
//   pinnquad loop my_model/model.block --controllers adaptive,indi --conditions calm,payload --out compared
#include "loop/loop_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "airframe/choice.hpp"
#include "command_line/console.hpp"
#include "command_line/held_columns.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "flight/block_loop.hpp"
#include "flight/loop_figures.hpp"
#include "loop/campaign.hpp"
#include "loop/controllers.hpp"
#include "loop/summary.hpp"
#include "loop/wrench_block.hpp"
#include "model/given_model.hpp"
#include "pinnquad/exported/model.hpp"

namespace {

using namespace pinnquad;

struct LoopOptions {
  std::string model;
  std::string airframe;
  std::string trajectory = programs::loop_trajectories.front();
  std::string guard = "envelope";
  std::vector<std::string> columns;
  bool json = false;
  // of a comparison
  std::vector<std::string> controllers, conditions, trajectories = {"eight", "circle", "random"},
                                                    gains = {"equal", "tuned"};
  int seeds = 5, budget = 40;
  double duration_s = 40, noise = 1, delay_ms = 0;
  unsigned threads = 0;
  std::string vehicle = "nominal", wrench, out;

  bool compares() const { return !(controllers.empty() && conditions.empty() && out.empty()); }
};

template <class Named>
std::vector<std::string> names_of(const Named& all) {
  std::vector<std::string> names;
  for (const auto& each : all) names.emplace_back(each.name);
  return names;
}

/// The airframe that flies. Throws std::invalid_argument for one whose motors are not those of the model.
programs::NamedAirframe chosen_airframe(const LoopOptions& options, const BlockModel& model) {
  if (options.airframe.empty()) return {model.airframe_name(), model.airframe()};
  programs::NamedAirframe chosen = programs::chosen_airframe(options.airframe);
  if (motor_torque_signs(chosen.value) != motor_torque_signs(model.airframe())) {
    throw std::invalid_argument("--airframe: the motors of " + printable(chosen.name) +
                                " stand or turn otherwise than those of " + model.airframe_name() +
                                ", which the model commands");
  }
  return chosen;
}

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
                           {"hover_trim", programs::loop_figures(flights.hover_trim)}};
  for (std::size_t i = 0; i < columns.size(); ++i) report["columns"][model.columns()[i].name] = columns[i];
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
    std::printf("column      %s %g %s\n", printable(column.name).c_str(), columns[i], printable(column.unit).c_str());
  }
  std::printf("trajectory  %s, period %.1f s, %.2f to %.2f m above the ground%s, flown by %s for %.0f s\n",
              options.trajectory.c_str(), flights.period_s, flights.lowest_m, flights.highest_m,
              flights.near_ground ? ", in ground effect" : "", printable(airframe).c_str(),
              TrackingPlan<double>{}.duration_s);
  std::printf("  %-20s %8s %8s %9s   %s\n", "feed-forward", "RMSE cm", "max cm", "speed m/s", "answered by the model");
  print_flight("model", flights.model);
  print_flight("analytic inverse", flights.analytic_inverse);
  print_flight("none (hover trim)", flights.hover_trim);
  const nlohmann::json by_status = declined(flights.model.fallback);
  std::string reasons;
  for (const auto& [status, ticks] : by_status.items()) {
    programs::add_to_list(reasons, std::to_string(ticks.get<unsigned>()) + " " + status);
  }
  if (!reasons.empty()) std::printf("  the analytic inverse stood in for the model: %s\n", reasons.c_str());
}

/// The residual wrench that is given. Throws InputError for another block, std::invalid_argument for a controller that
/// flies one where none is given.
std::optional<BlockModel> wrench_for(const LoopOptions& options, const programs::LoopCampaign& plan) {
  if (!options.wrench.empty()) {
    std::optional<BlockModel> block(programs::read_model(options.wrench));
    programs::require_wrench(*block, plan.airframe, plan.airframe_name);
    return block;
  }
  for (const programs::LoopController& each : programs::loop_controllers) {
    const auto& asked = plan.controllers;
    if (!each.asks_wrench || std::find(asked.begin(), asked.end(), each.name) == asked.end()) continue;
    throw std::invalid_argument(std::string("--controllers ") + each.name +
                                " flies a residual wrench: --wrench FILE, which train --recipe wrench writes");
  }
  return {};
}

/// Controllers side by side.
int compare(const LoopOptions& options, const BlockModel& model, const std::vector<double>& columns,
            const programs::NamedAirframe& airframe) {
  if (options.out.empty()) throw std::invalid_argument("--out: the folder of the comparison is missing");
  const auto or_usual = [](const std::vector<std::string>& named, std::vector<std::string> usual) {
    std::vector<std::string> once;
    for (const std::string& name : named.empty() ? usual : named) {
      if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
    }
    return once;
  };
  programs::LoopCampaign plan{model, columns, airframe.value, airframe.name};
  plan.controllers = or_usual(options.controllers, {"pid", "formula", "indi", "structured", "adaptive"});
  plan.conditions = or_usual(options.conditions, {"calm", "wind_8", "gusts", "payload", "weak_rotor", "battery"});
  plan.trajectories = or_usual(options.trajectories, {});
  plan.gains = or_usual(options.gains, {});
  plan.vehicle = options.vehicle;
  const std::optional<BlockModel> wrench = wrench_for(options, plan);
  if (wrench) plan.wrench = &*wrench;
  plan.seeds = options.seeds;
  plan.budget = options.budget;
  plan.duration_s = options.duration_s;
  for (double* noise : {&plan.sensors.position_m, &plan.sensors.velocity_m_s, &plan.sensors.attitude_rad,
                        &plan.sensors.body_rates_rad_s}) {
    *noise *= options.noise;
  }
  plan.sensors.delay_s = 1e-3 * options.delay_ms;
  plan.threads = options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  plan.out = options.out;
  const nlohmann::json result = programs::run_campaign(plan);
  if (options.json) {
    std::printf("%s\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    programs::print_loop_tables(result);
    std::printf("%zu flights, in %s/loop.json; to look at: %s/loop.html\n", result["rows"].size(),
                printable(options.out).c_str(), printable(options.out).c_str());
  }
  return 0;
}

int loop(const LoopOptions& options) {
  const BlockModel model = programs::read_model(options.model);
  if (programs::is_wrench(model)) {
    throw InputError(model.path(), 0, 0, "an inverse-dynamics model", "a residual wrench, which --wrench takes");
  }
  if (model.features().window().latest_s > 0) {
    throw std::invalid_argument(model.path() + ": its window looks ahead of the present, which no loop can");
  }
  const std::vector<double> columns = programs::held_columns(programs::range_of(model).columns(), options.columns);
  const programs::NamedAirframe airframe = chosen_airframe(options, model);
  if (options.compares()) return compare(options, model, columns, airframe);
  const programs::LoopFlights flights =
      programs::fly_loop(model, {options.trajectory, airframe.value, options.guard == "envelope", columns});
  programs::stop_if_interrupted();
  const nlohmann::json report = report_of(options, model, airframe.name, columns, flights);
  if (options.json) {
    std::printf("%s\n", report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    print_table(options, model, airframe.name, columns, flights);
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

programs::Command programs::loop_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "loop", "Flies a model in a closed loop in the simulator, from its block, without compiling");
  const auto options = std::make_shared<LoopOptions>();
  add_model(*line, options->model);
  line->add_option("--trajectory", options->trajectory,
                   "eight: a figure-eight that the airframe can fly and the model's envelope holds; yaw_eight: a "
                   "quicker one whose nose swings; circle: a level one")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(loop_trajectories.begin(), loop_trajectories.end())));
  line->add_option("--column", options->columns,
                   "the value at which a column that the model asks for is held, in place of the middle of its "
                   "training envelope: --column battery_voltage=15.2")
      ->type_name("NAME=VALUE");
  line->add_option(
      "--airframe", options->airframe,
      "what flies in place of the model's own airframe, its motors as there: a file, or one of: " + airframe_names());
  line->add_option("--guard", options->guard,
                   "envelope: outside of its training envelope the analytic inverse flies in place of the model; none: "
                   "the model flies there too")
      ->capture_default_str()
      ->check(CLI::IsMember({"envelope", "none"}));
  line->add_flag("--json", options->json, "the figures as JSON");
  const auto one_of = [](const std::vector<std::string>& names) {
    CLI::IsMember known(names);
    known.description("");  // the names are below
    return known;
  };
  const auto list = [&](const char* name, std::vector<std::string>& value, const std::vector<std::string>& names,
                        const std::string& text) {
    line->add_option(name, value, text)
        ->delimiter(',')
        ->type_name("NAME,...")
        ->check(one_of(names))
        ->group("Comparison");
  };
  const auto described = [](const char* title, const auto& all) {
    std::string result = title;
    for (const auto& each : all) {
      char name[32];
      std::snprintf(name, sizeof name, "\n  %-18s", each.name);
      result += name + std::string(each.summary);
    }
    return result + "\n";
  };
  list("--controllers", options->controllers, names_of(loop_controllers),
       "compare these controllers, of those below (default: pid,formula,indi,structured,adaptive)");
  list("--conditions", options->conditions, names_of(loop_conditions),
       "under these conditions, of those below (default: calm,wind_8,gusts,payload,weak_rotor,battery)");
  list("--trajectories", options->trajectories, {campaign_trajectories.begin(), campaign_trajectories.end()},
       "on these trajectories (default: eight,circle,random); step: a place 50 m away");
  list("--gains", options->gains, {campaign_gains.begin(), campaign_gains.end()},
       "equal: moderate gains, the same for all; tuned: those that a search finds for each, on other trajectories and "
       "seeds (default: both)");
  const auto number = [&](const char* name, auto& value, auto least, auto most, const char* text) {
    add_number(*line, name, value, least, most, text)->group("Comparison");
  };
  line->add_option(
          "--vehicle", options->vehicle,
          "nominal: as the controllers know it; harder: with rotor drag, inflow, flapping, wake, a battery that "
          "sags and legs, of which they know nothing")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(campaign_vehicles.begin(), campaign_vehicles.end())))
      ->group("Comparison");
  line->add_option("--wrench", options->wrench,
                   "residual wrench of the vehicle, which train --recipe wrench writes: for the controllers wrench, "
                   "wrench_indi, full")
      ->type_name("FILE")
      ->group("Comparison");
  number("--seeds", options->seeds, 1, 1000, "seeds of noise, wind, gusts, random paths, the weak rotor");
  number("--budget", options->budget, 1, 100000, "evaluations of the search, the same for each controller");
  number("--duration", options->duration_s, 15.0, 3600.0, "of a flight, s; errors are of what comes after 10 s");
  number("--noise", options->noise, 0.0, 100.0,
         "of what controllers see, times 5 mm, 0.02 m/s, 0.002 rad, 0.02 rad/s for each sample at 500 Hz");
  number("--delay", options->delay_ms, 0.0, 200.0, "of what controllers see, ms");
  number("--threads", options->threads, 1u, 1024u, "flights at once (default: all cores)");
  line->get_option("--threads")->default_str("");
  line->add_option("--out", options->out,
                   "folder of the comparison: loop.json, loop.html; the same command goes on in it")
      ->type_name("FOLDER")
      ->group("Comparison");
  line->footer(
      described("Controllers:", loop_controllers) + described("Conditions:", loop_conditions) +
      "Examples:\n"
      "  pinnquad loop my_model/model.hpp\n"
      "  pinnquad loop my_model/model.block --trajectory circle --guard none --json\n"
      "  pinnquad loop trained.block --column battery_voltage=15.2\n"
      "  pinnquad loop trained.block --controllers structured,adaptive,indi --conditions calm,payload --out compared\n"
      "The feedback is the same for all that fly. A model that is shown the altitude flies near the ground.\n"
      "Exit codes: 0; 1 the model loses the vehicle, or answers nothing; 2 bad input or a file that can't be read; "
      "130\n"
      "interrupted.");
  return {line, [options] { return loop(*options); }};
}
