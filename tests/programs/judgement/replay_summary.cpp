// SPDX-License-Identifier: MIT
// The summary of a replay, of rows that are made up.
#include "model/replay_summary.hpp"

#include <doctest/doctest.h>

TEST_CASE("the longest stretch without the model is the one that lasts longest, whatever its rows") {
  programs::Replayed replayed;
  replayed.flights = {"made up"};
  const auto add = [&](double time_s, programs::Answerer answerer) {
    programs::ReplayedRow row;
    row.row = replayed.rows.size() + 1;
    row.time_s = time_s;
    row.answerer = answerer;
    replayed.rows.push_back(row);
  };
  using programs::Answerer;
  add(0, Answerer::model);
  for (int i = 1; i <= 5; ++i) add(0.01 * i, Answerer::nobody);  // 5 rows, 0.05 s
  add(0.06, Answerer::model);
  add(0.07, Answerer::analytic_inverse);  // 2 rows with a gap between them, 2 s
  add(2.06, Answerer::nobody);
  add(2.07, Answerer::model);
  add(2.08, Answerer::nobody);  // to the end
  const programs::ReplaySummary summary = programs::summary_of(replayed);
  REQUIRE(summary.longest.first != nullptr);
  CHECK(summary.longest.first->row == 8);
  CHECK(summary.longest.rows == 2);
  CHECK(summary.longest.duration_s == doctest::Approx(2));
}
