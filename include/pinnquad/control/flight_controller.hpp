// SPDX-License-Identifier: MIT
// A cascaded flight controller: position -> velocity -> attitude -> body rates, all proportional, without memory.
// Its output are the accelerations wanted; any inverse of the dynamics turns them into commands.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "pinnquad/control/flatness.hpp"
#include "pinnquad/dynamics/rigid_body.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad {

/// Gains of the cascade, each loop slower than the one inside it. The defaults are moderate: a tracking error of 10 cm
/// asks for 0.54 m/s^2.
template <class Scalar>
struct FlightGains {
  Scalar position_1_s = Scalar(1.8);        ///< velocity wanted per position error
  Scalar velocity_1_s = Scalar(3);          ///< acceleration wanted per velocity error
  Scalar tilt_1_s = Scalar(9);              ///< body rate wanted per attitude error, roll and pitch
  Scalar yaw_1_s = Scalar(3);               ///< the same for yaw, where rotors have little torque
  Scalar roll_pitch_rate_1_s = Scalar(22);  ///< angular acceleration wanted per body rate error
  Scalar yaw_rate_1_s = Scalar(8);          ///< the same for yaw
};

/// Limits of the demand: on the specific force (thrust / mass, NED), on turning, and on the speed of a trajectory's
/// point and the position error together. Without a speed limit, the default, a vehicle far from its place arrives
/// faster than it can stop.
template <class Scalar>
struct FlightLimits {
  Scalar max_tilt_rad = Scalar(0.85);  ///< of the thrust wanted, 49 degrees
  Scalar max_horizontal_acceleration_m_s2 = Scalar(9);
  Scalar min_vertical_specific_force_m_s2 = Scalar(3.5);  ///< above free fall: attitude needs thrust
  Scalar max_specific_force_m_s2 = Scalar(17);
  Scalar max_roll_pitch_rate_rad_s = Scalar(4);  ///< of what an attitude error asks for
  Scalar max_roll_pitch_acceleration_rad_s2 = Scalar(100);
  Scalar max_yaw_acceleration_rad_s2 = Scalar(4);
  Scalar max_horizontal_speed_m_s = std::numeric_limits<Scalar>::max();
  Scalar max_climb_m_s = std::numeric_limits<Scalar>::max();
  Scalar max_descent_m_s = std::numeric_limits<Scalar>::max();
};

namespace detail {

/// Thrust without torque over weight, and the greatest angular acceleration about each axis, no rotor moved by more
/// than hover leaves it.
template <class Scalar>
struct Authority {
  Scalar thrust_to_weight{0};
  std::array<Scalar, 3> angular_acceleration_rad_s2{};
};

template <class Scalar>
Authority<Scalar> authority(const Airframe<Scalar>& airframe, Scalar rotor_scale) noexcept {
  Authority<Scalar> result;
  const auto left = [](Scalar hover) noexcept { return hover < Scalar(1) - hover ? hover : Scalar(1) - hover; };
  const Rotors<Scalar> rotors(airframe);
  if (rotors.balanced() && has_diagonal_inertia(airframe)) {  // all rotors reach their ends together
    result.thrust_to_weight = airframe.thrust_to_weight() * rotor_scale;
    const Scalar each = left(Scalar(1) / result.thrust_to_weight);
    const AllocationMatrix<Scalar> matrix = allocation(airframe);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Scalar& most = result.angular_acceleration_rad_s2[axis];
      for (const Scalar entry : matrix[axis + 1]) most += entry < Scalar(0) ? -entry : entry;
      most *= each * rotor_scale / airframe.inertia_kg_m2[axis];
    }
    return result;
  }
  const Scalar weight_N = airframe.mass_kg * standard_gravity_m_s2<Scalar>;
  ThrustFractions<Scalar> hover = rotors.fractions_of_pure_thrust_1_N();
  Scalar greatest(0);
  for (Scalar& fraction : hover) {
    fraction *= weight_N / rotor_scale;
    if (fraction > greatest) greatest = fraction;
  }
  result.thrust_to_weight = Scalar(1) / greatest;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vector3<Scalar> acceleration = Vector3<Scalar>::Zero();
    acceleration[static_cast<int>(axis)] = Scalar(1);
    Wrench<Scalar> turning;
    turning.torque_N_m = inertia_times(airframe, acceleration);
    const ThrustFractions<Scalar> moved = rotors.fractions_for(turning, rotor_scale);
    Scalar most = std::numeric_limits<Scalar>::max();
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const Scalar by = moved[i] < Scalar(0) ? -moved[i] : moved[i];
      if (left(hover[i]) < most * by) most = left(hover[i]) / by;
    }
    result.angular_acceleration_rad_s2[axis] = most;
  }
  return result;
}

}  // namespace detail

