// SPDX-License-Identifier: MIT
// Feature sets with a past, and the history that makes their inputs of a loop's.
#include "pinnquad/features/windowed.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/features/input_history.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;
using pinnquad::test::RandomStates;

namespace {

using Period = PeriodMicroseconds<20000>;
using Past = Windowed<PaperFeatures, 4, Period>;
using About = Windowed<PaperFeatures, 5, Period, Centred>;

/// Straight lines in time, and a turn about one axis at constant rate: what an interpolation gives is known.
template <class Scalar>
MotionInputs<Scalar> line(double time_s) {
  const auto at = [&](double start, double slope) { return Scalar(start + slope * time_s); };
  MotionInputs<Scalar> inputs;
  inputs.linear_acceleration_m_s2 = {at(1, 2), at(-1, 0.5), at(0, -3)};
  inputs.angular_acceleration_rad_s2 = {at(5, -20), at(0, 10), at(2, 1)};
  inputs.velocity_m_s = {at(0, 1), at(3, -1), at(0.5, 0.25)};
  inputs.body_rates_rad_s = {Scalar(0), Scalar(0), Scalar(1.5)};
  inputs.attitude = from_euler(EulerAngles<Scalar>{Scalar(0), Scalar(0), at(3, 1.5)});  // past yaw = pi on the way
  return inputs;
}

/// Largest difference of the numbers of two inputs; attitudes as rotations.
template <class Scalar>
double apart(const MotionInputs<Scalar>& a, const MotionInputs<Scalar>& b) {
  double most = 0;
  const auto add = [&](double difference) { most = std::fmax(most, std::fabs(difference)); };
  for (int i = 0; i < 3; ++i) {
    add(double(a.linear_acceleration_m_s2[i] - b.linear_acceleration_m_s2[i]));
    add(double(a.angular_acceleration_rad_s2[i] - b.angular_acceleration_rad_s2[i]));
    add(double(a.velocity_m_s[i] - b.velocity_m_s[i]));
    add(double(a.body_rates_rad_s[i] - b.body_rates_rad_s[i]));
  }
  const Quaternion<Scalar> turn = conjugate(a.attitude) * b.attitude;
  add(2 * std::sqrt(double(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z)));
  return most;
}

template <class Scalar>
bool same(const MotionInputs<Scalar>& a, const MotionInputs<Scalar>& b) {
  const Quaternion<Scalar>&p = a.attitude, &q = b.attitude;
  return a.linear_acceleration_m_s2 == b.linear_acceleration_m_s2 &&
         a.angular_acceleration_rad_s2 == b.angular_acceleration_rad_s2 && a.velocity_m_s == b.velocity_m_s &&
         a.body_rates_rad_s == b.body_rates_rad_s && p.w == q.w && p.x == q.x && p.y == q.y && p.z == q.z;
}

/// A sample within the tolerance is taken for the tap, and line() changes by up to 20 per second; a turn of 0.03 rad
/// per sample is a straight line to 1e-7.
constexpr double straight = 20 * Past::Window::tolerance_s + 1e-6;

}  // namespace

