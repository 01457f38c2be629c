// SPDX-License-Identifier: MIT
#include "pinnquad/deploy/golden_features.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/inference/windowed.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;

namespace {

template <class Features>
using ModelOf = TrainedModel<Network<float, InputSize<Features::size>, Dense<4>>, Context<Features, PaperQuadrotor>>;

}  // namespace

TEST_CASE("golden features are evenly spaced rows, the first and the last among them") {
  const Flight flight = test::random_flight_rows(101, 3);
  const RowSet rows(flight, {10, 81});
  const auto golden = golden_features<ModelOf<PaperFeatures>>(rows);
  REQUIRE(golden.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(golden[i] == sample_features<PaperFeatures, float>(flight[10 + 10 * i]));
  }
  CHECK(golden_features<ModelOf<PaperFeatures>>(rows, 2).back() == sample_features<PaperFeatures, float>(flight[80]));
  CHECK(golden_features<ModelOf<PaperFeatures>>(RowSet(flight, {7, 8}), 3).size() == 3);  // of one row, thrice
  CHECK_THROWS_AS(golden_features<ModelOf<PaperFeatures>>(RowSet()), std::invalid_argument);
  CHECK_THROWS_AS(golden_features<ModelOf<PaperFeatures>>(rows, 1), std::invalid_argument);
}

TEST_CASE("rows whose window is not full are no golden ones") {
  using Features = Windowed<PaperFeatures, 3, PeriodMicroseconds<50000>>;
  const Flight flight = test::random_flight_rows(20, 3);  // 0.05 s apart
  std::vector<ModelOf<Features>::FeatureVector> full;
  each_features<Features, float>(RowSet(flight, {0, 20}),
                                 [&](const Flight&, std::size_t, const auto& x) { full.push_back(x); });
  REQUIRE(full.size() == 18);
  const auto golden = golden_features<ModelOf<Features>>(RowSet(flight, {0, 20}), 2);
  CHECK(golden.front() == full.front());
  CHECK(golden.back() == full.back());
  CHECK_THROWS_AS(golden_features<ModelOf<Features>>(RowSet(flight, {0, 2})), std::invalid_argument);
}