/// The default limits, lowered to the airframe's at a thrust scale (Quadrotor::rotor_scale): 97 % of the thrust at
/// which the first rotor is at its end; 55 % of the horizontal acceleration that this leaves in level flight; angular
/// accelerations that move a rotor by 60 % (roll, pitch) and 40 % (yaw) of what hover leaves it; body rates that the
/// attitude loop can stop.
template <class Scalar>
FlightLimits<Scalar> flight_limits(const Airframe<Scalar>& airframe, Scalar rotor_scale,
                                   const FlightGains<Scalar>& gains = {}) noexcept {
  using std::sqrt;
  const auto lower = [](Scalar& limit, Scalar value) noexcept {
    if (value < limit) limit = value;
  };
  FlightLimits<Scalar> limits{};
  const auto [thrust_to_weight, most] = detail::authority(airframe, rotor_scale);
  lower(limits.max_specific_force_m_s2, Scalar(0.97) * thrust_to_weight * standard_gravity_m_s2<Scalar>);
  const Scalar spare = thrust_to_weight * thrust_to_weight - Scalar(1);
  lower(limits.max_horizontal_acceleration_m_s2,
        Scalar(0.55) * standard_gravity_m_s2<Scalar> * sqrt(spare > Scalar(0) ? spare : Scalar(0)));
  lower(limits.max_roll_pitch_acceleration_rad_s2, Scalar(0.6) * (most[0] < most[1] ? most[0] : most[1]));
  lower(limits.max_yaw_acceleration_rad_s2, Scalar(0.4) * most[2]);
  lower(limits.max_roll_pitch_rate_rad_s, limits.max_roll_pitch_acceleration_rad_s2 / gains.tilt_1_s);
  return limits;
}

/// A pilot's demand: a velocity, a yaw rate, and the sticks' own part of the body rates.
template <class Scalar>
struct SetPoint {
  Vector3<Scalar> velocity_m_s = Vector3<Scalar>::Zero();  ///< NED
  Scalar yaw_rate_rad_s = Scalar(0);                       ///< about world down
  Vector3<Scalar> stick_rad_s = Vector3<Scalar>::Zero();   ///< added to the body rates wanted, FRD
};

/// Linear and angular acceleration wanted of a state and a set point, NED and FRD, SI units. Outputs are untouched
/// where the status is not ok.
template <class Scalar>
class FlightController {
 public:
  explicit constexpr FlightController(const FlightGains<Scalar>& gains = {}, const FlightLimits<Scalar>& limits = {},
                                      Scalar gravity_m_s2 = standard_gravity_m_s2<Scalar>) noexcept
      : gains_(gains), limits_(limits), gravity_m_s2_(gravity_m_s2) {}

  constexpr const FlightLimits<Scalar>& limits() const noexcept { return limits_; }
  constexpr Scalar gravity_m_s2() const noexcept { return gravity_m_s2_; }

