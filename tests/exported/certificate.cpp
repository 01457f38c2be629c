// SPDX-License-Identifier: MIT
// Certificates against samples of the model as it flies, against differences, and where the numbers deserve
// none. Its bounds against interval arithmetic: certificate_intervals.cpp.
#include "pinnquad/exported/certificate.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "support/monotone_shapes.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

static_assert(has_certificate<BaseAlone> && has_certificate<WithResidual> && has_certificate<WindowedModel> &&
              has_certificate<ForceWindowedModel>);

/// Shown the angular acceleration after all, or another feature in its place; or outputs of another meaning.
using Seeing =
    Sum<MonotoneBase<PhysicsFeatures>, Saturated<Network<float, InputSize<PhysicsFeatures::size>, Dense<4>>>>;
using Elsewhere = AxisAligned<float, PhysicsFeatures::size, 6>;
struct AsCommands : BaseAlone {
  using Outputs = CommandOutputs;
};
/// A base that leaves the angular acceleration of the other taps to its weights.
using PresentAlone = AxisAligned<float, PhysicsWindow::size, 3>;
static_assert(!has_certificate<MonotoneShape<PhysicsFeatures, Seeing>> && !has_certificate<AsCommands> &&
              !has_certificate<MonotoneShape<PhysicsFeatures, Elsewhere>> &&
              !has_certificate<MonotoneShape<PhysicsWindow, PresentAlone>>);

template <class Model>
std::array<typename Model::Scalar, Model::inputs> inside(const Model& model, std::mt19937_64& engine) {
  std::array<typename Model::Scalar, Model::inputs> x{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = static_cast<typename Model::Scalar>(
        uniform(engine, double(model.envelope_lower[i]), double(model.envelope_upper[i])));
  }
  return x;
}

constexpr std::array<std::array<double, rotor_count>, 3> signs = {allocation_signs(PaperQuadrotor::value<double>(), 0),
                                                                  allocation_signs(PaperQuadrotor::value<double>(), 1),
                                                                  allocation_signs(PaperQuadrotor::value<double>(), 2)};

template <class Scalar>
double sum_of(const Scalar* commands, std::size_t axis) {
  double sum = 0;
  for (std::size_t i = 0; i < rotor_count; ++i) sum += signs[axis][i] * double(commands[i]);
  return sum;
}

}  // namespace

TEST_CASE_TEMPLATE("the certificate's slopes are what differences and the Jacobian of the model give, everywhere",
                   Shape, BaseAlone, WithResidual, WindowedModel, ForceWindowedModel) {
  using Model = MonotoneModel<Shape>;
  constexpr int size = Shape::Features::size;
  const Model model(3);
  const Certificate certificate = model.certificate();
  REQUIRE(certificate.proven());
  const InverseDynamics<Model> inverse(model);
  std::mt19937_64 engine(4);
  for (int sample = 0; sample < 200; ++sample) {
    const auto x = inside(model, engine);
    float u[4], moved_u[4], by_x[4 * size];
    REQUIRE(predict_with_jacobian(inverse, x.data(), u, by_x) == Status::ok);
    for (int axis = 0; axis < 3; ++axis) {
      for (int of = 0; of < 3; ++of) {
        const int place = Shape::Features::angular_acceleration + axis;
        double slope = 0, difference = 0;
        for (std::size_t i = 0; i < rotor_count; ++i) {
          slope += signs[std::size_t(of)][i] * double(by_x[int(i) * size + place]);
        }
        auto moved = x;
        moved[std::size_t(place)] = model.input.mean[std::size_t(place)];
        inverse.evaluate(moved.data(), moved_u);
        difference = (sum_of(u, std::size_t(of)) - sum_of(moved_u, std::size_t(of))) /
                     (double(x[std::size_t(place)]) - double(moved[std::size_t(place)]));
        const double expected = of == axis ? certificate.slope[axis] : 0.0;
        CHECK(slope == doctest::Approx(expected).epsilon(1e-5).scale(0.01));
        if (std::abs(x[std::size_t(place)] - moved[std::size_t(place)]) < 1) continue;
        CHECK(difference == doctest::Approx(expected).epsilon(1e-4).scale(0.1));
      }
    }
  }
}

