// SPDX-License-Identifier: MIT
// The numbering of motors: by the convention of a flight stack, or by the places of an airframe's rotors, whatever
// their spin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "pinnquad/dynamics/airframe.hpp"

namespace pinnquad::logs {

/// The corner of each command, first command first.
struct MotorOrder {
  /// Corner of an X quadrotor, seen from above.
  enum Corner : std::uint8_t { front_right, rear_left, front_left, rear_right };

  std::string_view name{};  ///< empty for an order that no convention has
  std::array<Corner, rotor_count> corners{};
};

/// PX4, "Quadrotor x" of its airframe reference: 1 front right, 2 rear left, 3 front left, 4 rear right. The paper's
/// Eq. (2) and the airframes here have it too.
inline constexpr MotorOrder px4_motor_order = {
    "px4", {MotorOrder::front_right, MotorOrder::rear_left, MotorOrder::front_left, MotorOrder::rear_right}};

/// The conventions with a name: PX4's; Betaflight's, QUADX of its mixer documentation, 1 rear right, 2 front right, 3
/// rear left, 4 front left; Crazyflie 2.x's, Bitcraze's documentation, M1..M4 clockwise from the front right.
inline constexpr std::array<MotorOrder, 3> motor_orders = {
    px4_motor_order,
    {"betaflight", {MotorOrder::rear_right, MotorOrder::front_right, MotorOrder::rear_left, MotorOrder::front_left}},
    {"crazyflie", {MotorOrder::front_right, MotorOrder::rear_right, MotorOrder::rear_left, MotorOrder::front_left}}};

/// True for an order in which each corner occurs once.
constexpr bool is_motor_order(const std::array<MotorOrder::Corner, rotor_count>& corners) noexcept {
  unsigned seen = 0;
  for (const MotorOrder::Corner corner : corners) {
    if (static_cast<unsigned>(corner) >= static_cast<unsigned>(rotor_count)) return false;
    seen |= 1u << static_cast<unsigned>(corner);
  }
  return seen == (1u << rotor_count) - 1u;
}

/// The order of that name; `out_of_range`, and `order` untouched, if there is none.
constexpr Status motor_order_named(std::string_view name, MotorOrder& order) noexcept {
  for (const MotorOrder& known : motor_orders) {
    if (known.name == name) {
      order = known;
      return Status::ok;
    }
  }
  return Status::out_of_range;
}

/// The order of an airframe's commands by its rotors' places, with the name of the convention that has it.
/// `out_of_range`, and `order` untouched, where the rotors don't sit one in each corner.
template <class Scalar>
constexpr Status motor_order_of(const Airframe<Scalar>& airframe, MotorOrder& order) noexcept {
  MotorOrder found{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<Scalar>& r = airframe.rotors[i];
    const bool front = r.x_m > Scalar(0), right = r.y_m > Scalar(0);
    if (!((front || r.x_m < Scalar(0)) && (right || r.y_m < Scalar(0)))) return Status::out_of_range;
    found.corners[i] = front ? (right ? MotorOrder::front_right : MotorOrder::front_left)
                             : (right ? MotorOrder::rear_right : MotorOrder::rear_left);
  }
  if (!is_motor_order(found.corners)) return Status::out_of_range;
  for (const MotorOrder& known : motor_orders) {
    bool same = true;
    for (std::size_t i = 0; i < rotor_count; ++i) same = same && known.corners[i] == found.corners[i];
    if (same) found.name = known.name;
  }
  order = found;
  return Status::ok;
}

}  // namespace pinnquad::logs
