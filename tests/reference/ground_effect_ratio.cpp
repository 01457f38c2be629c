// SPDX-License-Identifier: MIT
// Both ground effect models' thrust ratio over height, as the simulator tabulates it.
#include <doctest/doctest.h>

#include <cmath>

#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "reference/reference_rows.hpp"
#include "support/plain_dynamics.hpp"

TEST_CASE("the ground effect table, both models") {
  // float32 in the simulator; Cheeseman-Bennett's pole at 0.25 multiplies the rounding of Z/R by 2 * 0.25 / (x - 0.25)
  const double table_tolerance = 8e-9, plain_tolerance = 1.7e-8;  // the plain formula's radius is no float32
  const pinnquad::test::ReferenceTable table("ground_effect_ratio.csv");
  const auto airframe = pinnquad::ReferenceQuadrotor15::value<double>();
  pinnquad::test::Statistics cheeseman_bennett, conyers;
  REQUIRE(table.size() > 1000);
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double x = table.at(row, "Z_over_R");
    // the simulator's float of 0.25 lies outside the range of both models, that of 10 may
    if (std::fabs(x - 0.25) < 1e-9 || std::fabs(x - 10.0) < 1e-9) continue;
    CAPTURE(x);
    const double pole = x > 0.25 ? 1.0 + 0.5 / (x - 0.25) : 1.0;
    const double ratio = pinnquad::CheesemanBennett{}.thrust_ratio(x, airframe);
    const double of_table = table.at(row, "ratio_cheeseman_bennett");
    const bool holds = x >= pinnquad::CheesemanBennett::least_height;
    if (!holds) CHECK(ratio == doctest::Approx(4.0 / 3.0));
    const double b = holds ? std::fabs(ratio / of_table - 1.0) : 0.0;
    const double c = std::fabs(pinnquad::Conyers{}.thrust_ratio(x, airframe) / table.at(row, "ratio_conyers") - 1.0);
    if (holds) cheeseman_bennett.add(b);
    conyers.add(c);
    CHECK(b <= table_tolerance);
    CHECK(c <= table_tolerance);
    CHECK(std::fabs(plain::cheeseman_bennett(x) / table.at(row, "ratio_cheeseman_bennett") - 1.0) / pole <=
          table_tolerance);
    CHECK(std::fabs(plain::conyers(x, 690.0, 114.3) / table.at(row, "ratio_conyers") - 1.0) <= plain_tolerance);
  }
  cheeseman_bennett.print("ground_effect_ratio.csv", "Cheeseman-Bennett");
  conyers.print("ground_effect_ratio.csv", "Conyers");
  CHECK(conyers.count() >= table.size() - 2);
}