TEST_CASE("of a window the slope of an acceleration that is held is that of all taps") {
  const MonotoneModel<WindowedModel> model(5);
  const Certificate certificate = model.certificate();
  const InverseDynamics<MonotoneModel<WindowedModel>> inverse(model);
  std::mt19937_64 engine(6);
  for (int sample = 0; sample < 50; ++sample) {
    const auto x = inside(model, engine);
    for (int axis = 0; axis < 3; ++axis) {
      auto more = x;
      for (int tap = 0; tap < 3; ++tap) more[std::size_t(angular_acceleration_at<PhysicsWindow>(tap) + axis)] += 8;
      float u[4], u_of_more[4];
      inverse.evaluate(x.data(), u);
      inverse.evaluate(more.data(), u_of_more);
      const auto at = std::size_t(axis);
      CHECK((sum_of(u_of_more, at) - sum_of(u, at)) / 8 == doctest::Approx(certificate.held_slope[axis]).epsilon(1e-4));
    }
  }
  const Certificate force = MonotoneModel<ForceWindowedModel>(5).certificate();
  CHECK(force.held_slope[1] == force.slope[1]);
}

TEST_CASE_TEMPLATE("rounding turns no order: over the smallest steps and the largest, as it flies", Shape, WithResidual,
                   WindowedModel) {
  using Model = MonotoneModel<Shape>;
  const Model model(7);
  const InverseDynamics<Model, Extend<TrainingGuard, ClipCommands<>>> inverse(model);
  std::mt19937_64 engine(8);
  int rested = 0, rose = 0;
  for (int sample = 0; sample < 3000; ++sample) {
    const auto x = inside(model, engine);
    const int axis = sample % 3;
    const auto place = std::size_t(Shape::Features::angular_acceleration + axis);
    auto more = x;
    more[place] =
        sample % 2 == 0 ? std::nextafter(x[place], 1e30f) : x[place] + std::ldexp(1.0f, int(uniform(engine, -20, 3)));
    float u[4], u_of_more[4];
    inverse.evaluate(x.data(), u);
    inverse.evaluate(more.data(), u_of_more);
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const double rise = signs[std::size_t(axis)][i] * (double(u_of_more[i]) - double(u[i]));
      CHECK(rise >= 0);
      rested += rise > 0 ? 0 : 1;
      rose += rise > 0 ? 1 : 0;
    }
  }
  CHECK(rested > 100);  // the steps were as small as rounding
  CHECK(rose > 1000);
}

TEST_CASE("commands keep within the bound of the base's, far outside the envelope too") {
  using Model = MonotoneModel<WithResidual>;
  const Model model(9);
  const Certificate certificate = model.certificate();
  MonotoneModel<BaseAlone> base(9);
  base.input = model.input;
  base.output = model.output;
  std::copy_n(model.parameters.begin(), base.parameters.size(), base.parameters.begin());
  const InverseDynamics<Model> inverse(model);
  const InverseDynamics<MonotoneModel<BaseAlone>> base_inverse(base);
  std::mt19937_64 engine(10);
  double largest[4] = {};
  for (int sample = 0; sample < 3000; ++sample) {
    auto x = inside(model, engine);
    if (sample % 3 == 0) {
      for (float& v : x) v *= 30;
    }
    float u[4], base_u[4];
    inverse.evaluate(x.data(), u);
    base_inverse.evaluate(x.data(), base_u);
    double largest_command = 1;
    for (const float command : base_u) largest_command = std::max(largest_command, std::abs(double(command)));
    const double rounding = 2e-6 * largest_command;  // of sums that partly cancel
    for (std::size_t i = 0; i < 4; ++i) {
      const double difference = std::abs(double(u[i]) - double(base_u[i]));
      CHECK(difference <= certificate.command_bound[i] + rounding);
      largest[i] = std::max(largest[i], difference);
    }
  }
  for (std::size_t i = 0; i < 4; ++i) CHECK(largest[i] > 0.5 * certificate.command_bound[i]);  // it is no idle bound
}