  /// Pilot's loop: the accelerations that bring the vehicle to the velocity and yaw rate wanted; yaw itself is free.
  /// `not_finite` for a bad input, `output_not_finite` for one so large that a sum overflows; `demand` is untouched
  /// unless the Status is ok.
  Status operator()(const State<Scalar>& state, const SetPoint<Scalar>& wanted,
                    Accelerations<Scalar>& demand) const noexcept {
    if (!(all_finite(state) && all_finite(wanted.velocity_m_s) && is_finite(wanted.yaw_rate_rad_s) &&
          all_finite(wanted.stick_rad_s))) {
      return Status::not_finite;
    }
    const Vector3<Scalar> acceleration = limited((wanted.velocity_m_s - state.velocity_m_s) * gains_.velocity_1_s);
    Quaternion<Scalar> error;
    const Status status = attitude_error(state, acceleration, heading(state.attitude), error);
    if (status != Status::ok) return status;
    const Vector3<Scalar> turn =
        world_to_body<Scalar>(state.attitude, Vector3<Scalar>(Scalar(0), Scalar(0), wanted.yaw_rate_rad_s));
    const Accelerations<Scalar> asked{body_derivative(state, acceleration),
                                      angular_feedback(state, error, turn + wanted.stick_rad_s)};
    if (!(all_finite(asked.linear_m_s2) && all_finite(asked.angular_rad_s2))) return Status::output_not_finite;
    demand = asked;
    return Status::ok;
  }

  /// Trajectory loop: the question that an inverse is asked, the same in loops and in flight stacks. `demand` is the
  /// motion of the point (acceleration and jerk within the limits, angular accelerations from jerk and snap) and the
  /// feedback of position, velocity, attitude and body rate errors together. Rotors make no lateral force: along body x
  /// and y it is the acceleration of a vehicle that feels none. `feedback`: its share of the demand, for what
  /// integrates it. Yaw follows the trajectory. Speed within the limits, where there are any.
  /// `not_finite`, `no_solution` (flatness.hpp), `output_not_finite`; both are untouched unless the Status is ok.
  Status operator()(const State<Scalar>& state, TrajectoryPoint<Scalar> point, Accelerations<Scalar>& demand,
                    Accelerations<Scalar>& feedback) const noexcept {
    using std::cos;
    using std::sin;
    if (!(all_finite(state) && all_finite(point.position_m) && all_finite(point.velocity_m_s))) {
      return Status::not_finite;
    }
    point.acceleration_m_s2 = limited(point.acceleration_m_s2);
    point.jerk_m_s3 = limited_jerk(point.jerk_m_s3, point.acceleration_m_s2);
    FlatMotion<Scalar> flat;
    Status status = flat_motion(point, gravity_m_s2_, flat);
    if (status != Status::ok) return status;
    const Vector3<Scalar> velocity = wanted_velocity(point.velocity_m_s, point.position_m - state.position_m);
    const Vector3<Scalar> acceleration =
        limited(point.acceleration_m_s2 + (velocity - state.velocity_m_s) * gains_.velocity_1_s);
    Quaternion<Scalar> error;
    status = attitude_error(state, acceleration, Heading<Scalar>{sin(point.yaw_rad), cos(point.yaw_rad)}, error);
    if (status != Status::ok) return status;
    // `error` also turns vectors from the axes of the attitude wanted into those of the body
    Accelerations<Scalar> asked, corrected;
    corrected.linear_m_s2 = world_to_body<Scalar>(state.attitude, acceleration - point.acceleration_m_s2);
    corrected.angular_rad_s2 = angular_feedback(state, error, body_to_world(error, flat.body_rates_rad_s));
    asked.linear_m_s2 = body_derivative<Scalar>(state, {Scalar(0), Scalar(0), gravity_m_s2_});
    asked.linear_m_s2[2] = body_derivative(state, point.acceleration_m_s2)[2] + corrected.linear_m_s2[2];
    asked.angular_rad_s2 =
        limited_turn(body_to_world(error, flat.angular_acceleration_rad_s2) + corrected.angular_rad_s2);
    if (!(all_finite(asked.linear_m_s2) && all_finite(asked.angular_rad_s2) && all_finite(corrected.linear_m_s2) &&
          all_finite(corrected.angular_rad_s2))) {
      return Status::output_not_finite;
    }
    demand = asked;
    feedback = corrected;
    return Status::ok;
  }

