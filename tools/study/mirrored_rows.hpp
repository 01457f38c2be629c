// SPDX-License-Identifier: MIT
// Rows of a training beside their mirror images about the vehicle's x-z plane, or under other headings: a loss then
// asks for the symmetry. Not where wind, a side load or a crooked vehicle tell left from right or north from east.
#pragma once

#include <memory>
#include <stdexcept>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/core/scalar_math.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/airframe.hpp"

namespace study {

using pinnquad::Flight, pinnquad::FlightRows, pinnquad::RotorMount, pinnquad::RowSet, pinnquad::Sample;
using pinnquad::rotor_count;

/// partner[i]: the rotor that rotor i becomes.
struct RotorMirror {
  std::array<int, rotor_count> partner{};
  bool exists = false;  ///< false: the vehicle is crooked, and `partner` means nothing
};

namespace detail {
template <class Scalar>
bool close_to(Scalar a, Scalar b, Scalar tolerance) noexcept {
  return a - b <= tolerance && b - a <= tolerance;
}
}  // namespace detail

/// Places to a millimetre's tenth, axes and scales to a thousandth, products of inertia to a thousandth of the moments.
template <class Scalar>
RotorMirror mirror_of(const pinnquad::Airframe<Scalar>& airframe) noexcept {
  const Scalar place = Scalar(1e-4), share = Scalar(1e-3);
  RotorMirror mirror;
  const auto& [xy, xz, yz] = airframe.inertia_products_kg_m2;
  static_cast<void>(xz);
  const Scalar size = share * (airframe.inertia_kg_m2[0] + airframe.inertia_kg_m2[1]);
  mirror.exists = detail::close_to(xy, Scalar(0), size) && detail::close_to(yz, Scalar(0), size);
  for (std::size_t i = 0; i < rotor_count; ++i) {
    const RotorMount<Scalar>& one = airframe.rotors[i];
    int found = -1;
    for (std::size_t k = 0; k < rotor_count; ++k) {
      const RotorMount<Scalar>& other = airframe.rotors[k];
      const bool same = detail::close_to(one.x_m, other.x_m, place) && detail::close_to(one.y_m, -other.y_m, place) &&
                        detail::close_to(one.z_m, other.z_m, place) && one.spin != other.spin &&
                        detail::close_to(one.axis[0], other.axis[0], share) &&
                        detail::close_to(one.axis[1], -other.axis[1], share) &&
                        detail::close_to(one.axis[2], other.axis[2], share) &&
                        detail::close_to(one.thrust_scale, other.thrust_scale, share) &&
                        detail::close_to(one.thrust_curve, other.thrust_curve, share) &&
                        detail::close_to(airframe.rise_time_constant_s(i), airframe.rise_time_constant_s(k), share) &&
                        detail::close_to(airframe.fall_time_constant_s(i), airframe.fall_time_constant_s(k), share);
      if (same) found = static_cast<int>(k);
    }
    mirror.exists = mirror.exists && found >= 0;
    mirror.partner[i] = found;
  }
  return mirror;
}

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

/// Everything else of a sample is in the body's frame, or is an altitude.
inline Sample turned(const Sample& sample, double yaw_rad) {
  Sample image = sample;
  image.yaw_rad += yaw_rad;
  return image;
}

namespace detail {
template <class Change>
Flight changed_flight(const Flight& flight, const char* what, const Change& change) {
  if (!flight.columns().empty()) {
    throw std::invalid_argument("flight " + pinnquad::printable(flight.name) + ": what its column " +
                                pinnquad::printable(flight.columns().front().name) + " becomes when it is " + what +
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

/// Throws std::invalid_argument, one line, for an airframe that is not its own mirror image, and for a flight with
/// extra columns.
template <class Scalar>
Flight mirrored(const Flight& flight, const pinnquad::Airframe<Scalar>& airframe) {
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
  return detail::changed_flight(flight, "turned", [&](const Sample& sample) {
    return turned(sample, pinnquad::uniform(engine, -pinnquad::pi, pinnquad::pi));
  });
}
inline Flight turned(const Flight& flight, double yaw_rad) {
  return detail::changed_flight(flight, "turned", [&](const Sample& sample) { return turned(sample, yaw_rad); });
}

struct Symmetries {
  bool mirrored = true;  ///< each row once more as its mirror image
  bool turned = false;   ///< each of these once more under a heading drawn at random
};

/// Owns the copies; what it was made of must outlive it. The rows come first, in their order.
class SymmetricRows {
 public:
  /// Throws what mirrored() and turned_at_random() throw.
  template <class Scalar, class Engine>
  SymmetricRows(const RowSet& rows, const pinnquad::Airframe<Scalar>& airframe, const Symmetries& which, Engine& engine)
      : rows_(rows) {
    if (which.mirrored) add(rows, [&](const Flight& flight) { return study::mirrored(flight, airframe); });
    if (which.turned) add(RowSet(rows_), [&](const Flight& flight) { return turned_at_random(flight, engine); });
  }

  const RowSet& rows() const noexcept { return rows_; }

 private:
  template <class Change>
  void add(const RowSet& rows, const Change& change) {
    for (const FlightRows& piece : rows.pieces()) {
      copies_.push_back(std::make_unique<Flight>(change(*piece.flight)));
      rows_.add(*copies_.back(), piece.rows);
    }
  }

  RowSet rows_;
  std::vector<std::unique_ptr<Flight>> copies_;
};

}  // namespace study
