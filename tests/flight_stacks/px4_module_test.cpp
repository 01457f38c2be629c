// SPDX-License-Identifier: MIT
// PX4's module, its glue included (examples/px4_module/pinnquad_control.cpp), against a small uORB of ours and a
// stand-in of what PX4 does around a mode: the commander registers, unregisters, checks, changes modes; the allocator
// has the motors in PX4's own.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "px4/world.hpp"
#include "px4_module/pinnquad_control.hpp"

using namespace pinnquad::autopilot::test;

TEST_CASE("it registers although nobody listens at first, and when it was refused; config and arming check follow") {
  Px4World world;
  world.deaf = true;
  REQUIRE(shell("start") == PX4_OK);
  SUBCASE("nobody listens for 3 s") {
    world.run(3000);
    world.deaf = false;
  }
  SUBCASE("refused for 2 s") {
    world.deaf = false;
    world.refuses = true;
    world.run(2000);
    CHECK(world.mode_id == -1);
    world.refuses = false;
  }
  SUBCASE("started while armed: nobody is registered then") {
    world.deaf = false;
    world.armed = true;
    world.run(2000);
    CHECK(world.mode_id == -1);
    world.armed = false;
  }
  world.run(1500);
  CHECK(world.mode_id >= 0);
  CHECK(world.can_arm);
  world.nav_state = static_cast<uint8_t>(world.mode_id);
  world.run(50);
  CHECK(world.configured);
}

TEST_CASE("dropped by PX4, it registers again") {
  Px4World world;
  REQUIRE(shell("start") == PX4_OK);
  world.run(3000);
  REQUIRE(world.registrations == 1);
  world.mode_id = -1;
  world.run(2000);
  CHECK(world.mode_id >= 0);
  CHECK(world.registrations == 2);
}

TEST_CASE("stop is refused while it has the motors; they get commands all the while") {
  Px4World world;
  world.start_and_fly();
  world.longest_gap_us = 0;
  CHECK(shell("stop") == PX4_ERROR);
  world.run(500);
  CHECK(PinnquadControl::runs());
  CHECK(world.longest_gap_us <= 2000);
  CHECK(world.nav_state == world.mode_id);
}

