// SPDX-License-Identifier: MIT
// CASE NOT_A_FEED_FORWARD: pinnquad: this type is no feed-forward policy
// CASE FEED_FORWARD_IN_SECONDS: pinnquad: this type is no feed-forward policy; time is a std::uint64_t of microseconds
// CASE FEED_FORWARD_MAY_THROW: pinnquad: a feed-forward policy flies: its operator.. must be noexcept
// CASE LEARNS_IN_SECONDS: pinnquad: a policy's learn.., integrate.., across_m_s2.., observed.. or count.. can't be called
// CASE NOT_AN_INVERSE: pinnquad: AdaptiveInverse's second argument is no feed-forward policy
#include "pinnquad/control/adaptive_inverse.hpp"
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

namespace {

#if defined(FEED_FORWARD_IN_SECONDS)
using Time = double;
#else
using Time = std::uint64_t;
#endif

/// Half throttle, whatever is wanted.
struct Policy {
  template <class Scalar>
#if defined(NOT_A_FEED_FORWARD)
  void operator()(
#else
  pinnquad::Status operator()(
#endif
      const pinnquad::State<Scalar>&, const pinnquad::Accelerations<Scalar>&, Time, pinnquad::Commands<Scalar>& u)
#if !defined(FEED_FORWARD_MAY_THROW)
      noexcept
#endif
  {
    u.fill(Scalar(0.5));
#if !defined(NOT_A_FEED_FORWARD)
    return pinnquad::Status::ok;
#endif
  }
#if defined(LEARNS_IN_SECONDS)
  void learn(double, bool, const pinnquad::State<double>&, const pinnquad::Commands<double>&) noexcept {}
#endif
};

#if defined(NOT_AN_INVERSE)
struct Inverse {};
#else
using Inverse = Policy;
#endif

using Controller = pinnquad::TrackingController<double, Policy>;
using Learning = pinnquad::AdaptiveInverse<double, Inverse>;

}  // namespace

int main() { return sizeof(Controller) > sizeof(Policy) && sizeof(Learning) > sizeof(Inverse) ? 0 : 1; }
