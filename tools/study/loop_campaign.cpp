// SPDX-License-Identifier: MIT
#include "study/loop_campaign.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <system_error>

#include "command_line/folder_lock.hpp"
#include "command_line/folders.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "study/loop_controllers.hpp"

namespace study {

namespace {

using namespace pinnquad;
using namespace programs;

constexpr int other = 1000;  ///< seeds of the search

/// Tells a flight from the others of a campaign.
std::string key_of(const LoopFlight& flight) {
  return flight.controller + ' ' + flight.condition + ' ' + flight.trajectory + ' ' + flight.gains + ' ' +
         std::to_string(flight.seed);
}

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

/// One JSON value a line: the plan, then what is done. A last line that was not written whole is dropped.
class Journal {
 public:
  Journal(const std::string& path, const nlohmann::json& plan) : path_(path) {
    const std::uintmax_t kept = read(plan);
    std::error_code error;
    if (kept > 0) std::filesystem::resize_file(path, kept, error);
    if (error) throw OutputError(path, error.message());
    out_.open(path, kept > 0 ? std::ios::app : std::ios::trunc);
    if (kept == 0) write(plan);
    check();
  }

  std::map<std::string, nlohmann::json> rows;   ///< by key_of()
  std::map<std::string, nlohmann::json> tuned;  ///< by controller

  void add(const nlohmann::json& value) {
    const std::lock_guard<std::mutex> lock(mutex_);
    file(value);
    write(value);
    check();
  }

 private:
  /// Length of the lines that are whole, of the same plan; 0: none.
  std::uintmax_t read(const nlohmann::json& plan) {
    std::ifstream in(path_);
    std::string line;
    std::uintmax_t length = 0;
    while (std::getline(in, line) && !in.eof()) {
      const nlohmann::json value = nlohmann::json::parse(line, nullptr, false);
      if (value.is_discarded() || (length == 0 && value != plan)) break;
      if (length > 0) file(value);
      length += line.size() + 1;
    }
    return length;
  }
  void file(const nlohmann::json& value) {
    if (value.contains("tuned")) {
      tuned[value["tuned"]] = value;
    } else {
      rows[key_of({value["controller"], value["condition"], value["trajectory"], value["gains"], value["seed"]})] =
          value;
    }
  }
  void write(const nlohmann::json& value) { out_ << value.dump() << '\n' << std::flush; }
  void check() const {
    if (!out_) throw OutputError(path_, "the disk does not take it");
  }

  std::string path_;
  std::ofstream out_;
  std::mutex mutex_;
};

nlohmann::json plan_of(const LoopCampaign& plan) {
  const LoopSetting& setting = plan.setting;
  const LoopSensors& sensors = setting.sensors;
  nlohmann::json said = {{"format", 1},
                         {"model", setting.model.path()},
                         {"contents", hexadecimal(setting.model.contents_hash())},
                         {"airframe", plan.airframe_name},
                         {"vehicle", campaign_vehicles[setting.harder ? 1 : 0]},
                         {"mass_kg", setting.airframe.mass_kg},
                         {"columns", setting.columns},
                         {"seeds", plan.seeds},
                         {"budget", plan.budget},
                         {"duration_s", setting.duration_s},
                         {"noise",
                          {{"position_m", sensors.position_m},
                           {"velocity_m_s", sensors.velocity_m_s},
                           {"attitude_rad", sensors.attitude_rad},
                           {"body_rates_rad_s", sensors.body_rates_rad_s}}},
                         {"delay_s", sensors.delay_s}};
  if (setting.battery) {
    const Battery& battery = *setting.battery;
    said["battery"] = {battery.cells, battery.capacity_Ah, battery.start_charge};
  }
  if (plan.wrench != nullptr) said["wrench"] = hexadecimal(plan.wrench->contents_hash());
  return said;
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
  make_folders(plan.out);
  const FolderLock lock(plan.out);
  const nlohmann::json said = plan_of(plan);
  Journal journal(plan.out + "/loop.journal", said);
  std::map<std::string, nlohmann::json>&rows = journal.rows, &tuned = journal.tuned;

  std::vector<const StudiedController*> to_tune;
  if (std::find(plan.gains.begin(), plan.gains.end(), "tuned") != plan.gains.end()) {
    for (const StudiedController& each : studied_controllers()) {
      const bool asked =
          std::find(plan.controllers.begin(), plan.controllers.end(), each.name) != plan.controllers.end();
      if (asked && tuned.count(each.name) == 0) to_tune.push_back(&each);
    }
  }
  std::atomic<std::size_t> finished{0};
  const auto share_of = [&finished](std::size_t all) {
    return [&finished, all] { return static_cast<double>(finished.load()) / static_cast<double>(all); };
  };
  run_parallel("gains of " + std::to_string(to_tune.size()) + " controllers", to_tune.size(), plan.threads,
               share_of(to_tune.size()), [&](std::size_t i) {
                 journal.add(loop.tune(*to_tune[i]));
                 ++finished;
               });
  stop_if_interrupted();

  std::vector<LoopFlight> missing;
  const std::vector<LoopFlight> cells = cells_of(plan);
  for (const LoopFlight& cell : cells) {
    if (rows.count(key_of(cell)) == 0) missing.push_back(cell);
  }
  finished = 0;
  run_parallel(std::to_string(missing.size()) + " flights", missing.size(), plan.threads, share_of(missing.size()),
               [&](std::size_t i) {
                 stop_if_interrupted();
                 LoopGains gains;
                 if (missing[i].gains == "tuned") {
                   const nlohmann::json& found = tuned.at(missing[i].controller);
                   gains = {found["outer"], found["inner"], found["learning"]};
                 }
                 journal.add(loop.fly(missing[i], gains));
                 ++finished;
               });
  stop_if_interrupted();

  nlohmann::json result = said;
  result["tuning"] = nlohmann::json::array();
  for (const std::string& controller : plan.controllers) {
    if (tuned.count(controller) != 0) result["tuning"].push_back(tuned.at(controller));
  }
  result["rows"] = nlohmann::json::array();
  result["series"] = nlohmann::json::array();
  for (const LoopFlight& cell : cells) {
    nlohmann::json& row = rows.at(key_of(cell));
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
