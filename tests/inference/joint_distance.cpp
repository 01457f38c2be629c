// SPDX-License-Identifier: MIT
// JointDistance and MonitoredInverse as types of a guard: what each Status is, and what stays untouched.
#include "pinnquad/inference/joint_distance.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/monitored_inverse.hpp"
#include "support/guarded_inputs.hpp"
#include "support/small_model.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

/// Any lower triangular factor, and a mean that is not 0.
constexpr std::array<float, 136> any_factor() {
  std::array<float, 136> factor{};
  std::size_t at = 0;
  for (std::size_t j = 0; j < 16; ++j) {
    for (std::size_t i = j; i < 16; ++i) {
      factor[at++] = i == j ? 0.25F + 0.03125F * float(j) : 0.015625F * (float((7 * i + 3 * j) % 11) - 5);
    }
  }
  return factor;
}

struct Trust {
  static constexpr std::array<float, 16> distribution_mean = {0.5F, -0.25F, 1, 0, 2, -1};
  static constexpr std::array<float, 136> whitening = any_factor();
  static constexpr double squared_distance_limit = 30;
  static constexpr double command_residual_factor = 0.2;
  static constexpr double command_residual_limit = 0.05;
  static constexpr double command_residual_cleared = 0.02;
};

using Measuring = Extend<TrainingGuard, JointDistance<Trust>>;
using FallingBack = Extend<Measuring, Fallback<FixedFallback>>;
template <class Policies>
using Guarded = InverseDynamics<SmallModel, Policies>;

/// |W (x - mean)|^2 with W as a dense matrix, in double.
double dense_distance(const std::array<float, 16>& x) {
  Eigen::Matrix<double, 16, 16> factor = Eigen::Matrix<double, 16, 16>::Zero();
  Eigen::Matrix<double, 16, 1> difference;
  std::size_t at = 0;
  for (int j = 0; j < 16; ++j) {
    for (int i = j; i < 16; ++i) factor(i, j) = double(Trust::whitening[at++]);
    difference[j] = double(x[std::size_t(j)]) - double(Trust::distribution_mean[std::size_t(j)]);
  }
  return (factor * difference).squaredNorm();
}

}  // namespace

TEST_CASE("the distance is that of the dense product, and the guard refuses what lies further than its limit") {
  CHECK(std::is_empty_v<Guarded<Measuring>>);
  RandomStates random(401);
  const Guarded<Measuring> inverse;
  int near = 0, far = 0;
  for (int i = 0; i < 500; ++i) {
    const auto inputs = inputs_of(random, 0.99);
    const auto x = features(inputs);
    const double expected = dense_distance(x);
    CHECK(double(squared_joint_distance<Trust>(x.data())) == doctest::Approx(expected).epsilon(1e-5));
    if (std::abs(expected - Trust::squared_distance_limit) < 1e-3) continue;  // float decides
    const bool inside = expected < Trust::squared_distance_limit;
    ++(inside ? near : far);
    Commands<float> commands = marked(), alone{}, by_features = marked();
    REQUIRE(InverseDynamics<SmallModel>{}.predict(inputs, alone) == Status::ok);
    Guarded<Measuring>::Report report;
    const Status status = inverse.predict(inputs, commands, report);
    CHECK(status == (inside ? Status::ok : Status::outside_distribution));
    CHECK(report.cause == status);
    CHECK(double(report.squared_distance) == doctest::Approx(expected).epsilon(1e-5));
    CHECK(same_bits(commands, inside ? alone : marked()));
    CHECK(inverse.predict_features(x.data(), by_features) == status);
    CHECK(same_bits(by_features, commands));
  }
  CHECK(near > 50);
  CHECK(far > 50);
}

TEST_CASE("the envelope comes first, and what is not finite is refused as without a distance") {
  RandomStates random(402);
  Commands<float> commands = marked();
  const Guarded<Measuring> inverse;
  CHECK(inverse.predict(inputs_of(random, 100), commands) == Status::outside_envelope);
  auto inputs = inputs_of(random, 0.1);
  for (const float bad : {not_a_number, infinity, -infinity}) {
    inputs.velocity_m_s[1] = bad;
    CHECK(inverse.predict(inputs, commands) == Status::not_finite);
  }
  // no envelope: a distance that overflows is one that is too far
  const Guarded<Guard<FiniteInputs, JointDistance<Trust>>> without;
  inputs = inputs_of(random, 0.1);
  inputs.velocity_m_s[1] = 1e30F;
  CHECK(without.predict(inputs, commands) == Status::outside_distribution);
  CHECK(same_bits(commands, marked()));
}

