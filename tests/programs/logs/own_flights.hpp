// SPDX-License-Identifier: MIT
// Logs of our simulator as a vehicle writes them: sensors with noise, bias and a filter, an estimator that errs,
// topics at rates of their own. Calm, lively and gusty flights, and flights with a crash, a knock, a catch by hand, a
// take-off and a landing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "logs/attitude_convention.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/control/flight_controller.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"
#include "programs/logs/ulog_bytes.hpp"

namespace pinnquad_test {

enum class FlightKind { calm, lively, gusts, knock, crash, catch_by_hand, take_off_and_landing };
inline constexpr std::array<const char*, 7> flight_kind_names = {
    "calm", "lively", "gusts", "knock", "crash", "catch by hand", "take-off and landing"};

/// Rates of the topics, Hz. The first is PX4's default, the third that of its profile for system identification.
struct LogRates {
  double attitude, body_rates, force, position, motors;
};
inline constexpr std::array<LogRates, 4> log_rates = {
    {{50, 50, 20, 10, 20}, {100, 100, 100, 50, 100}, {250, 100, 250, 125, 50}, {500, 500, 500, 125, 500}}};

struct OwnFlight {
  FlightKind kind = FlightKind::calm;
  std::size_t rates = 1;    ///< of `log_rates`
  bool enu_flu = false;     ///< the log's axes; else NED and FRD
  bool derivative = false;  ///< the log has an angular acceleration, filtered at 20 Hz as PX4 does
  bool small = false;       ///< a Crazyflie, else the paper's quadrotor
  double duration_s = 30;
  std::uint64_t seed = 1;
};

/// The n-th of a mix in which all kinds, rates and axes meet each other.
inline OwnFlight own_flight(std::size_t n) {
  OwnFlight flight;
  flight.kind = static_cast<FlightKind>(n % flight_kind_names.size());
  const std::size_t round = n / flight_kind_names.size();
  flight.rates = round % log_rates.size();
  flight.enu_flu = round / 4 % 2 == 1;
  flight.derivative = round / 8 % 2 == 1;
  flight.small = round / 16 % 2 == 1;
  flight.duration_s = std::array<double, 4>{8, 20, 40, 60}[(round + n / 28) % 4];
  constexpr double shortest_on_legs_s = 20;  // of a shorter one nearly all rows are on the ground
  if (flight.kind == FlightKind::take_off_and_landing)
    flight.duration_s = std::max(flight.duration_s, shortest_on_legs_s);
  flight.seed = 1000 + n;
  return flight;
}

/// A log's numbers of one instant, NED and FRD.
struct LoggedInstant {
  pinnquad::Quaternion<double> attitude;
  pinnquad::Vector3<double> rates_rad_s, derivative_rad_s2, force_m_s2, velocity_m_s, position_m;
  pinnquad::Commands<double> commands{};
};

/// An error that wanders: of first order, with a standard deviation and a time constant.
class Wander {
 public:
  Wander(double deviation, double time_s, double step_s)
      : kept_(std::exp(-step_s / time_s)), drive_(deviation * std::sqrt(1 - kept_ * kept_)) {}
  template <class Engine>
  const pinnquad::Vector3<double>& next(Engine& engine, double times = 1) {
    for (int axis = 0; axis < 3; ++axis)
      value_[axis] = kept_ * value_[axis] + times * drive_ * pinnquad::standard_normal(engine);
    return value_;
  }

