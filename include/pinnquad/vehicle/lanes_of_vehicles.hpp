// SPDX-License-Identifier: MIT
// Vehicles into lanes and out of them: a Quadrotor of Lanes is as many vehicles, each with an airframe of its own.
//   using Eight = Lanes<double, 8>;
//   Airframe<Eight> airframes; VehicleState<Eight> states; Commands<Eight> commands;
//   const Quadrotor<Eight, QuadraticDrag> vehicles(airframes);
//   const Outcome<Eight> status = vehicles.step(states, commands, Eight(0.001));   // status.lane(i)
#pragma once

#include "pinnquad/core/lanes.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {
/// Calls `visit` for every number of a vehicle's state, in the order in which it lies in memory.
template <class StateType, class Visit>
PINNQUAD_ALWAYS_INLINE void each_state_number(StateType& state, const Visit& visit) noexcept {
  for (int i = 0; i < 3; ++i) visit(state.body.position_m[i]);
  for (int i = 0; i < 3; ++i) visit(state.body.velocity_m_s[i]);
  visit(state.body.attitude.w);
  visit(state.body.attitude.x);
  visit(state.body.attitude.y);
  visit(state.body.attitude.z);
  for (int i = 0; i < 3; ++i) visit(state.body.body_rates_rad_s[i]);
  for (auto& command : state.rotors) visit(command);
  visit(state.time_s);
  visit(state.charge_used_C);
}
inline constexpr std::size_t state_number_count = 19;
}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// One vehicle's state into a lane.
template <class Scalar, int Count>
PINNQUAD_ALWAYS_INLINE void set_lane(VehicleState<Lanes<Scalar, Count>>& states, int lane,
                                     const VehicleState<Scalar>& state) noexcept {
  double numbers[detail::state_number_count];
  std::size_t k = 0;
  detail::each_state_number(state, [&](const auto& number) noexcept { numbers[k++] = static_cast<double>(number); });
  k = 0;
  detail::each_state_number(states, [&](auto& number) noexcept {
    number.set_lane(lane, static_cast<decltype(number.lane(0))>(numbers[k++]));
  });
}
/// And its commands.
template <class Scalar, int Count>
PINNQUAD_ALWAYS_INLINE void set_lane(Commands<Lanes<Scalar, Count>>& all, int lane,
                                     const Commands<Scalar>& commands) noexcept {
  for (std::size_t i = 0; i < rotor_count; ++i) all[i].set_lane(lane, commands[i]);
}
/// False, and nothing done, for rotors that turn the other way than `all`'s: those lanes share.
template <class Scalar, int Count>
bool set_lane(Airframe<Lanes<Scalar, Count>>& all, int lane, const Airframe<Scalar>& airframe) noexcept {
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (all.rotors[i].spin != airframe.rotors[i].spin) return false;
  }
  Scalar numbers[airframe_number_count];
  std::size_t k = 0;
  each_number(airframe, [&](const auto& number) noexcept { numbers[k++] = static_cast<Scalar>(number); });
  k = 0;
  each_number(all, [&](auto& number) noexcept {
    const Scalar value = numbers[k++];
    if constexpr (!std::is_enum_v<std::decay_t<decltype(number)>>) number.set_lane(lane, value);
  });
  return true;
}

/// The same airframe in every lane.
template <class LanesType>
Airframe<LanesType> in_every_lane(const Airframe<typename LanesType::Scalar>& airframe) noexcept {
  Airframe<LanesType> all;
  for (std::size_t i = 0; i < rotor_count; ++i) all.rotors[i].spin = airframe.rotors[i].spin;
  for (int lane = 0; lane < LanesType::count; ++lane) set_lane(all, lane, airframe);
  return all;
}

/// The state of one lane.
template <class Scalar, int Count>
PINNQUAD_ALWAYS_INLINE VehicleState<Scalar> lane_of(const VehicleState<Lanes<Scalar, Count>>& states,
                                                    int lane) noexcept {
  VehicleState<Scalar> state;
  double numbers[detail::state_number_count];
  std::size_t k = 0;
  detail::each_state_number(
      states, [&](const auto& number) noexcept { numbers[k++] = static_cast<double>(number.lane(lane)); });
  k = 0;
  detail::each_state_number(
      state, [&](auto& number) noexcept { number = static_cast<std::decay_t<decltype(number)>>(numbers[k++]); });
  return state;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
