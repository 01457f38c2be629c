// SPDX-License-Identifier: MIT
// Many flights, one per seed, over the cores; what they reach, as a table and as CSV.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "command_line/in_words.hpp"
#include "command_line/parallel.hpp"
#include "flight/axis_motion.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/simulation/simulator.hpp"

namespace programs {

/// One flight in figures.
struct FlightFigures {
  std::uint64_t seed = 0;
  pinnquad::FlightReport report{};
  std::array<double, 3> correlation{};  ///< PCC of angular acceleration and signed command sum: roll, pitch, yaw
};

/// PCC of Fig. 2 about each axis, of the rows as they were recorded.
inline std::array<double, 3> axis_correlations(const pinnquad::Flight& flight,
                                               const pinnquad::Airframe<double>& airframe) {
  std::array<double, 3> result{};
  for (int axis = 0; axis < 3; ++axis) {
    const AxisMotion motion = axis_motion(flight, airframe, axis);
    result[static_cast<std::size_t>(axis)] =
        pinnquad::pearson_correlation(motion.angular_acceleration, motion.command_sum);
  }
  return result;
}

/// Flies the seeds from `first_seed` on; `fly_seed(seed, rows_done)` gives FlightFigures and counts its rows in the
/// atomic. In the order of the seeds; stops with what an exception of `fly_seed` says.
template <class FlySeed>
std::vector<FlightFigures> fly_seeds(const std::string& name, std::uint64_t first_seed, std::size_t seeds,
                                     std::size_t rows_per_flight, const FlySeed& fly_seed) {
  std::vector<FlightFigures> figures(seeds);
  std::atomic<std::size_t> rows_done{0};
  const double all_rows = static_cast<double>(seeds) * static_cast<double>(rows_per_flight);
  run_parallel(
      "flying " + std::to_string(seeds) + " seeds of " + name, seeds, std::max(1U, std::thread::hardware_concurrency()),
      [&] { return static_cast<double>(rows_done.load()) / all_rows; },
      [&](std::size_t i) { figures[i] = fly_seed(first_seed + i, rows_done); });
  return figures;
}

/// A column of the table.
struct FlightColumn {
  const char* name;   ///< in the CSV
  const char* title;  ///< in the table
  const char* format;
  double (*of)(const FlightFigures&);
};

inline const std::vector<FlightColumn>& flight_columns() {
  static const std::vector<FlightColumn> columns = {
      {"rows", "rows", "%.0f", [](const FlightFigures& f) { return static_cast<double>(f.report.rows); }},
      {"max_speed_m_s", "speed, m/s", "%.2f", [](const FlightFigures& f) { return f.report.max_speed_m_s; }},
      {"min_altitude_m", "lowest, m", "%.2f", [](const FlightFigures& f) { return f.report.min_altitude_m; }},
      {"max_altitude_m", "highest, m", "%.2f", [](const FlightFigures& f) { return f.report.max_altitude_m; }},
      {"max_tilt_deg", "tilt, deg", "%.1f",
       [](const FlightFigures& f) { return pinnquad::degrees_per_radian * f.report.max_tilt_rad; }},
      {"saturated_percent", "saturated, %", "%.2f",
       [](const FlightFigures& f) { return 100 * f.report.saturated_share; }},
      {"pcc_roll", "PCC roll", "%.3f", [](const FlightFigures& f) { return f.correlation[0]; }},
      {"pcc_pitch", "PCC pitch", "%.3f", [](const FlightFigures& f) { return f.correlation[1]; }},
      {"pcc_yaw", "PCC yaw", "%.3f", [](const FlightFigures& f) { return f.correlation[2]; }},
  };
  return columns;
}

/// One line per seed, then the least, the mean and the greatest of each column.
inline void print_flight_table(const std::vector<FlightFigures>& figures) {
  std::printf("%6s", "seed");
  for (const FlightColumn& column : flight_columns()) std::printf("  %12s", column.title);
  std::printf("\n");
  for (const FlightFigures& one : figures) {
    std::printf("%6llu", static_cast<unsigned long long>(one.seed));
    for (const FlightColumn& column : flight_columns()) {
      std::printf("  %12s", in_words(column.format, column.of(one)).c_str());
    }
    std::printf("%s\n", one.report.end == pinnquad::FlightEnd::completed ? "" : "  ended early");
  }
  const auto line = [&](const char* label, auto of_series) {
    std::printf("%6s", label);
    for (const FlightColumn& column : flight_columns()) {
      std::vector<double> series;
      for (const FlightFigures& one : figures) series.push_back(column.of(one));
      std::printf("  %12s", in_words(column.format, of_series(series)).c_str());
    }
    std::printf("\n");
  };
  line("min", [](const std::vector<double>& s) { return *std::min_element(s.begin(), s.end()); });
  line("mean", [](const std::vector<double>& s) { return pinnquad::summarize(s).mean; });
  line("max", [](const std::vector<double>& s) { return *std::max_element(s.begin(), s.end()); });
}

/// The lines per seed as CSV, whole or not at all.
inline void write_flight_table(const std::string& path, const std::vector<FlightFigures>& figures) {
  std::vector<std::string> header = {"seed"};
  for (const FlightColumn& column : flight_columns()) header.push_back(column.name);
  std::vector<std::vector<double>> rows;
  for (const FlightFigures& one : figures) {
    std::vector<double> row = {static_cast<double>(one.seed)};
    for (const FlightColumn& column : flight_columns()) row.push_back(column.of(one));
    rows.push_back(std::move(row));
  }
  pinnquad::write_csv(path, header, rows);
}

}  // namespace programs
