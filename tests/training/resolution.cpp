// SPDX-License-Identifier: MIT
#include "pinnquad/training/training_data.hpp"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "pinnquad/features/features.hpp"
#include "pinnquad/outputs/output_schema.hpp"

using pinnquad::detail::ColumnStatistics;
using pinnquad::detail::resolution_of;

namespace {

std::vector<std::array<double, 1>> column(std::initializer_list<double> values) {
  std::vector<std::array<double, 1>> rows;
  for (const double value : values) rows.push_back({value});
  return rows;
}

ColumnStatistics statistics(const std::vector<std::array<double, 1>>& rows) {
  return pinnquad::detail::column_statistics({"m/s"}, [&](const pinnquad::detail::RowVisit& visit) {
    for (const auto& row : rows) visit(row.data());
  })[0];
}

}  // namespace

TEST_CASE("every unit of the feature sets and output schemas has a resolution of its own") {
  const auto known = [](const char* unit) {
    const auto unknown = resolution_of("furlong", 0);
    const auto of_unit = resolution_of(unit, 0);
    CHECK(of_unit.smallest_deviation != unknown.smallest_deviation);
    CHECK(of_unit.smallest_deviation > 0);
    CHECK(of_unit.still_margin > of_unit.smallest_deviation);
  };
  for (const char* unit : pinnquad::PaperFeaturesWithAltitude::units) known(unit);
  known(pinnquad::CommandOutputs::units[0]);
  known(pinnquad::RotorSpeedOutputs::units[0]);
}

TEST_CASE("an unknown unit: relative to the value, and to 1 about 0") {
  CHECK(resolution_of("K", 0).smallest_deviation == 1e-6);
  CHECK(resolution_of("K", -0.5).still_margin == 0.01);
  CHECK(resolution_of("Pa", 1e5).smallest_deviation == doctest::Approx(0.1));
  CHECK(resolution_of("Pa", -1e5).still_margin == doctest::Approx(1000));
}

TEST_CASE("a known unit's spread is never below a float's rounding of the value") {
  CHECK(resolution_of("m", 100).smallest_deviation == 0.01);
  CHECK(resolution_of("m", 1e6).smallest_deviation == doctest::Approx(1));
}

TEST_CASE("still or not: scale and margin") {
  const auto moving = statistics(column({1, 3}));
  CHECK(moving.mean == 2);
  CHECK(moving.standard_deviation == 1);
  CHECK_FALSE(moving.still());
  CHECK(moving.scale() == 1);
  CHECK(moving.margin() == doctest::Approx(0.2));  // a tenth of the range
  const auto barely = statistics(column({1, 1.04}));
  CHECK_FALSE(barely.still());
  CHECK(barely.margin() == 0.01);  // the smallest spread
  const auto still = statistics(column({1, 1 + 1e-13}));
  CHECK(still.still());
  CHECK(still.scale() == 1);
  CHECK(still.margin() == 0.1);
  // seldom, but far: still by its spread, with the range's margin
  auto rare = column({0});
  rare.resize(100000, {0});
  rare[500] = {2};
  CHECK(statistics(rare).still());
  CHECK(statistics(rare).margin() == doctest::Approx(0.2));
}
