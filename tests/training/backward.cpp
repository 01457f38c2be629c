// SPDX-License-Identifier: MIT
// Every layer's backward rule, alone and in its mini-batch form, against central differences in double.
#include "pinnquad/training/backward.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/glu.hpp"
#include "pinnquad/nn/layer_norm.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "pinnquad/training/batch_norm.hpp"
#include "support/central_difference.hpp"
#include "support/own_layers.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;
using pinnquad::detail::BatchLayer;
using pinnquad::test::central_differences;
using pinnquad::test::ChannelScale;
using pinnquad::test::difference_step;
using pinnquad::test::fill_uniform;
using pinnquad::test::gradient_error;
using pinnquad::test::gradient_tolerance;
using pinnquad::test::off_zero;
using pinnquad::test::Softmax;

namespace {

constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Layer inputs keep this from 0: a thousand steps.
constexpr double input_margin = 1e-2;
static_assert(input_margin > difference_step);

template <class Spec, int In>
using Bound = typename Spec::template Bind<double, In>;

/// L = sum_k c_k y_k: its gradient by y is c.
template <class Layer>
double weighted_output(const std::vector<double>& parameters, const double* x, const double* c) {
  double y[Layer::outputs] = {};
  Layer::forward(parameters.data(), x, y);
  double sum = 0.0;
  for (int k = 0; k < Layer::outputs; ++k) sum += c[k] * y[k];
  return sum;
}

template <class Layer>
void check_rule() {
  std::mt19937_64 engine(81);
  for (int round = 0; round < 10; ++round) {
    std::vector<double> parameters(index(Layer::parameter_count)), c(index(Layer::outputs));
    fill_uniform(parameters, engine);
    fill_uniform(c, engine);
    auto x = off_zero(index(Layer::inputs), engine, input_margin);
    const auto loss = [&] { return weighted_output<Layer>(parameters, x.data(), c.data()); };
    std::vector<double> dx(x.size()), gradient(parameters.size(), 0.5);  // the rule adds to the gradient
    std::vector<double> y(c.size());
    Layer::forward(parameters.data(), x.data(), y.data());
    if constexpr (is_elementwise<Layer>) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        dx[i] = pinnquad::detail::scaled_by_slope<Layer>(pinnquad::slopes_from_input<Layer> ? x[i] : y[i], c[i]);
      }
    } else {
      for (double& v : dx) v = 99.0;  // the rule sets dx
      BackwardRule<Layer>::backward(parameters.data(), x.data(), y.data(), c.data(), dx.data(), gradient.data());
    }
    for (double& g : gradient) g -= 0.5;
    CHECK(gradient_error(dx.data(), central_differences(loss, x.data(), x.size()).data(), x.size()) <=
          gradient_tolerance);
    CHECK(gradient_error(gradient.data(), central_differences(loss, parameters.data(), parameters.size()).data(),
                         parameters.size()) <= gradient_tolerance);
  }
}

