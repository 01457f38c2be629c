// SPDX-License-Identifier: MIT
// Controllers compared in the loop, with equal gains and with those that a search finds.
//   pinnquad-study loop my_model/model.block --controllers adaptive,indi --conditions calm,payload --out compared
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "command_line/command.hpp"
#include "command_line/options.hpp"
#include "loop/loop_model.hpp"
#include "study/loop_campaign.hpp"
#include "study/loop_controllers.hpp"
#include "study/wrench_block.hpp"

namespace study {

namespace {

using namespace pinnquad;

struct LoopOptions : programs::LoopModelOptions {
  std::vector<std::string> controllers, conditions, trajectories = {"eight", "circle", "random"},
                                                    gains = {"equal", "tuned"};
  int seeds = 5, budget = 40;
  double duration_s = 40, noise = 1, delay_ms = 0;
  unsigned threads = 0;
  std::string vehicle = "nominal", wrench, out;
  bool json = false;
};

/// The residual wrench that is given. Throws InputError for another block, std::invalid_argument for a controller that
/// flies one where none is given.
std::optional<BlockModel> wrench_for(const LoopOptions& options, const LoopCampaign& plan) {
  if (!options.wrench.empty()) {
    std::optional<BlockModel> block(programs::read_model(options.wrench));
    require_wrench(*block, plan.setting.airframe, plan.airframe_name);
    return block;
  }
  for (const std::string& name : plan.controllers) {
    if (!controller_of(name).asks_wrench) continue;
    throw std::invalid_argument("--controllers " + name +
                                " flies a residual wrench: --wrench FILE, which pinnquad-study wrench writes");
  }
  return {};
}

int loop(const LoopOptions& options) {
  const programs::LoopModel given = programs::read_loop_model(options);
  if (is_wrench(given.model)) {
    throw InputError(given.model.path(), 0, 0, "an inverse-dynamics model", "a residual wrench, which --wrench takes");
  }
  if (options.out.empty()) throw std::invalid_argument("--out: the folder of the comparison is missing");
  using programs::names_or;
  LoopCampaign plan{{given.model, given.columns, given.airframe.value, given.battery}, given.airframe.name};
  plan.controllers = names_or(options.controllers, {"pid", "formula", "indi", "structured", "adaptive"});
  plan.conditions = names_or(options.conditions, {"calm", "wind_8", "gusts", "payload", "weak_rotor", "battery"});
  plan.trajectories = names_or(options.trajectories, {});
  plan.gains = names_or(options.gains, {});
  plan.setting.harder = options.vehicle == "harder";
  const std::optional<BlockModel> wrench = wrench_for(options, plan);
  if (wrench) plan.wrench = &*wrench;
  plan.seeds = options.seeds;
  plan.budget = options.budget;
  plan.setting.duration_s = options.duration_s;
  programs::LoopSensors& sensors = plan.setting.sensors;
  for (double* noise : {&sensors.position_m, &sensors.velocity_m_s, &sensors.attitude_rad, &sensors.body_rates_rad_s}) {
    *noise *= options.noise;
  }
  sensors.delay_s = 1e-3 * options.delay_ms;
  plan.threads = options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  plan.out = options.out;
  const nlohmann::json result = run_campaign(plan);
  if (options.json) {
    std::printf("%s\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    for (const std::string& warning : programs::bias_warnings(result["rows"])) {
      std::printf("warning: %s\n", warning.c_str());
    }
    const std::string out = printable(options.out);
    std::printf("%zu flights, in %s/loop.json\nits report  pinnquad-study-report %s\n", result["rows"].size(),
                out.c_str(), out.c_str());
  }
  return 0;
}

}  // namespace

programs::Command loop_command(CLI::App& program) {
  using programs::add_names, programs::described;
  CLI::App* line = program.add_subcommand(
      "loop", "Controllers compared in the loop, under conditions, with equal and with tuned gains");
  const auto options = std::make_shared<LoopOptions>();
  add_loop_model(*line, *options);
  add_names(*line, "--controllers", options->controllers, programs::names_of(studied_controllers()),
            "compare these controllers, of those below (default: pid,formula,indi,structured,adaptive)");
  add_names(*line, "--conditions", options->conditions, programs::names_of(programs::loop_conditions),
            "under these conditions, of those below (default: calm,wind_8,gusts,payload,weak_rotor,battery)");
  add_names(*line, "--trajectories", options->trajectories,
            {campaign_trajectories.begin(), campaign_trajectories.end()},
            "on these trajectories (default: eight,circle,random); step: a place 50 m away");
  add_names(
      *line, "--gains", options->gains, {campaign_gains.begin(), campaign_gains.end()},
      "equal: moderate gains, the same for all; tuned: those that a search finds for each, on other trajectories and "
      "seeds (default: both)");
  line->add_option(
          "--vehicle", options->vehicle,
          "nominal: as the controllers know it; harder: with rotor drag, inflow, flapping, wake, a battery that "
          "sags and legs, of which they know nothing")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>(campaign_vehicles.begin(), campaign_vehicles.end())));
  line->add_option("--wrench", options->wrench,
                   "residual wrench of the vehicle, which pinnquad-study wrench writes: for the controllers wrench, "
                   "wrench_indi, full")
      ->type_name("FILE");
  const auto number = [&](const char* name, auto& value, auto least, auto most, const char* text) {
    return programs::add_number(*line, name, value, least, most, text);
  };
  number("--seeds", options->seeds, 1, 1000, "seeds of noise, wind, gusts, random paths, the weak rotor");
  number("--budget", options->budget, 1, 100000, "evaluations of the search, the same for each controller");
  number("--duration", options->duration_s, 15.0, 3600.0, "of a flight, s; errors are of what comes after 10 s");
  number("--noise", options->noise, 0.0, 100.0,
         "of what controllers see, times 5 mm, 0.02 m/s, 0.002 rad, 0.02 rad/s for each sample at 500 Hz");
  number("--delay", options->delay_ms, 0.0, 200.0, "of what controllers see, ms");
  number("--threads", options->threads, 1u, 1024u, "flights at once (default: all cores)")->default_str("");
  line->add_flag("--json", options->json, "the figures as JSON");
  line->add_option("--out", options->out, "folder of the comparison: loop.json; the same command goes on in it")
      ->type_name("FOLDER");
  line->footer(described("Controllers:", studied_controllers()) + described("Conditions:", programs::loop_conditions) +
               "Examples:\n"
               "  pinnquad-study loop model.block --controllers pid,adaptive --seeds 2 --out compared\n"
               "  pinnquad-study-report compared     tables with intervals, ratios, pictures\n"
               "Exit codes: 0; 2 bad input or a file that can't be read or written; 130 interrupted: the same command\n"
               "goes on.");
  return {line, [options] { return loop(*options); }};
}

}  // namespace study
