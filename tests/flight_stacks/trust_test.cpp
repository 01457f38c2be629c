// SPDX-License-Identifier: MIT
// Both cores with limits of trust: a vehicle that changes faster than a bias is noticed and the analytic inverse flies;
// a payload that the bias carries and a calm flight, outages of samples and commands included, are no reason.
#include <doctest/doctest.h>

#include "flight.hpp"
#include "flight_paths.hpp"
#include "trusting_stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::autopilot::CoreRecord;
using pinnquad::autopilot::Reaction;

/// The command residual of a flight.
struct Trusted {
  double distrusted_s = 0;  ///< the first time; 0: never
  double cleared_s = 0;     ///< the last time that it was trusted again
  float most_residual = 0;
  long ticks = 0, by_analytic_while_distrusted = 0, distrusted = 0, far = 0;
  FlightFigures figures;
};

template <class Stack, class Target, class Faults>
Trusted flown(const Target& target, double duration_s, const Faults& faults) {
  FaultyFlight<Stack> flight;
  REQUIRE(flight.boot());
  Trusted result;
  bool before = true;
  result.figures = flight.fly(target, duration_s, faults, [&](const CoreRecord& tick) {
    const bool trusted = tick.trusted != 0;
    const double time_s = 1e-6 * static_cast<double>(tick.timestamp) - 5;
    if (!trusted && !(result.distrusted_s > 0)) result.distrusted_s = time_s;
    if (trusted && !before) result.cleared_s = time_s;
    before = trusted;
    result.most_residual = std::max(result.most_residual, tick.innovation);
    ++result.ticks;
    result.far += tick.cause == static_cast<std::uint8_t>(Status::outside_distribution) ? 1 : 0;
    if (trusted || tick.reaction > static_cast<std::uint8_t>(Reaction::levels)) return;
    ++result.distrusted;
    const bool by_analytic = tick.status == static_cast<std::uint8_t>(Status::fell_back) &&
                             tick.cause == static_cast<std::uint8_t>(Status::distrusted);
    result.by_analytic_while_distrusted += by_analytic ? 1 : 0;
  });
  return result;
}

template <class Stack>
void no_alarm(const char* path, const Trusted& flight) {
  INFO(Stack::name, ", ", path);
  CHECK_FALSE(flight.figures.crashed);
  CHECK(flight.most_residual > 1e-4f);  // it was measured
  CHECK(flight.distrusted == 0);
  CHECK(flight.far < flight.ticks / 50);
}

/// Of a fault from 6 to 16 s.
template <class Stack, class Target>
Trusted with_fault(const char* what, const Target& target, FaultKind kind, double value) {
  const std::vector<Fault> fault = {{6, 10, kind, value, what, Reaction::flies}};
  const Trusted flight = flown<Stack>(target, 22, fault);
  CHECK_FALSE(flight.figures.crashed);
  CHECK(flight.by_analytic_while_distrusted == flight.distrusted);
  return flight;
}

/// The bias explains it: the model is distrusted for a second after its beginning and its end at most.
template <class Stack, class Target>
void explained(const char* what, const Target& target, FaultKind kind, double value) {
  INFO(Stack::name, ", ", what);
  const Trusted flight = with_fault<Stack>(what, target, kind, value);
  CHECK(static_cast<double>(flight.distrusted) < 2.0 / 22 * static_cast<double>(flight.ticks));
  CHECK(flight.figures.late_rmse_m < 0.15);
}

/// No bias explains it: it changes faster.
template <class Stack, class Target>
void noticed(const char* what, const Target& target, FaultKind kind, double value) {
  INFO(Stack::name, ", ", what);
  const Trusted flight = with_fault<Stack>(what, target, kind, value);
  CHECK(flight.distrusted_s > 6);
  CHECK(flight.distrusted_s < 8);
  CHECK(flight.cleared_s > 16);
  CHECK(flight.cleared_s < 20);
}

