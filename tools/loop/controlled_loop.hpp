// SPDX-License-Identifier: MIT
// A controller flown on a trajectory under a condition. Outer loop, limits, what it sees and when, conditions and
// trajectories are the same for every controller.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "flight/loop_trajectories.hpp"
#include "flight/model_range.hpp"
#include "loop/conditions.hpp"
#include "loop/controllers.hpp"

namespace programs {

/// A model, the airframe that it flies, and for how long.
struct LoopSetting {
  const pinnquad::BlockModel& model;
  std::vector<double> columns;                 ///< of the model, in their order
  pinnquad::Airframe<double> airframe{};       ///< that the controllers are told
  std::optional<pinnquad::Battery> battery{};  ///< of the vehicle; its voltage is all that a model knows of it
  /// The vehicle has the effects of simulation/harder_quadrotor.hpp, of which the controllers know the drag alone.
  bool harder = false;
  LoopSensors sensors{};
  double duration_s = 40;
  std::string waypoints{};  ///< a file of them, flown to its end: another trajectory by its name
};

struct LoopFlight {
  std::string controller, condition, trajectory, gains;
  int seed = 1;
};

/// A controller by its name (loop_policy()).
using PolicyMaker = std::function<AnyPolicy(const std::string&, const LoopKnowledge&, const LoopGains&)>;

class ControlledLoop {
 public:
  static constexpr double settled_s = 10;  ///< figures are of what comes after
  static constexpr double lost_m = 10;     ///< so far off, a vehicle is lost

  /// Throws std::invalid_argument, one line, of an airframe or an envelope that holds no flight; InputError of a file.
  explicit ControlledLoop(const LoopSetting& setting);

  /// By name. Throws std::invalid_argument where the envelope holds none.
  AnyTrajectory trajectory(const std::string& name, std::uint64_t seed) const;
  /// With the duration of its waypoints.
  const LoopSetting& setting() const noexcept { return setting_; }

  /// A row of figures; with the error over time where the condition changes at half time, of the first seed.
  /// `feeds_back`: the controller does so itself, and the outer loop adds nothing.
  nlohmann::json fly(const LoopFlight& flight, const LoopGains& gains, const PolicyMaker& make,
                     bool feeds_back = false) const;

 private:
  LoopSetting setting_;
  pinnquad::SwitchedQuadrotor told_;
  pinnquad::SwitchedEffects flown_;  ///< but for the wind
  ModelRange range_;
  std::map<std::string, std::optional<AnyTrajectory>> at_once_;  ///< that are the same for every seed
};

/// A line for each controller and condition whose bias stood at its bound: what it lacks there stays as an error.
std::vector<std::string> bias_warnings(const nlohmann::json& rows);

}  // namespace programs
