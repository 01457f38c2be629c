// SPDX-License-Identifier: MIT
// Controllers that are compared: compositions of flight code by name. Outer loop, reference, limits, filters and the
// rotors' lag are the same for all; they differ in what turns a motion into commands, and in what they learn.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "flight/block_feed_forward.hpp"
#include "flight/loop_trajectories.hpp"
#include "loop/any_policy.hpp"
#include "loop/wrench_block.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/filtered_motion.hpp"
#include "pinnquad/control/known_drag.hpp"
#include "pinnquad/control/l1_adaptive.hpp"
#include "pinnquad/control/mppi.hpp"
#include "pinnquad/control/wind_filter.hpp"

namespace programs {

struct LoopController {
  const char* name;
  const char* summary;
  bool asks_model = false;  ///< of the block
  bool learns = false;
  bool asks_wrench = false;  ///< of --wrench
  bool feeds_back = false;   ///< itself: the outer loop adds nothing
};

inline constexpr std::array<LoopController, 18> loop_controllers = {{
    {"pid", "cascaded PID: the rigid body's allocation, integral of the feedback", false, true},
    {"formula", "the analytic inverse with nominal drag"},
    {"geometric", "the same, and the attitude leans against nominal drag"},
    {"formula_adaptive", "the analytic inverse, with a bias learnt in flight", false, true},
    {"indi", "incremental inversion of the rigid body (INDI): rates and force", false, true},
    {"observer", "disturbance observer: geometric, and a low-pass of what it lacks", false, true},
    {"l1", "L1 adaptive: geometric, and the low-pass of a piecewise-constant estimate", false, true},
    {"wrench", "the rigid body with the learnt residual wrench; the attitude leans against it", false, false, true},
    {"wrench_indi", "incremental inversion of that", false, true, true},
    {"full", "the same, and wind, thrust and force by a Kalman filter through the network", false, true, true},
    {"full_nominal", "full, with nominal drag in place of the learnt residual wrench", false, true},
    {"full_bias", "full, without a residual wrench", false, true},
    {"mppi", "model predictive path integral: nominal drag, 512 flights of 0.8 s, fifty times a second", false, false,
     false, true},
    {"structured", "the model of the block", true},
    {"structured_drag", "the same, and the attitude leans against nominal drag", true},
    {"adaptive", "the model, with a bias learnt in flight; beyond its bound formula_adaptive", true, true},
    {"structured_indi", "incremental inversion of the model", true, true},
    {"structured_observer", "disturbance observer on the model, and the attitude leans against nominal drag", true,
     true},
}};

/// Factors of what each controller has by default; 1 each: equal, moderate gains.
struct LoopGains {
  double outer = 1;     ///< of position and velocity gains
  double inner = 1;     ///< of attitude and body rate gains
  double learning = 1;  ///< of the rates at which it learns: integral, bias, cut-off
};

inline pinnquad::FlightGains<double> flight_gains(const LoopGains& factors) {
  pinnquad::FlightGains<double> gains;
  gains.position_1_s *= factors.outer;
  gains.velocity_1_s *= factors.outer;
  for (double* gain : {&gains.tilt_1_s, &gains.yaw_1_s, &gains.roll_pitch_rate_1_s, &gains.yaw_rate_1_s}) {
    *gain *= factors.inner;
  }
  return gains;
}

/// All that the controllers are told.
template <class Vehicle>
struct LoopKnowledge {
  const pinnquad::BlockModel& model;
  const std::vector<double>& columns;  ///< of the model, in their order
  const Vehicle& vehicle;              ///< with its effects
  pinnquad::BiasSettings<double> bias{};
  double delay_s = 0;                            ///< by which states come late
  const pinnquad::BlockModel* wrench = nullptr;  ///< a residual wrench (loop/wrench_block.hpp), where one is given
  const AnyTrajectory* path = nullptr;           ///< for one that plans ahead
  double speed_m_s = 0;                          ///< that the model's envelope holds, level: likewise
};

/// MPPI as a policy: it looks along the trajectory in place of the motion wanted. It is told the airframe and the drag,
/// and takes the rotors for those that its last commands have settled.
class MppiPolicy {
  using State = pinnquad::State<double>;
  using Planner = pinnquad::Mppi<pinnquad::Quadrotor<float, pinnquad::StandardAtmosphere, pinnquad::QuadraticDrag>>;

