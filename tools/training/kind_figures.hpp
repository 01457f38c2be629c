// SPDX-License-Identifier: MIT
// The figures of a judged kind by their names, for report.json, the printed table and the page: one list behind all
// three.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/evaluation/summary.hpp"
#include "training/judged_kinds.hpp"
#include "training/model_figures.hpp"

namespace programs {

/// Of a fit on a parting: means over the motors.
struct ErrorFigure {
  const char* name;   ///< in report.json
  const char* title;  ///< in tables
  const MotorFigures FlightErrors::*of;
};

inline constexpr std::array<ErrorFigure, 5> error_figures = {
    {{"r2", "R^2", &FlightErrors::r2},
     {"r2_flight_bias_removed", "R^2, a bias per flight removed", &FlightErrors::r2_flight_bias_removed},
     {"r2_start_bias_removed", "R^2, bias of the first 4 s removed", &FlightErrors::r2_start_bias_removed},
     {"rmse", "RMSE", &FlightErrors::root_mean_square},
     {"mean_absolute_error", "mean absolute error", &FlightErrors::mean_absolute}}};

inline std::vector<double> over_seeds(const JudgedKind& kind, const ErrorFigure& figure) {
  return per_seed(kind, [&](const JudgedFit& fit) { return mean_over_motors(fit.errors.*figure.of); });
}
inline std::vector<double> over_seeds(const JudgedKind& kind, const ErrorFigure& figure, std::size_t motor) {
  return per_seed(kind, [&](const JudgedFit& fit) { return (fit.errors.*figure.of)[motor]; });
}

/// The same with a bias of the past.
inline std::vector<double> over_seeds_adaptive(const JudgedKind& kind, const ErrorFigure& figure) {
  return per_seed(kind, [&](const JudgedFit& fit) { return mean_over_motors(fit.adaptive.*figure.of); });
}
/// Those that a bias of the past changes.
inline constexpr std::array<std::size_t, 3> adaptive_figures = {0, 3, 4};

/// A figure of the axes over the seeds, means over the partings.
inline std::vector<double> over_seeds(const JudgedKind& kind, const ModelFigure& figure, std::size_t axis) {
  return per_seed(kind, [&](const JudgedFit& fit) { return figure.of(fit.judged, axis); });
}

/// Its mean, of each axis.
inline AxisFigures axis_means(const JudgedKind& kind, double (*of)(const Judgement&, std::size_t axis)) {
  AxisFigures means{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    means[axis] = pinnquad::summarize(per_seed(kind, [&](const JudgedFit& fit) { return of(fit.judged, axis); })).mean;
  }
  return means;
}

/// False of a kind that does not look at the angular acceleration.
inline bool sees_acceleration(const JudgedKind& kind) {
  return std::any_of(kind.fits.begin(), kind.fits.end(),
                     [](const JudgedFit& fit) { return fit.judged.derivatives.sees_acceleration; });
}

inline const char* word_of(TimeReach reach) {
  switch (reach) {
    case TimeReach::present: return "present";
    case TimeReach::causal: return "causal";
    case TimeReach::centred: return "centred";
  }
  return "";
}

/// {"mean": .., "deviation": .., "per_seed": [..]}; what is not finite is null.
inline nlohmann::json described(const std::vector<double>& values) {
  const pinnquad::Summary summary = pinnquad::summarize(values);
  return {{"mean", summary.mean}, {"deviation", summary.deviation}, {"per_seed", values}};
}

}  // namespace programs
