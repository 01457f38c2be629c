// SPDX-License-Identifier: MIT
// The cascaded controller: rest at rest, convergence, limits, symmetry, refusal of bad input.
#include "pinnquad/control/flight_controller.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "support/uneven_airframe.hpp"

namespace {

using namespace pinnquad;

template <class Scalar>
using Vehicle = Quadrotor<Scalar, StandardAtmosphere, QuadraticDrag>;

template <class Scalar>
Vehicle<Scalar> vehicle() {
  return Vehicle<Scalar>(airframe_value<PaperQuadrotor, Scalar>(), paper_site<Scalar>(), {}, {});
}

/// Flies a set point for a while through the analytic inverse.
template <class Scalar>
Status fly_set_point(const Vehicle<Scalar>& quadrotor, const SetPoint<Scalar>& wanted, Scalar duration_s,
                     VehicleState<Scalar>& state) {
  const FlightController<Scalar> controller;
  const auto step_s = Scalar(0.001);
  Commands<Scalar> commands{};
  while (Scalar(state.time_s) < duration_s) {
    Accelerations<Scalar> demand;
    Status status = controller(state.body, wanted, demand);
    if (status == Status::ok) status = inverse_commands(quadrotor, state.body, demand, Scalar(state.time_s), commands);
    if (status == Status::ok) status = quadrotor.step(state, desaturate(quadrotor.rotors(), commands), step_s);
    if (status != Status::ok) return status;
  }
  return Status::ok;
}

}  // namespace

TEST_CASE_TEMPLATE("in hover nothing is asked for, and the hover holds", Scalar, float, double) {
  const Vehicle<Scalar> quadrotor = vehicle<Scalar>();
  const FlightController<Scalar> controller;
  Accelerations<Scalar> demand;
  REQUIRE(controller(State<Scalar>{}, SetPoint<Scalar>{}, demand) == Status::ok);
  CHECK(demand.linear_m_s2.norm() <= Scalar(1e-6));
  CHECK(demand.angular_rad_s2.norm() <= Scalar(1e-6));

  Commands<Scalar> trim{};
  REQUIRE(hover_trim(quadrotor, Vector3<Scalar>(Scalar(0), Scalar(0), Scalar(0)), trim) == Status::ok);
  CHECK(trim[0] == doctest::Approx(0.505).epsilon(0.01));  // "hovers at command 0.50", at 122 m
  VehicleState<Scalar> state;
  state.rotors = trim;
  REQUIRE(fly_set_point(quadrotor, SetPoint<Scalar>{}, Scalar(5), state) == Status::ok);
  CHECK(state.body.position_m.norm() <= Scalar(1e-3));  // float: 5,000 roundings of 1e-7 N's worth of thrust
  CHECK(state.body.velocity_m_s.norm() <= Scalar(1e-3));
}

TEST_CASE("the velocity and the yaw rate wanted are reached from random states") {
  const Vehicle<double> quadrotor = vehicle<double>();
  std::mt19937_64 engine(5);
  for (int run = 0; run < 20; ++run) {
    VehicleState<double> state;
    for (int i = 0; i < 3; ++i) {
      state.body.velocity_m_s[i] = uniform(engine, -5, 5);
      state.body.body_rates_rad_s[i] = uniform(engine, -3, 3);
    }
    state.body.attitude =
        from_euler<double>({uniform(engine, -1.2, 1.2), uniform(engine, -1.2, 1.2), uniform(engine, -3, 3)});
    state.rotors = {0.5, 0.5, 0.5, 0.5};
    SetPoint<double> wanted;
    wanted.velocity_m_s = Vector3<double>(uniform(engine, -4, 4), uniform(engine, -4, 4), uniform(engine, -4, 4));
    wanted.yaw_rate_rad_s = uniform(engine, -0.8, 0.8);
    REQUIRE(fly_set_point(quadrotor, wanted, 6.0, state) == Status::ok);
    // no integral action: lateral drag (0.1 m/s^2 at 4 m/s) over the velocity gain of 3 1/s stays
    constexpr double standing_error_m_s = 0.1;
    CHECK((state.body.velocity_m_s - wanted.velocity_m_s).norm() <= standing_error_m_s);
    const double turn = body_to_world(state.body.attitude, state.body.body_rates_rad_s)[2];
    CHECK(turn == doctest::Approx(wanted.yaw_rate_rad_s).epsilon(0.05));
  }
}

