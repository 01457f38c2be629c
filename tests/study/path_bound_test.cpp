// SPDX-License-Identifier: MIT
// The path bound of a network, against its exact derivatives at many inputs, against interval arithmetic with directed
// rounding, and against the least that a network can do where that is known.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pinnquad/nn/activations.hpp"
#include "study/path_bounded_fit.hpp"
#include "support/interval.hpp"
#include "support/random_network.hpp"

using namespace pinnquad;
using namespace pinnquad::test;
using study::path_bound;

namespace {

template <class Activation>
using Three = Network<float, InputSize<6>, Dense<12>, Activation, Dense<9>, Activation, Dense<4>>;
using Two = Network<float, InputSize<6>, Dense<12>, Relu, Dense<4>>;
using One = Network<float, InputSize<6>, Dense<4>>;

/// The bound once more, from the weights alone, each operation rounded outward.
template <class NetworkType>
std::vector<Interval> enclosed(const typename NetworkType::Parameters& parameters, std::vector<int> widths, int input) {
  std::vector<Interval> v;
  std::size_t at = 0;
  int in = NetworkType::inputs;
  for (const int width : widths) {
    std::vector<Interval> next;
    for (int row = 0; row < width; ++row) {
      Interval sum(0);
      if (at == 0) {
        sum = Interval(double(parameters[std::size_t(row * in + input)]));
      } else {
        for (int i = 0; i < in; ++i) {
          sum = sum + Interval(double(parameters[at + std::size_t(row * in + i)])) * v[std::size_t(i)];
        }
      }
      next.push_back(sum * Interval(0, 1));
    }
    at += std::size_t((in + 1) * width);
    in = width;
    v = next;
  }
  return v;
}

}  // namespace

TEST_CASE_TEMPLATE("no derivative of the network leaves its path bound, whatever it is asked", NetworkType, Three<Relu>,
                   Three<Tanh>, Three<Softplus>, Three<Elu>, Three<LeakyRelu>, Two, One) {
  std::mt19937_64 engine(1);
  double nearest = 1;
  for (int sample = 0; sample < 30; ++sample) {
    NetworkType network;
    fill_uniform(network.parameters, engine, 1);
    for (int input = 0; input < NetworkType::inputs; ++input) {
      const auto bound = path_bound<NetworkType>(network.parameters, input);
      for (int trial = 0; trial < 200; ++trial) {
        float x[NetworkType::inputs], y[4], by_x[4 * NetworkType::inputs];
        for (float& v : x) v = float(uniform(engine, -1, 1) * std::pow(10.0, uniform(engine, -1, 2)));
        predictor_jacobian<NetworkType>(network.parameters.data(), x, y, by_x);
        for (int k = 0; k < 4; ++k) {
          const double slope = double(by_x[k * NetworkType::inputs + input]);
          const double rounding = 1e-5 * (1 + std::abs(slope));
          CHECK(slope >= bound.least[std::size_t(k)] - rounding);
          CHECK(slope <= bound.most[std::size_t(k)] + rounding);
          if (bound.least[std::size_t(k)] < -0.1) nearest = std::min(nearest, 1 - slope / bound.least[std::size_t(k)]);
        }
      }
    }
  }
  CHECK(nearest < 0.7);  // it is no idle bound
}

TEST_CASE_TEMPLATE("the path bound is that of interval arithmetic with directed rounding, to the last digits",
                   NetworkType, Three<Relu>, Two, One) {
  std::mt19937_64 engine(2);
  std::vector<int> widths = {4};
  if (std::is_same_v<NetworkType, Two>) widths = {12, 4};
  if (std::is_same_v<NetworkType, Three<Relu>>) widths = {12, 9, 4};
  for (int sample = 0; sample < 50; ++sample) {
    NetworkType network;
    fill_uniform(network.parameters, engine, 1);
    for (int input = 0; input < NetworkType::inputs; ++input) {
      const auto bound = path_bound<NetworkType>(network.parameters, input);
      const auto expected = enclosed<NetworkType>(network.parameters, widths, input);
      for (std::size_t k = 0; k < 4; ++k) {
        CHECK(bound.least[std::size_t(k)] <= expected[k].lower());
        CHECK(bound.most[std::size_t(k)] >= expected[k].upper());
        CHECK(bound.least[std::size_t(k)] == doctest::Approx(expected[k].lower()).epsilon(1e-13));
        CHECK(bound.most[std::size_t(k)] == doctest::Approx(expected[k].upper()).epsilon(1e-13));
      }
    }
  }
}

TEST_CASE("along a direction: bounds of the first layer's products with directed rounding, of either sign") {
  std::mt19937_64 engine(4);
  for (int sample = 0; sample < 200; ++sample) {
    One network;
    fill_uniform(network.parameters, engine, 1);
    programs::Intervals along;
    for (int i = 0; i < One::inputs; ++i) {
      const double least = uniform(engine, -3, sample % 2 == 0 ? -1 : 1);
      along.least.push_back(least);
      along.most.push_back(least + (sample % 3 == 0 ? 0 : uniform(engine, 0, 0.5)));
    }
    const programs::Intervals bound = programs::path_bound_along(network.parameters.data(), {4}, along);
    for (std::size_t row = 0; row < 4; ++row) {
      Interval sum(0);
      for (std::size_t i = 0; i < One::inputs; ++i) {
        sum =
            sum + Interval(double(network.parameters[row * One::inputs + i])) * Interval(along.least[i], along.most[i]);
      }
      CHECK(bound.least[row] <= std::min(0.0, sum.lower()));
      CHECK(bound.most[row] >= std::max(0.0, sum.upper()));
    }
  }
}

TEST_CASE("the bound is reached where all paths agree: weights above 0, all units on") {
  Three<Relu> network;
  std::mt19937_64 engine(3);
  for (float& v : network.parameters) v = float(uniform(engine, 0.1, 1));
  float x[6], y[4], by_x[24];
  for (float& v : x) v = 1;
  predictor_jacobian<Three<Relu>>(network.parameters.data(), x, y, by_x);
  for (int input = 0; input < 6; ++input) {
    const auto bound = path_bound<Three<Relu>>(network.parameters, input);
    for (int k = 0; k < 4; ++k) {
      CHECK(bound.most[std::size_t(k)] == doctest::Approx(double(by_x[k * 6 + input])).epsilon(1e-5));
      CHECK(bound.least[std::size_t(k)] == 0);
    }
  }
}
