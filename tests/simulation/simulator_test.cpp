// SPDX-License-Identifier: MIT
// The running simulation: in any portions the same flight, ended where it must, copied as a whole.
#include "pinnquad/simulation/simulator.hpp"
#include "pinnquad/simulation/flights.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"

namespace {

using namespace pinnquad;

using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
using Pilot = RandomPilot<std::mt19937_64>;

Vehicle vehicle() { return Vehicle(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), {}, {}); }

Pilot pilot(std::uint64_t seed) {
  return Pilot(std::mt19937_64(seed), pilot_style(vehicle(), FlightPlan{}.start_m), vehicle().site().ground_z_m);
}

Simulator<Vehicle, Pilot> running(std::uint64_t seed) { return Simulator<Vehicle, Pilot>(vehicle(), pilot(seed)); }

/// No air from 1 s on, but only between the controller's ticks: the inverse sees nothing of it, the physics fails.
struct Gap {
  template <class Scalar>
  void surroundings(Surroundings<Scalar>& air) const noexcept {
    if (air.time_s > Scalar(1.0004) && air.time_s < Scalar(1.0006)) {
      air.air_density_kg_m3 = std::numeric_limits<Scalar>::quiet_NaN();
    }
  }
};

/// Its third row is no number.
struct Blind {
  int rows = 0;
  void hold(const Commands<double>&, double) {}
  template <class... Effects>
  Sample operator()(const Quadrotor<double, Effects...>&, const VehicleState<double>&, const Commands<double>&) {
    Sample sample;
    if (++rows == 3) sample.angular_acceleration_rad_s2[1] = std::numeric_limits<double>::quiet_NaN();
    return sample;
  }
};

}  // namespace

TEST_CASE("a flight in portions is the flight in one") {
  FlightPlan plan;
  plan.samples = 200;
  const std::uint64_t whole = content_hash(fly(vehicle(), pilot(3), plan).flight);

  Simulator<Vehicle, Pilot> by_rows = running(3), by_seconds = running(3), by_ticks = running(3);
  for (int row = 0; row < 200; ++row) REQUIRE(by_rows.next_row());
  CHECK(content_hash(by_rows.recording()) == whole);

  CHECK(by_seconds.advance(0.013));  // not a multiple of anything: rounded to 14 ms
  CHECK(by_seconds.time_s() == doctest::Approx(0.014));
  CHECK(by_seconds.advance(7.0));
  CHECK(by_seconds.advance(2.986));
  CHECK(content_hash(by_seconds.recording()) == whole);

  while (by_ticks.recording().size() < 200) REQUIRE(by_ticks.tick());
  CHECK(content_hash(by_ticks.recording()) == whole);
  CHECK(by_ticks.time_s() == 10.0);
}

