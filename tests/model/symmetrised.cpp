// SPDX-License-Identifier: MIT
// A symmetrised answer of any weights: the commands to a mirrored motion are the mirrored commands; its Jacobian against
// differences; and which features a mirror turns, against features of mirrored samples.
#include "pinnquad/model/symmetrised.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/data/mirrored_flight.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/training/symmetric_answer.hpp"
#include "pinnquad/training/symmetric_context.hpp"
#include "pinnquad/training/training_data.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

Sample any_sample(std::mt19937_64& engine) {
  SampleValues values{};
  for (double& v : values) v = uniform(engine, -1, 1);
  return to_sample(values);
}

template <class Features>
std::array<double, std::size_t(Features::size)> features_of(const Sample& sample) {
  std::array<double, std::size_t(Features::size)> x{};
  Features::extract(SampleInputs<MotionInputs<double>>::from(sample), x.data());
  return x;
}

template <class Activation>
using Inner = Network<double, InputSize<PhysicsFeatures::size>, Dense<7>, Activation, Dense<4>>;

}  // namespace

TEST_CASE_TEMPLATE("features that a mirror turns are those of mirrored samples with the sign changed", Features,
                   PhysicsFeatures, PaperFeatures, AccelerationFeatures) {
  std::mt19937_64 engine(1);
  const RotorMirror mirror = mirror_of(PaperQuadrotor::value<double>());
  for (int i = 0; i < 20; ++i) {
    const Sample sample = any_sample(engine);
    const auto x = features_of<Features>(sample), image = features_of<Features>(mirrored(sample, mirror));
    for (int k = 0; k < Features::size; ++k) {
      const auto at = std::size_t(k);
      CHECK(image[at] == doctest::Approx(is_odd<Features>(k) ? -x[at] : x[at]).epsilon(1e-12));
    }
  }
}

TEST_CASE_TEMPLATE("commands to a mirrored motion are the mirrored commands, whatever the weights", Activation, Relu,
                   Tanh) {
  using Answer = SymmetricPredictor<PhysicsFeatures, Inner<Activation>>;
  std::mt19937_64 engine(2);
  const auto airframe = PaperQuadrotor::value<double>();
  const RotorMirror mirror = mirror_of(airframe);
  const auto mix = AxisCommandOutputs::prepare(airframe);
  Context<PhysicsFeatures, PaperQuadrotor, AxisCommandOutputs> given;
  for (double& v : given.input.mean) v = uniform(engine, -1, 1);
  for (double& v : given.input.standard_deviation) v = uniform(engine, 0.5, 2);
  for (double& v : given.output.mean) v = uniform(engine, -1, 1);
  for (double& v : given.output.standard_deviation) v = uniform(engine, 0.5, 2);
  const auto context = context_of_mirror_images(given);
  double asymmetry_of_inner = 0;
  for (int i = 0; i < 50; ++i) {
    Answer answer;
    fill_uniform(answer.parameters, engine, 0.7);
    Inner<Activation> inner;
    inner.parameters = answer.parameters;
    const Sample sample = any_sample(engine);
    const auto commands_of = [&](const Sample& asked, const auto& model, double* u) {
      auto x = features_of<PhysicsFeatures>(asked);
      context.input.standardise(x.data(), x.data());
      double y[4];
      model.forward(x.data(), y);
      for (std::size_t k = 0; k < 4; ++k) y[k] = y[k] * context.output.standard_deviation[k] + context.output.mean[k];
      AxisCommandOutputs::commands(static_cast<const double*>(nullptr), static_cast<const double*>(y), mix, u);
    };
    double u[4], image[4];
    commands_of(sample, answer, u);
    commands_of(mirrored(sample, mirror), answer, image);
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      CHECK(image[rotor] == doctest::Approx(u[mirror.partner[rotor]]).epsilon(1e-12).scale(1));
    }
    commands_of(sample, inner, u);
    commands_of(mirrored(sample, mirror), inner, image);
    asymmetry_of_inner = std::max(asymmetry_of_inner, std::abs(image[0] - u[mirror.partner[0]]));
  }
  CHECK(asymmetry_of_inner > 0.05);  // it was not symmetric by itself
}

TEST_CASE("the Jacobian of a symmetrised answer is what differences give") {
  using Answer = SymmetricPredictor<PhysicsFeatures, Inner<Tanh>>;
  constexpr int size = PhysicsFeatures::size;
  std::mt19937_64 engine(3);
  Answer answer;
  fill_uniform(answer.parameters, engine, 0.7);
  double x[size], y[4], by_x[4 * size];
  for (double& v : x) v = uniform(engine, -1, 1);
  Answer::jacobian(answer.parameters.data(), x, y, by_x);
  for (int i = 0; i < size; ++i) {
    constexpr double step = 1e-6;
    double more[size], less[size], y_more[4], y_less[4];
    std::copy_n(x, size, more);
    std::copy_n(x, size, less);
    more[i] += step;
    less[i] -= step;
    answer.forward(more, y_more);
    answer.forward(less, y_less);
    for (int k = 0; k < 4; ++k) {
      CHECK(by_x[k * size + i] == doctest::Approx((y_more[k] - y_less[k]) / (2 * step)).epsilon(1e-6).scale(0.01));
    }
  }
}

TEST_CASE("a monotone answer of any weights as its own mirror image, with the slopes that it had") {
  using Residual = Network<double, InputSize<residual_inputs<PhysicsFeatures>>, Dense<7>, Tanh, Dense<4>>;
  constexpr std::size_t size = PhysicsFeatures::size;
  std::mt19937_64 engine(4);
  MonotonePredictor<PhysicsFeatures, Residual> fitted;
  fill_uniform(fitted.parameters, engine, 0.7);
  double* const bounds = fitted.parameters.data() + MonotoneBase<PhysicsFeatures>::parameter_count;
  for (int sum = 0; sum < 4; ++sum) {
    bounds[sum] = -0.05 * (sum + 1);  // some of the answers are clipped
    bounds[4 + sum] = 0.2;
  }
  const auto answer = own_mirror_image<PhysicsFeatures, Residual>(fitted);
  for (int i = 0; i < 20; ++i) {
    std::array<double, size> x{}, image{};
    for (std::size_t k = 0; k < size; ++k) {
      x[k] = uniform(engine, -1, 1);
      image[k] = is_odd<PhysicsFeatures>(int(k)) ? -x[k] : x[k];
    }
    double y[4], of_image[4];
    answer.forward(x.data(), y);
    answer.forward(image.data(), of_image);
    for (int sum = 0; sum < 4; ++sum) {
      CHECK(of_image[sum] == doctest::Approx(sum % 2 == 1 ? -y[sum] : y[sum]).epsilon(1e-12).scale(1));
    }
  }
  for (int axis = 0; axis < 3; ++axis)
    CHECK(answer.parameters[std::size_t(axis)] == fitted.parameters[std::size_t(axis)]);
}
