// SPDX-License-Identifier: MIT
#include "study/loop_controllers.hpp"

#include <cstddef>
#include <stdexcept>
#include <utility>

#include "loop/policy_parts.hpp"
#include "study/known_drag.hpp"
#include "study/l1_adaptive.hpp"
#include "study/mppi.hpp"
#include "study/wind_filter.hpp"
#include "study/wrench_block.hpp"

namespace study {

namespace {

using namespace pinnquad;
using namespace programs;

/// MPPI as a policy: it looks along the trajectory in place of the motion wanted. It is told the airframe and the drag,
/// and takes the rotors for those that its last commands have settled.
class MppiPolicy {
  using Planner = Mppi<Quadrotor<float, StandardAtmosphere, QuadraticDrag>>;

 public:
  MppiPolicy(const Airframe<double>& airframe, const Site<double>& site, AnyTrajectory path, double speed_m_s,
             const LoopGains& gains)
      : planner_(pinnquad::airframe_in<float>(airframe),
                 {static_cast<float>(site.elevation_m), static_cast<float>(site.ground_z_m),
                  static_cast<float>(site.gravity_m_s2)},
                 settings(gains, speed_m_s)),
        path_(std::move(path)) {}

  Status operator()(const State<double>& state, const Accelerations<double>&, std::uint64_t time_us,
                    Commands<double>& commands) noexcept {
    VehicleState<float> vehicle;
    vehicle.body.position_m = state.position_m.cast<float>();
    vehicle.body.velocity_m_s = state.velocity_m_s.cast<float>();
    const Quaternion<double>& q = state.attitude;
    vehicle.body.attitude = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                             static_cast<float>(q.z)};
    vehicle.body.body_rates_rad_s = state.body_rates_rad_s.cast<float>();
    vehicle.rotors = last_;
    vehicle.time_s = 1e-6 * static_cast<double>(time_us);
    const Status status = planner_(
        vehicle, [this](double time_s) noexcept { return point(time_s); }, last_);
    if (status != Status::ok) return status;
    for (std::size_t i = 0; i < last_.size(); ++i) commands[i] = static_cast<double>(last_[i]);
    return status;
  }

 private:
  static MppiSettings settings(const LoopGains& gains, double speed_m_s) {
    MppiSettings result;
    constexpr double speed_per_distance_1_s = 1.5;  // 8 m/s at 6 m by these plans, and a margin
    result.most_off_m = static_cast<float>(speed_m_s / speed_per_distance_1_s);
    result.position_cost_1_m2 *= static_cast<float>(gains.outer);
    result.velocity_cost_s2_m2 *= static_cast<float>(gains.outer);
    result.rate_gain_1_s *= static_cast<float>(gains.inner);
    result.yaw_rate_gain_1_s *= static_cast<float>(gains.inner);
    return result;
  }
  TrajectoryPoint<float> point(double time_s) const noexcept {
    const TrajectoryPoint<double> p = path_.sample(time_s);
    TrajectoryPoint<float> result;
    result.position_m = p.position_m.cast<float>();
    result.velocity_m_s = p.velocity_m_s.cast<float>();
    result.acceleration_m_s2 = p.acceleration_m_s2.cast<float>();
    result.jerk_m_s3 = p.jerk_m_s3.cast<float>();
    result.snap_m_s4 = p.snap_m_s4.cast<float>();
    result.yaw_rad = static_cast<float>(p.yaw_rad);
    result.yaw_rate_rad_s = static_cast<float>(p.yaw_rate_rad_s);
    result.yaw_acceleration_rad_s2 = static_cast<float>(p.yaw_acceleration_rad_s2);
    return result;
  }

  Planner planner_;
  AnyTrajectory path_;
  Commands<float> last_{0.5f, 0.5f, 0.5f, 0.5f};
};

}  // namespace

const std::vector<StudiedController>& studied_controllers() {
  static const std::vector<StudiedController> all = [] {
    std::vector<StudiedController> result;
    for (const LoopController& each : loop_controllers) result.push_back({each});
    result.insert(result.end(), research_controllers.begin(), research_controllers.end());
    return result;
  }();
  return all;
}

const StudiedController& controller_of(const std::string& name) {
  for (const StudiedController& each : studied_controllers()) {
    if (each.name == name) return each;
  }
  throw std::out_of_range(name);
}

AnyPolicy studied_policy(const std::string& name, const LoopKnowledge& known, const BlockModel* wrench,
                         const LoopGains& gains) {
  const PolicyParts parts(known, gains);
  const auto leaning = [&](const auto& inverse) {
    return KnownDrag<std::decay_t<decltype(inverse)>, SwitchedQuadrotor>(inverse, known.vehicle);
  };
  if (name == "geometric") return AnyPolicy(leaning(parts.formula));
  if (name == "observer") return AnyPolicy(parts.incremental(parts.slower, leaning(parts.formula)));
  const Airframe<double>& airframe = known.vehicle.airframe();
  const Site<double> site = known.vehicle.site();
  if (name == "mppi") return AnyPolicy(MppiPolicy(airframe, site, *known.path, known.speed_m_s, gains));
  if (name == "l1") {
    L1Settings<double> l1;
    l1.force_cutoff_rad_s *= gains.learning;
    l1.torque_cutoff_rad_s *= gains.learning;
    const auto inverse = leaning(parts.formula);
    return AnyPolicy(L1Adaptive<double, std::decay_t<decltype(inverse)>, SwitchedQuadrotor>(inverse, known.vehicle, l1,
                                                                                            known.delay_s));
  }

  const double rotor_scale = known.vehicle.rotor_scale(known.vehicle.surroundings({}, 0));
  const auto with_wrench = [&](const auto& residual) {
    return WrenchInverse<double, std::decay_t<decltype(residual)>>(airframe, residual, rotor_scale, site.gravity_m_s2);
  };
  const auto full = [&](const auto& residual) {
    WindFilterSettings<double> walks;
    for (double* walk : {&walks.wind_walk_m_s, &walks.thrust_walk, &walks.force_walk_m_s2}) *walk *= gains.learning;
    const FlownMotion<double> often(10'000, parts.lag_s, known.delay_s);
    const WindInverse<double, std::decay_t<decltype(residual)>> wind(with_wrench(residual), walks, often);
    return AnyPolicy(parts.incremental(parts.at_once, wind));
  };
  if (name == "full_nominal") return full(NominalWrench<SwitchedQuadrotor>(known.vehicle));
  if (name == "full_bias") return full(NominalWrench<SwitchedQuadrotor>(parts.body));
  if (wrench != nullptr) {
    const BlockWrench learnt = wrench_of(*wrench);
    if (name == "wrench") return AnyPolicy(with_wrench(learnt));
    if (name == "wrench_indi") return AnyPolicy(parts.incremental(parts.at_once, with_wrench(learnt)));
    if (name == "full") return full(learnt);
  }
  if (name == "structured_drag") return AnyPolicy(leaning(parts.of_model(parts.falls_back())));
  if (name == "structured_observer") {
    return AnyPolicy(parts.incremental(parts.slower, leaning(parts.of_model(TrainingGuard{})), leaning(parts.formula)));
  }
  return loop_policy(name, known, gains);
}

}  // namespace study
