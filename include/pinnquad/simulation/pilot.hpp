// SPDX-License-Identifier: MIT
// A pilot is a policy: what he asks of the flight controller, tick by tick.
// Contract: `SetPoint<double> operator()(const State<double>& state, double time_s)`, called in time order.
#pragma once

#include <type_traits>

#include "pinnquad/control/flight_controller.hpp"

namespace pinnquad {

namespace detail {
template <class Pilot, class = void>
struct IsPilot : std::false_type {};
template <class Pilot>
struct IsPilot<Pilot, std::void_t<decltype(std::declval<Pilot&>()(std::declval<const State<double>&>(), 0.0))>>
    : std::is_same<SetPoint<double>, decltype(std::declval<Pilot&>()(std::declval<const State<double>&>(), 0.0))> {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class Pilot>
inline constexpr bool is_pilot = detail::IsPilot<Pilot>::value;

/// Asks for the same all the time; by default for a hover.
struct SteadyPilot {
  SetPoint<double> set_point{};

  SetPoint<double> operator()(const State<double>& /*state*/, double /*time_s*/) const { return set_point; }
};

}  // namespace pinnquad
