// SPDX-License-Identifier: MIT
#include "pinnquad/inference/guard.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/guarded_inputs.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

/// The small model with commands around 1 and 0: many lie outside 0..1, some far.
struct EdgyNumbers : SmallNumbers {
  static constexpr Scaler<float, 4> output{{0.97F, 0.03F, 0.5F, 0.5F}, {0.1F, 0.1F, 0.05F, 0.05F}};
};
using EdgyModel = AsHeader<EdgyNumbers>;

struct BrokenModel : Unchecked<SmallModel> {
  static constexpr Scaler<float, 4> output{{0.5F, not_a_number, 0.5F, 0.5F}, SmallModel::output.standard_deviation};
};

struct WideCommands {
  static constexpr double lower = -0.1;
  static constexpr double upper = 1.1;
};

/// Answers with the time, if it is told one.
struct ClockFallback {
  Status operator()(const MotionInputs<float>&, const PlaceAndTime<double>& place,
                    Commands<float>& commands) const noexcept {
    commands = {float(place.time_s), float(place.position_m[0]), float(place.position_m[1]), 0.0F};
    return Status::ok;
  }
};

template <class Guard, class Model = SmallModel>
using Guarded = InverseDynamics<Model, Guard>;

using Refusing = Extend<TrainingGuard, RefuseCommands<>>;
using Clipping = Extend<TrainingGuard, ClipCommands<>>;
using RefusingAndClipping = Extend<TrainingGuard, RefuseCommands<WideCommands>, ClipCommands<>>;
using FallingBack = Extend<TrainingGuard, Fallback<FixedFallback>>;

}  // namespace

TEST_CASE("a guard is a type: no room, and the order of its policies has no meaning") {
  CHECK(std::is_empty_v<InverseDynamics<SmallModel>>);
  CHECK(std::is_empty_v<Guarded<RefusingAndClipping>>);
  CHECK(sizeof(Guarded<FallingBack>) == sizeof(FixedFallback));
  CHECK(is_guard<TrainingGuard>);
  CHECK_FALSE(is_guard<FiniteInputs>);
  using Backwards = Guard<ClipCommands<>, TrainingEnvelope, FiniteInputs>;
  RandomStates random(181);
  for (int i = 0; i < 200; ++i) {
    const auto inputs = inputs_of(random, 1.6);
    Commands<float> a = marked(), b = marked();
    CHECK(Guarded<Clipping, EdgyModel>{}.predict(inputs, a) == Guarded<Backwards, EdgyModel>{}.predict(inputs, b));
    CHECK(same_bits(a, b));
  }
}

TEST_CASE("limits of the commands: refused, clipped, or a little clipped and much refused") {
  RandomStates random(182);
  int fine = 0, little = 0, much = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto inputs = inputs_of(random, 0.99);
    Commands<float> raw{}, refused = marked(), clipped = marked(), both = marked();
    REQUIRE(Guarded<TrainingGuard, EdgyModel>{}.predict(inputs, raw) == Status::ok);
    const auto [lowest, highest] = std::minmax_element(raw.begin(), raw.end());
    const bool inside = *lowest >= 0.0F && *highest <= 1.0F;
    const bool near = *lowest >= -0.1F && *highest <= 1.1F;
    ++(inside ? fine : near ? little : much);
    Commands<float> nearest{};
    for (std::size_t k = 0; k < 4; ++k) nearest[k] = std::min(std::max(raw[k], 0.0F), 1.0F);

    REQUIRE(Guarded<Refusing, EdgyModel>{}.predict(inputs, refused) == (inside ? Status::ok : Status::outside_limits));
    CHECK(same_bits(refused, inside ? raw : marked()));
    REQUIRE(Guarded<Clipping, EdgyModel>{}.predict(inputs, clipped) == (inside ? Status::ok : Status::limited));
    CHECK(same_bits(clipped, nearest));
    const Status expected = inside ? Status::ok : near ? Status::limited : Status::outside_limits;
    REQUIRE(Guarded<RefusingAndClipping, EdgyModel>{}.predict(inputs, both) == expected);
    CHECK(same_bits(both, near ? nearest : marked()));
  }
  MESSAGE("within limits ", fine, ", a little out ", little, ", far out ", much);
  CHECK(fine > 100);
  CHECK(little > 100);
  CHECK(much > 100);
}

