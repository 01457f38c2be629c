// SPDX-License-Identifier: MIT
// The path bound of a network that is shown the angular acceleration, against its exact derivatives at many inputs,
// against interval arithmetic with directed rounding, and against the least that a network can do where that is known.
#include "pinnquad/model/path_bound.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/interval.hpp"
#include "support/monotone_shapes.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

template <class Activation>
using Three = Network<float, InputSize<6>, Dense<12>, Activation, Dense<9>, Activation, Dense<4>>;
using Two = Network<float, InputSize<6>, Dense<12>, Relu, Dense<4>>;
using One = Network<float, InputSize<6>, Dense<4>>;

template <class Features>
using Seeing = Network<float, InputSize<Features::size>, Dense<8>, Relu, Dense<8>, Relu, Dense<4>>;
using PathModel = MonotoneShape<PhysicsFeatures, PathBoundedPredictor<PhysicsFeatures, Seeing<PhysicsFeatures>>>;
using PathWindow = MonotoneShape<PhysicsWindow, PathBoundedPredictor<PhysicsWindow, Seeing<PhysicsWindow>>>;
static_assert(has_certificate<PathModel> && has_certificate<PathWindow>);
/// A network that sees the angular acceleration, and says nothing of a bound.
static_assert(!has_certificate<
              MonotoneShape<PhysicsFeatures, Sum<MonotoneBase<PhysicsFeatures>, Saturated<Seeing<PhysicsFeatures>>>>>);

constexpr std::array<std::array<double, rotor_count>, 3> signs = {allocation_signs(PaperQuadrotor::value<double>(), 0),
                                                                  allocation_signs(PaperQuadrotor::value<double>(), 1),
                                                                  allocation_signs(PaperQuadrotor::value<double>(), 2)};

/// The network's weights shrunk by `factor` in the columns of the angular acceleration.
template <class Shape>
MonotoneModel<Shape> with_columns_scaled(std::uint64_t seed, float factor) {
  MonotoneModel<Shape> model(seed);
  constexpr int inputs = Shape::Features::size;
  const auto own = std::size_t(MonotoneModel<Shape>::Base::parameter_count + 8);
  for (int row = 0; row < 8; ++row) {
    for (int tap = 0; tap < MonotoneModel<Shape>::Base::taps; ++tap) {
      for (int axis = 0; axis < 3; ++axis) {
        model.parameters[own + std::size_t(row * inputs + angular_acceleration_at<typename Shape::Features>(tap) +
                                           axis)] *= factor;
      }
    }
  }
  return model;
}

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
      const auto bound = PathBounded<NetworkType>::bound(network.parameters.data(), input);
      for (int trial = 0; trial < 200; ++trial) {
        float x[NetworkType::inputs], y[4], by_x[4 * NetworkType::inputs];
        for (float& v : x) v = float(uniform(engine, -1, 1) * std::pow(10.0, uniform(engine, -1, 2)));
        predictor_jacobian<PathBounded<NetworkType>>(network.parameters.data(), x, y, by_x);
        for (int k = 0; k < 4; ++k) {
          const double slope = double(by_x[k * NetworkType::inputs + input]);
          const double rounding = 1e-5 * (1 + std::abs(slope));
          CHECK(slope >= bound.lower[k] - rounding);
          CHECK(slope <= bound.upper[k] + rounding);
          if (bound.lower[k] < -0.1) nearest = std::min(nearest, 1 - slope / bound.lower[k]);
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
      const auto bound = PathBounded<NetworkType>::bound(network.parameters.data(), input);
      const auto expected = enclosed<NetworkType>(network.parameters, widths, input);
      for (std::size_t k = 0; k < 4; ++k) {
        CHECK(bound.lower[k] <= expected[k].lower());
        CHECK(bound.upper[k] >= expected[k].upper());
        CHECK(bound.lower[k] == doctest::Approx(expected[k].lower()).epsilon(1e-13));
        CHECK(bound.upper[k] == doctest::Approx(expected[k].upper()).epsilon(1e-13));
      }
    }
  }
}

