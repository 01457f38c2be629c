// SPDX-License-Identifier: MIT
// Batch norm in training: statistics, gradient through them, running statistics, small batches and padding.
#include "pinnquad/training/batch_norm.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/trainer.hpp"
#include "support/batch_norm_networks.hpp"
#include "support/central_difference.hpp"
#include "support/own_layers.hpp"
#include "support/random_network.hpp"
#include "support/tolerances.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
using pinnquad::detail::NetworkGradient;
using namespace pinnquad::test;

namespace {

using Rows = std::vector<std::vector<double>>;

struct Moments {
  std::vector<double> mean, variance;  // divisor N
};

Moments moments(const Rows& rows) {
  Moments m;
  const double count = static_cast<double>(rows.size());
  for (std::size_t k = 0; k < rows[0].size(); ++k) {
    double sum = 0.0, squares = 0.0;
    for (const auto& row : rows) sum += row[k];
    for (const auto& row : rows) squares += (row[k] - sum / count) * (row[k] - sum / count);
    m.mean.push_back(sum / count);
    m.variance.push_back(squares / count);
  }
  return m;
}

/// A batch through the network with plain loops: batch norm by this batch's statistics (by the running ones for a
/// single sample), all other layers by their own forward pass. Notes what was normalised and how near a ReLU came to
/// its kink.
template <class Net, int Index = 0>
Rows plain_batch(const double* parameters, const Rows& x, double& smallest_kink, std::vector<Moments>& seen) {
  if constexpr (Index == Net::layer_count) {
    return x;
  } else {
    using Layer = typename Net::template Layer<Index>;
    const double* own = parameters + Net::Sizes::offset(Index);
    Rows y(x.size(), std::vector<double>(static_cast<std::size_t>(Layer::outputs)));
    if constexpr (std::is_same_v<Layer, typename BatchNorm::Bind<double, Layer::inputs>>) {
      constexpr auto size = static_cast<std::size_t>(Layer::outputs);
      Moments m = moments(x);
      seen.push_back(m);
      if (x.size() == 1) {
        m.mean.assign(own + 2 * size, own + 3 * size);
        m.variance.assign(own + 3 * size, own + 4 * size);
      }
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t k = 0; k < size; ++k) {
          y[i][k] = own[k] * (x[i][k] - m.mean[k]) / std::sqrt(m.variance[k] + 1e-5) + own[size + k];
        }
      }
    } else {
      for (std::size_t i = 0; i < x.size(); ++i) {
        if constexpr (std::is_same_v<Layer, typename Relu::Bind<double, Layer::inputs>>) {
          for (const double v : x[i]) smallest_kink = std::min(smallest_kink, std::fabs(v));
        }
        Layer::forward(own, x[i].data(), y[i].data());
      }
    }
    return plain_batch<Net, Index + 1>(parameters, y, smallest_kink, seen);
  }
}

template <class Gradient>
void put(Gradient& gradient, const Rows& x) {
  std::vector<typename Gradient::Scalar> values;
  for (const auto& row : x) {
    for (const double v : row) values.push_back(static_cast<typename Gradient::Scalar>(v));
  }
  gradient.put(values.data(), static_cast<int>(x.size()));
}

template <class Net, class Pack>
void check_gradient() {
  constexpr int capacity = 9;
  auto gradient = std::make_unique<NetworkGradient<Net, capacity, Pack>>();
  std::mt19937_64 engine(161);
  for (const int samples : {9, 1, 4, 2, 5, 3, 8}) {  // larger before smaller: leftovers would show
    CAPTURE(samples);
    Net net;
    Rows x(static_cast<std::size_t>(samples), std::vector<double>(Net::inputs));
    Rows c(x.size(), std::vector<double>(Net::outputs));
    double kink = 0.0;
    std::vector<Moments> unused;
    do {
      net = random_batch_norm_network<Net>(engine);
      for (auto& row : x) fill_uniform(row, engine, 2.0);
      kink = std::numeric_limits<double>::infinity();
      plain_batch<Net>(net.parameters.data(), x, kink, unused);
    } while (kink < kink_margin);
    for (auto& row : c) fill_uniform(row, engine);

    gradient->load(net.parameters);
    put(*gradient, x);
    gradient->forward(samples);
    const Rows y = plain_batch<Net>(net.parameters.data(), x, kink, unused);
    for (int i = 0; i < samples; ++i) {
      for (int k = 0; k < Net::outputs; ++k) {
        const auto row = static_cast<std::size_t>(i), column = static_cast<std::size_t>(k);
        gradient->output_delta(k, i) = c[row][column];
        CHECK(gradient->output(k, i) == doctest::Approx(y[row][column]).epsilon(1e-11));
      }
    }
    gradient->backward(samples);
    typename Net::Parameters analytic{};
    gradient->store_gradient(analytic);
    const auto loss = [&] {
      const Rows outputs = plain_batch<Net>(net.parameters.data(), x, kink, unused);
      double sum = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t k = 0; k < outputs[i].size(); ++k) sum += c[i][k] * outputs[i][k];
      }
      return sum;
    };
    auto numerical = central_differences(loss, net.parameters.data(), net.parameters.size());
    if (samples == 1) {  // the running statistics are constants of training, whatever the loss would gain by them
      pinnquad::unroll<Net::layer_count>([&](auto index) {
        using Layer = typename Net::template Layer<decltype(index)::value>;
        if (!std::is_same_v<Layer, typename BatchNorm::Bind<double, Layer::inputs>>) return;
        const auto first = static_cast<std::size_t>(Net::Sizes::offset(index) + 2 * Layer::outputs);
        for (std::size_t i = first; i < first + 2 * static_cast<std::size_t>(Layer::outputs); ++i) numerical[i] = 0.0;
      });
    }
    CHECK(gradient_error(analytic.data(), numerical.data(), numerical.size()) <= gradient_tolerance);
    typename Net::Parameters after{};
    gradient->store(after);
    CHECK(after == net.parameters);  // running statistics wait for follow_statistics()
  }
}

