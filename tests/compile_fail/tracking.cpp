// SPDX-License-Identifier: MIT
// CASE NOT_A_FEED_FORWARD: pinnquad: this type is no feed-forward policy
// CASE FEED_FORWARD_MAY_THROW: pinnquad: a feed-forward policy flies: its operator.. must be noexcept
#include "pinnquad/control/tracking_controller.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

namespace {

/// Half throttle, whatever is wanted.
struct Policy {
  template <class Scalar>
#if defined(NOT_A_FEED_FORWARD)
  void operator()(
#else
  pinnquad::Status operator()(
#endif
      const pinnquad::State<Scalar>&, const pinnquad::Accelerations<Scalar>&, Scalar, pinnquad::Commands<Scalar>& u)
#if !defined(FEED_FORWARD_MAY_THROW)
      noexcept
#endif
  {
    u.fill(Scalar(0.5));
#if !defined(NOT_A_FEED_FORWARD)
    return pinnquad::Status::ok;
#endif
  }
};

using Controller = pinnquad::TrackingController<double, Policy>;

}  // namespace

int main() { return sizeof(Controller) > sizeof(Policy) ? 0 : 1; }