TEST_CASE("along a direction: bounds of the first layer's products with directed rounding, of either sign") {
  std::mt19937_64 engine(4);
  for (int sample = 0; sample < 200; ++sample) {
    One network;
    fill_uniform(network.parameters, engine, 1);
    double least[One::inputs], most[One::inputs], work[4 * 4], lower[4], upper[4];
    for (int i = 0; i < One::inputs; ++i) {
      least[i] = uniform(engine, -3, sample % 2 == 0 ? -1 : 1);
      most[i] = least[i] + (sample % 3 == 0 ? 0 : uniform(engine, 0, 0.5));
    }
    constexpr int widths[] = {4};
    path_bound_along(network.parameters.data(), One::inputs, static_cast<const int*>(widths), 1,
                     static_cast<const double*>(least), static_cast<const double*>(most), static_cast<double*>(work), 4,
                     static_cast<double*>(lower), static_cast<double*>(upper));
    for (int row = 0; row < 4; ++row) {
      Interval sum(0);
      for (int i = 0; i < One::inputs; ++i) {
        sum = sum +
              Interval(double(network.parameters[std::size_t(row * One::inputs + i)])) * Interval(least[i], most[i]);
      }
      CHECK(lower[row] <= std::min(0.0, sum.lower()));
      CHECK(upper[row] >= std::max(0.0, sum.upper()));
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
    const auto bound = PathBounded<Three<Relu>>::bound(network.parameters.data(), input);
    for (int k = 0; k < 4; ++k) {
      CHECK(bound.upper[k] == doctest::Approx(double(by_x[k * 6 + input])).epsilon(1e-5));
      CHECK(bound.lower[k] == 0);
    }
  }
}

TEST_CASE_TEMPLATE("a certified model rises everywhere by at least its slope, and each rotor goes the right way", Shape,
                   PathModel, PathWindow) {
  std::mt19937_64 engine(4);
  int proven = 0, refused = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const auto model = with_columns_scaled<Shape>(seed, seed % 3 == 0 ? 1.0F : (seed % 3 == 1 ? 0.003F : 0.01F));
    const Certificate certificate = model.certificate();
    CHECK(certificate.bounded);
    if (!certificate.proven()) {
      ++refused;
      continue;
    }
    ++proven;
    constexpr int size = Shape::Features::size;
    for (int sample = 0; sample < 100; ++sample) {
      float x[size], y[4], by_x[4 * size];
      for (int i = 0; i < size; ++i) x[i] = float(uniform(engine, -4, 4) * (sample % 4 == 0 ? 20 : 1));
      predictor_jacobian<typename Shape::Network>(model.parameters.data(), x, y, by_x);
      for (int axis = 0; axis < 3; ++axis) {
        const int place = Shape::Features::angular_acceleration + axis;
        double sums[4], others = 0;
        for (int k = 0; k < 4; ++k) {
          sums[k] = double(by_x[k * size + place]) * double(model.output.standard_deviation[std::size_t(k)]) /
                    double(model.input.standard_deviation[std::size_t(place)]);
          if (k != 1 + axis) others += std::abs(sums[k]);
        }
        CHECK(sums[1 + axis] >= certificate.slope[axis] * (1 - 1e-5));
        CHECK(others <= certificate.other_sums[axis] * (1 + 1e-5));
        const auto mix = AxisCommandOutputs::prepare(PaperQuadrotor::value<double>());
        for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
          double slope = 0;
          for (std::size_t k = 0; k < 4; ++k) slope += mix.by[rotor][k] * sums[k];
          CHECK(slope * signs[std::size_t(axis)][rotor] > 0);
        }
      }
    }
  }
  CHECK(proven >= 4);
  CHECK(refused >= 6);
}

TEST_CASE("columns of a network that are 0 leave the base's slopes as they are; one that is NaN proves nothing") {
  auto model = with_columns_scaled<PathModel>(5, 0);
  MonotoneModel<BaseAlone> base(5);
  base.input = model.input;
  base.output = model.output;
  std::copy_n(model.parameters.begin(), base.parameters.size(), base.parameters.begin());
  const Certificate certificate = model.certificate(), of_base = base.certificate();
  REQUIRE(certificate.proven());
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(certificate.slope[axis] == doctest::Approx(of_base.slope[axis]).epsilon(1e-12));
    CHECK(certificate.slope[axis] <= of_base.slope[axis]);
    CHECK(certificate.other_sums[axis] == 0);
  }
  model.parameters[model.parameters.size() - 10] = std::nanf("");
  CHECK(!model.certificate().monotone);
}