using Small = BatchNormMlp<double, InputSize<16>, Hidden<2, 9>, OutputSize<4>, Relu>;
using PaperContext = pinnquad::Context<pinnquad::PaperFeatures, pinnquad::PaperQuadrotor>;

}  // namespace

TEST_CASE_TEMPLATE("gradient through the batch's statistics against central differences", Net,
                   Network<double, InputSize<5>, BatchNorm>,
                   BatchNormMlp<double, InputSize<5>, Hidden<2, 7>, OutputSize<4>, Relu>,
                   BatchNormMlp<double, InputSize<3>, Hidden<3, 4>, OutputSize<2>, Tanh>,
                   Network<double, InputSize<5>, BatchNorm, Dense<6>, BatchNorm, Tanh, Dense<3>, BatchNorm>,
                   Network<double, InputSize<5>, Tanh, BatchNorm, BatchNorm, Relu, Dense<3>>,
                   Network<double, InputSize<5>, DenseWithoutBias<6>, BatchNorm, pinnquad::test::Softmax, Dense<3>>) {
  check_gradient<Net, GenericPack<double, 4>>();
}

TEST_CASE("gradient through the batch's statistics in packs of 3") {
  check_gradient<Network<double, InputSize<5>, Tanh, BatchNorm, BatchNorm, Relu, Dense<3>>, GenericPack<double, 3>>();
}

TEST_CASE_TEMPLATE("running statistics: 0.9 old + 0.1 of the batch, variance with divisor N - 1", Pack,
                   GenericPack<double, 4>, NativePack<float>) {
  using Scalar = typename Pack::Scalar;
  using Net = Network<Scalar, InputSize<5>, BatchNorm>;
  using Double = Network<double, InputSize<5>, BatchNorm>;
  auto gradient = std::make_unique<NetworkGradient<Net, 9, Pack>>();
  std::mt19937_64 engine(162);
  Double expected = random_batch_norm_network<Double>(engine);
  Net net;
  for (std::size_t i = 0; i < net.parameters.size(); ++i)
    net.parameters[i] = static_cast<Scalar>(expected.parameters[i]);
  gradient->load(net.parameters);
  for (const int samples : {9, 2, 1, 7, 3}) {
    Rows x(static_cast<std::size_t>(samples), std::vector<double>(5));
    for (auto& row : x) fill_uniform(row, engine, 3.0);
    put(*gradient, x);
    gradient->forward(samples);
    gradient->follow_statistics();
    const Moments m = moments(x);
    for (std::size_t k = 0; k < 5 && samples > 1; ++k) {  // a single sample leaves them alone
      double& mean = expected.parameters[10 + k];
      double& variance = expected.parameters[15 + k];
      mean = 0.9 * mean + 0.1 * m.mean[k];
      variance = 0.9 * variance + 0.1 * m.variance[k] * samples / (samples - 1);
    }
    gradient->store(net.parameters);
    for (std::size_t i = 0; i < 20; ++i) {
      CHECK(std::fabs(static_cast<double>(net.parameters[i]) - expected.parameters[i]) <= rounding<Scalar>(100));
    }
  }
}

