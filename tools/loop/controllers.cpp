// SPDX-License-Identifier: MIT
#include "loop/controllers.hpp"

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "flight/block_feed_forward.hpp"
#include "loop/wrench_block.hpp"
#include "pinnquad/control/filtered_motion.hpp"
#include "pinnquad/control/known_drag.hpp"
#include "pinnquad/control/l1_adaptive.hpp"
#include "pinnquad/control/mppi.hpp"
#include "pinnquad/control/wind_filter.hpp"

namespace programs {

namespace {

using namespace pinnquad;

/// MPPI as a policy: it looks along the trajectory in place of the motion wanted. It is told the airframe and the drag,
/// and takes the rotors for those that its last commands have settled.
class MppiPolicy {
  using Planner = Mppi<Quadrotor<float, StandardAtmosphere, QuadraticDrag>>;

 public:
  MppiPolicy(const Airframe<double>& airframe, const Site<double>& site, AnyTrajectory path, double speed_m_s,
             const LoopGains& gains)
      : planner_(in_float(airframe),
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
  static Airframe<float> in_float(const Airframe<double>& airframe) {
    std::vector<double> numbers;
    Airframe<float> result;
    each_number(airframe, [&](const auto& number) { numbers.push_back(static_cast<double>(number)); });
    std::size_t k = 0;
    each_number(result, [&](auto& number) {
      using Number = std::decay_t<decltype(number)>;
      if constexpr (std::is_enum_v<Number>) {
        number = static_cast<Number>(static_cast<int>(numbers[k++]));
      } else {
        number = static_cast<float>(numbers[k++]);
      }
    });
    return result;
  }
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

FlightGains<double> flight_gains(const LoopGains& factors) {
  FlightGains<double> gains;
  gains.position_1_s *= factors.outer;
  gains.velocity_1_s *= factors.outer;
  for (double* gain : {&gains.tilt_1_s, &gains.yaw_1_s, &gains.roll_pitch_rate_1_s, &gains.yaw_rate_1_s}) {
    *gain *= factors.inner;
  }
  return gains;
}

AnyPolicy loop_policy(const std::string& name, const LoopKnowledge& known, const LoopGains& gains) {
  using Formula = AnalyticInverse<SwitchedQuadrotor>;
  const Airframe<double>& airframe = known.vehicle.airframe();
  const SwitchedQuadrotor body =
      quadrotor_with(switched_effects<Quadrotor<double, StandardAtmosphere>>(), airframe, known.vehicle.site());
  const Formula rigid_body(body), formula(known.vehicle);
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
    return KnownDrag<std::decay_t<decltype(inverse)>, SwitchedQuadrotor>(inverse, known.vehicle);
  };
  if (name == "pid") return AnyPolicy(IntegralInverse<double, Formula>(rigid_body, integral));
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
    return AnyPolicy(L1Adaptive<double, std::decay_t<decltype(inverse)>, SwitchedQuadrotor>(inverse, known.vehicle, l1,
                                                                                            known.delay_s));
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
  if (name == "full_nominal") return full(NominalWrench<SwitchedQuadrotor>(known.vehicle));
  if (name == "full_bias") return full(NominalWrench<SwitchedQuadrotor>(body));
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
