// SPDX-License-Identifier: MIT
#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

using namespace pinnquad;

/// Half throttle, whatever is wanted.
template <class Time = std::uint64_t, bool IsNoexcept = true, class Answer = Status>
struct Policy {
  template <class Scalar>
  Answer operator()(const State<Scalar>&, const Accelerations<Scalar>&, Time,
                    Commands<Scalar>& u) noexcept(IsNoexcept) {
    u.fill(Scalar(0.5));
    return Answer(Status::ok);
  }
};
template <class Policy>
constexpr auto controller = sizeof(TrackingController<double, Policy>);
template <class Policy>
constexpr auto learning = sizeof(AdaptiveInverse<double, Policy>);

// SOUND
static_assert(controller<Policy<>> > 0 && learning<Policy<>> > 0);

// CASE NOT_A_FEED_FORWARD: pinnquad: this type is no feed-forward policy
const auto size = controller<Policy<std::uint64_t, true, void>>;
// CASE FEED_FORWARD_IN_SECONDS: pinnquad: this type is no feed-forward policy; time is a std::uint64_t of microseconds
const auto size = controller<Policy<double>>;
// CASE FEED_FORWARD_MAY_THROW: pinnquad: a feed-forward policy flies: its operator.. must be noexcept
const auto size = controller<Policy<std::uint64_t, false>>;
// CASE LEARNS_IN_SECONDS: pinnquad: a policy's learn.., integrate.., across_m_s2.., observed.. or count.. can't be called
struct Learns : Policy<> {
  void learn(double, bool, const State<double>&, const Commands<double>&) noexcept {}
};
const auto size = controller<Learns>;
// CASE NOT_AN_INVERSE: pinnquad: AdaptiveInverse's second argument is no feed-forward policy
struct Nothing {};
const auto size = learning<Nothing>;
