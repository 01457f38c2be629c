// SPDX-License-Identifier: MIT
// Both example modules fly their airframe in the simulator, through the fault script: hover, figure-eight, random
// places.
#include <doctest/doctest.h>

#include "flight.hpp"
#include "flight_paths.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::autopilot::Reaction;

constexpr double duration_s = 33, calm_duration_s = 20;
constexpr double lowest_m = 9;         // 10.9 m is flown; the lowest place asked for is 9.9 m
constexpr double steepest_rad = 1.05;  // 60 deg; the outer loop asks for 49
constexpr std::array<Fault, 0> no_faults = {};

/// `farthest_m`: of the figure-eight the set points fly on for 1.5 s while the module, told nothing, holds its place.
template <class Stack, class Target>
void through_all_faults(const std::string& path, const Target& target, double farthest_m) {
  FaultyFlight<Stack> flight;
  CHECK(flight.boot());
  const FlightFigures flown = flight.fly(target, duration_s, fault_script);
  INFO(Stack::name, " ", path);
  MESSAGE("from ", flown.min_altitude_m, " m, tilt up to ", flown.max_tilt_rad, " rad");
  CHECK_FALSE(flown.crashed);
  CHECK(flown.min_altitude_m > lowest_m);
  CHECK(flown.max_tilt_rad < steepest_rad);
  CHECK(flown.max_error_m < farthest_m);
  CHECK(flown.takeovers == 1);
  CHECK(flown.module_share > 0.96);
  CHECK(flown.refused_samples > 30);
  CHECK(flown.distrusted == 0);
  using pinnquad::Status;
  const std::vector<Status> offered = {
      Status::block_corrupt,    Status::ok, Status::ok, Status::ok, Status::block_corrupt,
      Status::self_test_failed, Status::ok, Status::ok};
  CHECK(flown.offered == offered);
  for (std::size_t i = 0; i < fault_script.size(); ++i) {
    INFO(fault_script[i].text, ": ", to_string(flown.worst[i]));
    CHECK(flown.worst[i] == fault_script[i].worst);
    if (fault_script[i].kind == FaultKind::model_too_narrow) {
      CHECK(flown.asked[i] > 0);
      CHECK(flown.fell_back[i] == flown.asked[i]);
    } else if (path == "hover") {
      CHECK(flown.fell_back[i] == 0);
    }
  }
}

/// Without faults: how well it tracks, the network against the analytic inverse alone.
template <class Stack, class Target>
void calm(const std::string& path, const Target& target, double most_rmse_m, float most_fallback_share) {
  FaultyFlight<Stack> flight, by_analytic;
  REQUIRE(flight.boot());
  REQUIRE(by_analytic.boot());
  const FlightFigures flown = flight.fly(target, calm_duration_s, no_faults);
  const std::array<Fault, 1> narrow = {{{0.5, 100, FaultKind::model_too_narrow, 0, "", Reaction::flies}}};
  const FlightFigures analytic = by_analytic.fly(target, calm_duration_s, narrow);
  INFO(Stack::name, " ", path);
  CHECK_FALSE(flown.crashed);
  CHECK(flown.takeovers == 0);
  CHECK(flown.module_share == 1);
  CHECK(flown.distrusted == 0);
  CHECK(flown.rmse_m < most_rmse_m);
  CHECK(flown.fallback_share <= most_fallback_share);
  CHECK(analytic.fallback_share > 0.97f);
}

/// A model whose commands are too low (low_block) hovers; then the vehicle is half as heavy again for a while.
template <class Stack>
void carries_a_payload() {
  constexpr double loaded_s = 6, relieved_s = 16, ends_s = 26;
  const std::array<Fault, 2> faults = {
      {{0.1, 100, FaultKind::model_low, 0, "a model of too low commands", Reaction::flies},
       {loaded_s, relieved_s - loaded_s, FaultKind::payload, 1.5, "half as heavy again", Reaction::flies}}};
  FaultyFlight<Stack> flight;
  REQUIRE(flight.boot());
  using pinnquad::autopilot::CoreRecord;
  double handed_over_s = 0, taken_back_s = 0, deepest_m = 0, late_error_m = 0;
  bool by_analytic = false;
  const FlightFigures flown = flight.fly(hover, ends_s, faults, [&](const CoreRecord& tick) {
    const double time_s = 1e-6 * static_cast<double>(tick.timestamp) - 5;
    const bool now = tick.status == static_cast<std::uint8_t>(Status::fell_back) &&
                     tick.cause == static_cast<std::uint8_t>(Status::distrusted);
    if (now && !by_analytic && handed_over_s <= 0) handed_over_s = time_s;
    if (!now && by_analytic) taken_back_s = time_s;
    by_analytic = now;
    const double below_m = static_cast<double>(tick.position_m[2]) + 10;
    deepest_m = std::max(deepest_m, below_m);
    const bool late = (time_s > loaded_s + 6 && time_s < relieved_s) || time_s > relieved_s + 6;
    if (late) late_error_m = std::max(late_error_m, std::abs(below_m));
  });
  INFO(Stack::name);
  CHECK_FALSE(flown.crashed);
  CHECK(handed_over_s > loaded_s);
  CHECK(handed_over_s < loaded_s + 2);
  CHECK(taken_back_s > relieved_s);
  CHECK(taken_back_s < relieved_s + 4);
  CHECK_FALSE(by_analytic);
  CHECK(deepest_m < 0.5);
  CHECK(late_error_m < 0.1);
}

}  // namespace

TEST_CASE("a bias at its bound hands over to the analytic inverse with its own") {
  carries_a_payload<Px4Stack>();
  carries_a_payload<CrazyflieStack>();
}

TEST_CASE("px4_module flies the paper's quadrotor through all faults") {
  through_all_faults<Px4Stack>("hover", hover, 0.5);
  through_all_faults<Px4Stack>("eight", Eight(4, 9), 6);
  through_all_faults<Px4Stack>("random_places", RandomPlaces(1.5), 3);
}

TEST_CASE("crazyflie_app flies the Crazyflie through all faults") {
  through_all_faults<CrazyflieStack>("hover", hover, 0.5);
  through_all_faults<CrazyflieStack>("eight", Eight(1.5, 6), 3);
  through_all_faults<CrazyflieStack>("random_places", RandomPlaces(1), 2.5);
}

TEST_CASE("without faults the network flies, and tracks") {
  calm<Px4Stack>("hover", hover, 0.05, 0.0f);
  calm<Px4Stack>("eight", Eight(4, 9), 0.12, 0.01f);
  calm<Px4Stack>("random_places", RandomPlaces(1.5), 1, 0.02f);
  calm<CrazyflieStack>("hover", hover, 0.06, 0.0f);
  calm<CrazyflieStack>("eight", Eight(1.5, 6), 0.15, 0.01f);
  calm<CrazyflieStack>("random_places", RandomPlaces(1), 0.8, 0.06f);
}