TEST_CASE("on the reference there is no feedback, and the demand is the motion of flatness, laterally at rest") {
  FigureEight<double> eight;
  eight.yaw_amplitude_rad = 0.8;
  const FlightController<double> controller;
  constexpr double rounding = 1e-10;  // gains of up to 200 1/s^2 on errors of 1e-14
  for (double t = 0.1; t < 12; t += 0.7) {
    const TrajectoryPoint<double> point = eight.sample(t);
    FlatMotion<double> flat;
    REQUIRE(flat_motion(point, standard_gravity_m_s2<double>, flat) == Status::ok);
    const State<double> state{point.position_m, point.velocity_m_s, flat.attitude, flat.body_rates_rad_s};
    Accelerations<double> demand, feedback;
    REQUIRE(controller(state, point, demand, feedback) == Status::ok);
    CHECK(feedback.linear_m_s2.norm() <= rounding);
    CHECK(feedback.angular_rad_s2.norm() <= rounding);
    CHECK((demand.angular_rad_s2 - flat.angular_acceleration_rad_s2).norm() <= rounding);
    // the specific force of flatness has no lateral part, so that nothing is lost of the acceleration
    CHECK((world_acceleration(state, demand.linear_m_s2) - point.acceleration_m_s2).norm() <= rounding);
  }
}

TEST_CASE("limits: tilt, thrust and horizontal acceleration hold whatever is asked for") {
  const FlightController<double> controller;
  const FlightLimits<double>& limits = controller.limits();
  const double gravity = standard_gravity_m_s2<double>;
  std::mt19937_64 engine(6);
  constexpr double rounding = 1e-12;
  for (int i = 0; i < 1000; ++i) {
    Vector3<double> asked;
    for (int k = 0; k < 3; ++k) asked[k] = uniform(engine, -40, 40);
    const Vector3<double> given = controller.limited(asked);
    const double up = gravity - given[2];
    const double horizontal = std::sqrt(given[0] * given[0] + given[1] * given[1]);
    CHECK(up >= limits.min_vertical_specific_force_m_s2 - rounding);
    CHECK(std::sqrt(up * up + horizontal * horizontal) <= limits.max_specific_force_m_s2 + rounding);
    CHECK(horizontal <= limits.max_horizontal_acceleration_m_s2 + rounding);
    CHECK(horizontal <= up * std::tan(limits.max_tilt_rad) + rounding);
    CHECK(asked[0] * given[1] == doctest::Approx(asked[1] * given[0]));  // the course is kept
  }
  const Vector3<double> small(0.5, -0.2, 0.1);
  CHECK((controller.limited(small) - small).norm() <= rounding);
}

TEST_CASE("gains: what each error alone asks for, of the pilot and of a trajectory") {
  const FlightController<double> controller;
  const double small = 0.01, half_angle = std::sin(small / 2);
  struct Error {
    const char* what;
    State<double> state;
    Vector3<double> linear_m_s2, angular_rad_s2;  ///< asked for
    bool pilot_sees = true;
  };
  const auto error = [](const char* what) { return Error{what, {}, Vector3<double>::Zero(), Vector3<double>::Zero()}; };
  Error velocity = error("velocity"), roll = error("roll"), pitch = error("pitch"), yaw = error("yaw"),
        roll_rate = error("roll rate"), pitch_rate = error("pitch rate"), yaw_rate = error("yaw rate"),
        position = error("position");
  velocity.state.velocity_m_s[2] = small;  // down: the attitude wanted stays level
  velocity.linear_m_s2[2] = -3 * small;
  roll.state.attitude = from_euler<double>({small, 0, 0});
  roll.angular_rad_s2[0] = -22 * 9 * 2 * half_angle;
  pitch.state.attitude = from_euler<double>({0, small, 0});
  pitch.angular_rad_s2[1] = -22 * 9 * 2 * half_angle;
  roll_rate.state.body_rates_rad_s[0] = small;
  roll_rate.angular_rad_s2[0] = -22 * small;
  pitch_rate.state.body_rates_rad_s[1] = small;
  pitch_rate.angular_rad_s2[1] = -22 * small;
  yaw_rate.state.body_rates_rad_s[2] = small;
  yaw_rate.angular_rad_s2[2] = -8 * small;
  yaw.state.attitude = from_euler<double>({0, 0, small});
  yaw.angular_rad_s2[2] = -8 * 3 * 2 * half_angle;
  yaw.pilot_sees = position.pilot_sees = false;
  position.state.position_m[2] = 0.1;
  position.linear_m_s2[2] = -0.54;
  constexpr double rounding = 1e-12;
  for (const Error& e : {velocity, roll, pitch, roll_rate, pitch_rate, yaw_rate, yaw, position}) {
    CAPTURE(e.what);
    Accelerations<double> demand, feedback;
    REQUIRE(controller(e.state, TrajectoryPoint<double>{}, demand, feedback) == Status::ok);
    const Vector3<double> linear = body_to_world(e.state.attitude, feedback.linear_m_s2);
    CHECK((linear - e.linear_m_s2).norm() <= rounding);
    CHECK((feedback.angular_rad_s2 - e.angular_rad_s2).norm() <= 100 * rounding);
    // on a point at rest the demand is its feedback; laterally, what gravity and rotation leave
    Vector3<double> asked = body_derivative<double>(e.state, {0, 0, standard_gravity_m_s2<double>});
    asked[2] = body_derivative<double>(e.state, {0, 0, 0})[2] + feedback.linear_m_s2[2];
    CHECK((demand.linear_m_s2 - asked).norm() <= rounding);
    CHECK((demand.angular_rad_s2 - feedback.angular_rad_s2).norm() <= rounding);
    REQUIRE(controller(e.state, SetPoint<double>{}, demand) == Status::ok);
    const Vector3<double> nothing = Vector3<double>::Zero();
    CHECK((world_acceleration(e.state, demand.linear_m_s2) - (e.pilot_sees ? e.linear_m_s2 : nothing)).norm() <=
          rounding);
    CHECK((demand.angular_rad_s2 - (e.pilot_sees ? e.angular_rad_s2 : nothing)).norm() <= 100 * rounding);
  }
  Accelerations<double> demand;
  REQUIRE(controller(State<double>{}, {Vector3<double>::Zero(), 0.1, Vector3<double>(0.01, -0.02, 0.03)}, demand) ==
          Status::ok);
  CHECK((demand.angular_rad_s2 - Vector3<double>(22 * 0.01, -22 * 0.02, 8 * (0.1 + 0.03))).norm() <= rounding);
}

