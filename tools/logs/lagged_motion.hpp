// SPDX-License-Identifier: MIT
// How much of a vehicle's motion its commands explain if they act some rows later, lag by lag.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "logs/specific_force.hpp"
#include "pinnquad/data/dataset.hpp"

namespace programs::detail {

inline constexpr std::size_t lag_motions = 4;  ///< angular acceleration about x, y, z; specific force along z

/// One segment as series: four commands, three body rates, four motions.
struct LagSeries {
  std::array<std::vector<double>, pinnquad::rotor_count> commands;
  std::array<std::vector<double>, 3> rates;
  std::array<std::vector<double>, lag_motions> motions;

  std::size_t size() const noexcept { return rates[0].size(); }
};

inline std::vector<LagSeries> lag_series(const std::vector<pinnquad::Flight>& segments) {
  std::vector<LagSeries> all(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (const pinnquad::Sample& sample : segments[i]) {
      LagSeries& one = all[i];
      for (std::size_t k = 0; k < pinnquad::rotor_count; ++k) one.commands[k].push_back(sample.commands[k]);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        one.rates[k].push_back(sample.body_rates_rad_s[axis]);
        one.motions[k].push_back(sample.angular_acceleration_rad_s2[axis]);
      }
      one.motions[3].push_back(specific_force_m_s2(sample)[2]);
    }
  }
  return all;
}

/// y' = (x - y) / tau with x held over a period: a first-order lag, exactly.
inline void apply_first_order_lag(std::vector<double>& series, double period_s, double time_constant_s) {
  if (series.empty() || !(time_constant_s > 0)) return;
  const double share = 1 - std::exp(-period_s / time_constant_s);
  double state = series.front();
  for (double& value : series) value = state += share * (value - state);
}

/// Twice forward, twice backward: no phase, half the amplitude at about 0.64 of the corner.
inline void low_pass_without_phase(std::vector<double>& series, double period_s, double corner_Hz) {
  constexpr double tau = 6.283185307179586;
  for (int pass = 0; pass < 4; ++pass) {
    apply_first_order_lag(series, period_s, 1 / (tau * corner_Hz));
    std::reverse(series.begin(), series.end());
  }
}

inline std::vector<LagSeries> low_passed(std::vector<LagSeries> all, double period_s, double corner_Hz) {
  for (LagSeries& one : all) {
    for (auto& series : one.commands) low_pass_without_phase(series, period_s, corner_Hz);
    for (auto& series : one.rates) low_pass_without_phase(series, period_s, corner_Hz);
    for (auto& series : one.motions) low_pass_without_phase(series, period_s, corner_Hz);
  }
  return all;
}

/// R^2 of each motion by the commands, beyond what a constant and the body rates explain.
using Explained = std::array<double, lag_motions>;

inline constexpr std::size_t lag_columns = 1 + pinnquad::rotor_count + 3 + lag_motions;
using LagMoments = std::array<std::array<double, lag_columns>, lag_columns>;

inline Explained explained_beyond_rates(LagMoments moments) {
  constexpr double rank_threshold = 1e-9;
  constexpr std::size_t first_motion = 1 + pinnquad::rotor_count + 3;
  const LagMoments whole = moments;
  LagMoments centred{};
  const auto take = [&](std::size_t k) {
    const double pivot = moments[k][k], scale = k == 0 ? whole[k][k] : centred[k][k];
    if (!(pivot > rank_threshold * scale)) return;
    const auto row = moments[k];
    for (std::size_t i = 0; i < lag_columns; ++i) {
      const double factor = moments[i][k] / pivot;
      for (std::size_t j = 0; j < lag_columns; ++j) moments[i][j] -= factor * row[j];
    }
  };
  take(0);
  centred = moments;
  for (std::size_t k = 1 + pinnquad::rotor_count; k < first_motion; ++k) take(k);
  Explained before{}, result{};
  for (std::size_t m = 0; m < lag_motions; ++m) before[m] = moments[first_motion + m][first_motion + m];
  for (std::size_t k = 1; k <= pinnquad::rotor_count; ++k) take(k);
  for (std::size_t m = 0; m < lag_motions; ++m) {
    const double of = whole[first_motion + m][first_motion + m];
    if (!(before[m] > 1e-12 * of)) continue;
    result[m] = std::clamp(1 - moments[first_motion + m][first_motion + m] / before[m], 0.0, 1.0);
  }
  return result;
}

/// For each lag of `first` to `last` rows (commands that many rows before the motion; `first` may be negative), all
/// over the same rows, at most about `most_rows` of them. `rows`: how many.
inline std::vector<Explained> explained_by_lag(const std::vector<LagSeries>& all, int first, int last, int stride,
                                               std::size_t& rows) {
  constexpr std::size_t most_rows = 8000;
  const auto ahead = static_cast<std::size_t>(std::max(last, 0)),
             behind = static_cast<std::size_t>(std::max(-first, 0));
  std::size_t whole = 0;
  for (const LagSeries& one : all) whole += one.size() > ahead + behind ? one.size() - ahead - behind : 0;
  const std::size_t step = std::max<std::size_t>(1, whole / most_rows);
  std::vector<Explained> result;
  for (int lag = first; lag <= last; lag += stride) {
    LagMoments moments{};
    rows = 0;
    for (const LagSeries& one : all) {
      for (std::size_t row = ahead; row + behind < one.size(); row += step) {
        std::array<double, lag_columns> x{};
        std::size_t column = 0;
        x[column++] = 1;
        const auto commanded = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(row) - lag);
        for (const auto& series : one.commands) x[column++] = series[commanded];
        for (const auto& series : one.rates) x[column++] = series[row];
        for (const auto& series : one.motions) x[column++] = series[row];
        for (std::size_t i = 0; i < lag_columns; ++i) {
          for (std::size_t j = i; j < lag_columns; ++j) moments[i][j] += x[i] * x[j];
        }
        rows += 1;
      }
    }
    for (std::size_t i = 0; i < lag_columns; ++i) {
      for (std::size_t j = 0; j < i; ++j) moments[i][j] = moments[j][i];
    }
    result.push_back(rows > lag_columns ? explained_beyond_rates(moments) : Explained{});
  }
  return result;
}

}  // namespace programs::detail