TEST_CASE("advance: nothing for what is no duration") {
  Simulator<Vehicle, Pilot> simulator = running(1);
  for (const double duration_s :
       {0.0, 0.0009, -1.0, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(simulator.advance(duration_s));
    CHECK(simulator.time_s() == 0);
  }
  CHECK(simulator.recording().empty());
  CHECK(simulator.vehicle().body.position_m == FlightPlan{}.start_m);
}

TEST_CASE("a copy flies on like its original, and the original is not touched") {
  Simulator<Vehicle, Pilot> original = running(5);
  REQUIRE(original.advance(2));
  Simulator<Vehicle, Pilot> copy = original;
  REQUIRE(copy.advance(2));
  CHECK(original.recording().size() == 40);
  REQUIRE(original.advance(2));
  CHECK(original.recording().size() == 80);
  CHECK(content_hash(original.recording()) == content_hash(copy.recording()));
}

TEST_CASE("a recording that is taken leaves the flight as it is") {
  Simulator<Vehicle, Pilot> whole = running(6), parts = running(6);
  REQUIRE(whole.advance(3));
  REQUIRE(parts.advance(1));
  Flight rows = parts.take_recording();
  CHECK(parts.recording().empty());
  REQUIRE(parts.advance(2));
  for (const Sample& sample : parts.recording()) rows.push_back(sample);
  CHECK(content_hash(rows) == content_hash(whole.recording()));
}

TEST_CASE("it starts in hover, in balance") {
  Simulator<Vehicle, SteadyPilot> simulator(vehicle(), SteadyPilot{});
  Commands<double> hover{};
  REQUIRE(simulator.hover_commands(hover) == Status::ok);
  CHECK(simulator.commands() == hover);
  CHECK(simulator.altitude_m() == 35.877);
  REQUIRE(simulator.advance(5));
  CHECK((simulator.vehicle().body.position_m - FlightPlan{}.start_m).norm() < 1e-6);
}

TEST_CASE("commands from outside: the motors get them instead of the pilot's") {
  const Vehicle quadrotor = vehicle();
  Simulator<Vehicle, Pilot> simulator = running(2);
  VehicleState<double> alone = simulator.vehicle();
  const Commands<double> commands{0.6, 0.58, 0.59, 0.61};
  for (int tick = 0; tick < 100; ++tick) {
    REQUIRE(simulator.tick(commands));
    for (int step = 0; step < 2; ++step) REQUIRE(quadrotor.step(alone, commands, 0.001) == Status::ok);
  }
  CHECK(simulator.commands() == commands);
  CHECK(simulator.recording().size() == 4);
  CHECK(simulator.recording().back().commands == commands);
  CHECK((simulator.vehicle().body.position_m - alone.body.position_m).norm() < 1e-12);
  CHECK(simulator.vehicle().body.position_m[2] < -35);  // more than the hover's thrust
  CHECK_FALSE(simulator.tick({0.5, std::numeric_limits<double>::quiet_NaN(), 0.5, 0.5}));
  CHECK(simulator.status() == Status::not_finite);
}

TEST_CASE("what ends a flight ends it for good, with time and state") {
  SUBCASE("the ground, found by a row") {
    SteadyPilot down;
    down.set_point.velocity_m_s[2] = 5;
    Simulator<Vehicle, SteadyPilot> simulator(vehicle(), down);
    CHECK_FALSE(simulator.advance(100));
    CHECK(simulator.end() == FlightEnd::ground);
    CHECK(simulator.status() == Status::ok);
    CHECK(simulator.altitude_m() <= 0);
    const std::size_t rows = simulator.recording().size();
    CHECK(simulator.recording().back().altitude_m > 0);
    const double time_s = simulator.time_s();
    CHECK_FALSE(simulator.tick());
    CHECK_FALSE(simulator.next_row());
    CHECK(simulator.time_s() == time_s);
    CHECK(simulator.recording().size() == rows);
  }
  SUBCASE("a step that is not finite") {
    const Quadrotor<double, Gap> quadrotor(airframe_value<PaperQuadrotor, double>(), paper_site<double>(), Gap{});
    FlightPlan plan;
    plan.samples = 100;
    const RecordedFlight recorded = fly(quadrotor, SteadyPilot{}, plan);
    CHECK(recorded.report.end == FlightEnd::bad_status);
    CHECK(recorded.report.status == Status::output_not_finite);
    CHECK(recorded.report.rows == 20);
    CHECK(recorded.report.last.time_s == doctest::Approx(1.0).epsilon(1e-9));
    CHECK(recorded.report.last.body.position_m[2] == doctest::Approx(-35));
    CHECK(recorded.flight.size() == 20);
  }
  SUBCASE("a pilot who asks for what is no number") {
    const auto broken = [](const State<double>& /*state*/, double time_s) {
      SetPoint<double> set_point;
      if (time_s > 2) set_point.velocity_m_s[0] = std::numeric_limits<double>::quiet_NaN();
      return set_point;
    };
    FlightPlan plan;
    plan.samples = 100;
    const RecordedFlight recorded = fly(vehicle(), broken, plan);
    CHECK(recorded.report.status == Status::not_finite);
    CHECK(recorded.report.rows == 40);
    CHECK(recorded.report.last.time_s == doctest::Approx(2).epsilon(0.01));
  }
  SUBCASE("an airframe that can't fly") {
    Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
    airframe.mass_kg = 0;
    Simulator<Vehicle, SteadyPilot> simulator(Vehicle(airframe, paper_site<double>(), {}, {}), SteadyPilot{});
    CHECK(simulator.status() == Status::invalid_airframe);
    CHECK_FALSE(simulator.tick());
  }
  SUBCASE("clocks that do not run") {
    FlightPlan no_time, backwards, no_steps, no_ticks;
    no_time.physics_step_s = 0;
    backwards.physics_step_s = -0.001;
    no_steps.steps_per_control = 0;
    no_ticks.controls_per_sample = 0;
    FlightPlan no_number;
    no_number.physics_step_s = std::numeric_limits<double>::quiet_NaN();
    for (const FlightPlan& settings : {no_time, backwards, no_steps, no_ticks, no_number}) {
      Simulator<Vehicle, SteadyPilot> simulator(vehicle(), SteadyPilot{}, settings);
      CHECK(simulator.status() == Status::out_of_range);
      CHECK_FALSE(simulator.advance(1));
    }
  }
}

TEST_CASE("a row that is no number ends the flight and is not kept") {
  Simulator<Vehicle, SteadyPilot, Blind> simulator(vehicle(), SteadyPilot{});
  CHECK_FALSE(simulator.advance(1));
  CHECK(simulator.status() == Status::output_not_finite);
  CHECK(simulator.recording().size() == 2);
  CHECK(simulator.time_s() == doctest::Approx(0.15));
}

TEST_CASE("places that are none: refused before the flight") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto status = [](double north_m, double down_m) {
    FlightPlan settings;
    settings.start_m = Vector3<double>(north_m, 0, down_m);
    Simulator<Vehicle, SteadyPilot> simulator(vehicle(), SteadyPilot{}, settings);
    CHECK_FALSE(simulator.tick());
    return simulator.status();
  };
  CHECK(status(nan, -35) == Status::not_finite);
  CHECK(status(0, nan) == Status::not_finite);
  CHECK(status(0, -50e3) == Status::out_of_range);  // no air there that the standard knows
  CHECK(status(0, 1e9) == Status::out_of_range);
}

