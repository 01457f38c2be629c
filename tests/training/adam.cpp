// SPDX-License-Identifier: MIT
// Adam against the published update, written plainly, step by step.
#include "pinnquad/training/adam.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "support/random_network.hpp"
#include "support/tolerances.hpp"

using pinnquad::Adam;
using pinnquad::GenericPack;
using pinnquad::NativePack;
using pinnquad::test::fill_uniform;
using pinnquad::test::rounding;

namespace {

/// torch.optim.Adam(lr, betas, eps, weight_decay), amsgrad off, for one parameter: its documentation's algorithm.
struct PlainAdam {
  double learning_rate, beta_1, beta_2, epsilon, weight_decay;
  double m = 0.0, v = 0.0;

  double step(double p, double g, int t) {
    g = g + weight_decay * p;  // coupled: the decay goes through both moments
    m = beta_1 * m + (1 - beta_1) * g;
    v = beta_2 * v + (1 - beta_2) * g * g;
    const double m_hat = m / (1 - std::pow(beta_1, t));
    const double v_hat = v / (1 - std::pow(beta_2, t));
    return p - learning_rate * m_hat / (std::sqrt(v_hat) + epsilon);
  }
};

template <class Pack>
struct Parameters {
  static constexpr int count = 2 * Pack::width;
  using Scalar = typename Pack::Scalar;
  using Array = std::array<Scalar, static_cast<std::size_t>(count)>;
  Array p{}, g{}, first{}, second{};

  void step(const Adam& adam, long t) {
    adam.template update<Pack>(adam.begin(t), p.data(), g.data(), first.data(), second.data(), count);
  }
};

}  // namespace

TEST_CASE_TEMPLATE("two hundred steps as published, moments and all", Pack, GenericPack<double, 4>,
                   GenericPack<float, 4>, NativePack<float>) {
  using Scalar = typename Pack::Scalar;
  const Adam settings[] = {{}, {0.1, 0.8, 0.9, 1e-3, 0.0}, {0.01, 0.9, 0.999, 1e-8, 0.3}, {0.05, 0.0, 0.5, 1e-8, 0.1}};
  for (const Adam& adam : settings) {
    std::mt19937_64 engine(101);
    Parameters<Pack> library;
    std::array<PlainAdam, static_cast<std::size_t>(Parameters<Pack>::count)> plain{};
    std::array<double, static_cast<std::size_t>(Parameters<Pack>::count)> p{};
    fill_uniform(library.p, engine, 2.0);
    for (std::size_t i = 0; i < p.size(); ++i) {
      p[i] = static_cast<double>(library.p[i]);
      plain[i] = {adam.learning_rate, adam.beta_1, adam.beta_2, adam.epsilon, adam.weight_decay};
    }
    for (int t = 1; t <= 200; ++t) {
      fill_uniform(library.g, engine, 0.5);
      for (std::size_t i = 0; i < p.size(); ++i) p[i] = plain[i].step(p[i], static_cast<double>(library.g[i]), t);
      library.step(adam, t);
      double worst_p = 0.0, worst_m = 0.0, worst_v = 0.0;
      for (std::size_t i = 0; i < p.size(); ++i) {
        worst_p = std::max(worst_p, std::fabs(static_cast<double>(library.p[i]) - p[i]));
        worst_m = std::max(worst_m, std::fabs(static_cast<double>(library.first[i]) - plain[i].m));
        worst_v = std::max(worst_v, std::fabs(static_cast<double>(library.second[i]) - plain[i].v));
      }
      // some ten roundings a step, of parameters up to 2 and moments below 1; 1 - 0.999 in float costs none: it is cast
      CHECK(worst_p <= rounding<Scalar>(20.0 * t));
      CHECK(worst_m <= rounding<Scalar>(20));
      CHECK(worst_v <= rounding<Scalar>(20));
    }
  }
}

TEST_CASE("by hand: the first step is the learning rate, against the gradient's sign, whatever its size") {
  Parameters<GenericPack<double, 4>> parameters;
  const double gradients[8] = {1e-4, -1e-4, 1.0, -1.0, 250.0, -250.0, 3.0, -0.5};
  for (std::size_t i = 0; i < 8; ++i) parameters.g[i] = gradients[i];
  const Adam adam{1e-3, 0.9, 0.999, 1e-8, 0.0};
  parameters.step(adam, 1);
  // m / (1 - b1) = g, sqrt(v / (1 - b2)) = |g|: the step is rate g / (|g| + eps)
  for (std::size_t i = 0; i < 8; ++i) {
    const double g = gradients[i];
    CHECK(parameters.p[i] == doctest::Approx(-1e-3 * g / (std::fabs(g) + 1e-8)).epsilon(1e-12));
    CHECK(parameters.first[i] == doctest::Approx(0.1 * g).epsilon(1e-12));
    CHECK(parameters.second[i] == doctest::Approx(0.001 * g * g).epsilon(1e-12));
  }
  for (std::size_t i = 0; i < 8; ++i) parameters.g[i] = 0.0;
  parameters.step(adam, 2);
  // m = 0.09 g, v = 0.000999 g^2; corrected by 0.19 and 0.001999
  const double second_step = 1e-3 * (0.09 / 0.19) / std::sqrt(0.000999 / 0.001999);
  CHECK(parameters.p[2] == doctest::Approx(-1e-3 - second_step).epsilon(1e-7));  // epsilon is 1e-8 of |g| = 1
}

TEST_CASE("weight decay is coupled: it is normalised away, where a decoupled one would shrink by rate * decay") {
  Parameters<GenericPack<double, 4>> parameters;
  for (std::size_t i = 0; i < 8; ++i) parameters.p[i] = 2.0;
  const Adam adam{1e-3, 0.9, 0.999, 1e-8, 0.01};
  parameters.step(adam, 1);  // gradient 0: g = 0.02, the first step is the learning rate
  CHECK(parameters.p[0] == doctest::Approx(2.0 - 1e-3).epsilon(1e-8));
  CHECK(parameters.first[0] == doctest::Approx(0.1 * 0.02));
}

TEST_CASE("zero gradient without decay: nothing moves") {
  Parameters<GenericPack<double, 4>> parameters;
  parameters.p.fill(0.7);
  const auto before = parameters.p;
  for (int t = 1; t < 5; ++t) parameters.step({1e-3, 0.9, 0.999, 1e-8, 0.0}, t);
  CHECK(parameters.p == before);
}
