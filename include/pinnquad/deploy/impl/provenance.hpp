// SPDX-License-Identifier: MIT
// Bodies of provenance.hpp.
#pragma once

#include <algorithm>

#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY double stated_figure(double value) {
  constexpr double digits = 1e6;
  return std::abs(value) < digits ? std::round(value * digits) / digits : value;
}

PINNQUAD_BODY ModelFacts facts_of(const Provenance& from, const Airframe<double>& airframe) {
  ModelFacts facts;
  facts.command_meaning = from.command_meaning.value_or(command_meaning_of(airframe));
  facts.command_lower = from.command_lower;
  facts.command_upper = from.command_upper;
  facts.sample_period_s = from.sample_period_s;
  facts.lag_removed_s = from.lag_removed_s;
  if (const auto& verdict = from.verdict) {
    facts.has_verdict = true;
    facts.worse_than_mean = verdict->worse_than_mean();
    facts.beats_linear_regression = verdict->beats_linear_regression();
    facts.has_r_squared = is_finite(verdict->test_r_squared);
    if (facts.has_r_squared) facts.test_r_squared = stated_figure(verdict->test_r_squared);
    const double linear = verdict->linear_regression_r_squared;
    if (is_finite(linear)) facts.linear_regression_r_squared = stated_figure(linear);
  }
  if (from.bias_time_constants_s) {
    facts.has_bias = true;
    std::copy_n(from.bias_time_constants_s->begin(), 4, static_cast<double*>(facts.bias_time_constants_s));
  }
  return facts;
}

PINNQUAD_BODY void require_sound(const ModelFacts& facts) {
  const StatedFault fault = fault_of(facts, FiniteNumber{});
  if (fault.number == StatedNumber::none) return;
  const StatedRange& range = stated_ranges[static_cast<std::size_t>(fault.number)];
  throw std::invalid_argument(std::string("export: expected ") + range.expected + ", found " +
                              (*range.found == 0 ? number_text(fault.value) : range.found));
}

PINNQUAD_BODY void take_provenance(WrittenRecords& records, const Provenance& from, double window_s) {
  static_cast<Provenance&>(records) = from;
  if (records.certificate && !records.certificate->proven()) {
    throw std::invalid_argument(records.certificate->bounded ? "export: a slope of the model is not above its floor"
                                                             : "export: the bounds of the residual are none");
  }
  records.facts = facts_of(from, records.airframe);
  require_sound(records.facts);
  if (window_s <= 0) return;
  if (from.sample_period_s > 0 && !same_period(from.sample_period_s, window_s)) {
    throw std::invalid_argument("export: the sample period is not that of the features' window");
  }
  records.facts.sample_period_s = window_s;
}

}  // namespace detail
}  // namespace pinnquad
