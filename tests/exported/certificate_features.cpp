// SPDX-License-Identifier: MIT
// Whatever feature, tap or column shows an angular acceleration: the certificate counts it, or there is none; header
// and block agree.
#include <doctest/doctest.h>

#include "pinnquad/deploy/block_model.hpp"
#include "support/drawn_model.hpp"

using namespace pinnquad;
using pinnquad::test::drawn_block;
using pinnquad::test::drawn_model;
using pinnquad::test::ModelOf;

namespace {

using Period = PeriodMicroseconds<20000>;
template <class Features, class Answer = MonotoneBase<Features>>
using Certified = ModelOf<Answer, Features, AxisCommandOutputs>;

struct GyroSlope {
  static constexpr const char* name = "gyro_slope";
  static constexpr const char* unit = "deg/s^2";
};
struct TorqueAsked {
  static constexpr const char* name = "torque_x";
  static constexpr const char* unit = "N m";
};
struct Spin {
  static constexpr const char* name = "spin";
  static constexpr const char* unit = "rpm/s";
};
/// A feature that nobody but its author knows.
struct OwnFeature : detail::MotionPart<OwnFeature> {
  static constexpr int size = 1;
  static constexpr std::array<const char*, 1> names = {"effort"};
  static constexpr std::array<const char*, 1> units = {"1"};
  template <class Scalar>
  static void extract(const MotionInputs<Scalar>& in, Scalar* x) noexcept {
    x[0] = Scalar(0.1) * in.angular_acceleration_rad_s2[0];
  }
};

// none: a lone one in the past, in the future, two of them in another order, in a chosen set and as a whole part
using LonePast = PartlyWindowed<InverseFeatures, Chosen<NamedFeatures, 3>, 2, Period>;
using LoneFuture = PartlyWindowed<InverseFeatures, Chosen<NamedFeatures, 18, 5>, 3, Period, Centred>;
using TwoOfThree = PartlyWindowed<Chosen<NamedFeatures, 18, 3, 4, 5>, Chosen<NamedFeatures, 5, 4>, 2, Period>;
using OfTurningColumn = WithColumns<InverseFeatures, BatteryVoltage, GyroSlope>;
using OfTorque = Windowed<WithColumns<AccelerationFeatures, TorqueAsked>, 2, Period>;
using OfSpin = WithColumns<AccelerationFeatures, Spin>;
using OfOwnFeature = Joined<AccelerationFeatures, OwnFeature>;
// proven
using ChosenPlaces = Chosen<NamedFeatures, 18, 9, 3, 4, 5>;
using ChosenPast = PartlyWindowed<InverseFeatures, Chosen<NamedFeatures, 3, 4, 5, 18>, 2, Period>;
using OfColumn = WithColumns<AccelerationFeatures, BatteryVoltage>;
using ForcePast = PartlyWindowed<InverseFeatures, SpecificForce, 3, Period, Centred>;
/// Threes beyond the taps: slopes of the body rates.
using RatesToo = AxisAligned<float, PhysicsFeatures::size, 3, 6>;

template <class Model>
void header_and_block_say(bool has_one) {
  CHECK(has_certificate<Model> == has_one);
  const Model model = drawn_model<Model>(1);
  const BlockModel block("drawn.block", drawn_block(model));
  CHECK(block.certificate().has_value() == has_one);
  CHECK(certificate_of_trained(model).proven() == has_one);
  if (!has_one) CHECK(!block.proven_signs());
}

}  // namespace

TEST_CASE("an angular acceleration beside the threes of the affine part, or an unknown feature: no proof") {
  header_and_block_say<Certified<LonePast>>(false);
  header_and_block_say<Certified<LoneFuture>>(false);
  header_and_block_say<Certified<TwoOfThree>>(false);
  header_and_block_say<Certified<OfTurningColumn>>(false);
  header_and_block_say<Certified<OfTorque>>(false);
  header_and_block_say<Certified<OfSpin>>(false);
  header_and_block_say<Certified<OfOwnFeature>>(false);
  header_and_block_say<Certified<PhysicsFeatures, RatesToo>>(false);
}

TEST_CASE("threes of all taps that show one, chosen places, columns that are measured: proven as before") {
  header_and_block_say<Certified<ChosenPlaces>>(true);
  header_and_block_say<Certified<ChosenPast>>(true);
  header_and_block_say<Certified<OfColumn>>(true);
  header_and_block_say<Certified<ForcePast>>(true);
}

TEST_CASE("a derivative by an acceleration that is held moves the lone feature of another tap") {
  using Model = Certified<LonePast>;
  Model model = drawn_model<Model>(2);
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  auto& parameters = model.network.parameters;
  parameters[0] = 1;
  constexpr int others = LonePast::size - 3, lone = others - 1;
  parameters[std::size_t(3 + others + lone)] = -1.5F;  // roll's weight of wdot_x[-1]
  const BlockModel block("drawn.block", drawn_block(model));
  const std::vector<double> anywhere = block.golden_features(0);
  CHECK(block.derivatives(anywhere, false)[0] == doctest::Approx(1));
  CHECK(block.derivatives(anywhere, true)[0] == doctest::Approx(-0.5));
  CHECK(block.angular_accelerations().size() == 4);
}

TEST_CASE("an affine network of a lone angular acceleration is proven by the weights of all taps, or not") {
  using Affine = Network<float, InputSize<LonePast::size>, Dense<4>>;
  using Model = ModelOf<Affine, LonePast, AxisCommandOutputs>;
  Model model = drawn_model<Model>(3);
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  const auto weight = [&](int row, int feature) -> float& {
    return model.network.parameters[std::size_t(row * LonePast::size + feature)];
  };
  for (int axis = 0; axis < 3; ++axis) weight(1 + axis, 1 + axis) = 1;
  const int lone = LonePast::size - 1;
  weight(1, lone) = 0.5F;
  const auto proof = BlockModel("drawn.block", drawn_block(model)).proven_signs();
  REQUIRE(proof.has_value());
  CHECK(proof->held_slope[0] == doctest::Approx(1.5));
  CHECK(proof->slope[0] == doctest::Approx(1));
  weight(1, lone) = -1.5F;
  CHECK(!BlockModel("drawn.block", drawn_block(model)).proven_signs());
}