TEST_CASE("names tell the tap, units repeat, the angular acceleration is the present one") {
  CHECK(is_feature_set<Past>);
  CHECK(is_feature_set<About>);
  CHECK(is_feature_set<Windowed<PaperFeatures, 1, Period>>);
  CHECK(Past::size == 64);
  CHECK(Past::angular_acceleration == PaperFeatures::angular_acceleration);
  CHECK(std::string(Past::names[3]) == "wdot_x");
  CHECK(std::string(Past::names[16 + 3]) == "wdot_x[-1]");
  CHECK(std::string(Past::names[48 + 15]) == "cos_yaw[-3]");
  CHECK(std::string(Past::units[48 + 3]) == "rad/s^2");
  CHECK(std::string(About::names[16]) == "vdot_bx[-1]");
  CHECK(std::string(About::names[32]) == "vdot_bx[-2]");
  CHECK(std::string(About::names[48]) == "vdot_bx[+1]");
  CHECK(std::string(About::names[64]) == "vdot_bx[+2]");
  CHECK(std::string(Windowed<PaperFeatures, 13, Period>::names[10 * 16]) == "vdot_bx[-10]");
  CHECK(std::string(Windowed<PaperFeatures, 13, Period>::names[12 * 16]) == "vdot_bx[-12]");
  CHECK(Past::Window::offset_s(2) == doctest::Approx(-0.06));
  CHECK(About::Window::offset_s(3) == doctest::Approx(0.04));
  using WithVoltage = Windowed<WithColumns<PaperFeatures, BatteryVoltage>, 2, Period>;
  CHECK(std::string(WithVoltage::names[33]) == "battery_voltage[-1]");
  CHECK(std::string(extra_column_names<WithVoltage>[0]) == "battery_voltage");
}

TEST_CASE("a feature of another tap has the unit of the present one, whatever part of the features is repeated") {
  using PartOf = PartlyWindowed<WithColumns<PhysicsFeatures, BatteryVoltage>, AccelerationFeatures, 3, Period>;
  constexpr int present = PartOf::TapFeatures::size;
  for (int i = present; i < PartOf::size; ++i) {
    const std::string name = PartOf::names[std::size_t(i)];
    const std::string of_present = name.substr(0, name.find('['));
    CAPTURE(name);
    int found = 0;
    for (int k = 0; k < present; ++k) {
      if (of_present != PartOf::names[std::size_t(k)]) continue;
      CHECK(std::string(PartOf::units[std::size_t(i)]) == PartOf::units[std::size_t(k)]);
      ++found;
    }
    CHECK(found == 1);
  }
}

TEST_CASE("X of a window is X of each tap; a window that lacks a tap is refused, and its features are no numbers") {
  RandomStates random(7);
  Past::Inputs<double> inputs;
  static_cast<MotionInputs<double>&>(inputs) = motion_inputs(random.state<double>(), random.motion<double>());
  for (auto& other : inputs.others) other = motion_inputs(random.state<double>(), random.motion<double>());
  std::array<double, Past::size> x{};
  CHECK(Past::check(inputs) == Status::warming_up);
  Past::extract(inputs, x.data());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(is_finite(x[i]) == (i < 16));
  inputs.complete = true;
  CHECK(Past::check(inputs) == Status::ok);
  Past::extract(inputs, x.data());
  std::array<double, 16> tap{};
  for (std::size_t k = 0; k < 3; ++k) {
    PaperFeatures::extract(inputs.others[k], tap.data());
    for (std::size_t i = 0; i < 16; ++i) CHECK(x[16 * (k + 1) + i] == tap[i]);
  }
  inputs.others[2].velocity_m_s[1] = std::numeric_limits<double>::infinity();
  CHECK(Past::check(inputs) == Status::not_finite);
  inputs.attitude = {2, 0, 0, 0};
  CHECK(Past::check(inputs) == Status::not_unit_quaternion);
}

TEST_CASE("taps at exact distances in time, whatever the jitter of the loop") {
  std::mt19937_64 engine(5);
  for (const double loop_s : {0.020, 0.010, 0.004, 0.001}) {
    CAPTURE(loop_s);
    InputHistory<Past, double> history;
    double time_s = 1000;
    int complete = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      const Status status = history.take(line<double>(time_s - 1000), time_s);
      CHECK(status == (time_s - 1000 >= 0.06 - 2e-6 ? Status::ok : Status::warming_up));
      CHECK(same<double>(history.inputs(), line<double>(time_s - 1000)));
      if (status == Status::ok) {
        ++complete;
        for (int tap = 0; tap < 3; ++tap) {
          const auto expected = line<double>(time_s - 1000 - 0.02 * (tap + 1));
          CHECK(apart<double>(history.inputs().others[std::size_t(tap)], expected) < straight);
        }
      }
      time_s += loop_s * uniform(engine, 0.6, 1.4);
      if (time_s > 1002) break;
    }
    CHECK(complete > 50);
  }
}

