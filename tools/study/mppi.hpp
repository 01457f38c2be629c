// SPDX-License-Identifier: MIT
// Model predictive path integral control (MPPI): many flights of the next moment under disturbed plans, in lanes; the
// plan becomes their mean, weighted by what each cost. Source: Williams et al., Information-theoretic model predictive
// control (IEEE T-RO 2018). Here body rates and thrust are planned, about those of the trajectory (flatness.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

#include "pinnquad/control/flatness.hpp"
#include "pinnquad/core/lanes.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/vehicle/lanes_of_vehicles.hpp"

namespace study {

using namespace pinnquad;

/// Costs are per step, of squares; the values are ours.
struct MppiSettings {
  float step_s = 0.02f;               ///< of the flights looked at, and how often the plan is improved
  float temperature = 0.1f;           ///< over the mean cost above the least: less lets fewer flights decide
  float thrust_deviation_m_s2 = 1;    ///< standard deviation of what is tried, over mass
  float rate_deviation_rad_s = 0.6f;  ///< of roll and pitch rate; half of it for yaw
  float position_cost_1_m2 = 40;
  float velocity_cost_s2_m2 = 4;
  float attitude_cost = 4;          ///< of 1 - (q . q_wanted)^2, a quarter of the squared angle
  float rate_cost_s2 = 0.02f;       ///< of the planned rates' distance from the trajectory's
  float thrust_cost_s4_m2 = 0.01f;  ///< of the planned thrust's
  /// A trajectory further off is moved so near: by plans of 0.8 s it is flown to at 8 m/s. Shorter plans want less.
  float most_off_m = 6;
  float rate_gain_1_s = 22;  ///< angular acceleration per body rate error, roll and pitch
  float yaw_rate_gain_1_s = 8;
  std::uint32_t seed = 1;
};

/// `Rollouts` flights of `Steps` steps by the airframe's own dynamics with these effects; commands are those of the
/// rotors, 0 to 1. The same seed gives the same bits whatever the number of lanes.
template <class Vehicle, int Rollouts = 512, int Steps = 40>
class Mppi;
/// With the effects that the rollouts have.
template <class... Effects, int Rollouts, int Steps>
class Mppi<Quadrotor<float, Effects...>, Rollouts, Steps> {
  using Wide = Lanes<float, native_lanes<float>>;
  using Vehicle = Quadrotor<float, Effects...>;
  using Vehicles = Quadrotor<Wide, Effects...>;
  static constexpr int held_steps = 4;  ///< that a disturbance lasts
  static constexpr std::size_t steps = Steps, rollouts = Rollouts, lanes = static_cast<std::size_t>(Wide::count);
  static_assert(Rollouts % 16 == 0 && Rollouts >= 16 && Steps % held_steps == 0 && Steps > 0,
                "pinnquad: MPPI takes a multiple of 16 rollouts, of a multiple of 4 steps");

 public:
  /// Effects as they are by default.
  explicit Mppi(const Airframe<float>& airframe, const Site<float>& site = {},
                const MppiSettings& settings = {}) noexcept
      : Mppi(std::tuple<Effects...>{}, airframe, site, settings, std::index_sequence_for<Effects...>{}) {}
  Mppi(const Airframe<float>& airframe, const Site<float>& site, const MppiSettings& settings,
       const std::tuple<Effects...>& effects) noexcept
      : Mppi(effects, airframe, site, settings, std::index_sequence_for<Effects...>{}) {}

  /// `out_of_range` for settings that make no sense, or what Quadrotor::status() says.
  Status status() const noexcept {
    const MppiSettings& s = settings_;
    bool holds = true;
    for (const float positive :
         {s.step_s, s.temperature, s.thrust_deviation_m_s2, s.rate_deviation_rad_s, s.most_off_m}) {
      holds = holds && pinnquad::detail::plausible(positive);
    }
    for (const float cost : {s.position_cost_1_m2, s.velocity_cost_s2_m2, s.attitude_cost, s.rate_cost_s2,
                             s.thrust_cost_s4_m2, s.rate_gain_1_s, s.yaw_rate_gain_1_s}) {
      holds = holds && pinnquad::detail::plausible_or_zero(cost);
    }
    return holds ? vehicle_.status() : Status::out_of_range;
  }

  /// Commands for a state (with the commands that the rotors have followed) and a trajectory:
  /// `sample(time_s)` gives its TrajectoryPoint<float>. The plan is improved where step_s has passed since it was;
  /// between, and after it, it is flown by a loop of body rates. status(); `not_finite`; what flat_motion() says of a
  /// point; `no_solution` where no flight that was looked at stays a flight; `commands` is untouched unless ok.
  template <class Sample>
  Status operator()(const VehicleState<float>& state, const Sample& sample, Commands<float>& commands) noexcept {
    const Status sound = status();
    if (sound != Status::ok) return sound;
    if (!(all_finite(state.body) && all_finite(state.rotors) && is_finite(state.time_s))) return Status::not_finite;
    if (!is_unit(state.body.attitude)) return Status::not_unit_quaternion;
    const float scale = vehicle_.rotor_scale(vehicle_.surroundings(state.body, static_cast<float>(state.time_s)));
    const bool later = state.time_s >= improved_s_ + 0.999 * static_cast<double>(settings_.step_s);
    if (!begun_ || later || state.time_s < improved_s_) {
      const Status improved = improve(state, scale, sample);
      if (improved != Status::ok) return improved;
    }
    FlatMotion<float> now;
    const Status flat = flat_motion(sample(state.time_s), vehicle_.site().gravity_m_s2, now);
    if (flat != Status::ok) return flat;
    const Commands<float> result = commands_for(vehicle_, state.body, now, plan_[0], scale);
    if (!all_finite(result)) return Status::output_not_finite;
    commands = result;
    return Status::ok;
  }

