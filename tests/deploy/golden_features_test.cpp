// SPDX-License-Identifier: MIT
#include "pinnquad/deploy/golden_features.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "support/random_network.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;

namespace {

template <class Features>
using ModelOf = TrainedModel<Network<float, InputSize<Features::size>, Dense<4>>, Context<Features, PaperQuadrotor>>;

using Shown = Network<float, InputSize<residual_inputs<PhysicsFeatures>>, Dense<8>, Tanh, Dense<4>>;
using Structured = TrainedModel<MonotonePredictor<PhysicsFeatures, Shown>,
                                Context<PhysicsFeatures, PaperQuadrotor, AxisCommandOutputs>>;
template <class Base, class Residual>
Residual residual_of(const Sum<Base, Residual>&);
using Bound = decltype(residual_of(MonotonePredictor<PhysicsFeatures, Shown>{}));
constexpr auto first_bound = static_cast<std::size_t>(MonotoneBase<PhysicsFeatures>::parameter_count);

/// Random weights; the bounds of its residual are its least and largest on the rows, as a training sets them.
Structured structured(const RowSet& rows, std::uint64_t seed) {
  Structured model;
  std::mt19937_64 engine(seed);
  test::fill_uniform(model.network.parameters, engine, 0.5);
  for (std::size_t k = 0; k < 4; ++k) model.output.standard_deviation[k] = 0.1F;
  bool first = true;
  each_features<PhysicsFeatures, float>(rows, [&](const Flight&, std::size_t, const auto& x) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      model.envelope_lower[i] = first ? x[i] : std::min(model.envelope_lower[i], x[i]);
      model.envelope_upper[i] = first ? x[i] : std::max(model.envelope_upper[i], x[i]);
    }
    first = false;
  });
  for (std::size_t i = 0; i < model.envelope_lower.size(); ++i) {
    model.input.mean[i] = (model.envelope_lower[i] + model.envelope_upper[i]) / 2;
    model.input.standard_deviation[i] = (model.envelope_upper[i] - model.envelope_lower[i]) / 3 + 0.1F;
  }
  float* bounds = model.network.parameters.data() + first_bound;
  std::fill(bounds, bounds + 4, -1e30F);
  std::fill(bounds + 4, bounds + 8, 1e30F);
  float lower[4] = {}, upper[4] = {};
  first = true;
  each_features<PhysicsFeatures, float>(rows, [&](const Flight&, std::size_t, const auto& x) {
    float z[PhysicsFeatures::size], y[4];
    model.input.standardise(x.data(), z);
    Bound::forward(bounds, z, y);
    for (std::size_t k = 0; k < 4; ++k) {
      lower[k] = first ? y[k] : std::min(lower[k], y[k]);
      upper[k] = first ? y[k] : std::max(upper[k], y[k]);
    }
    first = false;
  });
  std::copy(lower, lower + 4, bounds);
  std::copy(upper, upper + 4, bounds + 4);
  return model;
}

}  // namespace

TEST_CASE("a bound of the residual that is moved moves a golden command") {
  const Flight flight = test::random_flight_rows(101, 3);
  const RowSet rows(flight, {0, 101});
  int found = 0, missed_by_rows = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Structured model = structured(rows, seed);
    const auto golden = golden_features(model, rows);
    REQUIRE(golden.size() == 8);
    CHECK(golden.back() == sample_features<PhysicsFeatures, float>(flight[100]));
    CHECK(golden == golden_features(model, rows));
    for (const auto& x : golden) {
      CHECK(detail::inside_envelope(model.envelope_lower.data(), x.data(), model.envelope_upper.data(), x.size()));
    }
    for (std::size_t bound = 0; bound < 8; ++bound) {
      Structured wider = model;  // what no row of the training would notice
      const auto range = static_cast<double>(model.network.parameters[first_bound + 4 + bound % 4] -
                                             model.network.parameters[first_bound + bound % 4]);
      wider.network.parameters[first_bound + bound] += static_cast<float>((bound < 4 ? -0.02 : 0.02) * range);
      double largest = 0, of_rows = 0;
      for (const auto& x : golden) {
        const auto before = model.predict(x), after = wider.predict(x);
        for (std::size_t k = 0; k < 4; ++k) largest = std::max(largest, double(std::abs(before[k] - after[k])));
      }
      each_features<PhysicsFeatures, float>(rows, [&](const Flight&, std::size_t, const auto& x) {
        const auto before = model.predict(x), after = wider.predict(x);
        for (std::size_t k = 0; k < 4; ++k) of_rows = std::max(of_rows, double(std::abs(before[k] - after[k])));
      });
      found += largest > 2 * golden_tolerance;
      missed_by_rows += of_rows <= golden_tolerance;
    }
  }
  CHECK(missed_by_rows == 32);
  CHECK(found >= 26);  // 8 vectors hold 6 beyond a bound: as many bounds, and those that they pass besides
  MESSAGE(found, " of 32 bounds");
}

TEST_CASE("golden features are evenly spaced rows, the first and the last among them") {
  const Flight flight = test::random_flight_rows(101, 3);
  const RowSet rows(flight, {10, 81});
  const ModelOf<PaperFeatures> model;
  const auto golden = golden_features(model, rows);
  REQUIRE(golden.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(golden[i] == sample_features<PaperFeatures, float>(flight[10 + 10 * i]));
  }
  CHECK(golden_features(model, rows, 2).back() == sample_features<PaperFeatures, float>(flight[80]));
  CHECK(golden_features(model, RowSet(flight, {7, 8}), 3).size() == 3);  // of one row, thrice
  CHECK_THROWS_AS(golden_features(model, RowSet()), std::invalid_argument);
  CHECK_THROWS_AS(golden_features(model, rows, 1), std::invalid_argument);
}

TEST_CASE("rows whose window is not full are no golden ones") {
  using Features = Windowed<PaperFeatures, 3, PeriodMicroseconds<50000>>;
  const Flight flight = test::random_flight_rows(20, 3);  // 0.05 s apart
  std::vector<ModelOf<Features>::FeatureVector> full;
  each_features<Features, float>(RowSet(flight, {0, 20}),
                                 [&](const Flight&, std::size_t, const auto& x) { full.push_back(x); });
  REQUIRE(full.size() == 18);
  const ModelOf<Features> model;
  const auto golden = golden_features(model, RowSet(flight, {0, 20}), 2);
  CHECK(golden.front() == full.front());
  CHECK(golden.back() == full.back());
  CHECK_THROWS_AS(golden_features(model, RowSet(flight, {0, 2})), std::invalid_argument);
}