TEST_CASE("stopped, it takes no topic with it: the motors are PX4's within 50 ms, the mode is gone") {
  Px4World world;
  world.start_and_fly();
  world.longest_gap_us = 0;
  SUBCASE("in the air, after another mode was selected") {
    world.nav_state = Px4World::hold;
    world.run(20);
    CHECK(shell("stop") == PX4_OK);
    CHECK_FALSE(PinnquadControl::runs());
    world.run(1000);
    CHECK(world.unregistrations == 0);  // PX4 does not look while it is armed
    world.armed = false;                // and finds it all the same
    world.run(50);
  }
  SUBCASE("on the ground, disarmed") {
    world.armed = false;
    world.run(20);
    CHECK(shell("stop") == PX4_OK);
    world.run(50);
    CHECK(world.nav_state == Px4World::hold);
  }
  CHECK_FALSE(PinnquadControl::runs());
  CHECK(world.unregistrations == 1);
  CHECK(world.mode_id == -1);
  CHECK(world.longest_gap_us <= 50'000);
  CHECK(uORB::nodes()["actuator_motors"].advertisers == 2);  // the module's publication is still there
  CHECK(uORB::nodes()["unregister_ext_component"].advertisers == 1);
  REQUIRE(shell("start") == PX4_OK);  // and once more: the reply of the first time is still there to be read
  world.run(1500);
  CHECK(world.mode_id >= 0);
  CHECK(world.registrations == 2);
}

TEST_CASE("giving up it asks for what PX4 can grant, until it is heard; the motors wait 50 ms at most") {
  Px4World world;
  world.start_and_fly();
  world.longest_gap_us = 0;
  SUBCASE("an attitude that stops: Hold") {
    world.attitude_stops = true;
    world.run(200);
    CHECK(world.nav_state == Px4World::hold);
  }
  SUBCASE("PX4 has no position: Altitude") {
    world.attitude_stops = true;
    world.flags.local_position_invalid = true;
    world.run(200);
    CHECK(world.nav_state == Px4World::altitude);
  }
  SUBCASE("no position and no sticks: Descend") {
    world.attitude_stops = true;
    world.flags.local_position_invalid = world.flags.manual_control_signal_lost = true;
    world.run(200);
    CHECK(world.nav_state == Px4World::descend);
  }
  SUBCASE("its own position stopped, whatever PX4 says: not Hold") {
    world.local_stops = true;
    world.run(1500);  // levels for 1 s first
    CHECK(world.nav_state == Px4World::altitude);
    for (const uint8_t mode : world.asked_for) CHECK(mode != Px4World::hold);
  }
  CHECK(world.longest_gap_us <= 50'000);
  world.run(400);
  CHECK_FALSE(world.can_arm);
}

TEST_CASE("nobody hears it for 300 ms: it asks again; a mode that PX4 does not grant is not asked for for ever") {
  Px4World world;
  world.start_and_fly();
  world.attitude_stops = true;
  SUBCASE("deaf") {
    world.deaf = true;
    world.run(300);
    world.deaf = false;
    world.run(20);
    CHECK(world.nav_state < vehicle_status_s::NAVIGATION_STATE_EXTERNAL1);
  }
  SUBCASE("flags that say there is a position, and there is none") {
    world.lies = true;
    world.run(400);
    CHECK(world.nav_state == Px4World::altitude);
    CHECK(world.asked_for.front() == Px4World::hold);
  }
}

TEST_CASE("selected, it alone writes to the motors, 30 ms after at the latest; selected once more, too") {
  Px4World world;
  world.start_and_fly();
  for (int i = 0; i < 2; ++i) {
    CHECK(world.by_others <= 30);
    world.by_others = world.by_module = 0;
    world.run(2000);
    CHECK(world.by_others == 0);
    CHECK(world.by_module == 2000);
    world.nav_state = Px4World::hold;
    world.run(500);
    world.nav_state = static_cast<uint8_t>(world.mode_id);
    world.run(50);
  }
}

TEST_CASE("the model's rotors at another scale: PX4's allocation knows none") {
  Px4World world;
  set_px4_airframe(pinnquad::airframe_value<TrainedQuadModel::Vehicle, double>(), 5);
  REQUIRE(shell("start") == PX4_OK);
  world.run(3000);
  CHECK(world.can_arm);
  CHECK(px4::complaints().empty());
}

TEST_CASE("rotors that are not the model's: it does not arm, and says why in one line; mended, it does") {
  Px4World world;
  const auto airframe = pinnquad::airframe_value<TrainedQuadModel::Vehicle, double>();
  auto& values = px4::parameter_values();
  const char* says = "";
  SUBCASE("six") {
    values["CA_ROTOR_COUNT"] = 6;
    says = "CA_ROTOR_COUNT says 6";
  }
  SUBCASE("in another order") {
    std::swap(values["CA_ROTOR1_PX"], values["CA_ROTOR3_PX"]);
    std::swap(values["CA_ROTOR1_PY"], values["CA_ROTOR3_PY"]);
    says = "CA_ROTOR1_PX";
  }
  SUBCASE("a wide one") {
    values["CA_ROTOR2_PY"] *= 1.6;
    values["CA_ROTOR1_PY"] *= 1.6;
    says = "_PY are";
  }
  SUBCASE("back to front") {
    set_px4_airframe(airframe, -1);
    says = "CA_ROTOR0_PX";
  }
  SUBCASE("one turns the other way") {
    values["CA_ROTOR2_KM"] = 0.05;
    says = "CA_ROTOR2_KM is 0.050; on the model's airframe the rotor turns clockwise";
  }
  SUBCASE("one without a sense of rotation") {
    values["CA_ROTOR0_KM"] = 0;
    says = "CA_ROTOR0_KM is 0.000; on the model's airframe the rotor turns counter-clockwise";
  }
  SUBCASE("no parameters") {
    values.erase("CA_ROTOR_COUNT");
    says = "CA_ROTOR_COUNT says 0";
  }
  REQUIRE(shell("start") == PX4_OK);
  world.run(3000);
  CHECK(world.mode_id >= 0);
  CHECK_FALSE(world.can_arm);
  REQUIRE(px4::complaints().size() == 1);
  CHECK(px4::complaints()[0].find(says) != std::string::npos);
  CHECK(px4::ground_station() == px4::complaints());
  set_px4_airframe(airframe);
  world.run(1000);
  CHECK_FALSE(world.can_arm);  // nobody has said so
  world.set("CA_ROTOR_COUNT", 4);
  world.run(1000);
  CHECK(world.can_arm);
  CHECK(px4::complaints().size() == 1);
}

TEST_CASE("a parameter that changes in flight takes nothing from it") {
  Px4World world;
  world.start_and_fly();
  world.set("CA_ROTOR_COUNT", 6);
  world.run(1000);
  CHECK(world.can_arm);
  world.armed = false;
  world.set("CA_ROTOR_COUNT", 6);
  world.run(1000);
  CHECK_FALSE(world.can_arm);
}

TEST_CASE("thin air and another thrust curve than PX4's: the motors get the control that makes the same thrust") {
  const auto hover = [](double density_kg_m3, double curve, double px4_curve) {
    Px4World world;
    auto& values = px4::parameter_values();
    values["PQ_AIR_RHO"] = density_kg_m3;
    values["PQ_THR_CURVE"] = curve;
    values["THR_MDL_FAC"] = px4_curve;
    REQUIRE(shell("start") == PX4_OK);
    world.fly();
    return double(world.last.control[0]);
  };
  const double rated = hover(1.225, -1, 0);
  const auto thrust = [](double k, double s) { return k * s * s + (1 - k) * s; };
  CHECK(hover(1.225, -1, 0.6) == doctest::Approx(rated));  // PX4's business
  CHECK(hover(1.225, 0.6, 0.6) == doctest::Approx(rated));
  CHECK(hover(0.98, -1, 0) == doctest::Approx(rated * 1.225 / 0.98));
  // control = signal where PX4 undoes nothing; the signal's thrust is the one wanted
  CHECK(thrust(0.6, hover(1.225, 0.6, 0)) == doctest::Approx(rated));
  CHECK(thrust(0.6, hover(0.98, 0.6, 0)) == doctest::Approx(rated * 1.225 / 0.98));
  // a linear propulsion behind PX4's square: the control's root is the signal
  CHECK(std::sqrt(hover(1.225, 0, 1)) == doctest::Approx(rated));
}

TEST_CASE("a battery that sags: the controls grow by its scale where the parameter asks for it, not beyond 1") {
  const auto hover = [](int asked, bool connected, float scale) {
    Px4World world;
    px4::parameter_values()["PQ_BAT_SCALE"] = asked;
    REQUIRE(shell("start") == PX4_OK);
    world.fly();
    uORB::Publication<battery_status_s> battery{ORB_ID(battery_status)};
    battery.publish({World::now_us, connected, scale, 15});
    world.run(20);
    return double(world.last.control[0]);
  };
  const double full = hover(1, true, 1);
  CHECK(hover(1, true, 1.2f) == doctest::Approx(1.2 * full).epsilon(0.01));
  CHECK(hover(0, true, 1.2f) == doctest::Approx(full).epsilon(0.01));
  CHECK(hover(1, false, 1.2f) == doctest::Approx(full).epsilon(0.01));
  for (const float none : {-1.0f, 0.0f, 30.0f, NAN}) CHECK(hover(1, true, none) == doctest::Approx(full).epsilon(0.01));
  pinnquad_px4::Propulsion propulsion;
  propulsion.battery_scale(1.25f);
  float controls[4];
  propulsion.controls(std::array<float, 4>{0.9f, 0.8f, 0.5f, 0.05f}, controls);  // the last has no room below
  for (const float u : controls) CHECK((u >= 0 && u <= 1));
  CHECK(controls[0] == doctest::Approx(1));
  CHECK(controls[0] - controls[1] == doctest::Approx(1.25 * 0.1));  // the torque stays
  CHECK(controls[1] - controls[2] == doctest::Approx(1.25 * 0.3));
}

TEST_CASE("propulsion: there and back again, over the whole range; a density that is none is the rated one") {
  for (const float density : {0.6f, 1.225f, 1.4f}) {
    for (const float curve : {-1.0f, 0.0f, 0.3f, 1.0f}) {
      for (const float px4_curve : {0.0f, 0.5f, 1.0f}) {
        const pinnquad_px4::Propulsion propulsion(density, curve, px4_curve);
        CHECK(propulsion.control(propulsion.thrust(1.0f)) == doctest::Approx(1.0));
        CHECK(propulsion.thrust(1.0f) == doctest::Approx(double(density) / 1.225));
        for (float u = 0; u <= 1; u += 0.125f) {
          CHECK(propulsion.control(propulsion.thrust(u)) == doctest::Approx(double(u)).epsilon(1e-5));
        }
      }
    }
  }
  CHECK(pinnquad_px4::Propulsion(-1.0f, -1.0f, 0.0f).control(0.5f) == 0.5f);
  CHECK(pinnquad_px4::Propulsion(std::numeric_limits<float>::quiet_NaN(), -1.0f, 0.0f).control(0.5f) == 0.5f);
}

TEST_CASE("the sample that the motors answer is the gyro's") {
  Px4World world;
  world.start_and_fly();
  CHECK(world.last.timestamp_sample == world.gyro_sample_us);
  CHECK(world.last.timestamp >= world.last.timestamp_sample);
  CHECK(std::isnan(world.last.control[4]));
}

TEST_CASE("each of EKF2's five reset counters alone moves what it says by its own delta, and nothing else") {
  Px4World world;
  world.start_and_fly();
  uORB::Subscription record_sub{ORB_ID(pinnquad_record)};
  // the deltas of all are there all the while, as in EKF2's messages
  const float deltas[7] = {3, -1, 0.5f, 0.25f, -0.75f, 0.125f, 0.4f};
  world.local.delta_xy[0] = deltas[0], world.local.delta_xy[1] = deltas[1], world.local.delta_z = deltas[2];
  world.local.delta_vxy[0] = deltas[3], world.local.delta_vxy[1] = deltas[4], world.local.delta_vz = deltas[5];
  world.local.delta_heading = deltas[6];
  struct Reset {
    const char* name;
    uint8_t vehicle_local_position_s::*counter;
    std::vector<std::size_t> moves;  ///< places in `deltas`
  };
  const Reset resets[] = {{"xy", &vehicle_local_position_s::xy_reset_counter, {0, 1}},
                          {"z", &vehicle_local_position_s::z_reset_counter, {2}},
                          {"vxy", &vehicle_local_position_s::vxy_reset_counter, {3, 4}},
                          {"vz", &vehicle_local_position_s::vz_reset_counter, {5}},
                          {"heading", &vehicle_local_position_s::heading_reset_counter, {6}}};
  world.run(20);
  for (const Reset& reset : resets) {
    CAPTURE(reset.name);
    ++(world.local.*reset.counter);
    float moved[7] = {};
    for (int i = 0; i < 40; ++i) {  // a record each millisecond: the jump is in one of them
      world.run(1);
      pinnquad_record_s record{};
      if (!record_sub.update(&record)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        moved[axis] += record.jump_position_m[axis];
        moved[3 + axis] += record.jump_velocity_m_s[axis];
      }
      moved[6] += record.jump_yaw_rad;
    }
    for (std::size_t i = 0; i < 7; ++i) {
      CAPTURE(i);
      const bool is_its = std::find(reset.moves.begin(), reset.moves.end(), i) != reset.moves.end();
      CHECK(moved[i] == (is_its ? deltas[i] : 0));
    }
  }
}

TEST_CASE("without set points it holds the place where it was selected, not where it was started") {
  Px4World world;
  world.sends_set_points = false;
  REQUIRE(shell("start") == PX4_OK);
  world.run(3000);
  world.local.x = 5;
  world.fly();
  for (int i = 1; i < 4; ++i) CHECK(std::abs(world.last.control[i] - world.last.control[0]) < 0.02f);
}

TEST_CASE("armed in the mode, hovering, landing: PX4's land detector says what is so, and PX4 disarms") {
  for (const bool range_finder : {false, true}) {
    for (const float height : {0.7f, 2.0f, 10.0f}) {
      CAPTURE(range_finder);
      CAPTURE(height);
      Px4World world;
      world.moves = world.detects = world.landed = true;
      world.range_finder = range_finder;
      world.start_and_fly();
      REQUIRE(world.landed);
      world.set_point.position[2] = -height;
      world.run(4000 + 1000 * static_cast<int>(height));
      float lowest = 100;
      for (int i = 0; i < 2000; ++i) {
        world.run(10);
        lowest = std::min(lowest, world.height_m());
        REQUIRE_FALSE(world.landed);
      }
      CHECK(lowest > 0.75f * height);
      world.set_point.position[2] = world.set_point.position[0] = NAN;
      world.set_point.velocity[2] = 0.5f;
      for (int i = 0; i < 3000 && world.height_m() > 0.01f; ++i) world.run(10);
      CHECK(world.height_m() <= 0.01f);
      float highest = 0;
      int ms = 0;
      for (; world.armed && ms < 20'000; ms += 10) {
        world.run(10);
        highest = std::max(highest, world.height_m());
      }
      CHECK_FALSE(world.armed);
      CHECK(highest < 0.05f);
      CHECK(ms < 8000);
    }
  }
}

TEST_CASE("a slow climb is no landing, with a range finder and without") {
  for (const bool range_finder : {false, true}) {
    Px4World world;
    world.moves = world.detects = world.landed = true;
    world.range_finder = range_finder;
    world.start_and_fly();
    world.set_point.velocity[2] = -0.2f;
    for (int i = 0; i < 600; ++i) {
      world.set_point.position[2] -= 0.02f;
      world.run(100);
      if (i > 30) REQUIRE_FALSE(world.landed);
    }
    CHECK(world.armed);
    CHECK(world.height_m() == doctest::Approx(12).epsilon(0.05));
  }
}

TEST_CASE("told in the air that it has landed, it flies on") {
  Px4World world;
  world.moves = world.landed = true;
  world.start_and_fly();
  world.set_point.position[2] = -2;
  world.run(5000);
  world.set_point.position[2] = -1.9f;  // a little down
  world.run(5000);
  CHECK(world.height_m() == doctest::Approx(1.9).epsilon(0.05));
  world.landed = false;
  world.run(1000);
  world.landed = true;
  world.set_point.position[2] = -1;
  world.run(5000);
  CHECK(world.height_m() == doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("motors that are stronger than the model's: it sinks as it is told, and no ground is felt in the air") {
  for (const double stronger : {0.8, 1.3}) {
    CAPTURE(stronger);
    Px4World world;
    world.stronger = stronger;
    world.moves = world.detects = world.landed = true;
    world.start_and_fly();
    world.set_point.position[2] = -10;
    world.run(15'000);
    world.set_point.position[2] = NAN;
    world.set_point.velocity[2] = 0.4f;
    for (int i = 0; i < 1500; ++i) {
      world.run(10);
      REQUIRE(world.record().lift == 1);
      REQUIRE(world.local.vz < 0.8f);
    }
    CHECK(world.height_m() < 6);
    CHECK(world.height_m() > 2);
  }
}

TEST_CASE("armed at its own place it stays there, however its estimate of the height wanders by 30 cm") {
  Px4World world;
  world.moves = world.detects = world.landed = true;
  world.start_and_fly();
  for (int i = 0; i < 1000; ++i) {
    const float drift = 0.3f * std::sin(0.01f * static_cast<float>(i));
    world.local.z += drift - world.drift_m;
    world.drift_m = drift;
    world.run(10);
    for (int motor = 0; motor < 4; ++motor) REQUIRE(world.last.control[motor] == doctest::Approx(0.02));
  }
  world.set_point.position[2] = -0.7f;
  world.run(3000);
  CHECK(world.height_m() > 0.3f);
}

TEST_CASE("thrust and torque set points say what the motors do, as PX4's allocator would") {
  Px4World world;
  world.set_point.position[1] = 0.4f;
  world.set_point.yaw = 0.3f;
  world.start_and_fly();
  uORB::Subscription thrust_sub{ORB_ID(vehicle_thrust_setpoint)}, torque_sub{ORB_ID(vehicle_torque_setpoint)};
  vehicle_thrust_setpoint_s thrust{};
  vehicle_torque_setpoint_s torque{};
  REQUIRE(thrust_sub.update(&thrust));
  REQUIRE(torque_sub.update(&torque));
  CHECK(thrust.timestamp_sample == world.last.timestamp_sample);
  CHECK(torque.timestamp_sample == world.last.timestamp_sample);
  // a quadrotor in X: roll and pitch by 1/sqrt(2) of the torque set point, yaw by all of it, on top of the thrust
  const float* u = world.last.control;
  const double half = std::sqrt(0.5);
  const double signs[4][3] = {{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}};
  for (int i = 0; i < 4; ++i) {
    const double made = -double(thrust.xyz[2]) +
                        half * (signs[i][0] * double(torque.xyz[0]) + signs[i][1] * double(torque.xyz[1])) +
                        signs[i][2] * double(torque.xyz[2]);
    CHECK(made == doctest::Approx(double(u[i])).epsilon(1e-4));
  }
  CHECK(torque.xyz[0] > 0.01f);
  CHECK(torque.xyz[2] > 0.01f);
  world.nav_state = Px4World::hold;
  world.run(100);
  while (thrust_sub.update(&thrust)) {
  }
  world.run(500);
  CHECK_FALSE(thrust_sub.updated());  // PX4's own controllers say it then
}

TEST_CASE("while another mode is selected the inverse is kept warm, 50 times a second") {
  Px4World world;
  REQUIRE(shell("start") == PX4_OK);
  world.run(1500);
  uORB::Subscription status_sub{ORB_ID(pinnquad_status)};
  pinnquad_status_s status{};
  static_cast<void>(status_sub.update(&status));
  const auto steps_in_a_second = [&] {
    int steps = 0;
    for (int i = 0; i < 1000; ++i) {
      world.run(1);
      if (status_sub.update(&status)) ++steps;
    }
    return steps;
  };
  CHECK(steps_in_a_second() == 50);
  CHECK(world.can_arm);
  world.nav_state = static_cast<uint8_t>(world.mode_id);
  world.run(20);
  CHECK(steps_in_a_second() == 1000);
}

TEST_CASE("module.yaml and the module have the same ranges, and the same parameters read at start") {
  read_parameters();
  std::size_t known = 0;
  for (const auto& parameter : px4::parameter_values()) {
    const std::string& name = parameter.first;
    const auto value = parameter.second;
    if (name.rfind("PQ_", 0) != 0) continue;
    CAPTURE(name);
    ++known;
    const pinnquad_px4::ParameterRange* found = nullptr;
    for (const auto& range : pinnquad_px4::parameter_ranges) {
      if (name == range.name) found = &range;
    }
    REQUIRE(found != nullptr);
    CHECK(found->holds(static_cast<float>(value)));
    CHECK(found->at_start == (parameter_bounds("reboot_required:").count(name) != 0));
    if (parameter_bounds("min:").count(name) == 0) {
      CHECK(found->least == 0);  // a boolean
      CHECK(found->most == 1);
      continue;
    }
    CHECK(static_cast<double>(found->least) == doctest::Approx(parameter_bounds("min:")[name]));
    CHECK(static_cast<double>(found->most) == doctest::Approx(parameter_bounds("max:")[name]));
  }
  CHECK(known == std::size(pinnquad_px4::parameter_ranges));
}

TEST_CASE("a parameter beyond its range: it does not start, and one line says which") {
  for (const auto& beyond : {std::pair<const char*, double>{"PQ_OUT_MIN", 1.5},
                             {"PQ_V_XY", -3},
                             {"PQ_AGE_RATES", -1},
                             {"PQ_AGE_ATT", -1},
                             {"PQ_AGE_POS", -1},
                             {"PQ_AGE_SP", -1},
                             {"PQ_G_RATE", -22},
                             {"PQ_STK_Z", NAN},
                             {"PQ_AIR_RHO", 0}}) {
    const char* const name = beyond.first;
    CAPTURE(name);
    Px4World world;
    px4::parameter_values()[name] = beyond.second;
    CHECK(shell("start") == PX4_ERROR);
    CHECK_FALSE(PinnquadControl::runs());
    REQUIRE(px4::complaints().size() == 1);
    CHECK(px4::complaints()[0].find(name) == 0);
  }
}

TEST_CASE("one that goes beyond its range later: not armed, the ground station hears why; back again, it may") {
  Px4World world;
  REQUIRE(shell("start") == PX4_OK);
  world.run(1500);
  REQUIRE(world.can_arm);
  world.set("PQ_V_XY", -3);
  world.run(500);
  CHECK_FALSE(world.can_arm);
  REQUIRE(px4::ground_station().size() == 1);
  CHECK(px4::ground_station()[0] == "will not arm: PQ_V_XY is -3.000, its range 1.000 to 20.000");
  world.run(1000);
  CHECK(px4::ground_station().size() == 1);
  world.nav_state = static_cast<uint8_t>(world.mode_id);  // a pilot who comes later hears it too
  world.run(500);
  CHECK(px4::ground_station().size() == 2);
  world.set("PQ_V_XY", 5);
  world.run(500);
  CHECK(world.can_arm);
  CHECK(px4::ground_station().size() == 2);
}

TEST_CASE("without an attitude it is not armed in the mode, and the ground station hears why, once") {
  Px4World world;
  REQUIRE(shell("start") == PX4_OK);
  world.run(1500);
  world.attitude_stops = true;
  world.run(1000);
  CHECK_FALSE(world.can_arm);
  CHECK(px4::ground_station().empty());  // nobody asked to fly
  world.nav_state = static_cast<uint8_t>(world.mode_id);
  world.lies = true;  // PX4 does not follow the takeover yet
  world.run(100);
  CHECK(world.by_module > 50);  // a simulator in lockstep waits for the outputs
  for (const float control : world.last.control) CHECK(std::isnan(control));
  world.lies = false;
  world.run(900);
  REQUIRE(px4::ground_station().size() == 1);
  CHECK(px4::ground_station()[0] == "will not arm: no answer to fly by; too old: attitude");
}

TEST_CASE("the motors' idling is below what PX4's land detector takes for standing") {
  for (const auto& range : pinnquad_px4::parameter_ranges) {
    if (std::string("PQ_OUT_MIN") == range.name) CHECK(range.most <= LandDetector::least_manual_thrust + 0.01f);
  }
}

TEST_CASE("in flight the sticks' speeds change; what is beyond its range changes nothing") {
  Px4World world;
  world.sends_set_points = false;
  world.start_and_fly();
  world.sends_sticks = world.sticks.valid = true;
  world.sticks.pitch = 1;
  const auto forward_m_s = [&] {
    world.run(100);
    return world.record().wanted_velocity_m_s[0];
  };
  CHECK(forward_m_s() == doctest::Approx(5));
  for (const double asked : {3, 300}) {
    world.set("PQ_STK_XY", asked);
    CHECK(forward_m_s() == doctest::Approx(3));
  }
  CHECK(world.can_arm);  // it keeps its mode
}

TEST_CASE("a second model in the tick of the first is refused, and one line says so") {
  Px4World world;
  REQUIRE(shell("start") == PX4_OK);
  world.run(1500);
  char name[] = "pinnquad_control", command[] = "model", file[] = "etc/pinnquad/model.block";
  char* arguments[] = {name, command, file};
  CHECK(pinnquad_control_main(3, arguments) == PX4_OK);
  CHECK(px4::complaints().empty());
  CHECK(pinnquad_control_main(3, arguments) == PX4_ERROR);
  REQUIRE(px4::complaints().size() == 1);
  CHECK(px4::complaints()[0].find("once more") != std::string::npos);
  world.run(100);
  CHECK(pinnquad_control_main(3, arguments) == PX4_OK);
}

TEST_CASE("each step's record is published, and the settings once a second: what replay needs") {
  Px4World world;
  world.start_and_fly();
  uORB::Subscription record_sub{ORB_ID(pinnquad_record)}, settings_sub{ORB_ID(pinnquad_settings)};
  pinnquad_record_s record{};
  static_cast<void>(record_sub.update(&record));
  pinnquad_settings_s settings{};
  static_cast<void>(settings_sub.update(&settings));
  int published = 0;
  for (int i = 0; i < 1500; ++i) {
    const uint32_t before = record.tick;
    world.run(1);
    REQUIRE(record_sub.update(&record));
    CHECK(record.tick == before + 1);
    for (int motor = 0; motor < 4; ++motor) CHECK(record.commands[motor] == world.last.control[motor]);
    CHECK(record.body_rates_us == world.gyro_sample_us);
    CHECK(record.drives_motors == 1);
    if (settings_sub.update(&settings)) ++published;
  }
  CHECK(record.attitude[0] == 1);
  CHECK(record.model != 0);
  CHECK(published >= 1);
  CHECK(published <= 2);
  CHECK(settings.horizontal_speed_m_s == px4::parameter_values()["PQ_V_XY"]);
  CHECK(settings.lowest_command == doctest::Approx(px4::parameter_values()["PQ_OUT_MIN"]));
  world.armed = false;  // selected still, and the motors are nobody's
  world.run(100);
  REQUIRE(record_sub.update(&record));
  CHECK(record.drives_motors == 0);
  world.attitude_stops = true;
  world.run(30);
  REQUIRE(record_sub.update(&record));
  CHECK((record.stale_inputs & 2) != 0);
}

TEST_CASE("the vehicle is learnt where the parameter asks for it, from one step to the next") {
  Px4World world;
  world.start_and_fly();
  const auto asked_for = [&](double value) {
    world.set("PQ_ONBOARD", value);
    world.run(1);
    return world.record().learning;
  };
  CHECK(world.record().learning == 0);
  CHECK(asked_for(1) == 1);
  CHECK((world.record().learnt & pinnquad::autopilot::CoreRecord::seen_flight) != 0);
  CHECK(asked_for(2) == 2);
  CHECK(asked_for(3) == 3);
  CHECK(asked_for(4) == 3);  // beyond its range: what was stays
  CHECK(asked_for(0) == 0);
}

TEST_CASE("told not to, it publishes no record") {
  Px4World world;
  px4::parameter_values()["PQ_RECORD"] = 0;
  world.start_and_fly();
  uORB::Subscription record_sub{ORB_ID(pinnquad_record)};
  pinnquad_record_s record{};
  static_cast<void>(record_sub.update(&record));
  world.run(20);
  CHECK_FALSE(record_sub.update(&record));
}

TEST_CASE("without a trajectory the sticks fly it along its heading; released, it holds where it came to stand") {
  Px4World world;
  world.sends_set_points = false;
  world.yaw = 0.5f;
  world.start_and_fly();
  manual_control_setpoint_s& sticks = world.sticks;
  world.sends_sticks = sticks.valid = true;
  const auto flown_for = [&](int ms) {
    world.run(ms);
    return world.record();
  };
  constexpr uint8_t flies = 0, holds = 1;
  CHECK(flown_for(700).reaction == holds);  // centred sticks ask for nothing
  const double full = px4::parameter_values()["PQ_STK_XY"];
  sticks.pitch = 1;
  sticks.yaw = -1;
  pinnquad_record_s record = flown_for(100);
  CHECK(record.reaction == flies);
  CHECK(record.wanted_velocity_m_s[0] == doctest::Approx(full * std::cos(0.5)));
  CHECK(record.wanted_velocity_m_s[1] == doctest::Approx(full * std::sin(0.5)));
  CHECK(record.wanted_velocity_m_s[2] == 0);
  CHECK(record.wanted_yaw_rate_rad_s == doctest::Approx(-px4::parameter_values()["PQ_STK_YAW"]));
  CHECK(std::isnan(record.wanted_position_m[0]));
  sticks.pitch = sticks.yaw = 0;
  sticks.roll = 1;
  sticks.throttle = 1;
  world.local.vx = 2;
  record = flown_for(100);
  CHECK(record.wanted_velocity_m_s[0] == doctest::Approx(-full * std::sin(0.5)));
  CHECK(record.wanted_velocity_m_s[2] == doctest::Approx(-px4::parameter_values()["PQ_STK_Z"]));
  sticks.roll = sticks.throttle = 0.04f;  // within the dead zone: released
  record = flown_for(700);
  CHECK(record.reaction == flies);  // brakes
  CHECK(record.wanted_velocity_m_s[0] == 0);
  world.local.vx = 0.1f;
  CHECK(flown_for(700).reaction == holds);
  sticks.throttle = 1;
  world.local.vz = -1;
  world.run(100);
  sticks.throttle = 0;
  record = flown_for(700);
  CHECK(record.reaction == flies);  // a climb is braked too
  CHECK(record.wanted_velocity_m_s[2] == 0);
  world.local.vz = 0;
  CHECK(flown_for(700).reaction == holds);
  sticks.pitch = 1;
  sticks.valid = false;
  CHECK(flown_for(100).reaction == holds);  // a radio that is lost flies nothing
}

TEST_CASE("a place to go to goes before the sticks, a trajectory before both") {
  Px4World world;
  world.sends_set_points = false;
  world.start_and_fly();
  uORB::Publication<goto_setpoint_s> goto_pub{ORB_ID(goto_setpoint)};
  goto_setpoint_s place{};
  place.position[0] = 3, place.position[2] = -1;
  place.flag_control_heading = true;
  place.heading = 0.25f;
  world.sends_sticks = world.sticks.valid = true;
  world.sticks.pitch = 1;
  const auto run = [&](int ms, bool sends_places) {
    for (int i = 0; i < ms; i += 10) {
      place.timestamp = World::now_us;
      if (sends_places) goto_pub.publish(place);
      world.run(10);
    }
    return world.record();
  };
  pinnquad_record_s record = run(100, true);
  CHECK(record.wanted_position_m[0] == 3);
  CHECK(record.wanted_yaw_rad == 0.25f);
  CHECK(std::isnan(record.wanted_velocity_m_s[0]));
  world.sends_set_points = true;
  world.set_point.position[0] = 1;
  CHECK(run(100, true).wanted_position_m[0] == 1);
  world.sends_set_points = false;
  CHECK(run(400, true).wanted_position_m[0] == 1);  // silent for less than half a second
  CHECK(run(200, true).wanted_position_m[0] == 3);
  record = run(700, false);
  CHECK(std::isnan(record.wanted_position_m[0]));
  CHECK(record.wanted_velocity_m_s[0] == doctest::Approx(px4::parameter_values()["PQ_STK_XY"]));
}
