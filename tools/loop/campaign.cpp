// SPDX-License-Identifier: MIT
#include "loop/campaign.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <stdexcept>
#include <system_error>

#include "command_line/folder_lock.hpp"
#include "command_line/folders.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "flight/block_loop.hpp"
#include "flight/loop_figures.hpp"
#include "flight/loop_trajectories.hpp"
#include "loop/controllers.hpp"
#include "loop/loop_page.hpp"
#include "loop/world.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace programs {

namespace {

using namespace pinnquad;

constexpr double settled_s = 10;  ///< figures are of what comes after
constexpr double lost_m = 10;     ///< so far off, a vehicle is lost
constexpr int other = 1000;       ///< seeds of the search

/// A flight of the table.
struct Cell {
  std::string controller, condition, trajectory, gains;
  int seed = 0;

  std::string key() const {
    return controller + ' ' + condition + ' ' + trajectory + ' ' + gains + ' ' + std::to_string(seed);
  }
};

/// Position errors over one flight.
struct Errors {
  std::vector<double> squares;  ///< of each control tick
  double period_s = 0;
  bool low = false;  ///< came to the ground

  double rmse_m(double from_s, double to_s) const {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = at(from_s); i < std::min(at(to_s), squares.size()); ++i, ++count) sum += squares[i];
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
  }
  double worst_m(double from_s) const {
    double most = 0;
    for (std::size_t i = at(from_s); i < squares.size(); ++i) most = std::max(most, squares[i]);
    return std::sqrt(most);
  }
  /// The largest error over a second.
  double worst_second_m(double from_s, double to_s) const {
    double most = 0;
    seconds(from_s, to_s, [&most](std::size_t, double rms_m) { most = std::max(most, rms_m); });
    return most;
  }
  /// Time from `onset_s` until the error over a second is, and stays, within 1.5 times `usual_m`.
  std::optional<double> recovery_s(double onset_s, double usual_m) const {
    const std::size_t onset = at(onset_s);
    std::size_t last = onset;
    seconds(onset_s, static_cast<double>(squares.size()) * period_s, [&](std::size_t end, double rms_m) {
      if (rms_m > 1.5 * usual_m) last = end;
    });
    if (last + 1 >= squares.size()) return {};
    return static_cast<double>(last - onset) * period_s;
  }

 private:
  /// Calls `visit(end, error)` for each second, tick by tick.
  template <class Visit>
  void seconds(double from_s, double to_s, const Visit& visit) const {
    const std::size_t window = at(1), first = at(from_s);
    double sum = 0;
    for (std::size_t i = first; i < std::min(at(to_s), squares.size()); ++i) {
      sum += squares[i];
      if (i >= first + window) sum -= squares[i - window];
      if (i + 1 >= first + window) visit(i, std::sqrt(std::max(0.0, sum) / static_cast<double>(window)));
    }
  }
  std::size_t at(double time_s) const { return static_cast<std::size_t>(std::lround(time_s / period_s)); }
};