  /// The velocity (NED) that closes a position error e: the point's velocity plus k e, k = position_1_s. Under a speed
  /// limit no more than 0.4 of the acceleration limit a can brake: sqrt(2 a (e - a / (2 k^2))) beyond e = a / k^2.
  Vector3<Scalar> wanted_velocity(const Vector3<Scalar>& reference_m_s, const Vector3<Scalar>& error_m) const noexcept {
    using std::sqrt;
    Vector3<Scalar> approach = error_m * gains_.position_1_s;
    constexpr Scalar none = std::numeric_limits<Scalar>::max(), brakes = Scalar(0.4);
    if (limits_.max_horizontal_speed_m_s < none) {
      const Scalar far = sqrt(error_m[0] * error_m[0] + error_m[1] * error_m[1]);
      const Scalar asked = gains_.position_1_s * far;
      const Scalar most = stoppable(far, brakes * limits_.max_horizontal_acceleration_m_s2);
      if (most < asked) shorten(approach, most);
    }
    const bool up = error_m[2] < Scalar(0);
    if ((up ? limits_.max_climb_m_s : limits_.max_descent_m_s) < none) {
      const Scalar far = up ? -error_m[2] : error_m[2];
      const Scalar most_brake = up ? gravity_m_s2_ - limits_.min_vertical_specific_force_m_s2
                                   : limits_.max_specific_force_m_s2 - gravity_m_s2_;
      const Scalar most = stoppable(far, brakes * most_brake);
      if (most < gains_.position_1_s * far) approach[2] = up ? -most : most;
    }
    Vector3<Scalar> result = reference_m_s + approach;
    shorten(result, limits_.max_horizontal_speed_m_s);
    if (result[2] > limits_.max_descent_m_s) result[2] = limits_.max_descent_m_s;
    if (result[2] < -limits_.max_climb_m_s) result[2] = -limits_.max_climb_m_s;
    return result;
  }

  /// The acceleration (NED) within the limits: the vertical part first, then as much of the horizontal as thrust and
  /// tilt leave.
  Vector3<Scalar> limited(const Vector3<Scalar>& acceleration_m_s2) const noexcept {
    using std::sqrt;
    using std::tan;
    Scalar up = gravity_m_s2_ - acceleration_m_s2[2];
    if (up > limits_.max_specific_force_m_s2) up = limits_.max_specific_force_m_s2;
    if (up < limits_.min_vertical_specific_force_m_s2) up = limits_.min_vertical_specific_force_m_s2;
    const Scalar left = limits_.max_specific_force_m_s2 * limits_.max_specific_force_m_s2 - up * up;
    Scalar most = sqrt(left > Scalar(0) ? left : Scalar(0));
    const Scalar most_by_tilt = up * tan(limits_.max_tilt_rad);
    if (most > most_by_tilt) most = most_by_tilt;
    if (most > limits_.max_horizontal_acceleration_m_s2) most = limits_.max_horizontal_acceleration_m_s2;
    const Scalar north = acceleration_m_s2[0], east = acceleration_m_s2[1];
    const Scalar horizontal = sqrt(north * north + east * east);
    const Scalar scale = horizontal > most ? most / horizontal : Scalar(1);
    return Vector3<Scalar>(north * scale, east * scale, gravity_m_s2_ - up);
  }