TEST_CASE("numbers that deserve no certificate get none") {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float slope : {-0.1F, 0.0F, nan, infinity}) {
    for (int i = 0; i < 3; ++i) {
      MonotoneModel<WithResidual> model(1);
      model.slope(i) = slope;
      CHECK(!model.certificate().monotone);
      CHECK(model.certificate().bounded);
    }
  }
  for (const int k : {0, 3}) {
    MonotoneModel<WithResidual> model(1);
    model.bound(k) = model.bound(4 + k) + 0.1F;  // above the upper one
    CHECK(!model.certificate().bounded);
    model.bound(k) = nan;
    CHECK(!model.certificate().bounded);
    model.bound(k) = -infinity;
    CHECK(!model.certificate().bounded);
    CHECK(model.certificate().monotone);
  }
  MonotoneModel<WithResidual> turned(1);
  turned.output.standard_deviation[2] = -turned.output.standard_deviation[2];
  CHECK(!turned.certificate().monotone);
  MonotoneModel<WithResidual> upside_down(1);
  upside_down.input.standard_deviation[4] = -1;
  CHECK(!upside_down.certificate().monotone);

  // a window whose present slope is above 0 and whose sum is not, and the other way round
  MonotoneModel<WindowedModel> past(1);
  REQUIRE(past.certificate().monotone);
  past.slope(3) = -60;
  CHECK(past.certificate().slope[0] > 0);
  CHECK(!past.certificate().monotone);
  MonotoneModel<WindowedModel> present(1);
  present.slope(1) = -1e-3F;
  CHECK(present.certificate().held_slope[1] > 0);
  CHECK(!present.certificate().monotone);
}

TEST_CASE("taps that cancel to less than the doubt of their sum prove nothing") {
  MonotoneModel<WindowedModel> model(1);
  model.input.standard_deviation.fill(1);
  model.slope(0) = 1;
  model.slope(3) = -0.5F;
  model.slope(6) = -0.5F;
  CHECK(!model.certificate().monotone);  // 0, the doubt below it
  model.slope(6) = -0.4999F;
  CHECK(model.certificate().monotone);
}

TEST_CASE("a vehicle whose rotors have no exact mix has no proof") {
  auto airframe = PaperQuadrotor::value<double>();
  CHECK(detail::exact_mix(detail::signed_mix(airframe)));
  CHECK(detail::exact_mix(detail::signed_mix(airframe_in<float>(airframe))));
  airframe.rotors[0].x_m = 0;  // its sign about pitch is 0
  const auto mix = detail::signed_mix(airframe);
  MonotoneModel<BaseAlone> model(1);
  const auto of = [&](const Airframe<double>& vehicle) { return model.certificate(airframe_in<float>(vehicle)); };
  CHECK(of(airframe).monotone == detail::exact_mix(mix));
  for (auto& rotor : airframe.rotors) rotor.spin = airframe.rotors[0].spin;  // no sign of yaw is another one
  CHECK(!of(airframe).monotone);
  double y[4] = {1, 2, 3, 4}, u[4];
  AxisCommandOutputs::commands(static_cast<const double*>(nullptr), static_cast<const double*>(y),
                               AxisCommandOutputs::prepare(airframe), static_cast<double*>(u));
  for (const double command : u) CHECK(std::isnan(command));  // and its commands reach no motor
}