 public:
  MppiPolicy(const pinnquad::Airframe<double>& airframe, const pinnquad::Site<double>& site, AnyTrajectory path,
             double speed_m_s, const LoopGains& gains)
      : planner_(in_float(airframe),
                 {static_cast<float>(site.elevation_m), static_cast<float>(site.ground_z_m),
                  static_cast<float>(site.gravity_m_s2)},
                 settings(gains, speed_m_s)),
        path_(std::move(path)) {}

  pinnquad::Status operator()(const State& state, const pinnquad::Accelerations<double>&, std::uint64_t time_us,
                              pinnquad::Commands<double>& commands) noexcept {
    pinnquad::VehicleState<float> vehicle;
    vehicle.body.position_m = state.position_m.cast<float>();
    vehicle.body.velocity_m_s = state.velocity_m_s.cast<float>();
    const pinnquad::Quaternion<double>& q = state.attitude;
    vehicle.body.attitude = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                             static_cast<float>(q.z)};
    vehicle.body.body_rates_rad_s = state.body_rates_rad_s.cast<float>();
    vehicle.rotors = last_;
    vehicle.time_s = 1e-6 * static_cast<double>(time_us);
    const pinnquad::Status status = planner_(
        vehicle, [this](double time_s) noexcept { return point(time_s); }, last_);
    if (status != pinnquad::Status::ok) return status;
    for (std::size_t i = 0; i < last_.size(); ++i) commands[i] = static_cast<double>(last_[i]);
    return status;
  }

