// SPDX-License-Identifier: MIT
// Trajectory tracking: commands = feed-forward of the reference motion + allocation of the feedback.
// The feedback law is the same whatever the feed-forward policy, so that policies can be compared.
#pragma once

#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/control/torque_priority.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

template <class Scalar, class FeedForward>
class TrackingController {
  static_assert(is_feed_forward<FeedForward, Scalar>,
                "pinnquad: this type is no feed-forward policy (control/feed_forward.hpp)");
  static_assert(is_noexcept_feed_forward<FeedForward, Scalar>,
                "pinnquad: a feed-forward policy flies: its operator() must be noexcept (control/feed_forward.hpp)");

 public:
  /// `density_ratio` rho / rho_0 of the place, by which rotor thrust scales.
  TrackingController(const Airframe<Scalar>& airframe, const FlightController<Scalar>& controller,
                     const FeedForward& feed_forward, Scalar density_ratio = Scalar(1)) noexcept
      : airframe_(airframe),
        rotors_(airframe),
        controller_(controller),
        feed_forward_(feed_forward),
        density_ratio_(density_ratio) {}

  /// u = u_ff(state, reference motion) + allocation^-1 (m a_fb along body z, J omega_dot_fb), torque before thrust.
  /// Any Status of controller or policy; the commands are untouched unless it is ok.
  Status operator()(const State<Scalar>& state, const TrajectoryPoint<Scalar>& point, Scalar time_s,
                    Commands<Scalar>& commands) noexcept {
    TrackingDemand<Scalar> demand;
    Status status = controller_(state, point, demand);
    if (status != Status::ok) return status;
    Commands<Scalar> sum{};
    status = feed_forward_(state, demand.reference, time_s, sum);
    if (!has_output(status)) return status;
    Wrench<Scalar> feedback;
    feedback.force_N[2] = airframe_.mass_kg * demand.feedback_acceleration_m_s2[2];
    feedback.torque_N_m = to_vector(airframe_.inertia_kg_m2).cwiseProduct(demand.feedback_angular_acceleration_rad_s2);
    const Commands<Scalar> correction = rotors_.commands(feedback, density_ratio_);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += correction[i];
    if (!all_finite(sum)) return Status::output_not_finite;
    commands = keep_torque(sum);
    return Status::ok;
  }

  const FeedForward& feed_forward() const noexcept { return feed_forward_; }

 private:
  Airframe<Scalar> airframe_;
  Rotors<Scalar> rotors_;
  FlightController<Scalar> controller_;
  FeedForward feed_forward_;
  Scalar density_ratio_;
};

}  // namespace pinnquad
