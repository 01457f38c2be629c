// SPDX-License-Identifier: MIT
// Adam, AdamW and learning-rate policies against the published updates, written plainly, step by step.
#include "pinnquad/training/adam.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/trainer.hpp"
#include "support/random_network.hpp"
#include "support/tolerances.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
using pinnquad::test::fill_uniform;
using pinnquad::test::known_map;
using pinnquad::test::rounding;

namespace {

/// The optimiser's own learning rate in every step.
struct FullRate {
  double factor(double) const noexcept { return 1.0; }
};

/// torch.optim.Adam and AdamW for one parameter, amsgrad off: their documentation's algorithms.
struct Plain {
  bool decoupled;  ///< the decay does not go through the moments
  double beta_1, beta_2, epsilon, weight_decay;
  double m = 0.0, v = 0.0;

  double step(double p, double g, double rate, int t) {
    (decoupled ? p : g) += (decoupled ? -rate : 1.0) * weight_decay * p;
    m = beta_1 * m + (1 - beta_1) * g;
    v = beta_2 * v + (1 - beta_2) * g * g;
    const double m_hat = m / (1 - std::pow(beta_1, t));
    const double v_hat = v / (1 - std::pow(beta_2, t));
    return p - rate * m_hat / (std::sqrt(v_hat) + epsilon);
  }
};

using Net =
    pinnquad::Mlp<double, pinnquad::InputSize<16>, pinnquad::Hidden<1, 9>, pinnquad::OutputSize<4>, pinnquad::Relu>;
using PaperContext = pinnquad::Context<pinnquad::PaperFeatures, pinnquad::PaperQuadrotor>;

/// Notes how far training was at each step; moves nothing.
struct Notes {
  double learning_rate = 1.0;
  std::vector<double>* done;
  int begin(long, double share) const {
    done->push_back(share);
    return 0;
  }
  template <class Pack, class Scalar>
  void update(int, Scalar*, const Scalar*, Scalar*, Scalar*, int) const noexcept {}
};

/// Gradient descent that looks at its rate where it uses it: in update().
struct Descent {
  double learning_rate = 0.1;
  int begin(long, double) const { return 0; }
  template <class Pack, class Scalar>
  void update(int, Scalar* parameters, const Scalar* gradient, Scalar*, Scalar*, int count) const noexcept {
    for (int i = 0; i < count; ++i) parameters[i] -= Scalar(learning_rate) * gradient[i];
  }
};

struct ThrowingUpdate : Descent {
  template <class Pack, class Scalar>
  void update(int, Scalar*, const Scalar*, Scalar*, Scalar*, int) const {}
};

template <class Optimizer>
Net::Parameters trained(const Optimizer& optimizer, int epochs) {
  const auto data = known_map<double>(100, 181);
  std::mt19937_64 engine(182);
  using Type = pinnquad::Trainer<Net, pinnquad::Mse, Optimizer, PaperContext>;
  auto trainer = std::make_unique<Type>(pinnquad::initialised<Net>(engine), pinnquad::Mse{}, optimizer, PaperContext{});
  for (int epoch = 0; epoch < epochs; ++epoch) trainer->epoch(data, Progress{epoch, epochs}, engine);
  return trainer->network().parameters;
}

}  // namespace

TEST_CASE_TEMPLATE("two hundred steps as published, moments and all, constant and along a cosine", Pack,
                   GenericPack<double, 4>, GenericPack<float, 4>, NativePack<float>) {
  using Scalar = typename Pack::Scalar;
  constexpr std::size_t count = 2 * static_cast<std::size_t>(Pack::width);
  constexpr int steps = 200;
  const auto run = [&](const auto& optimizer, bool decoupled, const auto& adam, const auto& begin, const auto& rate) {
    std::mt19937_64 engine(183);
    std::array<Scalar, count> p{}, g{}, first{}, second{};
    std::array<Plain, count> plain{};
    std::array<double, count> expected{};
    fill_uniform(p, engine, 2.0);
    for (std::size_t i = 0; i < count; ++i) {
      expected[i] = static_cast<double>(p[i]);
      plain[i] = {decoupled, adam.beta_1, adam.beta_2, adam.epsilon, adam.weight_decay};
    }
    for (int t = 1; t <= steps; ++t) {
      fill_uniform(g, engine, 0.5);
      const double factor = rate((t - 1) / static_cast<double>(steps));
      for (std::size_t i = 0; i < count; ++i) {
        expected[i] = plain[i].step(expected[i], static_cast<double>(g[i]), adam.learning_rate * factor, t);
      }
      optimizer.template update<Pack>(begin(t), p.data(), g.data(), first.data(), second.data(),
                                      static_cast<int>(count));
      double worst_p = 0.0, worst_moment = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        worst_p = std::max(worst_p, std::fabs(static_cast<double>(p[i]) - expected[i]));
        worst_moment = std::max({worst_moment, std::fabs(static_cast<double>(first[i]) - plain[i].m),
                                 std::fabs(static_cast<double>(second[i]) - plain[i].v)});
      }
      // some ten roundings a step, of parameters up to 2 and moments below 1; 1 - 0.999 in float costs none: it is cast
      CHECK(worst_p <= rounding<Scalar>(20.0 * t));
      CHECK(worst_moment <= rounding<Scalar>(20));
    }
  };
  const auto both = [&](const auto& adam, bool decoupled) {
    run(
        adam, decoupled, adam, [&](long t) { return adam.begin(t); }, [](double) { return 1.0; });
    const Scheduled<std::decay_t<decltype(adam)>, CosineDecay> scheduled{adam, {}};
    run(
        scheduled, decoupled, adam, [&](long t) { return scheduled.begin(t, static_cast<double>(t - 1) / steps); },
        [](double done) { return (1 + std::cos(std::acos(-1.0) * done)) / 2; });
  };
  for (const Adam& adam :
       {Adam{}, Adam{0.1, 0.8, 0.9, 1e-3, 0.0}, Adam{0.01, 0.9, 0.999, 1e-8, 0.3}, Adam{0.05, 0.0, 0.5, 1e-8, 0.1}}) {
    both(adam, false);
    both(AdamW{adam.learning_rate, adam.beta_1, adam.beta_2, adam.epsilon, adam.weight_decay}, true);
  }
}