TEST_CASE("limits: turning and its onset hold whatever the attitude and what is asked for, and are reached") {
  const FlightController<double> controller;
  const FlightLimits<double>& limits = controller.limits();
  constexpr double rounding = 1e-9;
  double steepest_onset = 0, fastest_yaw_onset = 0;
  std::mt19937_64 engine(8);
  for (int i = 0; i < 1000; ++i) {
    const auto drawn = [&](double most) {
      return Vector3<double>(uniform(engine, -most, most), uniform(engine, -most, most), uniform(engine, -most, most));
    };
    State<double> state;
    state.velocity_m_s = drawn(10);
    state.body_rates_rad_s = drawn(6);
    state.attitude = from_euler<double>({uniform(engine, -3, 3), uniform(engine, -1.4, 1.4), uniform(engine, -3, 3)});
    Accelerations<double> demand;
    REQUIRE(controller(state, {drawn(10), uniform(engine, -2, 2), drawn(2)}, demand) == Status::ok);
    const double onset = std::hypot(demand.angular_rad_s2[0], demand.angular_rad_s2[1]);
    const double yaw_onset = std::fabs(demand.angular_rad_s2[2]);
    CHECK(onset <= limits.max_roll_pitch_acceleration_rad_s2 + rounding);
    CHECK(yaw_onset <= limits.max_yaw_acceleration_rad_s2 + rounding);
    steepest_onset = std::max(steepest_onset, onset);
    fastest_yaw_onset = std::max(fastest_yaw_onset, yaw_onset);
  }
  CHECK(steepest_onset == doctest::Approx(100));
  CHECK(fastest_yaw_onset == doctest::Approx(4));

  // at rest the onset is the rate gain times the rate that the attitude error asks for, 4 rad/s at most
  for (const double roll_rad : {0.2, 0.4, 0.5, 1.0, -1.0, 2.0}) {
    CAPTURE(roll_rad);
    State<double> state;
    state.attitude = from_euler<double>({roll_rad, 0, 0});
    Accelerations<double> demand;
    REQUIRE(controller(state, SetPoint<double>{}, demand) == Status::ok);
    const double rate_rad_s = std::min(4.0, 9 * 2 * std::sin(std::fabs(roll_rad) / 2));
    CHECK(demand.angular_rad_s2[0] == doctest::Approx(roll_rad > 0 ? -22 * rate_rad_s : 22 * rate_rad_s));
    CHECK(std::fabs(demand.angular_rad_s2[1]) <= rounding);
  }
}

