// SPDX-License-Identifier: MIT
// Back-propagation through whole networks against central differences, in double.
#include "pinnquad/training/network_gradient.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "support/central_difference.hpp"
#include "support/own_layers.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;
using pinnquad::detail::NetworkGradient;
using pinnquad::test::central_differences;
using pinnquad::test::ChannelScale;
using pinnquad::test::fill_uniform;
using pinnquad::test::gradient_error;
using pinnquad::test::gradient_tolerance;
using pinnquad::test::kink_margin;
using pinnquad::test::PackReciprocal;
using pinnquad::test::Reciprocal;
using pinnquad::test::ScalarSquare;
using pinnquad::test::Softmax;
using pinnquad::test::Square;
using pinnquad::test::UnitLength;

namespace {

/// No input of 1 / v may be nearer to 0: a step of 1e-5 errs by its share squared there, 1e-8 of the slope.
constexpr double pole_margin = 0.1;

/// How near this pass comes to a kink or a pole: the smallest input of any ReLU, and of any reciprocal by its own
/// measure. Walks the layers with the network's own types.
template <class Net, int Index = 0>
double smallest_kink_input(const double* parameters, const double* x) {
  if constexpr (Index == Net::layer_count) {
    return std::numeric_limits<double>::infinity();
  } else {
    using Layer = typename Net::template Layer<Index>;
    double smallest = std::numeric_limits<double>::infinity();
    if constexpr (std::is_same_v<Layer, Relu::Bind<double, Layer::inputs>> ||
                  std::is_same_v<Layer, test::LeakyRelu::Bind<double, Layer::inputs>> ||
                  std::is_same_v<Layer, pinnquad::LeakyRelu::Bind<double, Layer::inputs>>) {
      for (int i = 0; i < Layer::inputs; ++i) {
        // an input that is exactly 0 comes from a ReLU before, and stays 0 within the step
        if (x[i] != 0.0) smallest = std::min(smallest, std::fabs(x[i]));
      }
    }
    if constexpr (std::is_same_v<Layer, Reciprocal::Bind<double, Layer::inputs>> ||
                  std::is_same_v<Layer, PackReciprocal::Bind<double, Layer::inputs>>) {
      for (int i = 0; i < Layer::inputs; ++i) {
        smallest = std::min(smallest, std::fabs(x[i]) / pole_margin * kink_margin);
      }
    }
    double y[Layer::outputs] = {};
    Layer::forward(parameters + Net::Sizes::offset(Index), x, y);
    return std::min(smallest, smallest_kink_input<Net, Index + 1>(parameters, y));
  }
}

template <class Net, class Pack>
void check_network() {
  constexpr int capacity = 9;
  auto gradient = std::make_unique<NetworkGradient<Net, capacity, Pack>>();
  std::mt19937_64 engine(91);
  for (const int samples : {9, 1, 4, 2, 5, 3, 8}) {  // larger before smaller: leftovers would show
    CAPTURE(samples);
    auto net = std::make_unique<Net>();
    fill_uniform(net->parameters, engine);
    std::vector<std::array<double, Net::inputs>> x(static_cast<std::size_t>(samples));
    std::vector<std::array<double, Net::outputs>> c(x.size());
    for (auto& sample : x) {
      do {
        fill_uniform(sample, engine);
      } while (smallest_kink_input<Net>(net->parameters.data(), sample.data()) < kink_margin);
    }
    for (auto& sample : c) fill_uniform(sample, engine);

    gradient->load(net->parameters);
    const auto put = [&] {
      gradient->put(x[0].data(), samples);
      gradient->forward(samples);
    };
    put();
    for (int i = 0; i < samples; ++i) {
      std::array<double, Net::outputs> y{};
      net->forward(x[static_cast<std::size_t>(i)].data(), y.data());
      for (int k = 0; k < Net::outputs; ++k) {
        CHECK(gradient->output(k, i) == doctest::Approx(y[static_cast<std::size_t>(k)]).epsilon(1e-12));
        gradient->output_delta(k, i) = c[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
      }
    }
    gradient->backward(samples);
    typename Net::Parameters analytic{};
    gradient->store_gradient(analytic);
    const auto loss = [&] {
      double sum = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        std::array<double, Net::outputs> y{};
        net->forward(x[i].data(), y.data());
        for (std::size_t k = 0; k < y.size(); ++k) sum += c[i][k] * y[k];
      }
      return sum;
    };
    const auto numerical = central_differences(loss, net->parameters.data(), net->parameters.size());
    CHECK(gradient_error(analytic.data(), numerical.data(), numerical.size()) <= gradient_tolerance);
  }
}

}  // namespace

