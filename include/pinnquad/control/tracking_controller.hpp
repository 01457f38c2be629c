// SPDX-License-Identifier: MIT
// Trajectory tracking: commands = feed-forward of the reference motion + allocation of the feedback.
// The feedback law is the same whatever the feed-forward policy, so that policies can be compared.
#pragma once

#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/dynamics/inertia.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

template <class Scalar, class FeedForward>
class TrackingController {
  static_assert(is_feed_forward<FeedForward, Scalar>,
                "pinnquad: this type is no feed-forward policy (control/feed_forward.hpp)");
  static_assert(is_noexcept_feed_forward<FeedForward, Scalar>,
                "pinnquad: a feed-forward policy flies: its operator() must be noexcept (control/feed_forward.hpp)");

 public:
  /// `rotor_scale` of the place, rho / rho_0 times the battery's thrust scale (Quadrotor::rotor_scale).
  TrackingController(const Airframe<Scalar>& airframe, const FlightController<Scalar>& controller,
                     const FeedForward& feed_forward, Scalar rotor_scale = Scalar(1)) noexcept
      : airframe_(airframe),
        rotors_(airframe),
        controller_(controller),
        feed_forward_(feed_forward),
        rotor_scale_(rotor_scale) {}

  /// u = u_ff(state, reference motion) + allocation^-1 (m a_fb along body z, J omega_dot_fb), summed in thrust fractions, torque
  /// before thrust.
  /// Any Status of controller or policy; the commands are untouched unless it is ok.
  Status operator()(const State<Scalar>& state, const TrajectoryPoint<Scalar>& point, Scalar time_s,
                    Commands<Scalar>& commands) noexcept {
    TrackingDemand<Scalar> demand;
    Status status = controller_(state, point, demand);
    if (status != Status::ok) return status;
    Commands<Scalar> reference{};
    status = feed_forward_(state, demand.reference, time_s, reference);
    if (!has_output(status)) return status;
    Wrench<Scalar> feedback;
    feedback.force_N[2] = airframe_.mass_kg * demand.feedback_acceleration_m_s2[2];
    feedback.torque_N_m = inertia_times(airframe_, demand.feedback_angular_acceleration_rad_s2);
    ThrustFractions<Scalar> sum = rotors_.fractions(reference);
    const ThrustFractions<Scalar> correction = rotors_.fractions_for(feedback, rotor_scale_);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += correction[i];
    if (!all_finite(sum)) return Status::output_not_finite;
    commands = desaturate(rotors_, rotors_.commands_of(sum));
    return Status::ok;
  }

  const FeedForward& feed_forward() const noexcept { return feed_forward_; }

 private:
  Airframe<Scalar> airframe_;
  Rotors<Scalar> rotors_;
  FlightController<Scalar> controller_;
  FeedForward feed_forward_;
  Scalar rotor_scale_;
};

}  // namespace pinnquad