TEST_CASE("default limits in figures: 49 degrees, 9 m/s^2, thrust from 3.5 to 17 m/s^2") {
  const FlightController<double> controller;
  const auto horizontal = [&](double down_m_s2) { return controller.limited(Vector3<double>(90, 0, down_m_s2)); };
  CHECK(horizontal(50)[2] == doctest::Approx(9.80665 - 3.5));
  CHECK(std::atan2(horizontal(50)[0], 3.5) == doctest::Approx(0.85));  // the tilt's
  CHECK(0.85 * 57.29577951308232 == doctest::Approx(49).epsilon(0.01));
  CHECK(horizontal(0)[0] == doctest::Approx(9));
  CHECK(horizontal(-50)[2] == doctest::Approx(9.80665 - 17));
  CHECK(std::fabs(horizontal(-50)[0]) <= 1e-6);
}

TEST_CASE("an airframe with little thrust gets narrower limits") {
  Airframe<double> heavy = airframe_value<PaperQuadrotor, double>();
  const FlightLimits<double> light_limits = flight_limits(heavy, 1.0);
  heavy.mass_kg *= 1.75;
  const FlightLimits<double> limits = flight_limits(heavy, 1.0);
  CHECK(limits.max_specific_force_m_s2 < heavy.thrust_to_weight() * standard_gravity_m_s2<double>);
  CHECK(limits.max_roll_pitch_acceleration_rad_s2 < 0.4 * light_limits.max_roll_pitch_acceleration_rad_s2);
  CHECK(limits.max_yaw_acceleration_rad_s2 < light_limits.max_yaw_acceleration_rad_s2);
  const double reach = heavy.thrust_to_weight();
  CHECK(limits.max_specific_force_m_s2 == doctest::Approx(0.97 * reach * 9.80665));
  CHECK(limits.max_horizontal_acceleration_m_s2 == doctest::Approx(0.55 * 9.80665 * std::sqrt(reach * reach - 1)));
  CHECK(limits.max_roll_pitch_rate_rad_s == doctest::Approx(limits.max_roll_pitch_acceleration_rad_s2 / 9));
  REQUIRE(limits.max_roll_pitch_rate_rad_s < light_limits.max_roll_pitch_rate_rad_s);
}

TEST_CASE(
    "limits of uneven rotors: at 1 / 0.97 of the thrust, 1 / 0.6 or 1 / 0.4 of the turning, the first rotor is at its "
    "end") {
  Airframe<double> a = test::uneven_airframe<double>();
  a.mass_kg *= 1.5;  // little is left
  for (const double scale : {1.0, 0.9}) {
    const FlightLimits<double> limits = flight_limits(a, scale);
    const Rotors<double> rotors(a);
    const auto reach = [&](double specific_force_m_s2, int axis, double acceleration_rad_s2) {
      Vector3<double> turning = Vector3<double>::Zero();
      turning[axis] = acceleration_rad_s2;
      Wrench<double> wanted;
      wanted.force_N[2] = -a.mass_kg * specific_force_m_s2;
      wanted.torque_N_m = inertia_times(a, turning);
      double distance = 1;  // to the nearest end, negative beyond
      for (const double s : rotors.fractions_for(wanted, scale)) distance = std::min({distance, s, 1 - s});
      return distance;
    };
    CHECK(std::abs(reach(limits.max_specific_force_m_s2 / 0.97, 0, 0)) < 1e-12);
    const double hover = standard_gravity_m_s2<double>;
    const double roll = limits.max_roll_pitch_acceleration_rad_s2 / 0.6, yaw = limits.max_yaw_acceleration_rad_s2 / 0.4;
    const double first = std::min(std::min(reach(hover, 0, roll), reach(hover, 0, -roll)),
                                  std::min(reach(hover, 1, roll), reach(hover, 1, -roll)));
    CHECK(std::abs(first) < 1e-12);
    CHECK(std::abs(std::min(reach(hover, 2, yaw), reach(hover, 2, -yaw))) < 1e-12);
  }
}

TEST_CASE("bad input: a Status, and the demand is left alone") {
  const FlightController<float> controller;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Accelerations<float> demand;
  demand.linear_m_s2[0] = 42;
  State<float> state;
  SetPoint<float> wanted;
  SUBCASE("state") { state.attitude.y = nan; }
  SUBCASE("velocity wanted") { wanted.velocity_m_s[1] = std::numeric_limits<float>::infinity(); }
  SUBCASE("yaw rate wanted") { wanted.yaw_rate_rad_s = nan; }
  SUBCASE("sticks") { wanted.stick_rad_s[2] = nan; }
  CHECK(controller(state, wanted, demand) == Status::not_finite);
  CHECK(demand.linear_m_s2[0] == 42);
}