TEST_CASE("without an envelope any finite motion is answered; without a check of the inputs the envelope refuses NaN") {
  RandomStates random(184);
  const Guarded<Guard<FiniteInputs>> anywhere;
  const Guarded<Guard<TrainingEnvelope>> unchecked;
  const auto far = inputs_of(random, 100.0);
  Commands<float> commands = marked(), expected{};
  CHECK(InverseDynamics<SmallModel>{}.predict(far, commands) == Status::outside_envelope);
  CHECK(anywhere.predict(far, commands) == Status::ok);
  anywhere.evaluate(features(far).data(), expected.data());
  CHECK(same_bits(commands, expected));
  const auto good = inputs_of(random, 0.9);
  CHECK(unchecked.predict(good, commands) == Status::ok);
  CHECK(InverseDynamics<SmallModel>{}.predict(good, expected) == Status::ok);
  CHECK(same_bits(commands, expected));
  for (const float bad : {not_a_number, infinity, -infinity}) {
    for (std::size_t k = 0; k < 16; ++k) {
      auto x = SmallModel::golden_features[0];
      x[k] = bad;
      commands = marked();
      CHECK(anywhere.predict_features(x.data(), commands) == Status::not_finite);
      CHECK(same_bits(commands, marked()));
    }
    for (const int field : {0, 1, 2}) {
      auto inputs = good;
      (field == 0 ? inputs.velocity_m_s[1] : field == 1 ? inputs.attitude.w : inputs.attitude.z) = bad;
      commands = marked();
      CHECK(unchecked.predict(inputs, commands) == Status::outside_envelope);
      CHECK(anywhere.predict(inputs, commands) == Status::not_finite);
      CHECK(same_bits(commands, marked()));
    }
    auto x = features(good);
    x[7] = bad;
    CHECK(anywhere.predict_features(x.data(), commands) == Status::not_finite);
    CHECK(unchecked.predict_features(x.data(), commands) == Status::outside_envelope);
    CHECK(same_bits(commands, marked()));
  }
}

TEST_CASE_TEMPLATE("the NaN of a broken model reaches nothing, under any guard", Policies, TrainingGuard, Refusing,
                   Clipping, RefusingAndClipping) {
  RandomStates random(185);
  const auto inputs = inputs_of(random, 0.9);
  Commands<float> commands = marked();
  typename Guarded<Policies, BrokenModel>::Report report;
  CHECK(Guarded<Policies, BrokenModel>{}.predict(inputs, commands, report) == Status::output_not_finite);
  CHECK(report.cause == Status::output_not_finite);
  CHECK(Guarded<Policies, BrokenModel>{}.predict_features(features(inputs).data(), commands) ==
        Status::output_not_finite);
  CHECK(same_bits(commands, marked()));
}