/// The mini-batch form sums over samples; what it is given past them must not count.
template <class Layer, class Pack>
void check_batch() {
  using Form = BatchLayer<Layer, Pack, 13>;
  constexpr int stride = pinnquad::detail::batch_capacity<Pack, 13>;
  constexpr double canary = 1e30;
  std::mt19937_64 engine(82);
  for (const int samples : {1, 2, 3, 4, 5, 8, 13}) {
    CAPTURE(samples);
    auto layer = std::make_unique<Form>();
    std::vector<double> parameters(index(Layer::parameter_count)), stored(parameters.size());
    fill_uniform(parameters, engine);
    layer->load(parameters.data());
    layer->store(stored.data());
    CHECK(stored == parameters);

    std::vector<double> x(index(Layer::inputs * stride), canary), y(index(Layer::outputs * stride), canary),
        delta = y, previous = x;
    for (int sample = 0; sample < samples; ++sample) {
      const auto values = off_zero(index(Layer::inputs), engine, input_margin);
      for (int i = 0; i < Layer::inputs; ++i) x[index(i * stride + sample)] = values[index(i)];
      for (int k = 0; k < Layer::outputs; ++k) delta[index(k * stride + sample)] = pinnquad::uniform(engine, -1, 1);
    }
    const auto c = delta;
    const auto inputs = x;
    if constexpr (Form::in_place) {
      y = x;
      layer->forward(y.data(), y.data(), samples);
      layer->backward(y.data(), y.data(), delta.data(), delta.data(), samples);
    } else if constexpr (Form::fuses_slope) {
      layer->forward(x.data(), y.data(), samples, pinnquad::detail::Activate<void>{});
      layer->backward(x.data(), delta.data(), previous.data(), samples, pinnquad::detail::ScaleBySlope<void>{});
    } else {
      layer->forward(x.data(), y.data(), samples);
      layer->backward(x.data(), y.data(), delta.data(), previous.data(), samples);
    }
    const std::vector<double>& dx = Form::in_place ? delta : previous;
    const auto sample_of = [](const std::vector<double>& values, int features, int sample) {
      std::vector<double> column(index(features));
      for (int i = 0; i < features; ++i) column[index(i)] = values[index(i * stride + sample)];
      return column;
    };
    const auto loss = [&] {
      double sum = 0.0;
      for (int s = 0; s < samples; ++s) {
        sum += weighted_output<Layer>(parameters, sample_of(x, Layer::inputs, s).data(),
                                      sample_of(c, Layer::outputs, s).data());
      }
      return sum;
    };
    for (int sample = 0; sample < samples; ++sample) {
      std::vector<double> expected(index(Layer::outputs));
      Layer::forward(parameters.data(), sample_of(x, Layer::inputs, sample).data(), expected.data());
      for (int k = 0; k < Layer::outputs; ++k) {
        CHECK(y[index(k * stride + sample)] == doctest::Approx(expected[index(k)]).epsilon(1e-13));
      }
    }
    for (int i = 0; i < Layer::inputs; ++i) {
      double* const row = x.data() + i * stride;
      const auto numerical = central_differences(loss, row, index(samples));
      CHECK(gradient_error(dx.data() + i * stride, numerical.data(), numerical.size()) <= gradient_tolerance);
    }
    std::vector<double> gradient(parameters.size());
    layer->store_gradient(gradient.data());
    CHECK(gradient_error(gradient.data(), central_differences(loss, parameters.data(), parameters.size()).data(),
                         parameters.size()) <= gradient_tolerance);
    CHECK(x == inputs);
  }
}

}  // namespace

TEST_CASE_TEMPLATE("backward rule of every layer", Layer, Bound<Dense<1>, 1>, Bound<Dense<5>, 3>, Bound<Dense<11>, 9>,
                   Bound<DenseWithoutBias<1>, 1>, Bound<DenseWithoutBias<5>, 3>, Bound<DenseWithoutBias<11>, 9>,
                   Bound<Relu, 7>, Bound<Tanh, 6>, Bound<pinnquad::Gelu, 5>, Bound<pinnquad::Silu, 6>,
                   Bound<pinnquad::Softplus, 7>, Bound<pinnquad::Sine, 4>, Bound<pinnquad::test::ScalarSquare, 3>,
                   Bound<pinnquad::Elu, 6>, Bound<pinnquad::LeakyRelu, 7>, Bound<test::LeakyRelu, 5>,
                   Bound<ChannelScale, 6>, Bound<Softmax, 5>, Bound<pinnquad::LayerNorm<6>, 6>,
                   Bound<pinnquad::LayerNorm<4>, 6>, Bound<pinnquad::RmsNorm<5>, 5>, Bound<pinnquad::RmsNorm<3>, 4>,
                   Bound<pinnquad::Glu<3>, 6>, Bound<pinnquad::Glu<2>, 7>) {
  if constexpr (is_elementwise<Layer> || pinnquad::is_detected<pinnquad::detail::BackwardOf, Layer>) {
    SUBCASE("alone") { check_rule<Layer>(); }
  }
  SUBCASE("mini-batch, packs of 4") { check_batch<Layer, GenericPack<double, 4>>(); }
  SUBCASE("mini-batch, packs of 3") { check_batch<Layer, GenericPack<double, 3>>(); }
}

TEST_CASE("the slope at the kink of ReLU is 0, on both forms") {
  using Layer = Bound<Relu, 4>;
  using Pack = GenericPack<double, 4>;
  CHECK(Layer::slope(0.0) == 0.0);
  const double y[4] = {0.0, 1.0, -0.0, 1e-300}, dy[4] = {2.0, 3.0, 4.0, 5.0};
  double dx[4] = {};
  Layer::scaled(Pack::load(y), Pack::load(dy)).store(dx);
  for (int i = 0; i < 4; ++i) CHECK(dx[i] == dy[i] * Layer::slope(y[i]));
}