TEST_CASE("what a larger batch left behind does not reach a smaller one, not even NaN") {
  using Net = BatchNormMlp<double, InputSize<3>, Hidden<2, 5>, OutputSize<2>, Relu>;
  std::mt19937_64 engine(164);
  const auto net = random_batch_norm_network<Net>(engine);
  auto gradient = std::make_unique<NetworkGradient<Net, 8, GenericPack<double, 4>>>();
  const auto run = [&](int samples) {
    gradient->load(net.parameters);
    gradient->forward(samples);
    for (int i = 0; i < samples; ++i) {
      for (int k = 0; k < 2; ++k) gradient->output_delta(k, i) = 1.0 + i;
    }
    gradient->backward(samples);
    gradient->follow_statistics();
    Net::Parameters result{}, state{};
    gradient->store_gradient(result);
    gradient->store(state);
    return std::make_pair(result, state);
  };
  const Rows x = {{0.5, -1.0, 0.25}, {-0.5, 1.5, 1.0}, {0.1, 0.2, -2.0}};
  put(*gradient, x);
  const auto clean = run(3);
  put(*gradient, Rows(8, std::vector<double>(3, std::numeric_limits<double>::quiet_NaN())));
  run(8);
  put(*gradient, x);
  CHECK(run(3) == clean);
}

TEST_CASE("the trainer: differentiate() changes nothing, a step moves weights, gamma, beta and running statistics") {
  using Type = pinnquad::Trainer<Small, Mse, Adam, PaperContext>;
  const auto data = pinnquad::test::known_map<double>(64, 165);
  std::mt19937_64 engine(166);
  const auto net = pinnquad::initialised<Small>(engine);
  auto trainer = std::make_unique<Type>(net, Mse{}, Adam{1e-3, 0.9, 0.999, 1e-8, 0.0}, PaperContext{});
  std::vector<int> rows(64);
  for (int i = 0; i < 64; ++i) rows[static_cast<std::size_t>(i)] = i;
  trainer->differentiate(data, rows.data(), 64);
  CHECK(trainer->network().parameters == net.parameters);
  const auto gradient = trainer->parameter_gradient();
  trainer->batch(data, rows.data(), 64);
  const auto after = trainer->network().parameters;
  const auto first =
      static_cast<std::size_t>(Small::Sizes::offset(1));  // the first BatchNorm: gamma, beta, mean, variance
  for (std::size_t i = 0; i < 18; ++i) {
    // Adam's first step is the learning rate, against the gradient's sign
    CHECK(after[first + i] - net.parameters[first + i] ==
          doctest::Approx(gradient[first + i] > 0 ? -1e-3 : 1e-3).epsilon(1e-3));
  }
  for (std::size_t i = 18; i < 36; ++i) {
    CHECK(gradient[first + i] == 0.0);
    CHECK(after[first + i] != net.parameters[first + i]);
  }
  // a single row moves gamma and beta, not the statistics
  trainer->batch(data, rows.data(), 1);
  const auto last = trainer->network().parameters;
  for (std::size_t i = 18; i < 36; ++i) CHECK(last[first + i] == after[first + i]);
  CHECK(last[first + 9] != after[first + 9]);
}

TEST_CASE("training lowers the loss, and the running statistics come to serve: validation agrees with the network") {
  using Type = pinnquad::Trainer<Small::Rebind<float>, Mse, Adam, PaperContext>;
  const auto data = pinnquad::test::known_map<float>(640 + 1, 167);  // the last batch is a single row
  const auto unseen = pinnquad::test::known_map<float>(101, 168);
  std::mt19937_64 engine(169);
  PaperContext context;
  context.output.standard_deviation = {0.5, 2.0, 3.0, 0.25};
  const auto net = pinnquad::initialised<Small::Rebind<float>>(engine);
  auto trainer = std::make_unique<Type>(net, Mse{}, Adam{}, context);
  const double before = trainer->validate(unseen).mean_squared;
  for (int epoch = 0; epoch < 40; ++epoch) trainer->epoch(data, {epoch, 40}, engine);
  const auto errors = trainer->validate(unseen);
  CHECK(errors.mean_squared < 0.4 * before);
  const auto trained = trainer->network();
  double squared = 0.0, absolute = 0.0;
  for (int row = 0; row < unseen.size(); ++row) {
    float y[4] = {};
    trained.forward(unseen.features_of(row), y);
    for (int k = 0; k < 4; ++k) {
      const double difference = static_cast<double>(y[k]) - static_cast<double>(unseen.outputs_of(row)[k]);
      squared += difference * difference;
      absolute += std::fabs(difference) * context.output.standard_deviation[static_cast<std::size_t>(k)];
    }
  }
  CHECK(errors.mean_squared == doctest::Approx(squared / (4 * 101)).epsilon(1e-5));
  CHECK(errors.mean_absolute == doctest::Approx(absolute / (4 * 101)).epsilon(1e-5));
  CHECK(trainer->network().parameters == trained.parameters);
  CHECK(std::isnan(trainer->validate({}).mean_squared));  // no row, no error: 0 would be the best of all
  CHECK(std::isnan(trainer->validate({}).mean_absolute));
}