 private:
  static pinnquad::Airframe<float> in_float(const pinnquad::Airframe<double>& airframe) {
    std::vector<double> numbers;
    pinnquad::Airframe<float> result;
    pinnquad::each_number(airframe, [&](const auto& number) { numbers.push_back(static_cast<double>(number)); });
    std::size_t k = 0;
    pinnquad::each_number(result, [&](auto& number) {
      using Number = std::decay_t<decltype(number)>;
      if constexpr (std::is_enum_v<Number>) {
        number = static_cast<Number>(static_cast<int>(numbers[k++]));
      } else {
        number = static_cast<float>(numbers[k++]);
      }
    });
    return result;
  }
  static pinnquad::MppiSettings settings(const LoopGains& gains, double speed_m_s) {
    pinnquad::MppiSettings result;
    constexpr double speed_per_distance_1_s = 1.5;  // 8 m/s at 6 m by these plans, and a margin
    result.most_off_m = static_cast<float>(speed_m_s / speed_per_distance_1_s);
    result.position_cost_1_m2 *= static_cast<float>(gains.outer);
    result.velocity_cost_s2_m2 *= static_cast<float>(gains.outer);
    result.rate_gain_1_s *= static_cast<float>(gains.inner);
    result.yaw_rate_gain_1_s *= static_cast<float>(gains.inner);
    return result;
  }
  pinnquad::TrajectoryPoint<float> point(double time_s) const noexcept {
    const pinnquad::TrajectoryPoint<double> p = path_.sample(time_s);
    pinnquad::TrajectoryPoint<float> result;
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
  pinnquad::Commands<float> last_{0.5f, 0.5f, 0.5f, 0.5f};
};

/// Throws std::out_of_range for a name that is none.
template <class Vehicle>
AnyPolicy loop_policy(const std::string& name, const LoopKnowledge<Vehicle>& known, const LoopGains& gains) {
  using namespace pinnquad;
  using Body = Quadrotor<double, StandardAtmosphere>;
  using Formula = AnalyticInverse<Vehicle>;
  const Airframe<double>& airframe = known.vehicle.airframe();
  const AnalyticInverse<Body> rigid_body(Body(airframe, known.vehicle.site()));
  const Formula formula(known.vehicle);
  const double lag_s = airframe.rise_time_constant_s(0);
  const FlownMotion<double> flown({25'000, lag_s, known.delay_s});
  FilteredMotionSettings<double> low_pass;
  low_pass.cutoff_rad_s *= gains.learning;
  low_pass.rotor_lag_s = lag_s;
  low_pass.delay_s = known.delay_s;
  const FilteredMotion<double> filtered(low_pass);
  BiasSettings<double> bias = known.bias, at_once = known.bias, slower = known.bias;
  for (std::size_t i = 0; i < bias.time_constants_s.size(); ++i) {
    bias.time_constants_s[i] /= gains.learning;
    at_once.time_constants_s[i] = 0;
    at_once.most[i] = std::numeric_limits<double>::infinity();  // an increment from tick to tick, not a bias learnt
    slower.time_constants_s[i] = 0.05 / gains.learning;
  }
  bias.across_time_constant_s /= gains.learning;
  at_once.across_time_constant_s = 0;
  slower.across_time_constant_s = 0.05 / gains.learning;
  IntegralSettings<double> integral;
  integral.linear_1_s *= gains.learning;
  integral.angular_1_s *= gains.learning;

  const auto adaptive = [&](const auto& inverse) {
    return AdaptiveInverse<double, std::decay_t<decltype(inverse)>>(inverse, airframe, bias, flown);
  };
  const auto incremental = [&](const auto& inverse, const BiasSettings<double>& settings) {
    return AdaptiveInverse<double, std::decay_t<decltype(inverse)>, FilteredMotion<double>>(inverse, airframe, settings,
                                                                                            filtered);
  };
  const auto leaning = [&](const auto& inverse) {
    return KnownDrag<std::decay_t<decltype(inverse)>, Vehicle>(inverse, known.vehicle);
  };
  if (name == "pid") return AnyPolicy(IntegralInverse<double, AnalyticInverse<Body>>(rigid_body, integral));
  if (name == "formula") return AnyPolicy(formula);
  if (name == "geometric") return AnyPolicy(leaning(formula));
  if (name == "formula_adaptive") return AnyPolicy(adaptive(formula));
  if (name == "indi") return AnyPolicy(incremental(rigid_body, at_once));
  if (name == "observer") return AnyPolicy(incremental(leaning(formula), slower));

  if (name == "mppi") return AnyPolicy(MppiPolicy(airframe, known.vehicle.site(), *known.path, known.speed_m_s, gains));

  if (name == "l1") {
    L1Settings<double> l1;
    l1.force_cutoff_rad_s *= gains.learning;
    l1.torque_cutoff_rad_s *= gains.learning;
    const auto inverse = leaning(formula);
    return AnyPolicy(
        L1Adaptive<double, std::decay_t<decltype(inverse)>, Vehicle>(inverse, known.vehicle, l1, known.delay_s));
  }

  const double rotor_scale = known.vehicle.rotor_scale(known.vehicle.surroundings({}, 0));
  const auto with_wrench = [&](const auto& residual) {
    return WrenchInverse<double, std::decay_t<decltype(residual)>>(airframe, residual, rotor_scale,
                                                                   known.vehicle.site().gravity_m_s2);
  };
  const auto full = [&](const auto& residual) {
    WindFilterSettings<double> walks;
    for (double* walk : {&walks.wind_walk_m_s, &walks.thrust_walk, &walks.force_walk_m_s2}) *walk *= gains.learning;
    const FlownMotion<double> often({10'000, lag_s, known.delay_s});
    const WindInverse<double, std::decay_t<decltype(residual)>> wind(with_wrench(residual), walks, often);
    return AnyPolicy(incremental(wind, at_once));
  };
  if (name == "full_nominal") return full(NominalWrench<Vehicle>(known.vehicle));
  if (name == "full_bias") return full(NominalWrench<Body>(Body(airframe, known.vehicle.site())));
  if (known.wrench != nullptr) {
    const BlockWrench learnt = wrench_of(*known.wrench);
    if (name == "wrench") return AnyPolicy(with_wrench(learnt));
    if (name == "wrench_indi") return AnyPolicy(incremental(with_wrench(learnt), at_once));
    if (name == "full") return full(learnt);
  }

  const auto handing_over = [](const auto& first, const auto& second) {
    return AnyPolicy(HandsOver<double, std::decay_t<decltype(first)>, std::decay_t<decltype(second)>>(first, second));
  };
  const double ground_z_m = known.vehicle.site().ground_z_m;
  const auto of_model = [&](const auto& guard, const auto& compose) {
    return with_feed_forward(known.model, guard, ground_z_m, known.columns, compose);
  };
  const Extend<TrainingGuard, Fallback<Formula>> falls_back(formula);
  if (name == "structured") {
    return of_model(falls_back, [](const auto& network) { return AnyPolicy(network); });
  }
  if (name == "structured_drag") {
    return of_model(falls_back, [&](const auto& network) { return AnyPolicy(leaning(network)); });
  }
  if (name == "adaptive") {
    return of_model(TrainingGuard{},
                    [&](const auto& network) { return handing_over(adaptive(network), adaptive(formula)); });
  }
  if (name == "structured_indi") {
    return of_model(TrainingGuard{}, [&](const auto& network) {
      return handing_over(incremental(network, at_once), incremental(formula, at_once));
    });
  }
  if (name == "structured_observer") {
    return of_model(TrainingGuard{}, [&](const auto& network) {
      return handing_over(incremental(leaning(network), slower), incremental(leaning(formula), slower));
    });
  }
  throw std::out_of_range(name);
}

}  // namespace programs