TEST_CASE("finite numbers never come to not_finite, wherever a sum overflows") {
  const FlightController<float> controller;
  std::mt19937_64 engine(21);
  int overflowed = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto any = [&] {  // of every magnitude that a float has
      const double exponent = uniform(engine, -3, 38.5);
      return static_cast<float>((uniform(engine, -1, 1) < 0 ? -1 : 1) * std::pow(10, exponent));
    };
    const auto vector = [&] { return Vector3<float>(any(), any(), any()); };
    State<float> state;
    SetPoint<float> wanted;
    TrajectoryPoint<float> point;
    if (i % 3 != 0) state.velocity_m_s = vector();
    if (i % 2 == 0) state.body_rates_rad_s = vector();
    wanted.velocity_m_s = vector();
    wanted.yaw_rate_rad_s = any();
    point.position_m = vector();
    point.velocity_m_s = vector();
    Accelerations<float> demand, to_point, feedback;
    for (Accelerations<float>* left : {&demand, &to_point, &feedback}) left->linear_m_s2[0] = 42;
    const Status of_demand = controller(state, wanted, demand), of_point = controller(state, point, to_point, feedback);
    for (const Status status : {of_demand, of_point}) {
      overflowed += status == Status::output_not_finite;
      REQUIRE(status != Status::not_finite);
    }
    REQUIRE((has_output(of_demand) || demand.linear_m_s2[0] == 42));
    REQUIRE((has_output(of_point) || (to_point.linear_m_s2[0] == 42 && feedback.linear_m_s2[0] == 42)));
  }
  CHECK(overflowed > 1000);
}

TEST_CASE(
    "speed: no limit asks for as much as the error is large; with limits no more than can be braked, in the error's "
    "direction") {
  const double unlimited = std::numeric_limits<double>::max();
  FlightLimits<double> limits;
  CHECK(limits.max_horizontal_speed_m_s == unlimited);
  const Vector3<double> reference(1, -2, 0.5), error(30, -40, 20);
  const FlightGains<double> gains;
  CHECK(FlightController<double>().wanted_velocity(reference, error) ==
        Vector3<double>(reference + error * gains.position_1_s));
  limits.max_horizontal_speed_m_s = 8;
  limits.max_climb_m_s = 3;
  limits.max_descent_m_s = 2;
  const FlightController<double> controller(gains, limits);
  std::mt19937_64 engine(4);
  for (int i = 0; i < 1000; ++i) {
    Vector3<double> far, moving;
    for (int k = 0; k < 3; ++k) far[k] = uniform(engine, -20, 20), moving[k] = uniform(engine, -10, 10);
    const Vector3<double> v = controller.wanted_velocity(moving, far);
    CHECK(std::hypot(v[0], v[1]) <= 8 + 1e-12);
    CHECK(v[2] <= 2);
    CHECK(v[2] >= -3);
    const Vector3<double> still = controller.wanted_velocity(Vector3<double>(0, 0, 0), far);
    CHECK(still[0] * far[1] == doctest::Approx(still[1] * far[0]));
    CHECK(still[2] * far[2] >= 0);
    // d(v^2 / 2)/ds: what it must brake on its way
    const double d = std::hypot(far[0], far[1]), h = 1e-4;
    const auto speed = [&](double at) { return controller.wanted_velocity({0, 0, 0}, {at, 0, 0})[0]; };
    const double braking = (speed(d + h) * speed(d + h) - speed(d - h) * speed(d - h)) / (4 * h);
    CHECK(braking <= 0.4 * limits.max_horizontal_acceleration_m_s2 * (1 + 1e-6));
  }
  // a climb is braked by gravity, with as little thrust as is allowed; a descent by thrust beyond the weight
  FlightLimits<double> fast;
  fast.max_climb_m_s = fast.max_descent_m_s = 100;
  fast.min_vertical_specific_force_m_s2 = 3;
  fast.max_specific_force_m_s2 = 15;
  const FlightController<double> racer(gains, fast);
  for (const double sign : {-1.0, 1.0}) {
    const auto speed = [&](double at) { return racer.wanted_velocity({0, 0, 0}, {0, 0, sign * at})[2]; };
    constexpr double far = 30, h = 1e-3, g = 9.80665;
    const double braking = (speed(far + h) * speed(far + h) - speed(far - h) * speed(far - h)) / (4 * h);
    CHECK(braking == doctest::Approx(0.4 * (sign < 0 ? g - 3 : 15 - g)).epsilon(1e-6));
  }
  const Vector3<double> near(0.3, -0.2, 0.1);
  CHECK((controller.wanted_velocity({0, 0, 0}, near) - near * gains.position_1_s).norm() <= 1e-15);
}