 private:
  double kept_, drive_;
  pinnquad::Vector3<double> value_ = pinnquad::Vector3<double>::Zero();
};

/// Every 2 ms what the sensors, the estimator and the mixer say.
inline std::vector<LoggedInstant> flown_instants(const OwnFlight& plan) {
  using namespace pinnquad;
  using Vehicle = Quadrotor<double, StandardAtmosphere, DrydenTurbulence<6>, QuadraticDrag>;
  constexpr double step_s = 0.002, ground_m = 0.06, stands_s = 2.5, climb_s = 3, land_s = 4;
  const bool on_legs = plan.kind == FlightKind::take_off_and_landing;
  const bool calm = plan.kind != FlightKind::lively && plan.kind != FlightKind::gusts;
  std::mt19937_64 engine(plan.seed);
  const double wind_m_s = plan.kind == FlightKind::gusts ? uniform(engine, 5, 12) : 0.05;
  const DrydenTurbulence<6> air(engine, DrydenParameters::low_altitude(wind_m_s, 10), wind_m_s);
  const Airframe<double> airframe =
      plan.small ? airframe_value<Crazyflie, double>() : airframe_value<PaperQuadrotor, double>();
  const Vehicle vehicle(airframe, Site<double>{}, StandardAtmosphere{}, air, QuadraticDrag{});
  const auto physics = vehicle.time_step(step_s);
  VehicleState<double> now;
  now.body.position_m = Vector3<double>(0, 0, on_legs ? -ground_m : -20);
  Commands<double> hover{};
  if (hover_trim(vehicle, now.body.position_m, hover) != Status::ok) return {};
  Commands<double> commands = hover;
  now.rotors = commands;
  const double scale = vehicle.rotor_scale(vehicle.surroundings(now.body, 0.0));
  const FlightController<double> controller({}, flight_limits(airframe, scale));

  const double speed_m_s = calm ? uniform(engine, 0.02, 0.3) : uniform(engine, 1, 3);
  const double stick_rad_s = calm ? uniform(engine, 0, 0.03) : 0.15;
  Wander speed(speed_m_s, calm ? 2.0 : 0.8, step_s), stick(stick_rad_s, 0.07, step_s);
  Wander yaw_rate(calm ? 0.05 : 0.5, 1.0, step_s);
  Wander attitude_error(uniform(engine, 0.002, 0.015), 5, step_s), tumbling(0.5, 0.2, step_s);
  Wander velocity_error(uniform(engine, 0.01, 0.1), 2, step_s), position_error(0.1, 5, step_s);
  Wander vibration(uniform(engine, 0.05, 0.5), 0.003, step_s), gyro_noise(uniform(engine, 0.003, 0.03), 0.004, step_s);
  const auto drawn = [&](double deviation) {
    return Vector3<double>(deviation * standard_normal(engine), deviation * standard_normal(engine),
                           deviation * standard_normal(engine));
  };
  const Vector3<double> gyro_bias = drawn(0.005), force_bias = drawn(0.1), askew = drawn(0.02);
  const double event_s = plan.kind == FlightKind::knock ? uniform(engine, 0.2, 0.9) * plan.duration_s
                                                        : plan.duration_s * (1 - uniform(engine, 0.005, 0.015));
  const Vector3<double> blow_rad_s = drawn(6), blow_m_s = drawn(1);
  const double filter = 1 - std::exp(-step_s * 2 * 3.14159265 * 40), slow = 1 - std::exp(-step_s * 2 * 3.14159265 * 20);
  Vector3<double> gyro = Vector3<double>::Zero(), derivative = gyro, force(0, 0, -standard_gravity_m_s2<double>);
  std::vector<LoggedInstant> instants;
  const auto count = static_cast<std::size_t>(plan.duration_s / step_s);
  for (std::size_t at = 0; at < count; ++at) {
    const double t = static_cast<double>(at) * step_s;
    const bool event = t >= event_s && !on_legs && plan.kind != FlightKind::calm;
    const bool standing =
        on_legs && (t < stands_s || (t > plan.duration_s - land_s && now.body.position_m[2] > -ground_m));
    const bool tumbles = event && plan.kind == FlightKind::crash,
               held = event && plan.kind == FlightKind::catch_by_hand;
    SetPoint<double> wanted;
    wanted.velocity_m_s = speed.next(engine);
    wanted.stick_rad_s = stick.next(engine);
    wanted.yaw_rate_rad_s = yaw_rate.next(engine)[2];
    if (on_legs && t < stands_s + climb_s) wanted.velocity_m_s = Vector3<double>(0, 0, -1);
    if (on_legs && t > plan.duration_s - land_s) wanted.velocity_m_s = Vector3<double>(0, 0, 1);
    Accelerations<double> demand;
    if (controller(now.body, wanted, demand) == Status::ok &&
        inverse_commands(vehicle, now.body, demand, t, commands) == Status::ok) {
      commands = desaturate(vehicle.rotors(), commands);
    }
    if (standing) commands = {0.08, 0.08, 0.08, 0.08};
    if (tumbles) commands[plan.seed % rotor_count] = 0;
    for (double& u : commands) u = std::clamp(u, 0.0, 1.0);
    if (event && plan.kind == FlightKind::knock && t < event_s + step_s) {
      now.body.body_rates_rad_s += blow_rad_s;
      now.body.velocity_m_s += blow_m_s;
    }
    if (held && at % 10 == 0) now.body.body_rates_rad_s = 0.8 * now.body.body_rates_rad_s + drawn(1.5);
    if (held) now.body.velocity_m_s *= 0.98;

    const auto motion = vehicle.evaluate(now.body, now.rotors, t).motion;
    Vector3<double> felt = motion.linear_m_s2 + cross(now.body.body_rates_rad_s, body_velocity(now.body)) -
                           world_to_body(now.body.attitude, Vector3<double>(0, 0, standard_gravity_m_s2<double>));
    if (standing) felt = Vector3<double>(0, 0, -standard_gravity_m_s2<double>);
    if (held) felt += drawn(5);
    const Vector3<double> before = gyro;
    gyro += filter * (now.body.body_rates_rad_s + gyro_bias + cross(askew, now.body.body_rates_rad_s) +
                      gyro_noise.next(engine) - gyro);
    for (double& rate : gyro) rate = std::clamp(rate, -34.9, 34.9);
    derivative += slow * ((gyro - before) / step_s - derivative);
    force += filter * (felt + force_bias + cross(askew, felt) + vibration.next(engine) - force);
    for (double& part : force) part = std::clamp(part, -156.0, 156.0);
    LoggedInstant logged;
    Vector3<double> turn = attitude_error.next(engine) / 2;
    if (tumbles) turn += tumbling.next(engine);  // an estimator loses itself where the gyro ends
    logged.attitude = normalized(now.body.attitude * Quaternion<double>{1, turn[0], turn[1], turn[2]});
    logged.rates_rad_s = gyro;
    logged.derivative_rad_s2 = derivative;
    logged.force_m_s2 = force;
    logged.velocity_m_s = now.body.velocity_m_s + velocity_error.next(engine, event ? 5 : 1);
    logged.position_m = now.body.position_m + position_error.next(engine);
    logged.commands = commands;
    instants.push_back(logged);
    if (standing) {
      now.body.velocity_m_s.setZero();
      now.body.body_rates_rad_s.setZero();
      now.rotors = commands;
      now.time_s += step_s;
    } else if (vehicle.step(now, commands, physics) != Status::ok) {
      break;
    }
  }
  return instants;
}

/// The log as PX4's logger writes it.
inline std::string own_ulog(const std::vector<LoggedInstant>& instants, const OwnFlight& plan) {
  UlogBytes ulog;
  const LogRates& rates = log_rates[plan.rates];
  constexpr double step_s = 0.002;
  const pinnquad::logs::AttitudeConvention as{false, false, plan.enu_flu, plan.enu_flu};
  const auto body = [&](const pinnquad::Vector3<double>& v) { return plan.enu_flu ? pinnquad::swap_flu_frd(v) : v; };
  const auto world = [&](const pinnquad::Vector3<double>& v) { return plan.enu_flu ? pinnquad::swap_enu_ned(v) : v; };
  const std::array<std::pair<const char*, int>, 5> topics = {
      {{"attitude", 4}, {"body_rates", 6}, {"force", 3}, {"place", 6}, {"motors", 4}}};
  const std::array<double, 5> of_topic = {rates.attitude, rates.body_rates, rates.force, rates.position, rates.motors};
  for (unsigned id = 0; id < of_topic.size(); ++id) {
    ulog.format(std::string(topics[id].first) + ":uint64_t timestamp;float[" + std::to_string(topics[id].second) +
                "] v;");
  }
  for (unsigned id = 0; id < of_topic.size(); ++id) ulog.topic(0, id, topics[id].first);
  for (std::size_t at = 0; at < instants.size(); ++at) {
    const LoggedInstant& now = instants[at];
    for (unsigned id = 0; id < of_topic.size(); ++id) {
      if (at % static_cast<std::size_t>(std::lround(1 / (step_s * of_topic[id]))) != 0) continue;
      std::vector<double> numbers;
      const auto say = [&](const auto& of) { numbers.insert(numbers.end(), of.begin(), of.end()); };
      if (id == 0) say(pinnquad::logs::written_attitude(now.attitude, as));
      if (id == 1) say(body(now.rates_rad_s)), say(body(now.derivative_rad_s2));
      if (id == 2) say(body(now.force_m_s2));
      if (id == 3) say(world(now.velocity_m_s)), say(world(now.position_m));
      if (id == 4) say(now.commands);
      Bytes bytes;
      bytes.u64(static_cast<std::uint64_t>(1000000 + 2000 * at));
      for (const double number : numbers) bytes.f32(static_cast<float>(number));
      ulog.data(id, bytes);
    }
  }
  return ulog.str();
}

/// The mapping that reads it.
inline std::string own_mapping(const OwnFlight& plan) {
  const auto columns = [](int first, int count) {
    std::string text = "[";
    for (int i = first; i < first + count; ++i) text += (i > first ? ", " : "") + ("\"v[" + std::to_string(i) + "]\"");
    return text + "]\n";
  };
  return std::string("world = \"") + (plan.enu_flu ? "enu" : "ned") + "\"\nbody = \"" + (plan.enu_flu ? "flu" : "frd") +
         "\"\n[ground]\nheight_m = \"before_flight\"\nby_contact = true\n" +
         "[attitude]\ntopic = \"attitude\"\norder = \"wxyz\"\ndirection = \"body_to_world\"\nquaternion = " +
         columns(0, 4) + "[body_rates]\ntopic = \"body_rates\"\ncolumns = " + columns(0, 3) +
         (plan.derivative ? "[angular_acceleration]\ntopic = \"body_rates\"\ncolumns = " + columns(3, 3) : "") +
         "[specific_force]\ntopic = \"force\"\ncolumns = " + columns(0, 3) +
         "[velocity]\ntopic = \"place\"\naxes = \"world\"\ncolumns = " + columns(0, 3) +
         "[position]\ntopic = \"place\"\ncolumns = " + columns(3, 3) +
         "[motors]\ntopic = \"motors\"\nnumbers = \"thrust\"\norder = \"px4\"\ncolumns = " + columns(0, 4);
}

}  // namespace pinnquad_test
