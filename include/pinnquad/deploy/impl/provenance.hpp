// SPDX-License-Identifier: MIT
// Bodies of provenance.hpp.
#pragma once

#include "pinnquad/deploy/provenance.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY double stated_figure(double value) {
  constexpr double digits = 1e6;
  return std::abs(value) < digits ? std::round(value * digits) / digits : value;
}

PINNQUAD_BODY void require_provenance(const Provenance& from, double window_s, std::size_t inputs,
                                      std::size_t outputs) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("export: " + what); };
  if (!is_command_range(from.command_lower, from.command_upper)) {
    refuse("the range of the commands is none, or beyond -1 to 1");
  }
  if (!in_range<StatedNumber::sample_period_s>(from.sample_period_s)) {
    refuse("the sample period is not one of 0 to 4 s, or below 0.00001 s");
  }
  if (!in_range<StatedNumber::lag_removed_s>(from.lag_removed_s)) refuse("the lag removed is not one of 0 to 1 s");
  if (window_s > 0 && from.sample_period_s > 0 && !same_period(from.sample_period_s, window_s)) {
    refuse("the sample period is not that of the features' window");
  }
  if (const auto& range = from.residual_range) {
    if (range->lower.size() != outputs || range->upper.size() != outputs) {
      refuse("the range of a residual is not one of bounds for every output");
    }
    require_finite(range->lower, "the lower bounds of the residual");
    require_finite(range->upper, "the upper bounds of the residual");
    for (std::size_t i = 0; i < outputs; ++i) {
      if (!(range->lower[i] <= range->upper[i])) refuse("a lower bound of the residual lies above the upper one");
    }
  }
  if (from.bias_time_constants_s && !are_bias_time_constants(*from.bias_time_constants_s)) {
    bool fast = true;
    for (const double time_s : *from.bias_time_constants_s) {
      fast = fast && time_s >= 0 && time_s <= longest_bias_time_constant_s;
    }
    refuse(fast ? "a time constant of the bias is below 0.02 s"
                : "a time constant of the bias is not one of 0 to 60 s");
  }
  if (const auto& distance = from.distance) {
    if (distance->mean.size() != inputs || distance->inverse_cholesky.size() != triangle(inputs)) {
      refuse("the statistics of a distance are not those of " + std::to_string(inputs) + " features");
    }
    require_finite(distance->mean, "the means of the distance");
    require_finite(distance->inverse_cholesky, "the triangle of the distance");
    if (!in_range<StatedNumber::distance_limit>(distance->limit)) {
      refuse("the limit of the distance is no number above 0 to 131072");
    }
  }
}

}  // namespace detail
}  // namespace pinnquad