TEST_CASE("the fallback answers where the network declines, and only there") {
  RandomStates random(186);
  const Guarded<FallingBack> inverse(FixedFallback{0.25F, Status::ok});
  const Commands<float> replaced{0.25F, 0.25F, 0.25F, 0.25F};
  int declined = 0, at_the_edge = 0;
  for (int i = 0; i < 500; ++i) {
    const auto inputs = inputs_of(random, 1.55);
    // outside by the angular acceleration alone: the network's commands at the edge, to which a fixed answer adds
    // nothing
    auto nearest = inputs;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(PaperFeatures::angular_acceleration + k);
      nearest.angular_acceleration_rad_s2[k] = std::clamp(
          inputs.angular_acceleration_rad_s2[k], SmallModel::envelope_lower[at], SmallModel::envelope_upper[at]);
    }
    Commands<float> edge = replaced;
    const bool by_angular_acceleration = InverseDynamics<SmallModel>{}.predict(nearest, edge) == Status::ok;
    Commands<float> alone = marked(), commands = marked(), reported = marked();
    const Status network = InverseDynamics<SmallModel>{}.predict(inputs, alone);
    Guarded<FallingBack>::Report report;
    REQUIRE(inverse.predict(inputs, commands) == (network == Status::ok ? Status::ok : Status::fell_back));
    REQUIRE(inverse.predict(inputs, reported, report) == (network == Status::ok ? Status::ok : Status::fell_back));
    CHECK(same_bits(commands, network == Status::ok ? alone : edge));
    CHECK(same_bits(commands, reported));
    CHECK(report.cause == network);
    CHECK(report.fallback_asked == (network != Status::ok));
    if (network != Status::ok) ++declined;
    if (network != Status::ok && by_angular_acceleration) ++at_the_edge;
  }
  CHECK(at_the_edge > 20);
  CHECK(declined - at_the_edge > 100);
  CHECK(declined < 400);
  // a bad input too: this fallback does not look at it
  auto inputs = inputs_of(random, 0.5);
  inputs.attitude.x = not_a_number;
  Commands<float> commands = marked();
  CHECK(inverse.predict(inputs, commands) == Status::fell_back);
  CHECK(same_bits(commands, replaced));
  // features alone have no inputs to fall back with
  auto x = SmallModel::golden_features[0];
  x[0] = 1e9F;
  commands = marked();
  CHECK(inverse.predict_features(x.data(), commands) == Status::outside_envelope);
  CHECK(same_bits(commands, marked()));
}

TEST_CASE(
    "a fallback that declines, or answers what the guard would not let through: the network's Status, untouched") {
  RandomStates random(187);
  const auto inputs = inputs_of(random, 50.0);
  const auto check = [&](auto guard, const FixedFallback& fallback, Status expected, Status of_fallback,
                         float command) {
    using Inverse = Guarded<decltype(guard)>;
    Commands<float> commands = marked();
    typename Inverse::Report report;
    CHECK(Inverse(decltype(guard)(fallback)).predict(inputs, commands, report) == expected);
    CHECK(report.cause == Status::outside_envelope);
    CHECK(report.fallback_asked);
    CHECK(report.fallback == of_fallback);
    CHECK(report.commands_clipped == (of_fallback == Status::limited));
    const Commands<float> written{command, command, command, command};
    CHECK(same_bits(commands, expected == Status::fell_back ? written : marked()));
  };
  const FallingBack plain(FixedFallback{});
  check(plain, {0.5F, Status::no_solution}, Status::outside_envelope, Status::no_solution, 0);
  check(plain, {not_a_number, Status::ok}, Status::outside_envelope, Status::output_not_finite, 0);
  check(plain, {infinity, Status::ok}, Status::outside_envelope, Status::output_not_finite, 0);
  check(plain, {1.5F, Status::ok}, Status::fell_back, Status::ok, 1.5F);
  const Extend<FallingBack, RefuseCommands<>> refusing(FixedFallback{});
  check(refusing, {1.5F, Status::ok}, Status::outside_envelope, Status::outside_limits, 0);
  check(refusing, {0.75F, Status::ok}, Status::fell_back, Status::ok, 0.75F);
  const Extend<FallingBack, ClipCommands<>> clipping(FixedFallback{});
  check(clipping, {1.5F, Status::ok}, Status::fell_back, Status::limited, 1.0F);
  check(clipping, {not_a_number, Status::ok}, Status::outside_envelope, Status::output_not_finite, 0);
}

TEST_CASE("place and time reach the fallback that asks for them, and trouble none that does not") {
  RandomStates random(188);
  const auto far = inputs_of(random, 50.0), near = inputs_of(random, 0.9);
  PlaceAndTime<double> place;
  place.position_m = Vector3<double>(3, -7, 0);
  place.time_s = 12.5;
  const Guarded<Extend<TrainingGuard, Fallback<ClockFallback>>> clock;
  Commands<float> commands = marked(), alone{};
  CHECK(clock.predict(far, place, commands) == Status::fell_back);
  CHECK(same_bits(commands, Commands<float>{12.5F, 3.0F, -7.0F, 0.0F}));
  CHECK(clock.predict(near, place, commands) == Status::ok);
  CHECK(InverseDynamics<SmallModel>{}.predict(near, alone) == Status::ok);
  CHECK(same_bits(commands, alone));
  const Guarded<FallingBack> fixed(FixedFallback{});
  CHECK(fixed.predict(far, place, commands) == Status::fell_back);
  CHECK(commands[0] == 0.5F);
  CHECK(InverseDynamics<SmallModel>{}.predict(far, place, commands) == Status::outside_envelope);
}

