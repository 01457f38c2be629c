// SPDX-License-Identifier: MIT
// Parts of feature sets that say what forces and torques depend on, against kinematics and the rigid body's equation.
#include "pinnquad/features/motion_parts.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "support/numbers_of.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;
using pinnquad::test::RandomStates;

namespace {

constexpr double g = standard_gravity_m_s2<double>;

template <class Part>
Vector3<double> features(const MotionInputs<double>& inputs) {
  std::array<double, 3> x{};
  Part::extract(inputs, x.data());
  return {x[0], x[1], x[2]};
}

/// A loop with a turning, tumbling body: position, attitude and rates of an instant.
struct Loop {
  static Vector3<double> position(double t) { return {3 * std::sin(0.7 * t), 2 * std::cos(1.1 * t), -5 + t * t / 7}; }
  static Vector3<double> velocity(double t) { return {2.1 * std::cos(0.7 * t), -2.2 * std::sin(1.1 * t), 2 * t / 7}; }
  static Vector3<double> acceleration(double t) {
    return {-1.47 * std::sin(0.7 * t), -2.42 * std::cos(1.1 * t), 2.0 / 7};
  }
  /// Rz(t) then Rx(0.5 t).
  static Quaternion<double> attitude(double t) { return from_euler(EulerAngles<double>{0.5 * t, 0, t}); }
  /// Of ZYX angles at zero pitch: (phi', psi' sin phi, psi' cos phi).
  static Vector3<double> rates(double t) { return {0.5, std::sin(0.5 * t), std::cos(0.5 * t)}; }
  static Vector3<double> body_velocity(double t) { return world_to_body(attitude(t), velocity(t)); }

  static MotionInputs<double> inputs(double t) {
    constexpr double step = 1e-5;
    MotionInputs<double> in;
    in.linear_acceleration_m_s2 = (body_velocity(t + step) - body_velocity(t - step)) / (2 * step);
    in.velocity_m_s = body_velocity(t);
    in.body_rates_rad_s = rates(t);
    in.attitude = attitude(t);
    return in;
  }
};

}  // namespace

TEST_CASE("specific force is what acts on a moving body besides gravity, wherever it heads and however it turns") {
  for (const double t : {0.1, 0.9, 2.3, 4.4}) {
    const Vector3<double> force = body_to_world(Loop::attitude(t), features<SpecificForce>(Loop::inputs(t)));
    const Vector3<double> expected = Loop::acceleration(t) - Vector3<double>(0, 0, g);
    CHECK((force - expected).norm() < 1e-8);
  }
}

TEST_CASE("hovering weighs g upwards, falling nothing") {
  MotionInputs<double> hover;
  hover.attitude = from_euler(EulerAngles<double>{0, 0, 2.0});
  CHECK((features<SpecificForce>(hover) - Vector3<double>(0, 0, -g)).norm() < 1e-12);
  hover.linear_acceleration_m_s2 = {0, 0, g};
  CHECK(features<SpecificForce>(hover).norm() < 1e-12);
}

TEST_CASE("with principal axes omega x J omega is the rate products times differences of inertia") {
  RandomStates random(4);
  for (int draw = 0; draw < test::draws; ++draw) {
    MotionInputs<double> in = motion_inputs(random.state<double>(), random.motion<double>());
    const Vector3<double>& w = in.body_rates_rad_s;
    const Vector3<double> inertia = random.vector<double>(1) + Vector3<double>(2, 2, 2);
    const Vector3<double> momentum(inertia[0] * w[0], inertia[1] * w[1], inertia[2] * w[2]);
    const Vector3<double> expected = cross<double>(w, momentum);
    const Vector3<double> products = features<RateProducts>(in);
    for (int i = 0; i < 3; ++i) {
      const double difference = inertia[(i + 2) % 3] - inertia[(i + 1) % 3];
      CHECK(difference * products[i] == doctest::Approx(expected[i]).epsilon(1e-9).scale(1));
    }
  }
}

TEST_CASE("a squared velocity keeps its sign; the down vector is R^T e_z and knows no heading") {
  MotionInputs<double> in;
  in.velocity_m_s = {-2, 0, 3};
  CHECK(features<SquaredVelocity>(in) == Vector3<double>(-4, 0, 9));
  CHECK(features<BodyVelocity>(in) == in.velocity_m_s);
  RandomStates random(5);
  for (int draw = 0; draw < test::draws; ++draw) {
    in.attitude = random.attitude<double>();
    const Vector3<double> down = features<DownVector>(in);
    CHECK((down - world_to_body(in.attitude, Vector3<double>(0, 0, 1))).norm() < 1e-12);
    const double turn = random.scalar<double>(-3, 3);
    in.attitude = Quaternion<double>{std::cos(turn), 0, 0, std::sin(turn)} * in.attitude;
    CHECK((features<DownVector>(in) - down).norm() < 1e-12);
  }
}

TEST_CASE("joined sets are their parts one after the other, with the angular acceleration where it stands") {
  CHECK(is_feature_set<PhysicsFeatures>);
  CHECK(PhysicsFeatures::size == 21);
  CHECK(PhysicsFeaturesWithoutVelocity::size == 15);
  CHECK(PhysicsFeatures::angular_acceleration == 3);
  CHECK(Joined<BodyRates, DownVector, AngularAcceleration>::angular_acceleration == 6);
  CHECK(Joined<BodyRates, DownVector>::angular_acceleration == -1);
  CHECK(std::string(PhysicsFeatures::names[3]) == "wdot_x");
  CHECK(std::string(PhysicsFeatures::units[20]) == "m^2/s^2");
  RandomStates random(6);
  const MotionInputs<double> in = motion_inputs(random.state<double>(), random.motion<double>());
  std::array<double, 21> x{};
  PhysicsFeatures::extract(in, x.data());
  const std::array<Vector3<double>, 7> parts = {features<SpecificForce>(in),  features<AngularAcceleration>(in),
                                                features<BodyRates>(in),      features<RateProducts>(in),
                                                features<DownVector>(in),     features<BodyVelocity>(in),
                                                features<SquaredVelocity>(in)};
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == parts[i / 3][int(i % 3)]);
}

TEST_CASE("an input that is not finite is refused, and makes a feature that is not") {
  RandomStates random(7);
  const MotionInputs<double> sound = motion_inputs(random.state<double>(), random.motion<double>());
  CHECK(PhysicsFeatures::check(sound) == Status::ok);
  test::with_each_number_bad<double>(sound, [](const MotionInputs<double>& in) {
    CHECK(PhysicsFeatures::check(in) == Status::not_finite);
    CHECK(PhysicsFeaturesWithoutVelocity::check(in) == Status::not_finite);
    std::array<double, 21> x{};
    std::array<double, 15> less{};
    PhysicsFeatures::extract(in, x.data());
    PhysicsFeaturesWithoutVelocity::extract(in, less.data());
    CHECK_FALSE(all_finite(x));
    CHECK_FALSE(all_finite(less));
  });
  MotionInputs<double> long_quaternion = sound;
  long_quaternion.attitude.w += 1;
  CHECK(PhysicsFeatures::check(long_quaternion) == Status::not_unit_quaternion);
}