const LoopCondition& condition_of(const std::string& name) {
  for (const LoopCondition& each : loop_conditions) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

const LoopController& controller_of(const std::string& name) {
  for (const LoopController& each : loop_controllers) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

/// The vehicle of "harder", of which controllers know nothing.
using HarderInLoop = Quadrotor<double, StandardAtmosphere, BatterySag, QuadraticDrag, RotorDrag, Inflow, BladeFlapping,
                               Wake, RotorGroundEffect<CheesemanBennett>, GroundContact>;

/// Airframe, trajectories and worlds of one campaign; near the ground or far from it.
class Loop {
 public:
  explicit Loop(const LoopCampaign& plan)
      : plan_(plan),
        told_(flight_vehicle<AgileFlight>(plan.airframe, ground_effect_of(plan))),
        flown_(plan.vehicle == "harder" ? switched_effects<HarderInLoop>() : switched_effects<AgileFlight::Vehicle>()),
        range_(range_of(plan.model)) {
    if (plan.vehicle != "harder") set_ground_effect(flown_, ground_effect_of(plan));
    const double ground_z_m = told_.site().ground_z_m;
    const auto eight = eight_for(plan.airframe, ground_z_m, range_);
    at_once_["eight"] = any(eight);
    at_once_["yaw_eight"] = any(std::optional(with_yaw(*eight)));
    if (std::find(plan.trajectories.begin(), plan.trajectories.end(), "circle") != plan.trajectories.end()) {
      at_once_["circle"] = any(circle_for(plan.airframe, ground_z_m, range_));
    }
    at_once_["step"] = {[start = eight->center_m](double time_s) {
      TrajectoryPoint<double> point;
      point.position_m = start;
      if (time_s > 0) point.position_m[0] += 50;
      return point;
    }};
    Status status = told_.status();
    HoverTrim<double> trim;
    if (status == Status::ok) status = hover_trim(told_, eight->center_m, trim);
    if (status != Status::ok) {
      throw std::invalid_argument(std::string("this airframe can't be flown here: ") + to_string(status));
    }
  }

  AnyTrajectory trajectory(const std::string& name, std::uint64_t seed) const {
    if (name == "random") return any(random_path_for(plan_.airframe, told_.site().ground_z_m, range_, seed));
    return at_once_.at(name);
  }

  /// A row of the table; with the error over time where the condition changes at half time, of the first seed.
  nlohmann::json fly(const Cell& cell, const LoopGains& gains) const {
    const auto seed = static_cast<std::uint64_t>(cell.seed);
    const AnyTrajectory path = trajectory(cell.trajectory, seed);
    const LoopCondition& condition = condition_of(cell.condition);
    TrackingPlan<double> how;
    how.duration_s = plan_.duration_s;
    const double half_s = 0.5 * how.duration_s;
    const double period_s = how.physics_step_s * how.steps_per_control;
    const Site<double> site = told_.site();
    LoopWorld world(plan_.airframe, flown_, site, condition, plan_.sensors, period_s, half_s, seed);
    const FlightGains<double> feedback = flight_gains(gains);
    FlightLimits<double> limits = flight_limits(plan_.airframe, told_.rotor_scale(told_.surroundings({}, 0)), feedback);
    limits.max_horizontal_speed_m_s = 12;
    limits.max_climb_m_s = 5;
    limits.max_descent_m_s = 3;
    auto bias = plan_.model.with([](const auto& model) { return bias_settings<double>(model.records()); });
    bias.across_time_constant_s = 0.1;  // the delay is told
    bias.most_across_m_s2 = 6;
    const double speed_m_s =
        std::min({limits.max_horizontal_speed_m_s, range_.speed_m_s(0).value_or(limits.max_horizontal_speed_m_s),
                  range_.speed_m_s(1).value_or(limits.max_horizontal_speed_m_s)});
    const LoopKnowledge known{plan_.model,           plan_.columns, told_, bias,
                              plan_.sensors.delay_s, plan_.wrench,  &path, speed_m_s};
    const AnyPolicy policy = loop_policy(cell.controller, known, gains);
    Errors errors;
    errors.period_s = period_s;
    errors.squares.reserve(static_cast<std::size_t>(how.duration_s / period_s) + 1);
    double effort = 0, at_bound = 0;
    Commands<double> before{};
    const auto observer = [&](double, const TrajectoryPoint<double>& point, const VehicleState<double>& vehicle,
                              const Commands<double>& commands) noexcept {
      errors.squares.push_back((point.position_m - vehicle.body.position_m).squaredNorm());
      at_bound += policy.at_bound() ? 1 : 0;
      errors.low = errors.low || vehicle.body.position_m[2] >= site.ground_z_m;
      for (std::size_t i = 0; i < commands.size(); ++i) {
        if (errors.squares.size() > 1) effort += std::abs(commands[i] - before[i]);
      }
      before = commands;
    };
    const bool alone = controller_of(cell.controller).feeds_back;
    const FlightController<double> outer(alone ? FlightGains<double>{0, 0, 0, 0, 0, 0} : feedback, limits);
    const TrackingResult<double> flown = track(told_, world, path, outer, policy, how, observer);
    const double onset_s = condition.at_half ? half_s : 0;
    const double usual_m =
        condition.at_half ? errors.worst_second_m(settled_s, half_s) : errors.worst_second_m(half_s, how.duration_s);
    const bool crashed = flown.status != Status::ok || errors.low || !(errors.worst_m(settled_s) < lost_m);
    const double ticks = static_cast<double>(std::max<std::size_t>(1, errors.squares.size()));
    nlohmann::json row = {{"controller", cell.controller},
                          {"condition", cell.condition},
                          {"trajectory", cell.trajectory},
                          {"gains", cell.gains},
                          {"seed", cell.seed},
                          {"rmse_cm", 100 * errors.rmse_m(settled_s, how.duration_s)},
                          {"worst_cm", 100 * errors.worst_m(settled_s)},
                          {"recovery_s", nullptr},
                          {"crashed", crashed},
                          {"saturated_share", flown.saturated_share},
                          {"effort_1_s", effort / (ticks * period_s)},
                          {"step_ns", 1e9 * policy.busy_s() / ticks},
                          {"bias_at_bound_share", at_bound / ticks},
                          {"answered_share", nullptr}};
    const auto recovered = errors.recovery_s(onset_s, usual_m);
    if (recovered && !crashed) row["recovery_s"] = *recovered;
    if (flown.fallback.asked > 0) row["answered_share"] = answered_share(flown.fallback);
    if (condition.at_half && cell.seed == 1 && cell.trajectory == "eight") {
      row["series"] = {{"period_s", 25 * period_s}, {"error_cm", nlohmann::json::array()}};
      for (std::size_t i = 0; i < errors.squares.size(); i += 25) {
        row["series"]["error_cm"].push_back(std::round(1e4 * std::sqrt(errors.squares[i])) / 100);
      }
    }
    return row;
  }

  /// The gains of least error, geometric mean, on trajectories and seeds of its own: a search that changes one gain at
  /// a time, by a step that shrinks.
  nlohmann::json tune(const LoopController& controller) const {
    const auto error_of = [&](const LoopGains& gains) {
      double sum = 0;
      int count = 0;
      for (const char* condition : {"calm", "wind_8", "payload", "weak_rotor"}) {
        for (const char* trajectory : {"yaw_eight", "random"}) {
          stop_if_interrupted();
          const Cell cell{controller.name, condition, trajectory, "search", other + count};
          const nlohmann::json row = fly(cell, gains);
          const double rmse_cm = row["crashed"].get<bool>() ? 100 * lost_m : row["rmse_cm"].get<double>();
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
  template <class Held>
  static AnyTrajectory any(const std::optional<Held>& held) {
    if (!held) throw std::invalid_argument("the model's envelope holds no trajectory of this kind, however slow");
    return {[path = *held](double time_s) { return path.sample(time_s); }};
  }
  static GroundEffectModel ground_effect_of(const LoopCampaign& plan) {
    return plan.model.features().asks_for_altitude() ? GroundEffectModel::conyers : GroundEffectModel::none;
  }

  const LoopCampaign& plan_;
  SwitchedQuadrotor told_;
  SwitchedEffects flown_;  ///< but for the wind
  ModelRange range_;
  std::map<std::string, AnyTrajectory> at_once_;  ///< that are the same for every seed
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

  std::map<std::string, nlohmann::json> rows;   ///< by Cell::key()
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
      rows[Cell{value["controller"], value["condition"], value["trajectory"], value["gains"], value["seed"]}.key()] =
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
  const LoopSensors& sensors = plan.sensors;
  nlohmann::json said = {{"format", 1},
                         {"model", plan.model.path()},
                         {"contents", hexadecimal(plan.model.contents_hash())},
                         {"airframe", plan.airframe_name},
                         {"vehicle", plan.vehicle},
                         {"mass_kg", plan.airframe.mass_kg},
                         {"columns", plan.columns},
                         {"seeds", plan.seeds},
                         {"budget", plan.budget},
                         {"duration_s", plan.duration_s},
                         {"noise",
                          {{"position_m", sensors.position_m},
                           {"velocity_m_s", sensors.velocity_m_s},
                           {"attitude_rad", sensors.attitude_rad},
                           {"body_rates_rad_s", sensors.body_rates_rad_s}}},
                         {"delay_s", sensors.delay_s}};
  if (plan.wrench != nullptr) said["wrench"] = hexadecimal(plan.wrench->contents_hash());
  return said;
}

std::vector<Cell> cells_of(const LoopCampaign& plan) {
  std::vector<Cell> cells;
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

  std::vector<const LoopController*> to_tune;
  if (std::find(plan.gains.begin(), plan.gains.end(), "tuned") != plan.gains.end()) {
    for (const LoopController& each : loop_controllers) {
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

  std::vector<Cell> missing;
  const std::vector<Cell> cells = cells_of(plan);
  for (const Cell& cell : cells) {
    if (rows.count(cell.key()) == 0) missing.push_back(cell);
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
  for (const Cell& cell : cells) {
    nlohmann::json& row = rows.at(cell.key());
    if (row.contains("series")) {
      nlohmann::json series = row["series"];
      for (const char* key : {"controller", "condition", "gains"}) series[key] = row[key];
      result["series"].push_back(series);
      row.erase("series");
    }
    result["rows"].push_back(row);
  }
  result["summary"] = loop_summary(result["rows"]);
  AtomicFile json(plan.out + "/loop.json"), page(plan.out + "/loop.html");
  json.stream() << result.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  page.stream() << loop_page(result);
  json.commit();
  page.commit();
  return result;
}

}  // namespace programs
