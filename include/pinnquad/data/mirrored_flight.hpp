// SPDX-License-Identifier: MIT
// A flight as it might as well have been: its mirror image about the vehicle's x-z plane, and the same under another
// heading. No new measurement, but what a network would otherwise have to find out from rows. Not where wind, a side load
// or a crooked vehicle tell left from right or north from east.
#pragma once

#include <stdexcept>
#include <string>

#include "pinnquad/core/random.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/mirror.hpp"

namespace pinnquad {

/// `mirror` exists.
inline Sample mirrored(const Sample& sample, const RotorMirror& mirror) {
  Sample image = sample;
  image.linear_acceleration_m_s2[1] *= -1;
  image.velocity_m_s[1] *= -1;
  for (const int axis : {0, 2}) {
    image.angular_acceleration_rad_s2[axis] *= -1;
    image.body_rates_rad_s[axis] *= -1;
  }
  image.roll_rad *= -1;
  image.yaw_rad *= -1;
  for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
    image.commands[rotor] = sample.commands[static_cast<std::size_t>(mirror.partner[rotor])];
  }
  return image;
}

/// Everything of a sample but the heading is told in the body's frame, or is an altitude: it alone turns.
inline Sample turned(const Sample& sample, double yaw_rad) {
  Sample image = sample;
  image.yaw_rad += yaw_rad;
  return image;
}

namespace detail {
template <class Change>
Flight changed_flight(const Flight& flight, const char* what, const Change& change) {
  if (!flight.columns().empty()) {
    throw std::invalid_argument("flight " + printable(flight.name) + ": what its column " +
                                printable(flight.columns().front().name) + " becomes when it is " + what +
                                " is not known");
  }
  Flight image;
  image.name = flight.name + ", " + what;
  image.trajectory = flight.trajectory;
  image.weight = flight.weight;
  image.reserve(flight.size());
  for (const Sample& sample : flight) image.push_back(change(sample));
  return image;
}
}  // namespace detail

/// Throws std::invalid_argument, one line, for an airframe that is not its own mirror image, and for a flight with extra
/// columns.
template <class Scalar>
Flight mirrored(const Flight& flight, const Airframe<Scalar>& airframe) {
  const RotorMirror mirror = mirror_of(airframe);
  if (!mirror.exists) {
    throw std::invalid_argument(
        "mirrored flight: expected an airframe whose left is as its right, found a rotor without a partner of the "
        "other spin, or products of inertia xy or yz");
  }
  return detail::changed_flight(flight, "mirrored", [&](const Sample& sample) { return mirrored(sample, mirror); });
}

/// Each row under a heading of its own. Features of more than one instant that hold the heading want turned() with one
/// angle instead. Throws std::invalid_argument for a flight with extra columns.
template <class Engine>
Flight turned_at_random(const Flight& flight, Engine& engine) {
  constexpr double pi = 3.14159265358979323846;
  return detail::changed_flight(flight, "turned",
                                [&](const Sample& sample) { return turned(sample, uniform(engine, -pi, pi)); });
}
inline Flight turned(const Flight& flight, double yaw_rad) {
  return detail::changed_flight(flight, "turned", [&](const Sample& sample) { return turned(sample, yaw_rad); });
}

}  // namespace pinnquad
