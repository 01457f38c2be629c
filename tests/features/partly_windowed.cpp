// SPDX-License-Identifier: MIT
// Windows over a part of a feature set: the whole at the present instant, the part at the others.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "pinnquad/features/input_history.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;
using pinnquad::test::RandomStates;

namespace {

using Period = PeriodMicroseconds<20000>;
using Whole = WithColumns<PhysicsFeatures, BatteryVoltage>;
using Past = PartlyWindowed<Whole, AccelerationFeatures, 3, Period>;
using About = PartlyWindowed<Whole, AccelerationFeatures, 5, Period, Centred>;

Whole::Inputs<double> some(RandomStates& random) {
  Whole::Inputs<double> inputs;
  static_cast<MotionInputs<double>&>(inputs) = motion_inputs(random.state<double>(), random.motion<double>());
  inputs.column<BatteryVoltage>() = 3.7;
  return inputs;
}

}  // namespace

TEST_CASE("names, units and places: all of the present, then the part of each other tap") {
  CHECK(is_feature_set<Past>);
  CHECK(is_feature_set<About>);
  CHECK(is_windowed<Past>);
  CHECK(Past::size == 22 + 2 * 6);
  CHECK(About::size == 22 + 4 * 6);
  CHECK(std::string(Past::names[21]) == "battery_voltage");
  CHECK(std::string(Past::units[21]) == "V");
  CHECK(std::string(Past::names[22]) == "s_x[-1]");
  CHECK(std::string(Past::names[33]) == "wdot_z[-2]");
  CHECK(std::string(Past::units[27]) == "rad/s^2");
  CHECK(std::string(About::names[22 + 12]) == "s_x[+1]");
  CHECK(std::string(extra_column_names<Past>[0]) == "battery_voltage");
  CHECK(angular_acceleration_at<Past>(0) == 3);
  CHECK(angular_acceleration_at<Past>(1) == 25);
  CHECK(angular_acceleration_at<Past>(2) == 31);
  CHECK(angular_acceleration_at<PartlyWindowed<Whole, SpecificForce, 3, Period>>(2) == -1);
  CHECK(angular_acceleration_at<Windowed<PaperFeatures, 3, Period>>(2) == 35);
  CHECK(angular_acceleration_at<PaperFeatures>(0) == 3);
  for (int tap = 0; tap < 3; ++tap) {
    const auto first = std::size_t(angular_acceleration_at<Past>(tap));
    CHECK(std::string(Past::names[first]).substr(0, 6) == "wdot_x");
  }
}

TEST_CASE("X is the whole of the present, then the part of each other tap, NaN where it is not there") {
  RandomStates random(3);
  Past::Inputs<double> in;
  static_cast<Whole::Inputs<double>&>(in) = some(random);
  in.others = {some(random), some(random)};
  CHECK(Past::check(in) == Status::warming_up);
  std::array<double, Past::size> x{};
  Past::extract(in, x.data());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(is_finite(x[i]) == (i < 22));
  in.complete = true;
  CHECK(Past::check(in) == Status::ok);
  Past::extract(in, x.data());
  std::array<double, 22> present{};
  Whole::extract(static_cast<const Whole::Inputs<double>&>(in), present.data());
  for (std::size_t i = 0; i < present.size(); ++i) CHECK(x[i] == present[i]);
  for (std::size_t tap = 0; tap < 2; ++tap) {
    std::array<double, 6> part{};
    AccelerationFeatures::extract(in.others[tap], part.data());
    for (std::size_t i = 0; i < part.size(); ++i) CHECK(x[22 + 6 * tap + i] == part[i]);
  }
}

TEST_CASE("of another tap only what it is asked for is checked; of the present all") {
  RandomStates random(4);
  Past::Inputs<double> in;
  static_cast<Whole::Inputs<double>&>(in) = some(random);
  in.others = {some(random), some(random)};
  in.complete = true;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  in.others[1].column<BatteryVoltage>() = nan;
  CHECK(Past::check(in) == Status::ok);
  in.others[1].angular_acceleration_rad_s2[2] = nan;
  CHECK(Past::check(in) == Status::not_finite);
  in.others[1].angular_acceleration_rad_s2[2] = 0;
  in.column<BatteryVoltage>() = nan;
  CHECK(Past::check(in) == Status::not_finite);
}

TEST_CASE("a loop's history fills it, a plan the centred one; the part of the whole is the whole window") {
  RandomStates random(5);
  std::array<Whole::Inputs<double>, 7> taken;
  for (auto& inputs : taken) inputs = some(random);
  InputHistory<Past, double> history;
  InputHistory<Windowed<Whole, 3, Period>, double> whole_history;
  for (std::size_t tick = 0; tick < taken.size(); ++tick) {
    const Status status = history.take(taken[tick], 0.02 * double(tick));
    CHECK(status == (tick < 2 ? Status::warming_up : Status::ok));
    CHECK(whole_history.take(taken[tick], 0.02 * double(tick)) == status);
  }
  std::array<double, Past::size> x{};
  std::array<double, 66> all{};
  Past::extract(history.inputs(), x.data());
  Windowed<Whole, 3, Period>::extract(whole_history.inputs(), all.data());
  for (std::size_t i = 0; i < 22; ++i) CHECK(x[i] == all[i]);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(x[22 + i] == all[22 + i]);
    CHECK(x[28 + i] == all[44 + i]);
  }
  About::Inputs<double> window;
  static_cast<Whole::Inputs<double>&>(window) = taken[3];
  for (std::size_t tap = 0; tap < window.others.size(); ++tap) {
    window.others[tap] = taken[std::size_t(3 + std::lround(About::Window::offset_s(int(tap)) / 0.02))];
  }
  window.complete = true;
  CHECK(About::check(window) == Status::ok);
  std::array<double, About::size> about{};
  std::array<double, 6> part{};
  About::extract(window, about.data());
  const std::array<std::size_t, 4> order = {2, 1, 4, 5};  // -1, -2, +1, +2 about the fourth
  for (std::size_t tap = 0; tap < order.size(); ++tap) {
    AccelerationFeatures::extract(taken[order[tap]], part.data());
    for (std::size_t i = 0; i < part.size(); ++i) CHECK(about[22 + 6 * tap + i] == part[i]);
  }
}