TEST_CASE_TEMPLATE(
    "gradient of networks: layers in every order, a user's between the library's", Net,
    Network<double, InputSize<3>, Dense<2>>, Network<double, InputSize<5>, Dense<6>, Tanh, Dense<9>, Relu, Dense<2>>,
    Network<double, InputSize<5>, Dense<6>, pinnquad::LeakyRelu, Dense<9>, pinnquad::Elu, Dense<2>>,
    Network<double, InputSize<5>, DenseWithoutBias<6>, Tanh, DenseWithoutBias<9>, Dense<2>>,
    Network<double, InputSize<4>, Tanh, Dense<5>, Dense<3>, Tanh>,
    Network<double, InputSize<5>, Dense<6>, test::LeakyRelu, Dense<7>, test::LeakyRelu, Dense<4>>,
    Network<double, InputSize<5>, ChannelScale, Dense<6>, ChannelScale, Dense<3>, ChannelScale>,
    Network<double, InputSize<5>, Dense<7>, ChannelScale, Tanh, Dense<3>>,
    Network<double, InputSize<5>, Softmax, Dense<4>, Softmax, Dense<2>>,
    // a rule that needs the output keeps it, whatever follows
    Network<double, InputSize<5>, Dense<6>, Softmax, Tanh, Dense<3>>,
    Network<double, InputSize<5>, Tanh, Tanh, Dense<3>>, Network<double, InputSize<5>, Dense<6>, Tanh, Tanh, Tanh>,
    // a slope that is asked with the input finds it, whatever stands before and behind
    Network<double, InputSize<5>, Dense<6>, Gelu, Dense<9>, Silu, Dense<2>>,
    Network<double, InputSize<5>, Dense<6>, Sine, Sine, Softplus, Dense<2>, Gelu>,
    Network<double, InputSize<5>, pinnquad::Elu, Dense<6>, pinnquad::Elu, Gelu, Dense<3>>,
    Network<double, InputSize<5>, Dense<6>, Tanh, Square, Softmax, ScalarSquare, Dense<3>>,
    // no value at 0: a padding row would spread NaN to every weight
    Network<double, InputSize<5>, UnitLength, Dense<4>, UnitLength, Dense<2>>,
    Network<double, InputSize<3>, Reciprocal, ChannelScale, UnitLength, Dense<2>>,
    Network<double, InputSize<3>, PackReciprocal, UnitLength, DenseWithoutBias<3>, UnitLength, Dense<2>>) {
  check_network<Net, GenericPack<double, 4>>();
}

TEST_CASE_TEMPLATE("gradient of networks in packs of 3", Net,
                   Network<double, InputSize<5>, Dense<6>, Relu, Dense<7>, Relu, Dense<4>>,
                   Network<double, InputSize<5>, Gelu, Tanh, Sine, Dense<3>>) {
  check_network<Net, GenericPack<double, 3>>();
}

namespace {

/// One batch forward and back: the gradient of a weighted sum of all outputs.
template <class Net, class Pack>
std::vector<double> gradient_of(const std::vector<double>& parameters, const std::vector<double>& x, int samples) {
  using Scalar = typename Net::Scalar;
  auto gradient = std::make_unique<NetworkGradient<Net, 13, Pack>>();
  typename Net::Parameters loaded{}, result{};
  for (std::size_t i = 0; i < loaded.size(); ++i) loaded[i] = static_cast<Scalar>(parameters[i]);
  gradient->load(loaded);
  std::vector<Scalar> inputs(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) inputs[i] = static_cast<Scalar>(x[i]);
  gradient->put(inputs.data(), samples);
  gradient->forward(samples);
  for (int s = 0; s < samples; ++s) {
    for (int k = 0; k < Net::outputs; ++k) gradient->output_delta(k, s) = Scalar(0.25) * Scalar(s - 2 * k + 1);
  }
  gradient->backward(samples);
  gradient->store_gradient(result);
  return {result.begin(), result.end()};
}

}  // namespace

TEST_CASE_TEMPLATE("in float on the vector unit as in double by plain loops", Net,
                   Network<float, InputSize<5>, Dense<6>, Relu, Dense<17>, Relu, Dense<4>>,
                   Network<float, InputSize<5>, Dense<9>, Gelu, DenseWithoutBias<7>, Tanh, Dense<3>, Softplus>,
                   Network<float, InputSize<5>, Dense<9>, pinnquad::Elu, Dense<7>, pinnquad::LeakyRelu, Dense<3>>,
                   Network<float, InputSize<3>, Dense<16>, Square, Dense<2>, test::LeakyRelu>) {
  std::mt19937_64 engine(93);
  constexpr double float_tolerance = 3.7e-7;  // of the largest: sums of at most 17 products, three layers deep
  for (const int samples : {1, 4, 7, 13}) {
    CAPTURE(samples);
    std::vector<double> parameters(static_cast<std::size_t>(Net::parameter_count)),
        x(static_cast<std::size_t>(samples * Net::inputs));
    fill_uniform(parameters, engine);
    fill_uniform(x, engine);
    for (double& v : parameters) v = static_cast<double>(static_cast<float>(v));
    for (double& v : x) v = static_cast<double>(static_cast<float>(v));
    const auto single = gradient_of<Net, pinnquad::NativePack<float>>(parameters, x, samples);
    const auto expected =
        gradient_of<typename Net::template Rebind<double>, GenericPack<double, 3>>(parameters, x, samples);
    CHECK(gradient_error(single.data(), expected.data(), expected.size()) <= float_tolerance);
  }
}