template <class Stack>
void judge_stack() {
  constexpr std::array<Fault, 0> none = {};
  no_alarm<Stack>("hover", flown<Stack>(hover, 20, none));
  no_alarm<Stack>("eight", flown<Stack>(Eight(4, 9), 20, none));
  no_alarm<Stack>("random places", flown<Stack>(RandomPlaces(1.5), 33, none));
  no_alarm<Stack>("eight, all faults", flown<Stack>(Eight(4, 9), 33, fault_script));
  explained<Stack>("25 % heavier", hover, FaultKind::payload, 1.25);
  explained<Stack>("25 % heavier on the figure-eight", Eight(4, 9), FaultKind::payload, 1.25);
  explained<Stack>("a rotor that makes 85 %", hover, FaultKind::bent_rotor, 0.85);
  noticed<Stack>("a rotor that makes 60 % for 0.2 s of 0.4 s", hover, FaultKind::rotor_flutters, 0.6);
}

/// Every motion is too far.
struct NarrowTrust : StructuredQuadModelTrust {
  static constexpr double squared_distance_limit = 1e-3;
};
using NarrowStack =
    Px4StackOf<StructuredQuadModel,
               pinnquad::autopilot::NeuralController<StructuredQuadModel, pinnquad::ModelView<StructuredQuadModel>,
                                                     pinnquad::Quadrotor<float, pinnquad::QuadraticDrag>, NarrowTrust>>;

}  // namespace

TEST_CASE(
    "limits of trust: a fluttering rotor is noticed; what a bias carries, calm flight and outages are not; PX4's "
    "core") {
  judge_stack<TrustingPx4Stack>();
}

TEST_CASE(
    "limits of trust: a fluttering rotor is noticed; what a bias carries, calm flight and outages are not; the "
    "Crazyflie's core") {
  judge_stack<TrustingCrazyflieStack>();
}

TEST_CASE("limits of trust: beyond the distance the analytic inverse flies") {
  const Trusted flight = flown<NarrowStack>(hover, 2, std::array<Fault, 0>{});
  CHECK(flight.far == flight.ticks);
  CHECK(flight.figures.fallback_share == 1);
  CHECK_FALSE(flight.figures.crashed);
}

TEST_CASE("limits of trust: a model of other training data than theirs is refused") {
  TrustingPx4Stack stack;
  const Block sound = sound_block<StructuredQuadModel>();
  Block other = sound;
  other[pinnquad::detail::ModelBlockHeader::training_data_hash] ^= 1;
  other = sealed(other);
  CHECK(stack.offer(other.data(), other.size()) == Status::block_incompatible);
  CHECK_FALSE(stack.ready());
  CHECK(stack.offer(sound.data(), sound.size()) == Status::ok);
  CHECK(stack.settings().distance_limit == static_cast<float>(StructuredQuadModelTrust::squared_distance_limit));
}

TEST_CASE("limits of trust: another model begins without the command residual of the one before") {
  const Block first = sound_block<StructuredQuadModel>();
  Block second = first;
  second[second.size() - 8] ^= 1;  // the last bit of its last number
  second = sealed(second);
  TrustingController controller;
  REQUIRE(controller.offer_model(first.data(), first.size()) == Status::ok);
  controller.situation({true, false});
  std::uint64_t now_us = 1'000'000;  // a window begins: none ends within what follows
  const auto cause_of_step = [&] {
    REQUIRE(controller.body_rates(now_us, {0, 0, 0}) == Status::ok);
    REQUIRE(controller.attitude(now_us, {}) == Status::ok);
    REQUIRE(controller.local(now_us, {}) == Status::ok);
    pinnquad::Commands<float> commands{};
    pinnquad::autopilot::StepReport report;
    REQUIRE(controller.step(now_us, commands, report) == Reaction::holds_position);
    now_us += 2000;
    return report.cause;
  };
  CHECK(cause_of_step() != Status::distrusted);
  CoreRecord logged;
  logged.innovation = 0.05f;
  logged.trusted = 0;
  controller.resume(logged);
  CHECK(cause_of_step() == Status::distrusted);
  CHECK(controller.command_residual() == 0.05f);
  REQUIRE(controller.offer_model(second.data(), second.size()) == Status::ok);
  CHECK_FALSE(controller.trusted());
  CHECK(cause_of_step() != Status::distrusted);
  CHECK(controller.trusted());
  CHECK(controller.command_residual() == 0);
}
