// SPDX-License-Identifier: MIT
// The biases of both cores: what they carry, what freezes them, what becomes of them where nothing can be learnt.
#include <doctest/doctest.h>

#include "flight.hpp"
#include "flight_paths.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::autopilot::CoreRecord;
using pinnquad::autopilot::CoreSettings;
using pinnquad::autopilot::Reaction;

constexpr double duration_s = 20;

CoreSettings without_bias() {
  CoreSettings none;
  for (float& most : none.most_bias) most = 0;
  none.most_across_m_s2 = 0;
  return none;
}

/// A path with a fault that lasts, from `from_s` on: by the network, by the analytic inverse, and without biases.
template <class Stack, class Target>
void carries(const char* what, const Target& target, FaultKind kind, double value, double from_s, double most_late_m,
             double most_m) {
  INFO(Stack::name, ", ", what);
  const std::vector<Fault> own = {{from_s, 100, kind, value, what, Reaction::flies}};
  std::vector<Fault> narrow = own;
  narrow.push_back({0.3, 100, FaultKind::model_too_narrow, 0, "by the analytic inverse", Reaction::flies});
  const auto fly = [&](const CoreSettings& settings, const std::vector<Fault>& faults) {
    FaultyFlight<Stack> flight(settings);
    REQUIRE(flight.boot());
    return flight.fly(target, duration_s, faults);
  };
  const FlightFigures network = fly({}, own), analytic = fly({}, narrow), none = fly(without_bias(), own),
                      analytic_none = fly(without_bias(), narrow);
  MESSAGE("RMSE from 8 s on, cm: ", 100 * network.late_rmse_m, ", analytic inverse ", 100 * analytic.late_rmse_m,
          "; without biases ", 100 * none.late_rmse_m, ", ", 100 * analytic_none.late_rmse_m);
  for (const FlightFigures* flown : {&network, &analytic}) {
    CHECK_FALSE(flown->crashed);
    CHECK(flown->distrusted == 0);
    CHECK(flown->late_rmse_m < most_late_m);
    CHECK(flown->max_error_m < most_m);
  }
  CHECK((none.crashed || network.late_rmse_m < none.late_rmse_m / 2));
  CHECK((analytic_none.crashed || analytic.late_rmse_m < analytic_none.late_rmse_m / 2));
}

template <class Stack>
void carries_all(const Eight& eight, double rotor) {
  carries<Stack>("hover, 20 % picked up", hover, FaultKind::payload, 1.2, 6, 0.02, 0.3);
  carries<Stack>("hover, a weak rotor", hover, FaultKind::bent_rotor, rotor, 6, 0.02, 0.3);
  carries<Stack>("hover, a battery a fifth too weak", hover, FaultKind::weak_battery, 0.8, 6, 0.02, 0.3);
  carries<Stack>("hover, wind 3 m/s", hover, FaultKind::wind, 3, 6, 0.02, 0.3);
  carries<Stack>("eight with 20 % of payload", eight, FaultKind::payload, 1.2, 0, 0.15, 0.3);
}

/// A hover with a payload, and samples of which nothing can be learnt for a while from 10 s on.
template <class Stack>
void outlasts(const char* what, FaultKind kind, double value, double lasts_s) {
  INFO(Stack::name, ", ", what);
  constexpr double from_s = 10, hold_s = 0.45, learns_again_s = 2.5;
  const std::vector<Fault> faults = {{0, 100, FaultKind::payload, 1.2, "20 % heavier", Reaction::flies},
                                     {from_s, lasts_s, kind, value, what, Reaction::flies}};
  FaultyFlight<Stack> flight;
  REQUIRE(flight.boot());
  CoreRecord at_start, held, at_end, later;
  const FlightFigures flown = flight.fly(hover, 18, faults, [&](const CoreRecord& tick) {
    const double since_s = 1e-6 * static_cast<double>(tick.timestamp) - 5 - from_s;
    if (since_s < 0.1) at_start = tick;  // a period that began before has ended
    if (since_s < hold_s) held = tick;
    if (since_s < lasts_s) at_end = tick;
    if (since_s < lasts_s + learns_again_s) later = tick;
  });
  CHECK_FALSE(flown.crashed);
  const float learnt = at_start.bias_sums[0];
  CHECK(learnt > 0.3f);
  CHECK(held.bias_sums[0] == learnt);
  CHECK(held.analytic_bias_sums[0] == at_start.analytic_bias_sums[0]);
  CHECK(held.bias_waited_s > 0.3f);
  const double faded = std::exp(-(lasts_s - 0.5) / 2);
  CHECK(at_end.bias_sums[0] == doctest::Approx(static_cast<double>(learnt) * faded).epsilon(0.05));
  CHECK(static_cast<Status>(at_end.bias_status) == Status::warming_up);
  CHECK(static_cast<Status>(at_end.analytic_bias_status) == Status::warming_up);
  CHECK(later.bias_sums[0] == doctest::Approx(static_cast<double>(learnt)).epsilon(0.15));
  CHECK(static_cast<Status>(later.bias_status) == Status::ok);
}