TEST_CASE("a report that is used again says what the last answer came to alone, where place and time are told too") {
  RandomStates random(190);
  const auto far = inputs_of(random, 50.0), near = inputs_of(random, 0.9);
  const PlaceAndTime<double> place;
  using Inverse = Guarded<Extend<TrainingGuard, Fallback<ClockFallback>>>;
  using Report = Inverse::Report;
  const Inverse clock;
  const Guarded<FallingBack> fixed(FixedFallback{});
  const auto used_again = [&](const auto& inverse, const auto& ask) {
    Commands<float> commands{};
    Report used, fresh;
    REQUIRE(ask(inverse, far, commands, used) == Status::fell_back);
    REQUIRE(used.cause == Status::outside_envelope);
    REQUIRE(used.worst_feature >= 0);
    REQUIRE(ask(inverse, near, commands, used) == Status::ok);
    REQUIRE(ask(inverse, near, commands, fresh) == Status::ok);
    CHECK(used.cause == fresh.cause);
    CHECK(used.fallback == fresh.fallback);
    CHECK(used.fallback_asked == fresh.fallback_asked);
    CHECK(used.worst_feature == fresh.worst_feature);
    CHECK(used.excess == fresh.excess);
  };
  used_again(fixed, [](const auto& inverse, const auto& inputs, auto& commands, auto& report) {
    return inverse.predict(inputs, commands, report);
  });
  used_again(clock, [&](const auto& inverse, const auto& inputs, auto& commands, auto& report) {
    return inverse.predict(inputs, place, commands, report);
  });
  // nobody asks the network: nothing of its features is said
  Commands<float> commands{};
  Report used;
  REQUIRE(clock.predict(far, place, commands, used) == Status::fell_back);
  REQUIRE(used.worst_feature >= 0);
  REQUIRE(clock.without_network(Status::distrusted, near, commands, used, place) == Status::fell_back);
  CHECK(used.cause == Status::distrusted);
  CHECK(used.worst_feature == -1);
  CHECK(used.excess == Report{}.excess);
  REQUIRE(fixed.predict(far, commands, used) == Status::fell_back);
  REQUIRE(fixed.without_network(Status::distrusted, near, commands, used) == Status::fell_back);
  CHECK(used.worst_feature == -1);
  CHECK(used.excess == Report{}.excess);
}

