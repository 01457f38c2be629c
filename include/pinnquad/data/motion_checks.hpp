// SPDX-License-Identifier: MIT
// Checks of a flight by its motion, not by the range of its columns: the attitude turns by the body rates, the velocity
// changes by the acceleration, the altitude by the velocity, rates by their derivative (motion_pair.hpp). In radians
// throughout the turning over the integral of the rates is 1, with one of them in degrees 57.3 or 1 / 57.3; a column
// that is negated, exchanged with another or late goes against it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/motion_pair.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad {

namespace detail {

/// A value that cannot be, or a whole column that is wrong.
struct Implausible {
  std::size_t row = 0;    ///< from 0
  std::size_t field = 0;  ///< index in `sample_field_names`
  std::string expected;   ///< "the derivative of w_x"
  std::string found;      ///< "that of w_y negated"
};

/// Steps of the checks: over 0.2 s a measured attitude turns, from row to row it jitters.
inline constexpr double turning_step_s = 0.2, acceleration_step_s = 0.04;
/// Another reading of columns is asked where as they stand they agree less than this, and believed where it leaves a
/// third of what they leave, and agrees by half.
inline constexpr double agrees = 0.85, related = 0.5, far_better = 1.0 / 3;
/// Two that agree as well are not late, and their derivatives not of other angles, which are nearly the body's rates
/// where angles are small.
inline constexpr double in_time = 0.97;

inline constexpr std::size_t linear_field = 1, angular_field = 4, velocity_field = 7, rates_field = 10,
                             angles_field = 13, altitude_field = 16;
std::string field_name(std::size_t first, Eigen::Index axis);

inline std::string hundredths(double value) { return number_text(std::round(100 * value) / 100); }

inline std::string late_text(double late_s) { return number_text(std::round(std::abs(late_s) * 1e3)) + " ms late"; }

/// Units and axes that a log may have in place of a flight's: which of roll, pitch and yaw are in degrees, the unit of
/// the rates, and what these are.
struct TurningReading {
  enum Rates {
    of_body,
    of_world,
    of_enu_world,
    of_world_as_flu,
    of_enu_world_as_flu,
    of_flu_body,
    of_angles,
    of_angles_as_flu,
    reversed
  };
  std::array<bool, 3> degrees{};
  double rates_unit = 1;
  Rates rates = of_body;
};
inline constexpr std::array<const char*, 9> turning_rate_texts = {
    "",
    "rates in the world's axes (turn them by the attitude into the body, R^T w, or log the gyro)",
    "rates in the world's axes east, north, up (turn them into the body)",
    "rates in the world's axes, read as x forward, y left, z up (turn them by the attitude into the body)",
    "rates in the world's axes east, north, up, read as x forward, y left, z up (turn them into the body)",
    "rates in x forward, y left, z up (w_y and w_z are negated, or pitch and yaw)",
    "derivatives of roll, pitch and yaw (turn them into p, q, r)",
    "derivatives of roll, pitch and yaw, the latter two negated (turn them into p, q, r)",
    "rates that the attitude turns against: it is that of the world in the body (conjugate the quaternion), or all "
    "rates are negated"};

/// The reading of a flight's columns under which two series agree far better than as they stand.
class BestReading {
 public:
  explicit BestReading(const MotionBlocks& sums)
      : sums_(sums), moving_(sums.moving()), as_it_stands_(sums.agreement(moving_)), most_(as_it_stands_) {}

  double as_it_stands() const noexcept { return as_it_stands_; }
  /// Takes a reading that is better than those before it, and agrees by more than `enough`.
  bool takes(const MotionBlocks& read, double enough = related);
  bool found() const noexcept { return most_ > as_it_stands_; }
  /// "; agreement 0.31 as it stands, 0.98 so"
  std::string evidence() const;

 private:
  const MotionBlocks& sums_;
  std::array<bool, 3> moving_;
  double as_it_stands_, most_;
};

EulerAngles<double> angles_of(const Sample& sample);

/// Rotation vector of a turn, the shorter way.
Vector3<double> turn_vector(const Quaternion<double>& q);

/// Attitude of each row, from its Euler angles.
std::vector<Quaternion<double>> attitudes_of(const Flight& flight);

/// The turning of the attitude from row to row, as logged rates would integrate to it if a log is to be read so, over
/// steps of `turning_step_s`. `attitude`: attitudes_of() the flight.
MotionBlocks turning_sums(const Flight& flight, const std::vector<Quaternion<double>>& attitude,
                          const TurningReading& reading = {});

/// Compares, over steps of 0.2 s, the turning of the attitude with the integral of the body rates. A mistake where a
/// rate stands still that should not; where the two agree far better with some of them in degrees, or with rates of
/// other axes; where a rate follows another axis, or its own negated; where one of the two is late by 0.1 s or more.
/// Limits: a flight that hardly turns, noise and gaps in time decide nothing; angles and rates share the blame.
/// `attitude`: attitudes_of() the flight.
std::optional<Implausible> find_turning_mistake(const Flight& flight, const std::vector<Quaternion<double>>& attitude);

/// A vector that was read in axes of a kind, in the axes that it should have been read in: 0 as it stands; 1 ENU for
/// NED; 2 x forward, y left, z up for FRD; 3 and 4 both, in either order.
inline constexpr std::size_t axes_kinds = 5;
Vector3<double> in_axes(const Vector3<double>& v, std::size_t kind);

/// A reading of the columns that should hold the derivative of the body-frame velocity.
struct AccelerationReading {
  enum Kind { kinematic, without_turning, world_derivative, world, world_force, no_gravity, accelerometer };
  Kind kind = kinematic;
  std::size_t axes = 0;  ///< of a vector of the world: axes_kinds

