// SPDX-License-Identifier: MIT
// Feed-forward policies: the commands for a motion wanted; a controller's feedback is part of it.
// Contract: `Status operator()(const State<S>&, const Accelerations<S>& desired, std::uint64_t time_us, Commands<S>&)
// noexcept`; the commands are untouched unless has_output(status). One is AnalyticInverse
// (inference/analytic_inverse.hpp).
// Optional, each noexcept; a policy around another one passes each on, and one that has another signature does not
// compile:
//   void learn(std::uint64_t now_us, bool known, const State<S>&, const Commands<S>&)
//       each tick, before the policy is asked: the state, and the commands in force since the tick before; `known`:
//       they drove the motors
//   void integrate(const Accelerations<S>& feedback)
//       the controller's feedback of this tick
//   Vector3<S> across_m_s2(const State<S>&) const
//       an acceleration across the thrust, which no rotor makes: NED, m/s^2; it is taken from what is asked for.
//       `static constexpr bool across_varies` or `bool across_varies() const`: false if it is the same in every state
//   Status observed(const State<S>&, const Accelerations<S>& flown, std::uint64_t time_us, Commands<S>&)
//       the answer to a motion that was flown, without guard and integral
//   FallbackCount count() const
// Time is a count of microseconds from any start: seconds in float are 4 ms apart after ten hours.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/features/input_history.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"

