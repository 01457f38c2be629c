// SPDX-License-Identifier: MIT
// Every number of a state, of accelerations or of a model's inputs, for tests that make each bad in turn.
#pragma once

#include <limits>
#include <vector>

#include "pinnquad/features/features.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad::test {

template <class Scalar>
constexpr Scalar no_numbers[] = {std::numeric_limits<Scalar>::quiet_NaN(), std::numeric_limits<Scalar>::infinity(),
                                 -std::numeric_limits<Scalar>::infinity()};

namespace detail {
template <class Scalar, class... Vectors>
std::vector<Scalar*> pointers(Vectors&... vectors) {
  std::vector<Scalar*> all;
  const auto add = [&all](auto& vector) {
    for (int i = 0; i < 3; ++i) all.push_back(&vector[i]);
  };
  (add(vectors), ...);
  return all;
}
template <class Scalar>
std::vector<Scalar*> with_attitude(std::vector<Scalar*> all, Quaternion<Scalar>& q) {
  all.insert(all.end(), {&q.w, &q.x, &q.y, &q.z});
  return all;
}
}  // namespace detail

template <class Scalar>
std::vector<Scalar*> numbers_of(State<Scalar>& state) {
  return detail::with_attitude(detail::pointers<Scalar>(state.position_m, state.velocity_m_s, state.body_rates_rad_s),
                               state.attitude);
}
template <class Scalar>
std::vector<Scalar*> numbers_of(Accelerations<Scalar>& motion) {
  return detail::pointers<Scalar>(motion.linear_m_s2, motion.angular_rad_s2);
}
template <class Scalar>
std::vector<Scalar*> numbers_of(MotionInputs<Scalar>& in) {
  return detail::with_attitude(detail::pointers<Scalar>(in.linear_acceleration_m_s2, in.angular_acceleration_rad_s2,
                                                        in.velocity_m_s, in.body_rates_rad_s),
                               in.attitude);
}
template <class Scalar>
std::vector<Scalar*> numbers_of(Commands<Scalar>& commands) {
  return {&commands[0], &commands[1], &commands[2], &commands[3]};
}

/// `check(whole)` with each number of `whole` made NaN and infinite in turn.
template <class Scalar, class Whole, class Check>
void with_each_number_bad(Whole whole, const Check& check) {
  for (Scalar* const number : numbers_of(whole)) {
    const Scalar sound = *number;
    for (const Scalar bad : no_numbers<Scalar>) {
      *number = bad;
      check(whole);
    }
    *number = sound;
  }
}

}  // namespace pinnquad::test
