// SPDX-License-Identifier: MIT
// Parts of a motion as feature sets to be joined: Joined<SpecificForce, AngularAcceleration, BodyRates> is one. Forces
// and torques depend on them directly; a network would have to find them in velocities and Euler angles. Body frame
// FRD. An input that is not finite makes a feature of each part that depends on it not finite.
#pragma once

#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/features/extra_columns.hpp"

namespace pinnquad {

namespace detail {

/// A part of three features: all but `names`, `units` and `of(inputs)`, the three, or an extract() of its own where a
/// vector in between would lie on the stack beside the network's numbers.
template <class Part>
struct MotionPart {
  template <class Scalar>
  using Inputs = MotionInputs<Scalar>;
  static constexpr int size = 3;
  static constexpr int angular_acceleration = -1;

  /// As PaperFeatures: of all inputs, whatever the part reads.
  template <class Scalar>
  static Status check(const MotionInputs<Scalar>& in) noexcept {
    return PaperFeatures::check<Scalar>(in);
  }
  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& in, Scalar* x) noexcept {
    const Vector3<Scalar>& values = Part::template of<Scalar>(in);
    for (int i = 0; i < 3; ++i) x[i] = values[i];
  }
};

template <class Part>
inline constexpr bool is_motion_part = std::is_base_of_v<MotionPart<Part>, Part>;

}  // namespace detail

/// The reading of an accelerometer: the sum of all forces but gravity over the mass. s = v_dot + omega x v - R^T g.
/// Hovering it is (0, 0, -g) whatever the heading; a wind is in it, the frame's turning is not.
struct SpecificForce : detail::MotionPart<SpecificForce> {
  static constexpr std::array<const char*, 3> names = {"s_x", "s_y", "s_z"};
  static constexpr std::array<const char*, 3> units = {"m/s^2", "m/s^2", "m/s^2"};

  template <class Scalar>
  static Vector3<Scalar> of(const MotionInputs<Scalar>& in) noexcept {
    const Vector3<Scalar> turning = cross<Scalar>(in.body_rates_rad_s, in.velocity_m_s);
    const Vector3<Scalar> down = world_down_axis(in.attitude);
    return in.linear_acceleration_m_s2 + turning - standard_gravity_m_s2<Scalar> * down;
  }
};

/// Derivative of the body rates, FRD, rad/s^2.
struct AngularAcceleration : detail::MotionPart<AngularAcceleration> {
  static constexpr int angular_acceleration = 0;
  static constexpr std::array<const char*, 3> names = {"wdot_x", "wdot_y", "wdot_z"};
  static constexpr std::array<const char*, 3> units = {"rad/s^2", "rad/s^2", "rad/s^2"};

  template <class Scalar>
  static const Vector3<Scalar>& of(const MotionInputs<Scalar>& in) noexcept {
    return in.angular_acceleration_rad_s2;
  }
};

/// Body rates p, q, r, FRD, rad/s.
struct BodyRates : detail::MotionPart<BodyRates> {
  static constexpr std::array<const char*, 3> names = {"w_x", "w_y", "w_z"};
  static constexpr std::array<const char*, 3> units = {"rad/s", "rad/s", "rad/s"};

  template <class Scalar>
  static const Vector3<Scalar>& of(const MotionInputs<Scalar>& in) noexcept {
    return in.body_rates_rad_s;
  }
};

/// The parts of omega x J omega: (w_y w_z, w_z w_x, w_x w_y). With principal axes along the body's each component of
/// omega x J omega is one of these times a difference of two moments of inertia: a factor that a linear map finds by
/// itself, and that standardisation removes. So no airframe is needed.
struct RateProducts : detail::MotionPart<RateProducts> {
  static constexpr std::array<const char*, 3> names = {"w_yz", "w_zx", "w_xy"};
  static constexpr std::array<const char*, 3> units = {"rad^2/s^2", "rad^2/s^2", "rad^2/s^2"};

  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& in, Scalar* x) noexcept {
    const Vector3<Scalar>& w = in.body_rates_rad_s;
    x[0] = w[1] * w[2];
    x[1] = w[2] * w[0];
    x[2] = w[0] * w[1];
  }
};

/// v_B: rotor drag is proportional to it.
struct BodyVelocity : detail::MotionPart<BodyVelocity> {
  static constexpr std::array<const char*, 3> names = {"v_bx", "v_by", "v_bz"};
  static constexpr std::array<const char*, 3> units = {"m/s", "m/s", "m/s"};

  template <class Scalar>
  static const Vector3<Scalar>& of(const MotionInputs<Scalar>& in) noexcept {
    return in.velocity_m_s;
  }
};

/// v_i |v_i|, axis by axis: drag of a body is proportional to it.
struct SquaredVelocity : detail::MotionPart<SquaredVelocity> {
  static constexpr std::array<const char*, 3> names = {"vv_bx", "vv_by", "vv_bz"};
  static constexpr std::array<const char*, 3> units = {"m^2/s^2", "m^2/s^2", "m^2/s^2"};

  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& in, Scalar* x) noexcept {
    for (int i = 0; i < 3; ++i) {
      const Scalar speed = in.velocity_m_s[i];
      x[i] = speed < Scalar(0) ? -speed * speed : speed * speed;
    }
  }
};

