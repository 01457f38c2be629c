// SPDX-License-Identifier: MIT
// Wind, thrust and force by a Kalman filter through a residual wrench: against a dense reference, on flights, and where
// a measurement is an outlier.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "study/wind_filter.hpp"

using namespace pinnquad;
using namespace study;

namespace {

Airframe<double> airframe() { return airframe_value<LightQuadrotor, double>(); }

/// Force / mass -D v of the velocity through the air, no torque.
struct Drag {
  Vector3<double> d = Vector3<double>(0.5, 0.4, 0.3);
  Accelerations<double> operator()(const WrenchInputs<double>& in) const noexcept {
    return {-d.cwiseProduct(in.air_velocity_m_s), Vector3<double>::Zero()};
  }
};

MotionInputs<double> drawn_motion(std::mt19937_64& engine) {
  MotionInputs<double> motion;
  for (int i = 0; i < 3; ++i) {
    motion.linear_acceleration_m_s2[i] = standard_normal(engine);
    motion.velocity_m_s[i] = 3 * standard_normal(engine);
    motion.body_rates_rad_s[i] = 0.3 * standard_normal(engine);
  }
  motion.attitude =
      from_euler(EulerAngles<double>{uniform(engine, -0.6, 0.6), uniform(engine, -0.6, 0.6), uniform(engine, -3, 3)});
  return motion;
}

const Commands<double> hover{0.5, 0.5, 0.5, 0.5};
const Vector3<double> hover_force(0, 0, -9.8);

/// The motion that `told` makes, exactly.
MotionInputs<double> explained(MotionInputs<double> motion, const WindAndThrust<double>& told) {
  const auto& q = motion.attitude;
  const Vector3<double> through_air = motion.velocity_m_s - world_to_body<double>(q, told.wind_m_s);
  const Vector3<double> force = told.thrust_scale * hover_force +
                                Drag{}({through_air, motion.body_rates_rad_s, hover}).linear_m_s2 +
                                world_to_body<double>(q, told.force_m_s2);
  motion.linear_acceleration_m_s2 += force - SpecificForce::of<double>(motion);
  return motion;
}

using Residual = NominalWrench<Quadrotor<double, StandardAtmosphere, QuadraticDrag>>;
using Policy = WindInverse<double, Residual>;

/// A figure-eight by a vehicle; what the policy has found at its end.
template <class Vehicle>
WindAndThrust<double> found_on_eight(const Vehicle& vehicle, std::uint64_t seed) {
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> known(airframe(), paper_site<double>());
  const double scale = known.rotor_scale(known.surroundings({}, 0.0));
  const Policy::Inverse inverse(airframe(), Residual(known), scale);
  const Policy policy(inverse, {}, FlownMotion<double>(10'000, airframe().rise_time_constant_s(0)));
  using Adaptive = AdaptiveInverse<double, Policy>;
  BiasSettings<double> bias;
  bias.most_across_m_s2 = 6;
  TrackingController<double, Adaptive> controller(
      airframe(), FlightController<double>({}, flight_limits(airframe(), scale)),
      Adaptive(policy, airframe(), bias, FlownMotion<double>(25'000, airframe().rise_time_constant_s(0))), scale);
  FigureEight<double> eight;
  eight.center_m = {0, 0, -20};
  VehicleState<double> flown;
  flown.body.position_m = eight.sample(0).position_m;
  flown.rotors = {0.45, 0.45, 0.45, 0.45};
  std::mt19937_64 engine(seed);
  Commands<double> commands{};
  for (int tick = 0; tick < 10000; ++tick) {  // 20 s
    State<double> seen = flown.body;
    for (int i = 0; i < 3; ++i) {
      seen.velocity_m_s[i] += 0.02 * standard_normal(engine);
      seen.body_rates_rad_s[i] += 0.02 * standard_normal(engine);
    }
    REQUIRE(has_output(controller(seen, eight.sample(0.002 * tick), std::uint64_t(2000 * tick + 2000), commands)));
    REQUIRE(vehicle.step(flown, commands, 0.002) == Status::ok);
  }
  return controller.feed_forward().inverse().filter().estimate();
}

}  // namespace

TEST_CASE("the filter is the extended Kalman filter of its measurement, written densely") {
  WindFilterSettings<double> settings;
  settings.gate = 1e9;
  settings.most_wind_m_s = settings.most_force_m_s2 = 1e3;
  settings.least_thrust = -100;
  settings.most_thrust = 100;
  settings.wind_start_m_s = settings.thrust_start = settings.force_start_m_s2 = 3;
  WindFilter<double> filter(settings);
  using State7 = Eigen::Matrix<double, 7, 1>;
  using Square7 = Eigen::Matrix<double, 7, 7>;
  State7 x = State7::Zero();
  x[3] = 1;
  Square7 p = Square7::Identity() * 9;
  State7 walk;
  walk << State7::Constant(settings.wind_walk_m_s).head<3>(), settings.thrust_walk,
      State7::Constant(settings.force_walk_m_s2).head<3>();
  std::mt19937_64 engine(1);
  const double period_s = 0.01;
  for (int n = 0; n < 200; ++n) {
    const MotionInputs<double> motion = drawn_motion(engine);
    Eigen::Matrix3d to_body;
    for (int k = 0; k < 3; ++k) to_body.col(k) = world_to_body<double>(motion.attitude, Vector3<double>::Unit(k));
    Eigen::Matrix<double, 3, 7> h;
    const Eigen::Matrix3d slope = -Eigen::Matrix3d(Drag{}.d.asDiagonal());
    h << -slope * to_body, hover_force, to_body;
    const Eigen::Vector3d expected =
        slope * (motion.velocity_m_s - to_body * x.head<3>()) + x[3] * hover_force + to_body * x.tail<3>();
    p += Square7((period_s * walk.cwiseProduct(walk)).asDiagonal());
    for (int i = 0; i < 7; ++i) {  // no less is known than at the start
      const double factor = std::min(1.0, 3 / std::sqrt(p(i, i)));
      p.row(i) *= factor;
      p.col(i) *= factor;
    }
    const Eigen::Matrix3d s = h * p * h.transpose() + Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d cofactors = (Eigen::Matrix3d() << s(1, 1) * s(2, 2) - s(1, 2) * s(2, 1),
                                       s(0, 2) * s(2, 1) - s(0, 1) * s(2, 2), s(0, 1) * s(1, 2) - s(0, 2) * s(1, 1),
                                       s(1, 2) * s(2, 0) - s(1, 0) * s(2, 2), s(0, 0) * s(2, 2) - s(0, 2) * s(2, 0),
                                       s(0, 2) * s(1, 0) - s(0, 0) * s(1, 2), s(1, 0) * s(2, 1) - s(1, 1) * s(2, 0),
                                       s(0, 1) * s(2, 0) - s(0, 0) * s(2, 1), s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0))
                                          .finished();
    const Eigen::Matrix<double, 7, 3> gain = p * h.transpose() * cofactors / (s.row(0) * cofactors.col(0)).value();
    x += gain * (SpecificForce::of<double>(motion) - expected);
    p = (Square7::Identity() - gain * h) * p;
    REQUIRE(filter.update(Drag{}, motion, hover, hover_force, period_s) == Status::ok);
    const double tolerance = 1e-9 * (1 + x.norm());
    REQUIRE((filter.estimate().wind_m_s - x.head<3>()).norm() <= tolerance);
    REQUIRE(std::abs(filter.estimate().thrust_scale - x[3]) <= tolerance);
    REQUIRE((filter.estimate().force_m_s2 - x.tail<3>()).norm() <= tolerance);
    REQUIRE((filter.covariance() - p).norm() <= 1e-9);
  }
}

TEST_CASE("what explains every motion is found, and its variance falls") {
  WindAndThrust<double> truth;
  truth.wind_m_s = {3, -2, 0.5};
  truth.thrust_scale = 0.9;
  truth.force_m_s2 = {0.2, 0.1, -0.1};
  WindFilterSettings<double> settings;
  settings.gate = 1e9;
  WindFilter<double> filter(settings);
  std::mt19937_64 engine(2);
  const double before = filter.covariance().trace();
  for (int n = 0; n < 3000; ++n) {
    REQUIRE(filter.update(Drag{}, explained(drawn_motion(engine), truth), hover, hover_force, 0.01) == Status::ok);
  }
  CHECK((filter.estimate().wind_m_s - truth.wind_m_s).norm() <= 0.3);
  CHECK(filter.estimate().thrust_scale == doctest::Approx(truth.thrust_scale).epsilon(0.002));
  CHECK((filter.estimate().force_m_s2 - truth.force_m_s2).norm() <= 0.1);
  CHECK(filter.covariance().trace() < 0.1 * before);
}

TEST_CASE("a wind of 4 m/s and a battery at 88 % are found on a figure-eight, noise included") {
  using Windy = Quadrotor<double, StandardAtmosphere, ConstantWind, QuadraticDrag>;
  const Vector3<double> wind(3.2, -2.4, 0);
  const WindAndThrust<double> windy =
      found_on_eight(Windy(airframe(), paper_site<double>(), {}, ConstantWind{{wind[0], wind[1], wind[2]}}, {}), 1);
  CHECK((windy.wind_m_s - wind).head<2>().norm() <= 1.0);
  CHECK(std::abs(windy.thrust_scale - 1) <= 0.02);
  using Empty = Quadrotor<double, StandardAtmosphere, Battery, QuadraticDrag>;
  Battery weak;
  weak.cell_resistance_ohm_Ah = 0;
  weak.capacity_Ah = 1e6;
  weak.rated_V = weak.cells * Battery::full_cell_V / std::sqrt(0.88);
  const WindAndThrust<double> empty = found_on_eight(Empty(airframe(), paper_site<double>(), {}, weak, {}), 2);
  CHECK(empty.thrust_scale == doctest::Approx(0.88).epsilon(0.01));
  CHECK(empty.wind_m_s.norm() <= 1.0);
}

TEST_CASE("an outlier is refused, and what lasts is none") {
  WindFilter<double> filter;
  std::mt19937_64 engine(3);
  for (int n = 0; n < 300; ++n) {
    REQUIRE(filter.update(Drag{}, explained(drawn_motion(engine), {}), hover, hover_force, 0.01) == Status::ok);
  }
  const WindAndThrust<double> before = filter.estimate();
  MotionInputs<double> hit = explained(drawn_motion(engine), {});
  hit.linear_acceleration_m_s2[1] += 30;
  CHECK(filter.update(Drag{}, hit, hover, hover_force, 0.01) == Status::distrusted);
  CHECK(filter.estimate().wind_m_s == before.wind_m_s);
  CHECK(filter.estimate().force_m_s2 == before.force_m_s2);
  int refused = 1;
  while (filter.update(Drag{}, hit, hover, hover_force, 0.01) == Status::distrusted) ++refused;
  CHECK(refused * 0.01 == doctest::Approx(filter.settings().patience_s).epsilon(0.05));
  CHECK(filter.estimate().wind_m_s != before.wind_m_s);
}

TEST_CASE("an estimate beyond its bounds is limited to them") {
  WindFilterSettings<double> settings;
  settings.gate = 1e12;
  settings.most_wind_m_s = 2;
  WindFilter<double> filter(settings);
  WindAndThrust<double> storm;
  storm.wind_m_s = {15, 0, 0};
  std::mt19937_64 engine(4);
  Status status = Status::ok;
  for (int n = 0; n < 1000; ++n) {
    status = filter.update(Drag{}, explained(drawn_motion(engine), storm), hover, hover_force, 0.01);
    REQUIRE(has_output(status));
  }
  CHECK(status == Status::limited);
  CHECK(filter.estimate().wind_m_s.norm() == doctest::Approx(2.0));
}