TEST_CASE("the report says how far outside which feature lies, in half-widths") {
  const InverseDynamics<SmallModel> inverse;
  RandomStates random(189);
  using Report = InverseDynamics<SmallModel>::Report;
  MotionInputs<float> inputs;  // level, at rest: inside
  Commands<float> commands{};
  Report report;
  report.worst_feature = 5;
  report.excess[3] = 7;
  CHECK(inverse.predict(inputs, commands, report) == Status::ok);
  CHECK(report.worst_feature == -1);
  CHECK(report.excess == std::array<float, 16>{});
  CHECK(report.cause == Status::ok);
  CHECK_FALSE(report.fallback_asked);

  const auto half_width = [](std::size_t i) {
    return (static_cast<double>(SmallModel::envelope_upper[i]) - static_cast<double>(SmallModel::envelope_lower[i])) /
           2;
  };
  constexpr double tolerance = 1e-5;  // float differences of numbers up to 300
  inputs.velocity_m_s[1] = -30.0F;    // feature 7
  inputs.body_rates_rad_s[2] = 5.0F;  // feature 11
  CHECK(inverse.predict(inputs, commands, report) == Status::outside_envelope);
  CHECK(report.cause == Status::outside_envelope);
  for (std::size_t i = 0; i < 16; ++i) {
    const double expected = i == 7    ? (30.0 - half_width(7)) / half_width(7)
                            : i == 11 ? (5.0 - half_width(11)) / half_width(11)
                                      : 0.0;  // this envelope is symmetric about 0
    CHECK(std::fabs(static_cast<double>(report.excess[i]) - expected) <= tolerance);
  }
  CHECK(report.worst_feature == 7);
  CHECK(std::string(PaperFeatures::names[7]) == "v_by");
  inputs.body_rates_rad_s[2] = 100.0F;
  CHECK(inverse.predict(inputs, commands, report) == Status::outside_envelope);
  CHECK(report.worst_feature == 11);

  // the last feature, cos psi, too: an envelope that ends at 0.5
  SmallInstance never_north;
  never_north.envelope_upper[15] = 0.5F;
  CHECK(InverseDynamics<SmallInstance>(never_north).predict({}, commands, report) == Status::outside_envelope);
  CHECK(report.worst_feature == 15);
  const double its_half_width = (0.5 - static_cast<double>(never_north.envelope_lower[15])) / 2;
  CHECK(std::fabs(static_cast<double>(report.excess[15]) - 0.5 / its_half_width) <= tolerance);

  inputs.body_rates_rad_s[2] = not_a_number;  // refused before there are features
  CHECK(inverse.predict(inputs, commands, report) == Status::not_finite);
  CHECK(report.cause == Status::not_finite);
  CHECK(report.worst_feature == -1);
  // a guard that does not look at the inputs: the NaN is the worst feature, before any number
  const Guarded<Guard<TrainingEnvelope>> unchecked;
  CHECK(unchecked.predict(inputs, commands, report) == Status::outside_envelope);
  CHECK(report.worst_feature == 11);
  CHECK(std::isnan(report.excess[11]));
  inputs.linear_acceleration_m_s2[0] = infinity;
  CHECK(unchecked.predict(inputs, commands, report) == Status::outside_envelope);
  CHECK(report.worst_feature == 0);
}

TEST_CASE("a model may be an instance: its own numbers and its own forward pass are the ones in use") {
  RandomStates random(190);
  SmallInstance model;
  const InverseDynamics<SmallInstance> inverse(model);
  CHECK(inverse.model().parameters == SmallModel::parameters);
  CHECK_FALSE(std::is_default_constructible_v<InverseDynamics<SmallInstance>>);
  for (int i = 0; i < 300; ++i) {
    const auto inputs = inputs_of(random, 1.3);
    Commands<float> commands = marked(), constant = marked();
    REQUIRE(inverse.predict(inputs, commands) == InverseDynamics<SmallModel>{}.predict(inputs, constant));
    constexpr float kernels_differ = 2e-6F;  // portable here, vector unit there
    for (std::size_t k = 0; k < 4; ++k) {
      if (constant[k] == constant[k]) CHECK(std::fabs(commands[k] - constant[k]) <= kernels_differ);
    }
  }
  const auto inputs = inputs_of(random, 0.5);
  Commands<float> before{}, after = marked();
  REQUIRE(inverse.predict(inputs, before) == Status::ok);
  model.parameters[171] += 1.0F;  // the last bias: the last command, by the spread
  REQUIRE(InverseDynamics<SmallInstance>(model).predict(inputs, after) == Status::ok);
  CHECK(after[3] - before[3] ==
        doctest::Approx(static_cast<double>(SmallModel::output.standard_deviation[3])).epsilon(1e-4));
  CHECK(after[0] == before[0]);
  model.output.mean[0] += 0.25F;
  model.input.mean[2] += 0.5F;
  REQUIRE(InverseDynamics<SmallInstance>(model).predict(inputs, after) == Status::ok);
  CHECK(after[0] > before[0] + 0.1F);
  model.envelope_upper[6] = -100.0F;
  CHECK(InverseDynamics<SmallInstance>(model).predict(inputs, after) == Status::outside_envelope);
  CHECK(inverse.predict(inputs, after) == Status::ok);  // it holds its own copy
  const InverseDynamics<SmallInstance, FallingBack> falling(model, FallingBack(FixedFallback{}));
  CHECK(falling.predict(inputs, after) == Status::fell_back);
}
