// SPDX-License-Identifier: MIT
// The figures of a judged kind by their names, for report.json, the printed table and the page: one list behind all
// three.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/evaluation/summary.hpp"
#include "training/log_judgement.hpp"

namespace programs {

/// Of a fit on a parting: means over the motors.
struct LogFigure {
  const char* name;   ///< in report.json
  const char* title;  ///< in tables
  const MotorFigures LogErrors::*of;
};

inline constexpr std::array<LogFigure, 5> log_figures = {
    {{"r2", "R^2", &LogErrors::r2},
     {"r2_flight_bias_removed", "R^2, a bias per flight removed", &LogErrors::r2_flight_bias_removed},
     {"r2_start_bias_removed", "R^2, bias of the first 4 s removed", &LogErrors::r2_start_bias_removed},
     {"rmse", "RMSE", &LogErrors::root_mean_square},
     {"mean_absolute_error", "mean absolute error", &LogErrors::mean_absolute}}};

inline std::vector<double> over_seeds(const JudgedKind& kind, const LogFigure& figure) {
  return per_seed(kind, [&](const JudgedFit& fit) { return mean_over_motors(fit.errors.*figure.of); });
}
inline std::vector<double> over_seeds(const JudgedKind& kind, const LogFigure& figure, std::size_t motor) {
  return per_seed(kind, [&](const JudgedFit& fit) { return (fit.errors.*figure.of)[motor]; });
}

/// Slopes over all fits of a kind: the worst of them.
struct KindSlopes {
  bool applicable = false;
  std::array<double, 3> wrong_share{};  ///< mean over the fits
  std::array<double, 3> least{};        ///< least of the fits
  std::array<double, 3> median{};       ///< mean over the fits
};

inline KindSlopes slopes_of(const JudgedKind& kind) {
  KindSlopes result;
  for (std::size_t i = 0; i < kind.fits.size(); ++i) {
    const LogSlopes& slopes = kind.fits[i].slopes;
    result.applicable = result.applicable || slopes.applicable;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = 1.0 / static_cast<double>(kind.fits.size());
      result.wrong_share[axis] += share * slopes.wrong_share[axis];
      result.median[axis] += share * slopes.median[axis];
      if (i == 0 || !(slopes.least[axis] >= result.least[axis])) result.least[axis] = slopes.least[axis];
    }
  }
  return result;
}

/// Signs of pairs of rows that follow each other: means over the fits.
inline PairSigns pair_signs_of(const JudgedKind& kind) {
  PairSigns result{{}, {}, {}, {}};
  for (const JudgedFit& fit : kind.fits) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = 1.0 / static_cast<double>(kind.fits.size());
      for (AxisFigures PairSigns::*const of :
           {&PairSigns::all, &PairSigns::of_flown, &PairSigns::large, &PairSigns::large_of_flown}) {
        (result.*of)[axis] += share * (fit.pairs.*of)[axis];
      }
    }
  }
  return result;
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