/// R^T e_z: how far down each body axis points. The tilt without angles and without the heading, on which no force
/// depends.
struct DownVector : detail::MotionPart<DownVector> {
  static constexpr std::array<const char*, 3> names = {"down_x", "down_y", "down_z"};
  static constexpr std::array<const char*, 3> units = {"1", "1", "1"};

  template <class Scalar>
  static Vector3<Scalar> of(const MotionInputs<Scalar>& in) noexcept {
    return world_down_axis(in.attitude);
  }
};

/// The specific force along the thrust axis: the part of it that the rotors make. The other two parts are made by the
/// air. On recorded flights they stay within some tenths of a m/s^2; a wanted motion has more, wherever the attitude
/// still lags, and no command makes it. A model that is shown them as SpecificForce would be asked outside its envelope
/// for nothing: on the demo's figure-eight 80 % of the time.
struct ThrustAxisForce : detail::MotionPart<ThrustAxisForce> {
  static constexpr int size = 1;
  static constexpr std::array<const char*, 1> names = {"s_z"};
  static constexpr std::array<const char*, 1> units = {"m/s^2"};

  /// Fills x[0]. The inputs must have passed check().
  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& in, Scalar* x) noexcept {
    x[0] = SpecificForce::of<Scalar>(in)[2];
  }
};

/// Feature sets of the same inputs, one after the other.
template <class First, class... More>
struct Joined {
  static_assert(is_feature_set<First> && (is_feature_set<More> && ...),
                "pinnquad: an argument of Joined is not a feature set (features/features.hpp)");
  static_assert((std::is_same_v<typename First::template Inputs<double>, typename More::template Inputs<double>> &&
                 ...),
                "pinnquad: feature sets that are Joined have the same Inputs");
  static_assert(
      !is_windowed<First>,
      "pinnquad: a window is around what is joined: PartlyWindowed<Joined<...>, ...> (features/windowed.hpp)");

  template <class Scalar>
  using Inputs = typename First::template Inputs<Scalar>;
  static constexpr int size = (First::size + ... + More::size);
  static constexpr int angular_acceleration = [] {
    const int places[] = {First::angular_acceleration, More::angular_acceleration...};
    const int sizes[] = {First::size, More::size...};
    int before = 0;
    for (std::size_t i = 0; i <= sizeof...(More); before += sizes[i++]) {
      if (places[i] >= 0) return before + places[i];
    }
    return -1;
  }();
  static constexpr auto names = detail::joined_texts(First::names, More::names...);
  static constexpr auto units = detail::joined_texts(First::units, More::units...);
  static_assert(detail::all_differ(names), "pinnquad: feature sets that are Joined have a feature in common");

  /// The first Status that is not ok.
  template <class AnyInputs>
  static Status check(const AnyInputs& in) noexcept {
    Status status = First::check(in);
    if constexpr (!(detail::is_motion_part<First> && ... && detail::is_motion_part<More>)) {
      ((status = status == Status::ok ? More::check(in) : status), ...);
    }  // else each part has checked all of the motion
    return status;
  }
  /// Fills x[0..size). The inputs must have passed check().
  template <class Scalar, class AnyInputs>
  static void extract(const AnyInputs& in, Scalar* x) noexcept {
    First::extract(in, x);
    int at = First::size;
    ((More::extract(in, x + at), at += More::size), ...);
  }
};

/// The features that thrust and torques change at once: those that a window is worth for.
struct AccelerationFeatures : Joined<SpecificForce, AngularAcceleration> {};

/// For a vehicle whose velocity is known.
struct PhysicsFeatures
    : Joined<SpecificForce, AngularAcceleration, BodyRates, RateProducts, DownVector, BodyVelocity, SquaredVelocity> {};

/// For a vehicle whose velocity was not measured: the specific force comes from an accelerometer. MotionInputs then
/// have the velocity 0 and v_dot = s + R^T g.
struct PhysicsFeaturesWithoutVelocity
    : Joined<SpecificForce, AngularAcceleration, BodyRates, RateProducts, DownVector> {};

/// PhysicsFeatures with the specific force along the thrust axis alone.
struct InverseFeatures
    : Joined<ThrustAxisForce, AngularAcceleration, BodyRates, RateProducts, DownVector, BodyVelocity, SquaredVelocity> {
};

/// And the altitude: for a vehicle near the ground.
struct InverseFeaturesWithAltitude : detail::WithAltitude<InverseFeatures> {};

/// InverseFeatures for a vehicle whose velocity was not measured.
struct InverseFeaturesWithoutVelocity
    : Joined<ThrustAxisForce, AngularAcceleration, BodyRates, RateProducts, DownVector> {};

/// AccelerationFeatures with the specific force along the thrust axis alone.
struct InverseAccelerations : Joined<ThrustAxisForce, AngularAcceleration> {};

}  // namespace pinnquad