 private:
  template <std::size_t... Index>
  Mppi(const std::tuple<Effects...>& effects, const Airframe<float>& airframe, const Site<float>& site,
       const MppiSettings& settings, std::index_sequence<Index...>) noexcept
      : settings_(settings),
        vehicle_(airframe, site, std::get<Index>(effects)...),
        vehicles_(in_every_lane<Wide>(airframe),
                  Site<Wide>{Wide(site.elevation_m), Wide(site.ground_z_m), Wide(site.gravity_m_s2)},
                  std::get<Index>(effects)...),
        step_(vehicles_.time_step(Wide(settings.step_s))) {
    static_cast<void>(effects);
  }

  /// Additions of the plan to the trajectory: thrust over mass, m/s^2, and body rates, rad/s.
  template <class Number>
  using Change = std::array<Number, 4>;

  /// Four numbers of mean 0 and variance 1, each the sum of four uniform bytes; of a flight and a stretch of time.
  Change<float> disturbance(std::uint64_t rollout, std::uint64_t stretch) const noexcept {
    Change<float> result{};
    if (rollout == 0) return result;  // the plan as it is
    std::uint64_t bits = (improved_ * rollouts + rollout) * steps + stretch + (std::uint64_t{settings_.seed} << 32);
    std::uint64_t drawn = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i % 2 == 0) {  // splitmix64; 64 bits are two numbers
        bits += 0x9e3779b97f4a7c15u;
        drawn = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9u;
        drawn = (drawn ^ drawn >> 27) * 0x94d049bb133111ebu;
        drawn ^= drawn >> 31;
      }
      const auto half = static_cast<std::uint32_t>(i % 2 == 0 ? drawn : drawn >> 32);
      const std::uint32_t sum = (half & 255u) + (half >> 8 & 255u) + (half >> 16 & 255u) + (half >> 24);
      constexpr float mean = 510, deviation = 147.79f;
      result[i] = (static_cast<float>(sum) - mean) / deviation;
    }
    result[0] *= settings_.thrust_deviation_m_s2;
    result[1] *= settings_.rate_deviation_rad_s;
    result[2] *= settings_.rate_deviation_rad_s;
    result[3] *= 0.5f * settings_.rate_deviation_rad_s;
    return result;
  }

  /// The loop of body rates, for one vehicle or in lanes: clipped commands of the rotors.
  template <class Number>
  Commands<Number> commands_for(const Quadrotor<Number, Effects...>& vehicle, const State<Number>& state,
                                const FlatMotion<float>& wanted, const Change<Number>& change,
                                Number scale) const noexcept {
    const Vector3<Number>& rates = state.body_rates_rad_s;
    Vector3<Number> turning;
    for (int i = 0; i < 3; ++i) {
      const Number gain(i < 2 ? settings_.rate_gain_1_s : settings_.yaw_rate_gain_1_s);
      const Number rate = Number(wanted.body_rates_rad_s[i]) + change[static_cast<std::size_t>(i) + 1];
      turning[i] = Number(wanted.angular_acceleration_rad_s2[i]) + gain * (rate - rates[i]);
    }
    const Airframe<Number>& airframe = vehicle.airframe();
    Wrench<Number> wrench;
    wrench.force_N[2] = -(Number(wanted.specific_thrust_m_s2) + change[0]) * airframe.mass_kg;
    wrench.torque_N_m =
        inertia_times<Number>(airframe, turning) - cross<Number>(inertia_times<Number>(airframe, rates), rates);
    return clipped(vehicle.rotors().commands(wrench, scale));
  }

  /// One improvement of the plan.
  template <class Sample>
  Status improve(const VehicleState<float>& start, float scale, const Sample& sample) noexcept {
    const double step_s = static_cast<double>(settings_.step_s);
    for (std::size_t k = 0; k < steps; ++k) {
      const double from_s = start.time_s + step_s * static_cast<double>(k);
      Status flat = flat_motion(sample(from_s + 0.5 * step_s), vehicle_.site().gravity_m_s2, on_the_way_[k]);
      points_[k] = sample(from_s + step_s);
      if (flat == Status::ok) flat = flat_motion(points_[k], vehicle_.site().gravity_m_s2, motions_[k]);
      if (flat != Status::ok) return flat;
    }
    const Vector3<float> off = start.body.position_m - sample(start.time_s).position_m;
    const float off_m = pinnquad::detail::square_root(off.squaredNorm());
    if (off_m > settings_.most_off_m) {
      for (TrajectoryPoint<float>& point : points_) point.position_m += off * (1 - settings_.most_off_m / off_m);
    }
    if (begun_) {  // what was planned for a step is now a step nearer
      for (std::size_t k = 0; k + 1 < steps; ++k) plan_[k] = plan_[k + 1];
    }
    VehicleState<Wide> same;
    for (int lane = 0; lane < Wide::count; ++lane) set_lane(same, lane, start);
    for (std::size_t first = 0; first < rollouts; first += lanes) look_ahead(first, same, Wide(scale));

    float least = std::numeric_limits<float>::max();
    for (const float cost : cost_) least = cost < least ? cost : least;
    if (!(least < std::numeric_limits<float>::max())) return Status::no_solution;
    float above = 0, whole = 0;
    std::size_t flown = 0;
    for (const float cost : cost_) {
      if (!(cost < std::numeric_limits<float>::max())) continue;
      above += cost - least;
      ++flown;
    }
    const float temperature = settings_.temperature * above / static_cast<float>(flown);
    std::array<Change<float>, steps / held_steps> mean{};
    for (std::size_t rollout = 0; rollout < rollouts; ++rollout) {
      if (!(cost_[rollout] < std::numeric_limits<float>::max())) continue;
      const float exponent = temperature > 0 ? (cost_[rollout] - least) / temperature : 0.0f;
      if (exponent > 20) continue;
      const float weight = pinnquad::detail::exponential(-exponent);
      whole += weight;
      for (std::size_t stretch = 0; stretch < mean.size(); ++stretch) {
        const Change<float> tried = disturbance(rollout, stretch);
        for (std::size_t i = 0; i < 4; ++i) mean[stretch][i] += weight * tried[i];
      }
    }
    for (std::size_t k = 0; k < steps; ++k) {
      for (std::size_t i = 0; i < 4; ++i) plan_[k][i] += mean[k / held_steps][i] / whole;
    }
    begun_ = true;
    improved_s_ = start.time_s;
    ++improved_;
    return Status::ok;
  }

  /// The costs of as many flights as there are lanes; greatest for one that a step refuses.
  void look_ahead(std::size_t first, const VehicleState<Wide>& start, Wide scale) noexcept {
    const MppiSettings& s = settings_;
    VehicleState<Wide> state = start;
    Outcome<Wide> outcome(Status::ok);
    Wide cost(0);
    Change<Wide> tried{};
    for (std::size_t k = 0; k < steps; ++k) {
      if (k % held_steps == 0) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const Change<float> one = disturbance(first + lane, k / held_steps);
          for (std::size_t i = 0; i < 4; ++i) tried[i].set_lane(static_cast<int>(lane), one[i]);
        }
      }
      Change<Wide> change{};
      for (std::size_t i = 0; i < 4; ++i) change[i] = Wide(plan_[k][i]) + tried[i];
      outcome = vehicles_.step(state, commands_for(vehicles_, state.body, on_the_way_[k], change, scale), step_);
      const TrajectoryPoint<float>& point = points_[k];
      Wide far(0), fast(0);
      for (int i = 0; i < 3; ++i) {
        const Wide off = state.body.position_m[i] - Wide(point.position_m[i]);
        const Wide faster = state.body.velocity_m_s[i] - Wide(point.velocity_m_s[i]);
        far += off * off;
        fast += faster * faster;
      }
      const Quaternion<float>& wanted = motions_[k].attitude;
      const Quaternion<Wide>& q = state.body.attitude;
      const Wide along = q.w * Wide(wanted.w) + q.x * Wide(wanted.x) + q.y * Wide(wanted.y) + q.z * Wide(wanted.z);
      const Wide turning = change[1] * change[1] + change[2] * change[2] + change[3] * change[3];
      cost += Wide(s.position_cost_1_m2) * far + Wide(s.velocity_cost_s2_m2) * fast +
              Wide(s.attitude_cost) * (Wide(1) - along * along) + Wide(s.rate_cost_s2) * turning +
              Wide(s.thrust_cost_s4_m2) * (change[0] * change[0]);
    }
    const Wide greatest(std::numeric_limits<float>::max());
    cost = select(outcome == Status::ok && cost < greatest, cost, greatest);
    for (std::size_t lane = 0; lane < lanes; ++lane) cost_[first + lane] = cost.lane(static_cast<int>(lane));
  }

  MppiSettings settings_;
  Vehicle vehicle_;
  Vehicles vehicles_;
  typename Vehicles::TimeStep step_;
  std::array<Change<float>, steps> plan_{};
  std::array<FlatMotion<float>, steps> on_the_way_{};  ///< in the middle of each step
  std::array<FlatMotion<float>, steps> motions_{};     ///< and at its end
  std::array<TrajectoryPoint<float>, steps> points_{};
  std::array<float, rollouts> cost_{};
  double improved_s_ = 0;
  std::uint64_t improved_ = 0;
  bool begun_ = false;
};

}  // namespace study
