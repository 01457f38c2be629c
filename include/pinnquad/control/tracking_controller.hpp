// SPDX-License-Identifier: MIT
// Trajectory tracking: FlightController's demand, reference and feedback together -> commands of a policy, which adds
// what it has learnt -> desaturate(). NeuralController (control/autopilot) flies the same law, to the bit. It flies
// where the policy declines too.
#pragma once

#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/control/leaning.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// Commands of a reference point and a measured state, NED and FRD, SI units. Status `limited` where a command was
/// limited, `fell_back` where the policy declined and the rigid body flew.
template <class Scalar, class FeedForward>
class TrackingController {
  static_assert(is_feed_forward<FeedForward, Scalar>,
                "pinnquad: this type is no feed-forward policy; time is a std::uint64_t of microseconds "
                "(control/feed_forward.hpp)");
  static_assert(!is_feed_forward<FeedForward, Scalar> || is_detected<detail::NoexceptFeedForward, FeedForward, Scalar>,
                "pinnquad: a feed-forward policy flies: its operator() must be noexcept (control/feed_forward.hpp)");
  static_assert(detail::require_whole_policy<FeedForward, Scalar>());

 public:
  /// `rotor_scale` of the place, rho / rho_0 times the battery's thrust scale (Quadrotor::rotor_scale).
  TrackingController(const Airframe<Scalar>& airframe, const FlightController<Scalar>& controller,
                     const FeedForward& feed_forward, Scalar rotor_scale = Scalar(1)) noexcept
      : airframe_(airframe),
        rotors_(airframe),
        controller_(controller),
        feed_forward_(feed_forward),
        rotor_scale_(rotor_scale) {}

  /// u = desaturate(policy(state, demand)). Where the policy declines, the rigid body of the airframe answers, without
  /// air.
  /// A policy that learns (control/feed_forward.hpp) is shown the state and the commands of the tick before first,
  /// and what it finds across the thrust is taken from the motion that is asked for, with its rate of change along the
  /// trajectory.
  /// `ok`. `limited`: the policy limited, or its commands were desaturated. `fell_back`: the policy fell back, or
  /// declined (feed_forward_status() says why). Any other Status of the controller, and `output_not_finite`: the
  /// commands are untouched.
  Status operator()(const State<Scalar>& state, const TrajectoryPoint<Scalar>& point, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    if constexpr (learns_in_flight<FeedForward, Scalar>) {
      feed_forward_.learn(time_us, flew_, state, last_);
      flew_ = false;
    }
    Accelerations<Scalar> demand, feedback;
    const TrajectoryPoint<Scalar> asked = leaning(feed_forward_, state, point, controller_.gravity_m_s2());
    const Status demanded = controller_(state, asked, demand, feedback);
    if (demanded != Status::ok) return demanded;
    if constexpr (integrates_feedback<FeedForward, Scalar>) feed_forward_.integrate(feedback);
    Commands<Scalar> wanted{};
    Status status = feed_forward_status_ = feed_forward_(state, demand, time_us, wanted);
    if (!has_output(status)) {
      status = Status::fell_back;
      const Wrench<Scalar> wrench = required_wrench(airframe_, state, demand, controller_.gravity_m_s2());
      wanted = rotors_.commands_of(rotors_.fractions_for(wrench, rotor_scale_));
    }
    if (!all_finite(wanted)) return Status::output_not_finite;
    commands = desaturate(rotors_, wanted);
    if constexpr (learns_in_flight<FeedForward, Scalar>) {
      last_ = commands;
      flew_ = true;
    }
    return status == Status::ok && clipped(wanted) != wanted ? Status::limited : status;
  }
  /// Time in seconds would be truncated.
  template <class Seconds, std::enable_if_t<std::is_floating_point_v<Seconds>, int> = 0>
  Status operator()(const State<Scalar>&, const TrajectoryPoint<Scalar>&, Seconds, Commands<Scalar>&) = delete;

  /// From now on of this airframe, with this controller: a policy that learns finds more of either in flight. What it
  /// has learnt stays.
  void change_to(const Airframe<Scalar>& airframe, const FlightController<Scalar>& controller) noexcept {
    airframe_ = airframe;
    rotors_ = Rotors<Scalar>(airframe);
    controller_ = controller;
  }

  const FeedForward& feed_forward() const noexcept { return feed_forward_; }
  /// The policy's own Status of the last tick that asked it.
  Status feed_forward_status() const noexcept { return feed_forward_status_; }

 private:
  Airframe<Scalar> airframe_;
  Rotors<Scalar> rotors_;
  FlightController<Scalar> controller_;
  FeedForward feed_forward_;
  Scalar rotor_scale_;
  Status feed_forward_status_{Status::ok};
  Commands<Scalar> last_{};  ///< in force since the tick before, for a policy that learns
  bool flew_ = false;
};

}  // namespace pinnquad