namespace pinnquad {

namespace detail {
// The time in braces: a call that takes it as a floating-point number is not detected.
template <class Policy, class Scalar>
using FeedForward = std::enable_if_t<
    std::is_same_v<Status, decltype(std::declval<Policy&>()(
                               std::declval<const State<Scalar>&>(), std::declval<const Accelerations<Scalar>&>(),
                               {std::declval<std::uint64_t>()}, std::declval<Commands<Scalar>&>()))>>;
template <class Policy, class Scalar>
using NoexceptFeedForward = std::enable_if_t<noexcept(
    std::declval<Policy&>()(std::declval<const State<Scalar>&>(), std::declval<const Accelerations<Scalar>&>(),
                            {std::declval<std::uint64_t>()}, std::declval<Commands<Scalar>&>()))>;
template <class Measured, class Scalar, class Present>
using NoexceptMeasurement = std::enable_if_t<noexcept(std::declval<Measured&>()(
    std::declval<const State<Scalar>&>(), {std::declval<std::uint64_t>()}, std::declval<Present&>()))>;
/// Nothing is measured: the motion says all.
struct MotionAlone {};
template <class Policy>
using FallbackCountOf = decltype(std::declval<const Policy&>().count());
template <class Policy, class Scalar>
using LearnCall = decltype(std::declval<Policy&>().learn({std::declval<std::uint64_t>()}, bool{},
                                                         std::declval<const State<Scalar>&>(),
                                                         std::declval<const Commands<Scalar>&>()));
template <class Policy, class Scalar>
using IntegrateCall = decltype(std::declval<Policy&>().integrate(std::declval<const Accelerations<Scalar>&>()));
template <class Policy, class Scalar>
using AcrossCall = decltype(std::declval<const Policy&>().across_m_s2(std::declval<const State<Scalar>&>()));
template <class Policy>
using AcrossVaries = decltype(Policy::across_varies);
template <class Policy, class Scalar>
using ObservedCall = decltype(std::declval<Policy&>().observed(
    std::declval<const State<Scalar>&>(), std::declval<const Accelerations<Scalar>&>(), {std::declval<std::uint64_t>()},
    std::declval<Commands<Scalar>&>()));

/// Finds a policy's member by name, whatever its type: `&WithPolicyNames<Policy>::name` is ambiguous, and no type,
/// where the policy has one.
struct PolicyNames {
  void learn();
  void integrate();
  void across_m_s2();
  void observed();
  void count();
};
template <class Policy>
struct WithPolicyNames : Policy, PolicyNames {};
template <class Policy>
using NoLearn = decltype(&WithPolicyNames<Policy>::learn);
template <class Policy>
using NoIntegrate = decltype(&WithPolicyNames<Policy>::integrate);
template <class Policy>
using NoAcross = decltype(&WithPolicyNames<Policy>::across_m_s2);
template <class Policy>
using NoObserved = decltype(&WithPolicyNames<Policy>::observed);
template <class Policy>
using NoCount = decltype(&WithPolicyNames<Policy>::count);
/// False where a member has an optional name of the contract and can't be called as it says.
template <class Policy, class Scalar>
constexpr bool is_whole_policy() noexcept {
  if constexpr (std::is_class_v<Policy> && !std::is_final_v<Policy>) {
    const bool called[] = {is_detected<LearnCall, Policy, Scalar>, is_detected<IntegrateCall, Policy, Scalar>,
                           is_detected<AcrossCall, Policy, Scalar>, is_detected<ObservedCall, Policy, Scalar>,
                           is_detected<FallbackCountOf, Policy>};
    const bool absent[] = {is_detected<NoLearn, Policy>, is_detected<NoIntegrate, Policy>,
                           is_detected<NoAcross, Policy>, is_detected<NoObserved, Policy>,
                           is_detected<NoCount, Policy>};
    for (int i = 0; i < 5; ++i) {
      if (!called[i] && !absent[i]) return false;
    }
  }
  return true;
}
template <class Policy, class Scalar>
constexpr bool require_whole_policy() noexcept {
  static_assert(
      is_whole_policy<Policy, Scalar>(),
      "pinnquad: a policy's learn(), integrate(), across_m_s2(), observed() or count() can't be called as the "
      "contract says: it would be passed over (control/feed_forward.hpp)");
  return true;
}
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file, but for `noexcept`.
template <class Policy, class Scalar>
inline constexpr bool is_feed_forward = is_detected<detail::FeedForward, Policy, Scalar>;

/// True for a policy that has learn().
template <class Policy, class Scalar>
inline constexpr bool learns_in_flight = is_detected<detail::LearnCall, Policy, Scalar>;

/// True for one that has integrate().
template <class Policy, class Scalar>
inline constexpr bool integrates_feedback = is_detected<detail::IntegrateCall, Policy, Scalar>;

/// True for one that has across_m_s2().
template <class Policy, class Scalar>
inline constexpr bool knows_across = is_detected<detail::AcrossCall, Policy, Scalar>;

namespace detail {
template <class Policy, class Scalar>
constexpr bool varying_across() noexcept {
  if constexpr (is_detected<AcrossVaries, Policy>) {
    return Policy::across_varies;
  } else {
    return knows_across<Policy, Scalar>;
  }
}
}  // namespace detail

/// True where it depends on the state.
template <class Policy, class Scalar>
inline constexpr bool across_varies = detail::varying_across<Policy, Scalar>();

/// The acceleration that the policy knows of; zero of one that knows of none.
template <class Scalar, class Policy>
Vector3<Scalar> across_of(const Policy& policy, const State<Scalar>& state) noexcept {
  if constexpr (knows_across<Policy, Scalar>) {
    return policy.across_m_s2(state);
  } else {
    static_cast<void>(policy), static_cast<void>(state);
    return Vector3<Scalar>::Zero();
  }
}

/// The policy's observed(); the policy itself where it has none.
template <class Scalar, class Policy>
Status observed_by(Policy& policy, const State<Scalar>& state, const Accelerations<Scalar>& flown,
                   std::uint64_t time_us, Commands<Scalar>& commands) noexcept {
  if constexpr (is_detected<detail::ObservedCall, Policy, Scalar>) {
    return policy.observed(state, flown, time_us, commands);
  } else {
    return policy(state, flown, time_us, commands);
  }
}

/// Commands of a vehicle that stands still at a place, in calm or in the wind of its effects at time 0.
/// `no_solution` (vehicle/inverse.hpp) or `not_finite`; `commands` are untouched unless the Status is ok.
template <class Scalar, class... Effects>
Status hover_trim(const Quadrotor<Scalar, Effects...>& quadrotor, const Vector3<Scalar>& position_m,
                  Commands<Scalar>& commands) noexcept {
  State<Scalar> state;
  state.position_m = position_m;
  return inverse_commands(quadrotor, state, Accelerations<Scalar>{}, Scalar(0), commands);
}

/// Counts a network's answers by Status.
struct FallbackCount {
  static constexpr auto statuses = static_cast<std::size_t>(status_count);

  std::uint32_t asked{0};
  std::array<std::uint32_t, statuses> by_status{};  ///< `ok` and `limited`: the network answered

  constexpr std::uint32_t of(Status status) const noexcept { return by_status[index(status)]; }
  constexpr std::uint32_t fallbacks() const noexcept { return asked - of(Status::ok) - of(Status::limited); }
  /// The network's own Status.
  constexpr void add(Status status) noexcept {
    ++asked;
    ++by_status[index(status)];
  }

