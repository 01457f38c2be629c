// SPDX-License-Identifier: MIT
// The search for a counterexample, on sums that are known in closed form, and on a model whose other tap turns the
// response to an acceleration that is held.
#include "model/counterexample.hpp"

#include <doctest/doctest.h>

#include "model/searched_model.hpp"
#include "support/drawn_model.hpp"

namespace {

/// One feature from 0 to 1; the sum rises with it up to `top`, and falls ten times as steeply beyond.
programs::SearchedModel falls_beyond(double top) {
  programs::SearchedModel model;
  model.lower = {0};
  model.upper = {1};
  model.ways = {{0, false, {0}}};
  model.derivatives = [top](const std::vector<double>& x) { return std::vector<double>{x[0] < top ? 1.0 : -10.0}; };
  model.sums = [top](const std::vector<double>& x) {
    return std::array<double, 3>{x[0] < top ? x[0] : top - 10 * (x[0] - top), 0, 0};
  };
  model.starts = {{1.0}};
  return model;
}

constexpr double seconds = 0.05;

}  // namespace

TEST_CASE("a sum that falls inside the envelope is found, and both motions lie inside") {
  const programs::Search search = programs::search_counterexample(falls_beyond(0.5), 1, seconds);
  REQUIRE(search.found.has_value());
  CHECK(search.found->x[0] >= 0);
  CHECK(search.found->step > 0);
  CHECK(search.found->x[0] + search.found->step <= 1);
  CHECK(search.found->sum_of_more < search.found->sum);
  CHECK(search.least[0] == -10);
}

TEST_CASE("a sum that falls over no step inside the envelope is no counterexample, whatever it does beyond") {
  const programs::Search search = programs::search_counterexample(falls_beyond(0.9999), 1, seconds);
  CHECK_FALSE(search.found.has_value());
  CHECK(search.least[0] == -10);
}

TEST_CASE("more of a held acceleration is more in every feature that shows it, a lone one of another tap too") {
  using namespace pinnquad;
  using LonePast = PartlyWindowed<InverseFeatures, Chosen<NamedFeatures, 3>, 2, PeriodMicroseconds<20000>>;
  using Model = test::ModelOf<MonotoneBase<LonePast>, LonePast, AxisCommandOutputs>;
  Model model = test::drawn_model<Model>(1);
  model.input.standard_deviation.fill(1);
  constexpr int others = LonePast::size - 3;
  for (std::size_t axis = 0; axis < 3; ++axis) model.network.parameters[axis] = 1;
  model.network.parameters[std::size_t(3 + 2 * others - 1)] = -1.5F;  // roll's weight of wdot_x[-1]
  const BlockModel block("drawn.block", test::drawn_block(model));
  const programs::Search search = programs::search_counterexample(programs::searched_model(block), 1, seconds);
  REQUIRE(search.found.has_value());
  CHECK(search.found->asked.held);
  CHECK(search.found->asked.places == std::vector<std::size_t>{1, std::size_t(LonePast::size - 1)});
}