TEST_CASE("fallback, batch and Jacobian know the distance") {
  RandomStates random(403);
  const Guarded<FallingBack> falling{FallingBack(FixedFallback{0.25F, Status::ok})};
  const Commands<float> replaced{0.25F, 0.25F, 0.25F, 0.25F};
  constexpr int samples = 64;
  std::array<float, 16 * samples> x{};
  std::array<Status, samples> expected{}, statuses{};
  int refused = 0;
  for (int s = 0; s < samples; ++s) {
    const auto inputs = inputs_of(random, 1.05);
    const auto row = features(inputs);
    for (int k = 0; k < 16; ++k) x[std::size_t(k * samples + s)] = row[std::size_t(k)];
    Commands<float> plain{}, commands = marked();
    const Status status = Guarded<Measuring>{}.predict(inputs, plain);
    expected[std::size_t(s)] = status;
    Guarded<FallingBack>::Report report;
    CHECK(falling.predict(inputs, commands, report) == (status == Status::ok ? Status::ok : Status::fell_back));
    CHECK(report.cause == status);
    CHECK(same_bits(commands, status == Status::ok ? plain : replaced));
    float by_features[4], jacobian[64];
    CHECK(predict_with_jacobian(Guarded<Measuring>{}, row.data(), by_features, jacobian) == status);
    refused += status == Status::outside_distribution;
  }
  CHECK(refused > 5);
  std::array<float, 4 * samples> commands{};
  predict_batch(Guarded<Measuring>{}, x.data(), commands.data(), statuses.data(), samples);
  for (std::size_t s = 0; s < samples; ++s) CHECK(statuses[s] == expected[s]);
}

TEST_CASE("the command residual is the recursion by hand, alarms above its limit and clears below the other") {
  CommandResidualMonitor<Trust> monitor;
  CHECK(monitor.trusted());
  double mean = 0;
  bool trusted = true;
  int alarms = 0, changes = 0;
  RandomStates random(404);
  for (int i = 0; i < 2000; ++i) {
    const double size = (i / 100) % 2 == 0 ? 0.02 : 0.14;
    Commands<float> predicted{}, flown{};
    double error = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      flown[k] = random.scalar<float>(0.3, 0.7);
      predicted[k] = flown[k] + random.scalar<float>(-size, size);
      error += std::abs(double(predicted[k]) - double(flown[k])) / 4;
    }
    REQUIRE(monitor.update(predicted, flown) == Status::ok);
    mean = 0.2 * error + 0.8 * mean;
    const bool before = trusted;
    trusted = mean > 0.05 ? false : (mean < 0.02 ? true : trusted);
    changes += before != trusted ? 1 : 0;
    alarms += trusted ? 0 : 1;
    REQUIRE(double(monitor.mean()) == doctest::Approx(mean).epsilon(1e-5));
    REQUIRE(monitor.trusted() == trusted);
  }
  CHECK(alarms > 800);
  CHECK(alarms < 1200);
  CHECK(changes >= 19);
  const float kept = monitor.mean();
  for (const float bad : {not_a_number, infinity, -infinity, 3e38F}) {
    CHECK(monitor.update({bad, 0, 0, 0}, {0, -bad, 0, 0}) == Status::not_finite);
    CHECK(monitor.update({0, 0, 0, bad}, {bad, 0, 0, -bad}) == Status::not_finite);
    CHECK(monitor.mean() == kept);
  }
  monitor.reset();
  CHECK(monitor.mean() == 0);
  CHECK(monitor.trusted());
}