TEST_CASE("a flight of no rows") {
  FlightPlan plan;
  plan.samples = 0;
  const RecordedFlight none = fly(vehicle(), pilot(1), plan);
  CHECK(none.report.end == FlightEnd::completed);
  CHECK(none.flight.empty());
  CHECK(none.report.rows == 0);
  CHECK(none.report.saturated_share == 0);
}

TEST_CASE("a pilot without lags asks for his targets at once; one whose limits are no numbers ends the flight") {
  PilotStyle prompt;
  prompt.velocity_lag_s = prompt.yaw_rate_lag_s = 0;
  Pilot at_once(std::mt19937_64(4), prompt, 0.877);
  const SetPoint<double> asked = at_once({}, 0.0);
  CHECK(all_finite(asked.velocity_m_s));
  CHECK(asked.velocity_m_s.norm() > 0);
  CHECK(is_finite(asked.yaw_rate_rad_s));
  Simulator<Vehicle, Pilot> simulator(vehicle(), Pilot(std::mt19937_64(4), prompt, 0.877));
  CHECK(simulator.advance(5));

  for (int which = 0; which < 3; ++which) {
    PilotStyle style;
    (which == 0   ? style.max_speed_m_s
     : which == 1 ? style.velocity_lag_s
                  : style.thumbs.roll_pitch_deviation_rad_s) = std::numeric_limits<double>::quiet_NaN();
    Simulator<Vehicle, Pilot> blind(vehicle(), Pilot(std::mt19937_64(4), style, 0.877));
    CHECK_FALSE(blind.advance(5));
    CHECK(blind.status() == Status::not_finite);
    CHECK(all_finite(blind.vehicle().body));
  }
}

TEST_CASE("a vehicle upside down has a tilt of half a turn, whatever its quaternion's last bits") {
  int beyond = 0;
  for (int i = 0; i < 1000; ++i) {
    const double turn = 1e-3 * i;
    const Quaternion<double> down{0.0, std::cos(turn), std::sin(turn), 0.0};
    beyond += body_down_axis(down)[2] < -1 ? 1 : 0;
    CHECK(std::fabs(tilt_rad(down) - 3.14159265358979) < 1e-7);
  }
  CHECK(beyond > 0);
}

