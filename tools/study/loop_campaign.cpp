// SPDX-License-Identifier: MIT
#include "study/loop_campaign.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "loop/loop_flights.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "study/loop_controllers.hpp"

namespace study {

namespace {

using namespace pinnquad;
using namespace programs;

constexpr int other = 1000;  ///< seeds of the search

/// Flies the controllers of a campaign.
class Loop {
 public:
  explicit Loop(const LoopCampaign& plan) : plan_(plan), loop_(plan.setting) {}

  AnyTrajectory trajectory(const std::string& name, std::uint64_t seed) const { return loop_.trajectory(name, seed); }

  nlohmann::json fly(const LoopFlight& flight, const LoopGains& gains) const {
    const PolicyMaker make = [this](const std::string& name, const LoopKnowledge& known, const LoopGains& factors) {
      return studied_policy(name, known, plan_.wrench, factors);
    };
    return loop_.fly(flight, gains, make, controller_of(flight.controller).feeds_back);
  }

  /// The gains of least error, geometric mean, on trajectories and seeds of its own: a search that changes one gain at
  /// a time, by a step that shrinks.
  nlohmann::json tune(const StudiedController& controller) const {
    const auto error_of = [&](const LoopGains& gains) {
      double sum = 0;
      int count = 0;
      for (const char* condition : {"calm", "wind_8", "payload", "weak_rotor"}) {
        for (const char* trajectory : {"yaw_eight", "random"}) {
          stop_if_interrupted();
          const LoopFlight flight{controller.name, condition, trajectory, "search", other + count};
          const nlohmann::json row = fly(flight, gains);
          const double rmse_cm =
              row["crashed"].get<bool>() ? 100 * ControlledLoop::lost_m : row["rmse_cm"].get<double>();
          sum += std::log(std::max(rmse_cm, 1e-3));
          ++count;
        }
      }
      return std::exp(sum / count);
    };
    LoopGains best;
    double least = error_of(best), step = 1.6;
    const double at_first = least;
    int evaluations = 1;
    const int free = controller.learns ? 3 : 2;
    bool improved = false;
    for (int turn = 0; evaluations < plan_.budget; ++turn) {
      const int gain = turn / 2 % free;
      LoopGains tried = best;
      double& changed = gain == 0 ? tried.outer : (gain == 1 ? tried.inner : tried.learning);
      changed = std::clamp(turn % 2 == 0 ? changed * step : changed / step, 0.1, 10.0);
      const double error = error_of(tried);
      ++evaluations;
      if (error < least) {
        best = tried;
        least = error;
        improved = true;
      }
      if (turn % (2 * free) != 2 * free - 1) continue;
      if (!improved) step = std::sqrt(step);
      improved = false;
    }
    return {{"tuned", controller.name},  {"outer", best.outer},        {"inner", best.inner},
            {"learning", best.learning}, {"evaluations", evaluations}, {"equal_rmse_cm", at_first},
            {"tuned_rmse_cm", least}};
  }

 private:
  const LoopCampaign& plan_;
  ControlledLoop loop_;
};

nlohmann::json studied_plan(const LoopCampaign& plan) {
  nlohmann::json studied = plan_of(plan.setting, plan.airframe_name);
  studied["vehicle"] = campaign_vehicles[plan.setting.harder ? 1 : 0];
  studied["budget"] = plan.budget;
  if (plan.wrench != nullptr) studied["wrench"] = hexadecimal(plan.wrench->contents_hash());
  return studied;
}

std::vector<LoopFlight> cells_of(const LoopCampaign& plan) {
  std::vector<LoopFlight> cells;
  for (const std::string& gains : plan.gains) {
    for (const std::string& condition : plan.conditions) {
      for (const std::string& trajectory : plan.trajectories) {
        for (const std::string& controller : plan.controllers) {
          for (int seed = 1; seed <= plan.seeds; ++seed)
            cells.push_back({controller, condition, trajectory, gains, seed});
        }
      }
    }
  }
  return cells;
}

}  // namespace

nlohmann::json run_campaign(const LoopCampaign& plan) {
  const Loop loop(plan);
  for (const std::string& name : plan.trajectories) static_cast<void>(loop.trajectory(name, 1));
  nlohmann::json result = studied_plan(plan);
  LoopJournal journal(plan.out, result);
  const auto& tuned = journal.tuned();

  std::vector<const StudiedController*> to_tune;
  if (std::find(plan.gains.begin(), plan.gains.end(), "tuned") != plan.gains.end()) {
    for (const StudiedController& each : studied_controllers()) {
      const bool asked =
          std::find(plan.controllers.begin(), plan.controllers.end(), each.name) != plan.controllers.end();
      if (asked && tuned.count(each.name) == 0) to_tune.push_back(&each);
    }
  }
  std::atomic<std::size_t> finished{0};
  run_parallel(
      "gains of " + std::to_string(to_tune.size()) + " controllers", to_tune.size(), plan.threads,
      [&] { return static_cast<double>(finished.load()) / static_cast<double>(to_tune.size()); },
      [&](std::size_t i) {
        journal.add(loop.tune(*to_tune[i]));
        ++finished;
      });
  stop_if_interrupted();

  std::vector<nlohmann::json> rows = rows_of(cells_of(plan), &journal, plan.threads, [&](const LoopFlight& flight) {
    LoopGains gains;
    if (flight.gains == "tuned") {
      const nlohmann::json& found = tuned.at(flight.controller);
      gains = {found["outer"], found["inner"], found["learning"]};
    }
    return loop.fly(flight, gains);
  });

  result["seeds"] = plan.seeds;
  result["tuning"] = nlohmann::json::array();
  for (const std::string& controller : plan.controllers) {
    if (tuned.count(controller) != 0) result["tuning"].push_back(tuned.at(controller));
  }
  result["rows"] = nlohmann::json::array();
  result["series"] = nlohmann::json::array();
  for (nlohmann::json& row : rows) {
    if (row.contains("series")) {
      nlohmann::json series = row["series"];
      for (const char* key : {"controller", "condition", "gains"}) series[key] = row[key];
      result["series"].push_back(series);
      row.erase("series");
    }
    result["rows"].push_back(row);
  }
  const auto describe = [&result](const char* key, const auto& all, const std::vector<std::string>& names) {
    result[key] = nlohmann::json::array();
    for (const auto& each : all) {
      if (std::find(names.begin(), names.end(), each.name) == names.end()) continue;
      result[key].push_back({{"name", each.name}, {"summary", each.summary}});
    }
  };
  describe("controllers", studied_controllers(), plan.controllers);
  describe("conditions", loop_conditions, plan.conditions);
  AtomicFile json(plan.out + "/loop.json");
  json.stream() << result.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  json.commit();
  return result;
}

}  // namespace study
