// SPDX-License-Identifier: MIT
// Counts of derivatives and of steps below 0, on rows that are made up. The derivatives themselves:
// tests/exported/run_time_kinds.cpp.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "training/derivatives.hpp"

namespace {

using namespace pinnquad;

/// Rows in flight, each entry within a usual range.
std::vector<Sample> samples(std::size_t count, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<Sample> rows(count);
  for (Sample& row : rows) {
    for (int i = 0; i < 3; ++i) {
      row.linear_acceleration_m_s2[i] = 5 * any(engine);
      row.angular_acceleration_rad_s2[i] = 20 * any(engine);
      row.velocity_m_s[i] = 4 * any(engine);
      row.body_rates_rad_s[i] = 3 * any(engine);
    }
    row.roll_rad = 0.5 * any(engine);
    row.pitch_rad = 0.5 * any(engine);
    row.yaw_rad = 3 * any(engine);
    row.commands = {0.5, 0.5, 0.5, 0.5};
  }
  return rows;
}

}  // namespace

TEST_CASE("rows that a window leaves without an answer are told by NaN, the others stand in their places") {
  using Window = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>, Centred>;
  using Model = TrainedModel<Network<float, InputSize<Window::size>, Dense<4>>, Context<Window, GivenAirframe>>;
  Model model{GivenAirframe("paper", airframe_value<PaperQuadrotor, double>())};
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  model.network.parameters[3] = 1;  // u1: the present angular acceleration about x
  std::mt19937_64 engine(4);
  Flight flights[2];
  RowSet rows;
  for (Flight& flight : flights) {
    for (const Sample& sample : samples(6, engine)) {
      flight.push_back(sample);
      flight[flight.size() - 1].time_s = 0.02 * double(flight.size());
    }
    rows.add(flight, {1, 6});
  }
  const programs::Predictions predictions = pinnquad::predicted_commands(model, rows);
  REQUIRE(predictions.size() == 10);
  for (std::size_t row = 0; row < 10; ++row) {
    const bool complete = row % 5 > 0 && row % 5 < 4;
    CHECK(std::isfinite(predictions[row][0]) == complete);
    if (complete) CHECK(predictions[row][0] == doctest::Approx(rows[row].angular_acceleration_rad_s2[0]));
  }
}

TEST_CASE("the share counts rows below 0; what is not finite is told") {
  std::mt19937_64 engine(3);
  Flight flight;
  for (const Sample& sample : samples(4, engine)) flight.push_back(sample);
  const RowSet rows(flight, {0, 4});
  int row = 0;
  const programs::DerivativeFigures found = programs::derivative_figures(rows, [&row](const Sample&) {
    ++row;
    return programs::AxisSlopes{row == 2 ? -1e-9 : 0.0, row < 4 ? -1.0 - row : 1.0, row == 1 ? std::nan("") : 1.0};
  });
  CHECK(found.wrong_share[0] == 0.25);
  CHECK(found.wrong_share[1] == 0.75);
  CHECK(std::isnan(found.wrong_share[2]));
  CHECK(found.least[0] == -1e-9);
  CHECK(found.least[1] == -4);
  CHECK(found.median[1] == -2);
  CHECK(found.sees_acceleration);
  CHECK(std::isnan(found.least[2]));
  const programs::DerivativeFigures none =
      programs::derivative_figures({}, [](const Sample&) { return programs::AxisSlopes{}; });
  CHECK(std::isnan(none.wrong_share[0]));
  CHECK(std::isnan(none.least[0]));
}

TEST_CASE("large steps are those of more than half a deviation; rows that do not count split a flight") {
  // asked: 0 1 0 10 0, deviation 4.4; the sum goes against the two small steps, and against one of the two large ones
  std::array<programs::AxisSeries, 3> series;
  for (programs::AxisSeries& s : series) s = {{0, 1, 0, 10, 0}, {0, 1, 0, 1, 0}, {0, -1, 0, 1, 2}};
  const programs::PairSigns pairs = programs::pair_signs(series);
  CHECK(pairs.all[1] == 0.75);
  CHECK(pairs.large[1] == 0.5);
  CHECK(pairs.of_flown[1] == 0);
  CHECK(pairs.large_of_flown[1] == 0);
  std::mt19937_64 engine(4);
  Flight flight;
  for (const Sample& sample : samples(6, engine)) flight.push_back(sample);
  programs::Predictions made(5);
  for (std::size_t i = 0; i < made.size(); ++i) made[i][0] = static_cast<double>(i);
  const programs::PredictedRows left =
      programs::rows_that_count(RowSet(flight, {1, 6}), made, {false, true, true, false, true});
  REQUIRE(left.rows.pieces().size() == 2);
  CHECK(left.rows.pieces()[0].rows.begin == 2);
  CHECK(left.rows.pieces()[0].rows.end == 4);
  CHECK(left.rows.pieces()[1].rows.begin == 5);
  CHECK(left.predictions[2][0] == 4);
  CHECK(left.rows.size() == left.predictions.size());
}