TEST_CASE("a recorder is told the commands of each tick, and asked for a row after the last of them") {
  struct Counting {
    int* ticks;
    int* rows;
    Commands<double> last{};
    void hold(const Commands<double>& commands, double time_s) {
      CHECK(time_s == doctest::Approx(0.002 * *ticks));
      ++*ticks;
      last = commands;
    }
    Sample operator()(const Vehicle&, const VehicleState<double>& state, const Commands<double>& commands) {
      ++*rows;
      CHECK(*ticks == 25 * *rows);
      CHECK(commands == last);
      CHECK(state.time_s == doctest::Approx(0.05 * *rows));
      return {};
    }
    Sample operator()(const Quadrotor<double>&, const VehicleState<double>&, const Commands<double>&) { return {}; }
  };
  int ticks = 0, rows = 0;
  Simulator<Vehicle, Pilot, Counting> simulator(vehicle(), pilot(1), {}, Counting{&ticks, &rows});
  REQUIRE(simulator.advance(1));
  CHECK(ticks == 500);
  CHECK(rows == 20);
}

namespace {

/// Equation of the first rotor's speed controller: its thrust grows with the square of its speed.
struct Columns : pinnquad::ExactRecorder {
  std::vector<pinnquad::ColumnName> columns() const { return {{"n1", "rev/s"}, {"clock", "s"}}; }
  template <class Quadrotor>
  void measure(const Quadrotor& /*quadrotor*/, const VehicleState<double>& state, double* values) const {
    values[0] = 100 * std::sqrt(state.rotors[0]);
    values[1] = state.time_s < fails_s ? state.time_s : std::numeric_limits<double>::quiet_NaN();
  }
  double fails_s = 100;
};

}  // namespace

TEST_CASE("a recorder of columns: the same rows, a value per row and column; one that is not finite ends the flight") {
  Simulator<Vehicle, Pilot> plain(vehicle(), pilot(7));
  Simulator<Vehicle, Pilot, Columns> simulator(vehicle(), pilot(7), {}, Columns{{}, 2.0});
  for (int row = 0; row < 20; ++row) {
    REQUIRE(plain.next_row());
    REQUIRE(simulator.next_row());
    const auto& speeds = simulator.recording().column("n1")->values;
    REQUIRE(speeds.size() == std::size_t(row) + 1);
    CHECK(speeds.back() == 100 * std::sqrt(simulator.vehicle().rotors[0]));
    CHECK(simulator.recording().column("clock")->values.back() == simulator.time_s());
  }
  Flight rows = simulator.take_recording();
  CHECK(rows.columns().size() == 2);
  CHECK(pinnquad::to_values(rows[19]) == pinnquad::to_values(plain.recording()[19]));
  REQUIRE(simulator.next_row());  // it goes on with its columns
  CHECK(simulator.recording().column("clock")->values.size() == 1);
  while (simulator.next_row()) {
  }
  CHECK(simulator.status() == Status::output_not_finite);
  CHECK(simulator.time_s() == doctest::Approx(2.0));
}

TEST_CASE("a flight on a battery has its voltage as a column; one whose battery is off is the flight without one") {
  FlightPlan plan;
  plan.samples = 200;
  const Airframe<double> airframe = airframe_value<PaperQuadrotor, double>();
  const auto flown = [&](const std::optional<Battery>& battery) {
    return fly(flight_vehicle<AgileFlight>(airframe, GroundEffectModel::none, battery), pilot(3), plan);
  };
  const RecordedFlight without = flown({}), named = fly(vehicle(), pilot(3), plan);
  CHECK(content_hash(without.flight) == content_hash(named.flight));
  CHECK(without.flight.columns().empty());
  CHECK(without.report.last.charge_used_C == 0);

  const RecordedFlight on_battery = flown(Battery{4, 1.0, 0.6});
  REQUIRE(on_battery.report.end == FlightEnd::completed);
  REQUIRE(on_battery.flight.columns().size() == 1);
  const ExtraColumn& voltage = on_battery.flight.columns().front();
  CHECK(voltage.name == "battery_voltage");
  CHECK(voltage.unit == "V");
  double most = 0, least = 100;
  for (const double volts : voltage.values) most = std::max(most, volts), least = std::min(least, volts);
  CHECK(most < 4 * Battery::cell_at_rest_V(0.6));
  CHECK(least > 0.7 * 4 * Battery::full_cell_V);
  CHECK(least < most - 0.1);
  const double used_Ah = on_battery.report.last.charge_used_C / 3600;
  CHECK(used_Ah == doctest::Approx(10 * 11.0 / 3600).epsilon(0.5));  // ten seconds of some 11 A
}