TEST_CASE("what is an optimiser") {
  CHECK(pinnquad::is_optimizer<Adam>);
  CHECK(pinnquad::is_optimizer<AdamW>);
  CHECK((pinnquad::is_optimizer<Scheduled<Adam, CosineDecay>>));
  CHECK_FALSE(pinnquad::is_optimizer<int>);
  CHECK(pinnquad::is_optimizer<Descent>);
  CHECK_FALSE(pinnquad::is_optimizer<ThrowingUpdate>);  // the contract says noexcept
}

TEST_CASE("a rate reaches an optimiser wherever that reads its learning rate") {
  using Pack = GenericPack<double, 4>;
  const Scheduled<Descent, CosineDecay> scheduled{};
  for (const double done : {0.0, 0.25, 0.5, 0.9}) {
    std::array<double, 4> p = {1.0, 2.0, -3.0, 0.5}, g = {1.0, -1.0, 0.5, 0.0}, first{}, second{};
    auto expected = p;
    for (std::size_t i = 0; i < 4; ++i) expected[i] -= 0.1 * CosineDecay{}.factor(done) * g[i];
    scheduled.update<Pack>(scheduled.begin(1, done), p.data(), g.data(), first.data(), second.data(), 4);
    CHECK(p == expected);
  }
  CHECK(trained(Scheduled<Descent, CosineDecay>{}, 3) != trained(Descent{}, 3));
  CHECK(trained(Scheduled<Descent, FullRate>{}, 3) == trained(Descent{}, 3));
}

TEST_CASE("a rate over an optimiser that follows progress itself scales that one's rate") {
  std::vector<double> done;
  const Scheduled<Notes, CosineDecay> scheduled{Notes{2.0, &done}, {}};
  CHECK(scheduled.begin(1, 0.5).now.learning_rate == doctest::Approx(1.0));
  CHECK(done == std::vector<double>{0.5});
}

TEST_CASE("an optimiser's numbers are looked at before a training, in one line") {
  const auto complaint = [](const auto& optimizer) -> std::string {
    try {
      trained(optimizer, 0);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(complaint(Adam{}) == "accepted");
  CHECK(complaint(Adam{0.0, 0.0, 0.0, 0.0, 0.0}) == "accepted");
  CHECK(complaint(Adam{nan}) == "Adam::learning_rate: expected a finite number from 0, found nan");
  CHECK(complaint(Adam{-0.5}) == "Adam::learning_rate: expected a finite number from 0, found -0.5");
  CHECK(complaint(Adam{1e-3, 1.0}) == "Adam::beta_1: expected 0 <= beta_1 < 1, found 1");
  CHECK(complaint(Adam{1e-3, 0.9, -1.0}) == "Adam::beta_2: expected 0 <= beta_2 < 1, found -1");
  CHECK(complaint(AdamW{1e-3, 0.9, 0.999, 1e-8, nan}) ==
        "AdamW::weight_decay: expected a finite number from 0, found nan");
  CHECK(complaint(AdamW{1e-3, 0.9, 0.999, nan}) == "Adam::epsilon: expected a finite number from 0, found nan");
  CHECK(complaint(Scheduled<AdamW, CosineDecay>{{std::numeric_limits<double>::infinity()}, {}}) ==
        "Adam::learning_rate: expected a finite number from 0, found inf");
}

TEST_CASE("without decay AdamW is Adam, and a constant rate changes no bit") {
  const Adam adam{3e-3, 0.9, 0.999, 1e-8, 0.0};
  CHECK(trained(AdamW{3e-3, 0.9, 0.999, 1e-8, 0.0}, 3) == trained(adam, 3));
  CHECK(trained(Scheduled<Adam, FullRate>{adam, {}}, 3) == trained(adam, 3));
  CHECK(trained(Scheduled<Adam, CosineDecay>{adam, {}}, 3) != trained(adam, 3));
}

TEST_CASE("the trainer tells the share of steps taken: t / T over all batches of all epochs") {
  std::vector<double> done;
  trained(Notes{1.0, &done}, 3);  // 100 rows: two batches an epoch
  REQUIRE(done.size() == 6);
  for (std::size_t t = 0; t < 6; ++t) CHECK(done[t] == doctest::Approx(static_cast<double>(t) / 6.0));
}