 private:
  /// The jerk (NED) beside a limited acceleration: it turns the thrust no faster than an attitude error may, so that
  /// feedback can hold against a wrong one.
  Vector3<Scalar> limited_jerk(const Vector3<Scalar>& jerk_m_s3,
                               const Vector3<Scalar>& acceleration_m_s2) const noexcept {
    using std::sqrt;
    const Vector3<Scalar> force = acceleration_m_s2 - Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2_);
    const Scalar most = limits_.max_roll_pitch_rate_rad_s * limits_.max_roll_pitch_rate_rad_s * force.squaredNorm();
    const Scalar asked = jerk_m_s3.squaredNorm();
    if (!(asked > most)) return jerk_m_s3;
    return jerk_m_s3 * sqrt(most / asked);
  }

  /// The angular acceleration (FRD) within the limits: roll and pitch by one share, yaw by its own.
  Vector3<Scalar> limited_turn(const Vector3<Scalar>& acceleration_rad_s2) const noexcept {
    Vector3<Scalar> result = acceleration_rad_s2;
    shorten(result, limits_.max_roll_pitch_acceleration_rad_s2);
    const Scalar most = limits_.max_yaw_acceleration_rad_s2;
    if (result[2] > most) result[2] = most;
    if (result[2] < -most) result[2] = -most;
    return result;
  }

  /// The speed at this distance from which the position loop stops with no more than this deceleration.
  Scalar stoppable(Scalar far_m, Scalar deceleration_m_s2) const noexcept {
    using std::sqrt;
    const Scalar a = deceleration_m_s2 > Scalar(0.1) ? deceleration_m_s2 : Scalar(0.1);
    const Scalar knee = a / (gains_.position_1_s * gains_.position_1_s);
    if (!(far_m > knee)) return gains_.position_1_s * far_m;
    return sqrt(Scalar(2) * a * (far_m - Scalar(0.5) * knee));
  }

  /// Rotation from the attitude that points the thrust along `acceleration` - gravity, into the current one.
  Status attitude_error(const State<Scalar>& state, const Vector3<Scalar>& acceleration, const Heading<Scalar>& yaw,
                        Quaternion<Scalar>& error) const noexcept {
    if (!all_finite(acceleration)) return Status::output_not_finite;  // of finite inputs: a sum has overflowed
    Matrix<Scalar, 3, 3> axes;
    const Vector3<Scalar> force = acceleration - Vector3<Scalar>(Scalar(0), Scalar(0), gravity_m_s2_);
    const Status status = body_axes(force, yaw, axes);
    if (status != Status::ok) return status;
    error = conjugate(state.attitude) * from_rotation_matrix(axes);
    return Status::ok;
  }

  /// Attitude and body rate loops: angular acceleration, body.
  Vector3<Scalar> angular_feedback(const State<Scalar>& state, const Quaternion<Scalar>& error,
                                   const Vector3<Scalar>& reference_rates) const noexcept {
    const Scalar two(error.w < Scalar(0) ? -2 : 2);  // the short way round
    Vector3<Scalar> turn(gains_.tilt_1_s * two * error.x, gains_.tilt_1_s * two * error.y, Scalar(0));
    shorten(turn, limits_.max_roll_pitch_rate_rad_s);
    turn[2] = gains_.yaw_1_s * two * error.z;
    const Vector3<Scalar> rate_error = reference_rates + turn - state.body_rates_rad_s;
    Vector3<Scalar> wanted = rate_error * gains_.roll_pitch_rate_1_s;
    wanted[2] = gains_.yaw_rate_1_s * rate_error[2];
    return limited_turn(wanted);
  }

  /// Shortens the (x, y) part to a length; its direction stays.
  static void shorten(Vector3<Scalar>& v, Scalar most) noexcept {
    using std::sqrt;
    const Scalar length = sqrt(v[0] * v[0] + v[1] * v[1]);
    if (length > most) {
      v[0] *= most / length;
      v[1] *= most / length;
    }
  }

  FlightGains<Scalar> gains_;
  FlightLimits<Scalar> limits_;
  Scalar gravity_m_s2_;
};

}  // namespace pinnquad