TEST_CASE("a slope is proven above its floor, a share of the airframe's own, not above 0") {
  const auto airframe = airframe_in<float>(PaperQuadrotor::value<double>());
  const AxisSlopes own = hover_slopes(PaperQuadrotor::value<double>());  // of straight curves: the same at full command
  for (int axis = 0; axis < 3; ++axis) {
    const auto with_slope = [&](double slope) {
      MonotoneModel<WithResidual> model(1);
      const auto place = std::size_t(PhysicsFeatures::angular_acceleration + axis);
      constexpr auto others = MonotoneModel<WithResidual>::Base::weights;
      std::fill(model.parameters.begin() + others, model.parameters.end(), 0.0F);  // rounding hides nothing
      model.input.standard_deviation[place] = 1;
      model.output.standard_deviation[std::size_t(1 + axis)] = 1;
      model.slope(axis) = static_cast<float>(slope);
      return model.certificate(airframe);
    };
    CHECK(!with_slope(double(std::numeric_limits<float>::denorm_min())).monotone);
    CHECK(!with_slope(1e-9).monotone);
    CHECK(!with_slope(0.99 * least_slope_share * own[std::size_t(axis)]).monotone);
    CHECK(with_slope(1.01 * least_slope_share * own[std::size_t(axis)]).monotone);
  }
}

TEST_CASE("a slope that rounding hides over the whole envelope is not proven") {
  MonotoneModel<BaseAlone> model(1);
  REQUIRE(model.certificate().monotone);
  model.parameters[MonotoneModel<BaseAlone>::Base::weights + 5] = 3e9F;
  const Certificate certificate = model.certificate();
  CHECK(certificate.slope[0] > 0);
  CHECK(certificate.rounding > 1);
  CHECK(!certificate.monotone);
  // the proof: the envelope crossed, and no command is another one
  const InverseDynamics<MonotoneModel<BaseAlone>> inverse(model);
  auto x = model.input.mean;
  x[8] = model.envelope_upper[8];
  auto more = x;
  x[3] = model.envelope_lower[3];
  more[3] = model.envelope_upper[3];
  float u[4], u_of_more[4];
  inverse.evaluate(x.data(), u);
  inverse.evaluate(more.data(), u_of_more);
  for (int i = 0; i < 4; ++i) CHECK(u[i] == u_of_more[i]);
}

TEST_CASE(
    "of a window with taps of both signs rounding turns the order of small steps, and none from the sure one on") {
  MonotoneModel<WindowedModel> model(11);
  for (int axis = 0; axis < 3; ++axis) {
    model.slope(3 + axis) *= -0.4F;
    model.slope(6 + axis) *= -0.3F;
    for (int tap = 0; tap < 3; ++tap) {
      model.input.standard_deviation[std::size_t(angular_acceleration_at<PhysicsWindow>(tap) + axis)] = 2;
    }
    model.slope(axis) = 0.7F;
  }
  const Certificate certificate = model.certificate();
  REQUIRE(certificate.proven());
  const InverseDynamics<MonotoneModel<WindowedModel>> inverse(model);
  std::mt19937_64 engine(12);
  const auto turned = [&](double share_of_sure) {
    int fell = 0;
    for (int sample = 0; sample < 9000; ++sample) {
      const int axis = sample % 3;
      const auto x = inside(model, engine);
      auto more = x;
      for (int tap = 0; tap < 3; ++tap) {
        more[std::size_t(angular_acceleration_at<PhysicsWindow>(tap) + axis)] +=
            static_cast<float>(share_of_sure * certificate.sure_step[axis]);
      }
      float u[4], u_of_more[4];
      inverse.evaluate(x.data(), u);
      inverse.evaluate(more.data(), u_of_more);
      fell += sum_of(u_of_more, std::size_t(axis)) < sum_of(u, std::size_t(axis)) ? 1 : 0;
    }
    return fell;
  };
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(certificate.sure_step[axis] > 0);
    CHECK(certificate.sure_step[axis] < 0.1);
  }
  CHECK(turned(1) == 0);
  CHECK(turned(0.003) + turned(0.0003) + turned(0.00003) > 0);  // which of them, the kernel decides
}