  std::string text() const {
    const std::string in_world = axes == 0   ? " in axes north, east, down"
                                 : axes == 1 ? " in axes east, north, up"
                                             : " in axes of another convention (ENU, or z up)";
    switch (kind) {
      case without_turning: return "the world's acceleration in the body's axes (subtract w x v)";
      case world_derivative:
      case world: return "the world's acceleration" + in_world + " (turn it into the body, subtract w x v)";
      case world_force: return "the specific force" + in_world + " of the world (turn it into the body)";
      case no_gravity: return "that with gravity added once too often (an accelerometer's without gravity?)";
      case accelerometer: return "what an accelerometer reads (add gravity in the body's axes, subtract w x v)";
      case kinematic: break;
    }
    return "";
  }

  /// A row as every reading takes it.
  struct Row {
    Vector3<double> velocity, given, turning;  ///< of the columns; omega x v
    Quaternion<double> attitude;

    Row(const Sample& sample, const Quaternion<double>& q)
        : velocity(sample.velocity_m_s),
          given(sample.linear_acceleration_m_s2),
          turning(cross(sample.body_rates_rad_s, sample.velocity_m_s)),
          attitude(q) {}
  };

  Vector3<double> body_derivative(const Row& row) const {
    const Vector3<double>&given = row.given, &turning = row.turning;
    const Quaternion<double>& q = row.attitude;
    const bool falls = kind == world_force || kind == no_gravity || kind == accelerometer;
    const Vector3<double> gravity =
        falls ? world_to_body(q, Vector3<double>(0, 0, standard_gravity_m_s2<double>)) : Vector3<double>::Zero();
    switch (kind) {
      case without_turning: return given - turning;
      case world_derivative: return world_to_body(q, in_axes(given, axes)) - turning;
      case world: return world_to_body(q, in_axes(given + turning, axes)) - turning;
      case world_force: return world_to_body(q, in_axes(given + turning - gravity, axes)) + gravity - turning;
      case no_gravity: return given - gravity;
      case accelerometer: return given + gravity - turning;
      case kinematic: break;
    }
    return given;
  }
};

/// How the velocity in the world, and its derivative, come from a flight's columns.
struct VelocityReading {
  int turns = 1;  ///< by the attitude: 0 of columns in the world's axes, 2 of what was turned once too often
  std::size_t of_columns = 0;  ///< in_axes() before the first turn
  std::size_t of_world = 0;    ///< and after it
  AccelerationReading acceleration = {};

  Vector3<double> in_world(const Vector3<double>& column, const Quaternion<double>& attitude) const;
};
/// Changes of the velocity in the world against the world's acceleration, both of the body's columns, over steps of
/// `turning_step_s`. `attitude`: attitudes_of() the flight.
MotionBlocks world_velocity_sums(const Flight& flight, const std::vector<Quaternion<double>>& attitude,
                                 const VelocityReading& reading = {});

/// Correlates, over steps of 0.04 s or of a row, the change of each body rate and velocity with the integral of each
/// acceleration. A mistake where a column follows another axis, or its own negated, by 0.25 better than its own; where
/// it follows its own in another unit; where vdot leaves 0.3 or more of the change of v unexplained, and another
/// meaning of it less than a quarter of that. Over steps of 0.2 s, in the world's axes: a velocity that is negated
/// along one of them, in another unit or late; an altitude that goes against the velocity.
/// Measured, correlation of a column with its own axis, and most with another: the paper's flights above 0.88 and 0.17,
/// the independent simulator's above 0.97 and 0.12, real logs above 0.73 and 0.45 (or 1.00 and 0.8); under gyro noise
/// that drowns the motion 0 and 0.03.
/// Limits: a column that noise drowns, an axis that hardly moves and a flight of few rows decide nothing.
std::optional<Implausible> find_acceleration_mistake(const Flight& flight,
                                                     const std::vector<Quaternion<double>>& attitude);

}  // namespace detail
}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/motion_checks.hpp"
#endif