 private:
  static constexpr std::size_t index(Status status) noexcept { return static_cast<std::size_t>(status) % statuses; }
};

/// The network's prediction for the motion wanted, or its guard's fallback, counted by Status. `InverseDynamics`: as in
/// inference/inverse_dynamics.hpp; its scalar may be narrower than the loop's. Without a Fallback in its guard the
/// policy declines where the network does. A model with a past gets a window of the motions asked for, and declines as
/// `warming_up` first. A model that asks for more than MotionInputs (altitude, battery voltage) needs `Measured`, which
/// sets it before each prediction: `void operator()(const State<Scalar>&, std::uint64_t time_us, Inputs&) noexcept`.
template <class InverseDynamics, class Measured = detail::MotionAlone>
class NetworkInverse {
 public:
  using NetworkScalar = typename InverseDynamics::Scalar;
  using History = InputHistory<typename InverseDynamics::Features, NetworkScalar>;
  /// The model's inputs, or one tap of them.
  using Present = typename History::Present;
  static_assert(std::is_base_of_v<MotionInputs<NetworkScalar>, Present>,
                "pinnquad: NetworkInverse fills MotionInputs; this model's feature set asks for other inputs "
                "(features/features.hpp)");
  static_assert(
      !std::is_same_v<Measured, detail::MotionAlone> || std::is_same_v<MotionInputs<NetworkScalar>, Present>,
      "pinnquad: this model asks for more than MotionInputs; NetworkInverse needs a second argument that measures it "
      "(control/feed_forward.hpp)");

  /// `history`: an empty one, given where features that are known at run time alone say how long it is.
  explicit NetworkInverse(const InverseDynamics& inverse, const Measured& measured = Measured{},
                          const History& history = History{}) noexcept
      : inverse_(inverse), measured_(measured), history_(history) {}

  template <class Scalar>
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& desired, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    const Present present = measured_present(state, desired, time_us);
    const double time_s = seconds_of(time_us);
    static_cast<void>(history_.take(present, time_s));  // predict() says it too
    Commands<NetworkScalar> predicted{};
    typename InverseDynamics::Report report;
    const PlaceAndTime<Scalar> place{state.position_m, static_cast<Scalar>(time_s)};
    const Status status = inverse_.predict(history_.inputs(), place, predicted, report);
    count_.add(report.cause);
    if (!has_output(status)) return status;
    for (std::size_t i = 0; i < predicted.size(); ++i) commands[i] = Scalar(predicted[i]);
    return status;
  }

  /// The network's answer to a motion that was flown, without guard: `ok`, or why there is none (`outside_envelope`).
  /// A window is asked as though the motion had lasted; the one of the motions wanted stays as it is.
  template <class Scalar>
  Status observed(const State<Scalar>& state, const Accelerations<Scalar>& flown, std::uint64_t time_us,
                  Commands<Scalar>& commands) noexcept {
    Commands<NetworkScalar> said{};
    const Status status = inverse_.observed(history_.lasting(measured_present(state, flown, time_us)), said);
    if (status != Status::ok) return status == Status::limited ? Status::outside_envelope : status;
    for (std::size_t i = 0; i < said.size(); ++i) commands[i] = Scalar(said[i]);
    return status;
  }

  const FallbackCount& count() const noexcept { return count_; }

 private:
  template <class Scalar>
  Present measured_present(const State<Scalar>& state, const Accelerations<Scalar>& motion,
                           [[maybe_unused]] std::uint64_t time_us) noexcept {
    Present present;
    static_cast<MotionInputs<NetworkScalar>&>(present) = narrowed(motion_inputs(state, motion));
    if constexpr (!std::is_same_v<Measured, detail::MotionAlone>) {
      static_assert(is_detected<detail::NoexceptMeasurement, Measured, Scalar, Present>,
                    "pinnquad: what measures for NetworkInverse is called with state, time and inputs, and must be "
                    "noexcept; time is a std::uint64_t of microseconds (control/feed_forward.hpp)");
      measured_(state, time_us, present);
    }
    return present;
  }

  template <class Scalar>
  static MotionInputs<NetworkScalar> narrowed(const MotionInputs<Scalar>& in) noexcept {
    const Quaternion<Scalar>& q = in.attitude;
    return {in.linear_acceleration_m_s2.template cast<NetworkScalar>(),
            in.angular_acceleration_rad_s2.template cast<NetworkScalar>(),
            in.velocity_m_s.template cast<NetworkScalar>(),
            in.body_rates_rad_s.template cast<NetworkScalar>(),
            {NetworkScalar(q.w), NetworkScalar(q.x), NetworkScalar(q.y), NetworkScalar(q.z)}};
  }

  InverseDynamics inverse_;
  Measured measured_;
  History history_;
  FallbackCount count_{};
};

/// The policy's count; all zero for a policy that has no fallback.
template <class Policy>
constexpr FallbackCount fallback_count(const Policy& policy) noexcept {
  if constexpr (is_detected<detail::FallbackCountOf, Policy>) {
    return policy.count();
  } else {
    static_cast<void>(policy);
    return {};
  }
}

}  // namespace pinnquad
