// SPDX-License-Identifier: MIT
// A network that is shown the angular acceleration, trained beside a base: what it may not do, however much the rows
// ask for it; what it learns that one which is not shown it can't; and what a projection leaves alone. Rows that say
// what a derivative should be.
#include "study/path_bounded_fit.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"

using namespace pinnquad;
using namespace study;

namespace {

using Setting = Context<PhysicsFeatures, PaperQuadrotor, AxisCommandOutputs>;
using Seeing = Network<float, InputSize<PhysicsFeatures::size>, Dense<16>, Relu, Dense<4>>;
using Blind = Network<float, InputSize<residual_inputs<PhysicsFeatures>>, Dense<16>, Relu, Dense<4>>;

constexpr double own_slope = 0.004;  ///< s^2/rad of each rotor

/// The roll acceleration's share of the roll sum, a function of it: `shape(wdot_x)` per rotor.
template <class Shape>
Flight flight_of(const Shape& shape, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Flight flight(1200);
  flight.name = "made";
  const auto airframe = PaperQuadrotor::value<double>();
  for (std::size_t row = 0; row < flight.size(); ++row) {
    Sample& sample = flight[row];
    sample.time_s = 0.02 * static_cast<double>(row);
    for (int i = 0; i < 3; ++i) {
      sample.linear_acceleration_m_s2[i] = uniform(engine, -3, 3);
      sample.angular_acceleration_rad_s2[i] = uniform(engine, -20, 20);
      sample.body_rates_rad_s[i] = uniform(engine, -2, 2);
    }
    sample.roll_rad = uniform(engine, -0.5, 0.5);
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      double u = 0.5 + 0.03 * sample.linear_acceleration_m_s2[2] + 0.001 * uniform(engine, -1, 1);
      for (int axis = 0; axis < 3; ++axis) {
        const double asked = sample.angular_acceleration_rad_s2[axis];
        u += allocation_signs(airframe, axis)[rotor] * (axis == 0 ? shape(asked) : own_slope * asked);
      }
      sample.commands[rotor] = u;
    }
  }
  return flight;
}

using Answer = Sum<MonotoneBase<PhysicsFeatures>, Saturated<Seeing>>;

/// The least, over the axes, of what the network's paths leave of a slope, the other sums' parts taken off; above 0
/// each rotor goes the right way.
template <class ContextType>
double slope_left(const Answer& answer, const ContextType& context) {
  constexpr auto own = std::size_t(MonotoneBase<PhysicsFeatures>::parameter_count + 8);
  Seeing network;
  std::copy(answer.parameters.begin() + own, answer.parameters.end(), network.parameters.begin());
  double least = 1e300;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int place = PhysicsFeatures::angular_acceleration + int(axis);
    const programs::Intervals bound = path_bound<Seeing>(network.parameters, place);
    const auto scaled = [&](std::size_t k, double value) {
      return value * context.output.standard_deviation[k] / context.input.standard_deviation[std::size_t(place)];
    };
    double left = scaled(1 + axis, double(answer.parameters[axis]));
    for (std::size_t k = 0; k < 4; ++k) {
      const double worst = std::max(-bound.least[k], bound.most[k]);
      left -= scaled(k, k == 1 + axis ? -bound.least[k] : worst);
    }
    least = std::min(least, left);
  }
  return least;
}

struct Fitted {
  pinnquad::detail::ResidualFit<MonotoneBase<PhysicsFeatures>, Answer> fit;
  double slope_left;
  double blind_error;
};

template <class Shape>
Fitted fitted(const Shape& shape) {
  const Flight flight = flight_of(shape, 1);
  const RowSet training(flight, {0, 900}), validation(flight, {900, 1200});
  const auto context = make_context<Setting>(training);
  const AffineMap map = fit_monotone_base(context, training);
  ResidualTraining how;
  how.epochs = 100;
  how.learning_rate = 1e-2;
  how.weight_decay = 1e-5;
  const auto on = [](int) { return true; };
  std::mt19937_64 engine(1), again(1);
  const auto fit = fit_path_bounded<Seeing>(context, training, validation, map, how, engine, on);
  const auto blind = fit_monotone<Blind>(context, training, validation, map, how, again, on);
  return {fit, slope_left(fit.predictor, context), blind.error};
}

}  // namespace

TEST_CASE("a curve of the angular acceleration that rises is learnt, which a network that is not shown it can't") {
  const Fitted found = fitted([](double a) { return own_slope * (a < 0 ? 0.5 * a : 1.5 * a); });
  CHECK(found.slope_left > 0);
  CHECK(found.fit.residual_kept);
  CHECK(found.fit.error < 0.8 * found.blind_error);
}

TEST_CASE("rows that fall with the angular acceleration do not turn the slope") {
  const Fitted found = fitted([](double a) { return own_slope * (a - 14 * std::tanh(a / 4)); });
  CHECK(found.slope_left > 0);
}

TEST_CASE("without a projection the same rows do turn it; with one a network that keeps its bound is left as it is") {
  const Flight flight = flight_of([](double a) { return own_slope * (a - 14 * std::tanh(a / 4)); }, 1);
  const RowSet rows(flight, {0, flight.size()});
  const auto context = make_context<Setting>(rows);
  const AffineMap map = fit_monotone_base(context, rows);
  const study::detail::PathProjection<Setting, Seeing> projection(context, map);
  std::mt19937_64 engine(2);
  auto network = initialised<Seeing>(engine);
  const auto before = network.parameters;
  projection(network.parameters);
  CHECK(network.parameters != before);
  int changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto column = i % std::size_t(Seeing::inputs);
    const bool of_acceleration = i < 16 * std::size_t(Seeing::inputs) && column >= 3 && column < 6;
    if (network.parameters[i] == before[i]) continue;
    CHECK(of_acceleration);
    ++changed;
  }
  CHECK(changed >= 16);
  const auto projected = network.parameters;
  study::detail::PathProjection<Setting, Seeing>(context, map, 0.91)(network.parameters);  // a little more is allowed
  CHECK(network.parameters == projected);

  const auto answer_of = [&](const Seeing& trained) {
    Answer answer;
    const auto base = monotone_base<Setting>(map);
    auto* to = std::copy(base.parameters.begin(), base.parameters.end(), answer.parameters.begin());
    std::fill_n(to, 4, -1.0F);
    std::fill_n(to + 4, 4, 1.0F);
    std::copy(trained.parameters.begin(), trained.parameters.end(), to + 8);
    return slope_left(answer, context);
  };
  Seeing free;
  free.parameters = before;
  CHECK(answer_of(network) > 0);
  CHECK(answer_of(free) < 0);
  CHECK_THROWS_AS((study::detail::PathProjection<Setting, Seeing>(context, map, 1.0)), std::invalid_argument);
}