TEST_CASE("on the model's own period no tap is interpolated: the bits are those that were taken") {
  for (const double start_s : {0.0, 1.7e9}) {  // a clock since 1970 rounds to 2e-7 s
    RandomStates random(9);
    InputHistory<Past, float> history;
    std::vector<MotionInputs<float>> taken;
    for (int tick = 0; tick < 12; ++tick) {
      taken.push_back(motion_inputs(random.state<float>(), random.motion<float>()));
      const Status status = history.take(taken.back(), start_s + 0.02 * tick);
      CHECK(status == (tick < 3 ? Status::warming_up : Status::ok));
      for (std::size_t tap = 1; tick >= 3 && tap < 4; ++tap) {
        CHECK(same<float>(history.inputs().others[tap - 1], taken[std::size_t(tick) - tap]));
      }
    }
  }
}

TEST_CASE("a gap empties the window, and so does time that runs backwards; one late tick does not") {
  const auto fed = [](std::vector<double> steps_s) {
    InputHistory<Past, double> history;
    double time_s = 3;
    Status status = history.take(line<double>(0), time_s);
    for (int i = 0; i < 8; ++i) status = history.take(line<double>(0), time_s += 0.01);
    REQUIRE(status == Status::ok);
    for (const double step_s : steps_s) status = history.take(line<double>(0), time_s += step_s);
    return status;
  };
  CHECK(fed({0.029}) == Status::ok);
  CHECK(fed({0.04}) == Status::warming_up);
  CHECK(fed({0.04, 0.02, 0.02}) == Status::warming_up);
  CHECK(fed({0.04, 0.02, 0.02, 0.02}) == Status::ok);
  CHECK(fed({-0.01}) == Status::warming_up);
  CHECK(fed({-0.01, 0.02, 0.02}) == Status::warming_up);
  CHECK(fed({0.0}) == Status::ok);
}

TEST_CASE("a time that comes twice counts once, with what came last") {
  InputHistory<Past, double> history;
  for (int i = 0; i < 4; ++i) static_cast<void>(history.take(line<double>(i), 0.02 * i));
  static_cast<void>(history.take(line<double>(30), 0.06));
  CHECK(history.take(line<double>(4), 0.08) == Status::ok);
  CHECK(same<double>(history.inputs().others[0], line<double>(30)));
}

TEST_CASE("between samples of which one cannot be read there is none") {
  const std::array<double, 3> times_s = {0, 0.02, 0.04};
  for (int unreadable = 0; unreadable < 3; ++unreadable) {
    CAPTURE(unreadable);
    const auto read = [&](int i, MotionInputs<double>& inputs) {
      if (i == unreadable) return false;
      inputs = line<double>(times_s[std::size_t(i)]);
      return true;
    };
    const auto time_of = [&](int i) { return times_s[std::size_t(i)]; };
    MotionInputs<double> found;
    int at = 2;
    CHECK(detail::read_at<double>(Past::Window{}, 0.01, 0, 2, at, time_of, read, found) == (unreadable == 2));
    CHECK(detail::read_at<double>(Past::Window{}, 0.03, 0, 2, at, time_of, read, found) == (unreadable == 0));
    CHECK(detail::read_at<double>(Past::Window{}, 0.02, 0, 2, at, time_of, read, found) == (unreadable != 1));
  }
}