TEST_CASE("a monitored inverse: the model while it was right, then the fallback, and the model again") {
  RandomStates random(405);
  using Plain = Guarded<TrainingGuard>;
  using Backed = Guarded<Extend<TrainingGuard, Fallback<FixedFallback>>>;
  MonitoredInverse<Plain, Trust> refusing;
  MonitoredInverse<Backed, Trust> falling{Backed(Extend<TrainingGuard, Fallback<FixedFallback>>(FixedFallback{}))};
  const auto inputs = inputs_of(random, 0.5);
  Commands<float> predicted{};
  REQUIRE(Plain{}.predict(inputs, predicted) == Status::ok);
  const auto told = [&](float error) {
    Commands<float> flown = predicted;
    for (float& u : flown) u += error;
    REQUIRE(refusing.observe(inputs, flown) == Status::ok);
    REQUIRE(falling.observe(inputs, flown) == Status::ok);
  };
  const auto check = [&](Status refused, Status fallen) {
    Commands<float> a = marked(), b = marked();
    MonitoredInverse<Backed, Trust>::Report report;
    CHECK(refusing.predict(inputs, a) == refused);
    CHECK(falling.predict(inputs, b, report) == fallen);
    CHECK(report.cause == refused);
    CHECK(same_bits(a, refused == Status::ok ? predicted : marked()));
    CHECK(same_bits(b, fallen == Status::ok ? predicted : Commands<float>{0.5F, 0.5F, 0.5F, 0.5F}));
  };
  check(Status::ok, Status::ok);
  told(0.2F);  // mean 0.04
  check(Status::ok, Status::ok);
  told(0.2F);  // 0.072
  check(Status::distrusted, Status::fell_back);
  for (int i = 0; i < 5; ++i) told(0);  // 0.0236: below the limit, not yet cleared
  check(Status::distrusted, Status::fell_back);
  told(0);  // 0.0189
  check(Status::ok, Status::ok);

  // what can't be judged changes nothing
  auto broken = inputs;
  broken.attitude.w = not_a_number;
  const float kept = refusing.monitor().mean();
  CHECK(refusing.observe(broken, predicted) == Status::not_finite);
  CHECK(refusing.observe(inputs, {not_a_number, 0, 0, 0}) == Status::not_finite);
  CHECK(refusing.monitor().mean() == kept);
  // a fallback that declines leaves the reason
  using Declining = MonitoredInverse<Backed, Trust>;
  Declining none{Backed(Extend<TrainingGuard, Fallback<FixedFallback>>(FixedFallback{0, Status::no_solution}))};
  for (int i = 0; i < 9; ++i) REQUIRE(none.observe(inputs, {9, 9, 9, 9}) == Status::ok);
  Commands<float> commands = marked();
  CHECK(none.predict(inputs, commands) == Status::distrusted);
  CHECK(same_bits(commands, marked()));
}

namespace {

/// Answers with the time that it is told.
struct ClockFallback {
  Status operator()(const MotionInputs<float>&, const PlaceAndTime<double>& place,
                    Commands<float>& commands) const noexcept {
    const auto time = static_cast<float>(place.time_s);
    commands = {time, time, time, time};
    return Status::ok;
  }
};

}  // namespace

TEST_CASE("while the model is distrusted its fallback is told place and time, with a report and without") {
  RandomStates random(407);
  using Backed = Guarded<Extend<TrainingGuard, Fallback<ClockFallback>>>;
  MonitoredInverse<Backed, Trust> inverse{Backed(Extend<TrainingGuard, Fallback<ClockFallback>>(ClockFallback{}))};
  const auto inputs = inputs_of(random, 0.5);
  for (int i = 0; i < 9; ++i) REQUIRE(inverse.observe(inputs, {9, 9, 9, 9}) == Status::ok);
  REQUIRE_FALSE(inverse.trusted());
  PlaceAndTime<double> place;
  place.time_s = 0.25;
  Commands<float> with_report = marked(), without = marked();
  MonitoredInverse<Backed, Trust>::Report report;
  CHECK(inverse.predict(inputs, place, with_report, report) == Status::fell_back);
  CHECK(inverse.predict(inputs, place, without) == Status::fell_back);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(with_report[i] == 0.25F);
    CHECK(without[i] == 0.25F);
  }
}

namespace {

template <class T>
using Observed = decltype(std::declval<T&>().observe(MotionInputs<float>{}, Commands<float>{}));
template <class T>
using Reset = decltype(std::declval<T&>().reset());

}  // namespace

TEST_CASE("a monitored inverse: what writes needs one that is not const") {
  using Backed = Guarded<Extend<TrainingGuard, Fallback<FixedFallback>>>;
  using Monitored = MonitoredInverse<Backed, Trust>;
  CHECK(is_detected<Observed, Monitored>);
  CHECK(is_detected<Reset, Monitored>);
  CHECK_FALSE(is_detected<Observed, const Monitored>);
  CHECK_FALSE(is_detected<Reset, const Monitored>);
}