template <class Stack>
void outlasts_all() {
  outlasts<Stack>("frozen velocity and position", FaultKind::velocity_frozen, 0, 2.5);
  outlasts<Stack>("position and velocity 40 ms late", FaultKind::local_late, 0.04, 2.5);
  outlasts<Stack>("NaN in the velocity", FaultKind::velocity_nan, 0, 0.9);
  outlasts<Stack>("position and velocity missing", FaultKind::local_stops, 0, 0.9);
}

}  // namespace

TEST_CASE("the biases have the time constants of the block that flies, unless the settings say some") {
  using Times = pinnquad::SignedSums<float>;
  const Times usual = pinnquad::BiasSettings<float>{}.time_constants_s;
  const Times own = pinnquad::bias_settings<QuickCrazyflieModel>().time_constants_s;
  const Block telling = sound_block<QuickCrazyflieModel>(), silent = other_block<QuickCrazyflieModel>();
  CoreSettings of_the_user;
  of_the_user.bias_time_constants_s[0] = 1.5f;
  of_the_user.bias_time_constants_s[3] = 3;
  const auto check = [&](const CoreSettings& settings, const Times& of_telling, const Times& of_silent) {
    pinnquad::autopilot::NeuralController<QuickCrazyflieModel> core(settings);
    const auto flies = [&core](const Block& block) {
      pinnquad::Commands<float> commands{};
      pinnquad::autopilot::StepReport report;
      REQUIRE(core.offer_model(block.data(), block.size()) == Status::ok);
      static_cast<void>(core.step(1000, commands, report));
      CHECK(core.analytic_bias().settings().time_constants_s == core.bias().settings().time_constants_s);
      return core.bias().settings().time_constants_s;
    };
    CHECK(flies(telling) == of_telling);
    CHECK(flies(silent) == of_silent);
    CHECK(flies(telling) == of_telling);
  };
  check({}, own, usual);
  CoreSettings told;
  told.state_delay_s = 0.004f;
  check(told, {0.0025f, 0.0025f, 0.0025f, 0.05f}, {0.0025f, 0.0025f, 0.0025f, 0.05f});
  check(of_the_user, {1.5f, 0.2f, 0.2f, 3}, {1.5f, usual[1], usual[2], 3});
}

TEST_CASE("a rotor at 85 % that the usual time constants lose is flown by those of the model") {
  using Stack = CrazyflieStackOf<QuickCrazyflieModel>;
  const std::vector<Fault> weak = {{6, 100, FaultKind::bent_rotor, 0.85, "a rotor at 85 %", Reaction::flies}};
  CoreSettings usual;
  for (std::size_t k = 0; k < 4; ++k) {
    usual.bias_time_constants_s[k] = pinnquad::BiasSettings<float>{}.time_constants_s[k];
  }
  const auto fly = [&weak](const CoreSettings& settings) {
    FaultyFlight<Stack> flight(settings);
    REQUIRE(flight.boot());
    return flight.fly(hover, duration_s, weak);
  };
  const FlightFigures own = fly({}), slow = fly(usual);
  MESSAGE("up to ", own.max_error_m, " m off; with the usual time constants ", slow.max_error_m);
  CHECK_FALSE(own.crashed);
  CHECK(own.late_rmse_m < 0.03);
  CHECK(own.max_error_m < 0.3);
  CHECK((slow.crashed || slow.max_error_m > 0.8));
}

TEST_CASE("a payload, a weak rotor or battery and wind are carried; PX4's core") {
  carries_all<Px4Stack>(Eight(4, 9), 0.85);
}
TEST_CASE("a payload, a weak rotor or battery and wind are carried; the Crazyflie's core") {
  carries_all<CrazyflieStack>(Eight(1.5, 6), 0.92);
}

TEST_CASE_TEMPLATE("without samples to learn from a bias holds for half a second, then fades, and says so", Stack,
                   Px4Stack, CrazyflieStack) {
  outlasts_all<Stack>();
}

TEST_CASE("where the network declines, its bias moves with the analytic inverse's: its answers go on from there") {
  const std::vector<Fault> faults = {
      {4, 8, FaultKind::model_too_narrow, 0, "a model that declines nearly everything", Reaction::flies},
      {6, 100, FaultKind::payload, 1.2, "20 % heavier", Reaction::flies}};
  FaultyFlight<Px4Stack> flight;
  REQUIRE(flight.boot());
  CoreRecord declined;
  const FlightFigures flown = flight.fly(hover, 20, faults, [&](const CoreRecord& tick) {
    if (tick.timestamp < 5'000'000 + 12'000'000) declined = tick;
  });
  CHECK_FALSE(flown.crashed);
  CHECK(static_cast<Status>(declined.cause) == Status::outside_envelope);
  CHECK(declined.bias_sums[0] > 0.3f);
  CHECK(declined.bias_sums[0] == doctest::Approx(static_cast<double>(declined.analytic_bias_sums[0])).epsilon(0.1));
}