TEST_CASE("bad inputs and a bad time are refused and leave no trace") {
  InputHistory<Past, double> history, spared;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 4; ++i) {
    static_cast<void>(history.take(line<double>(i), 0.02 * i));
    static_cast<void>(spared.take(line<double>(i), 0.02 * i));
  }
  MotionInputs<double> bad = line<double>(1);
  bad.velocity_m_s[2] = nan;
  CHECK(history.take(bad, 0.07) == Status::not_finite);
  CHECK(Past::check(history.inputs()) == Status::not_finite);
  bad = line<double>(1);
  bad.attitude.w = 7;
  CHECK(history.take(bad, 0.07) == Status::not_unit_quaternion);
  CHECK(history.take(line<double>(1), nan) == Status::not_finite);
  CHECK(Past::check(history.inputs()) == Status::warming_up);  // the taps are those of another instant
  CHECK(history.take(line<double>(1), std::numeric_limits<double>::infinity()) == Status::not_finite);
  CHECK(history.take(line<double>(4), 0.08) == Status::ok);
  CHECK(spared.take(line<double>(4), 0.08) == Status::ok);
  for (std::size_t tap = 0; tap < 3; ++tap) {
    CHECK(same<double>(history.inputs().others[tap], spared.inputs().others[tap]));
  }
  history.clear();
  CHECK(Past::check(history.inputs()) == Status::warming_up);  // before the next inputs come, too
  CHECK(history.take(line<double>(5), 0.1) == Status::warming_up);
}

TEST_CASE("a fast loop is thinned and never waits for ever, however small the history") {
  std::mt19937_64 engine(6);
  InputHistory<Past, double, 4> history;  // the least: 0.06 s in one step between kept samples
  double time_s = 0;
  int complete = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    time_s += 0.0005 * uniform(engine, 0.2, 1.8);
    const Status status = history.take(line<double>(0.1), time_s);
    if (status == Status::ok) ++complete;
    if (time_s > 0.13) CHECK(status == Status::ok);
  }
  CHECK(complete > 3000);
}

TEST_CASE(
    "a late tick of a fast loop: what came just before it is not thinned away, nothing is interpolated over a gap") {
  InputHistory<Past, double> history;
  double time_s = 0;
  MotionInputs<double> inputs = line<double>(0);
  Status status = Status::ok;
  for (int tick = 0; tick < 200; ++tick) {
    time_s += 0.001;
    inputs.velocity_m_s[0] = tick % 2;  // a thinned sample has another value than its neighbour
    status = history.take(inputs, time_s);
  }
  REQUIRE(status == Status::ok);
  for (int tick = 0; tick < 6; ++tick) {  // at some of these the newest would give way
    InputHistory<Past, double> late = history;
    inputs.velocity_m_s[0] = 7;
    REQUIRE(late.take(inputs, time_s + 0.03) == Status::ok);
    const double newest = (199 + tick) % 2, share = (0.03 - 0.02) / 0.03;
    CHECK(late.inputs().others[0].velocity_m_s[0] == doctest::Approx(newest + share * (7 - newest)));
    inputs.velocity_m_s[0] = (200 + tick) % 2;
    status = history.take(inputs, time_s += 0.001);
  }
}

TEST_CASE("altitude and columns are interpolated too, attitudes the shorter way") {
  using Set = WithColumns<PaperFeaturesWithAltitude, BatteryVoltage>;
  Set::Inputs<double> a, b;
  a.altitude_m = 1;
  b.altitude_m = 3;
  a.column<BatteryVoltage>() = 16;
  b.column<BatteryVoltage>() = 15;
  b.attitude = {-1, 0, 0, 0};  // the same attitude
  const auto between = interpolated(a, b, 0.25);
  CHECK(between.altitude_m == doctest::Approx(1.5));
  CHECK(between.column<BatteryVoltage>() == doctest::Approx(15.75));
  CHECK(between.attitude.w == doctest::Approx(1));
  // a quarter turn: half of it is where it belongs, by symmetry
  const double h = std::sqrt(0.5);
  b.attitude = {-h, 0, 0, -h};
  const auto half = interpolated(a, b, 0.5).attitude;
  CHECK(half.w == doctest::Approx(std::cos(std::acos(-1.0) / 8)));
  CHECK(half.z == doctest::Approx(std::sin(std::acos(-1.0) / 8)));
}
