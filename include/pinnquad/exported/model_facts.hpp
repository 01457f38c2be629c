// SPDX-License-Identifier: MIT
// The facts of a model: numbers that it says of itself beside its arrays. They are made of a header's constants
// (exported/model.hpp), of a block's records (exported/block_records.hpp) or of a training (deploy/provenance.hpp), and
// checked here, once for all of them.
#pragma once

#include "pinnquad/core/detected.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/exported/stated_numbers.hpp"

namespace pinnquad::detail {

/// As made: commands of thrust in 0 to 1, and nothing else is said.
struct ModelFacts {
  CommandMeaning command_meaning = CommandMeaning::thrust;
  double command_lower = 0;  ///< the range that commands were given in
  double command_upper = 1;
  double sample_period_s = 0;    ///< of the flights, that of the features' window where there is one; 0: not said
  double lag_removed_s = 0;      ///< of the rotors, taken out of the commands before the training
  bool has_verdict = false;      ///< the next two are said
  bool worse_than_mean = false;  ///< than the mean of the commands, and exported all the same
  bool beats_linear_regression = false;
  bool has_r_squared = false;                      ///< the next one is said
  double test_r_squared = 0;                       ///< mean over the commands, on rows that it was not trained on
  double linear_regression_r_squared = -no_bound;  ///< as made: not said, any model beats it
  bool has_bias = false;                           ///< the next is said
  double bias_time_constants_s[4]{};               ///< sum by sum, of a bias learnt in flight; 0: none of this sum
};

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The first fault of a model's facts. `finite`: FiniteConstant for the compiler, FiniteNumber when a program runs.
template <class IsFinite>
constexpr StatedFault fault_of(const ModelFacts& facts, const IsFinite& finite) noexcept {
  using Number = StatedNumber;
  if (!finite(facts.command_lower) || !finite(facts.command_upper) ||
      !is_command_range(facts.command_lower, facts.command_upper)) {
    return {Number::command_range};
  }
  if (!finite(facts.sample_period_s) || !in_range<Number::sample_period_s>(facts.sample_period_s)) {
    return {Number::sample_period_s, facts.sample_period_s};
  }
  if (!finite(facts.lag_removed_s) || !in_range<Number::lag_removed_s>(facts.lag_removed_s)) {
    return {Number::lag_removed_s, facts.lag_removed_s};
  }
  const double figures[] = {facts.test_r_squared, facts.linear_regression_r_squared};
  for (const double figure : figures) {
    if (!finite(figure) || !in_range<Number::r_squared>(figure)) return {Number::r_squared, figure};
  }
  if (facts.has_verdict && facts.has_r_squared &&
      !bears_out(facts.worse_than_mean, facts.beats_linear_regression, facts.test_r_squared,
                 facts.linear_regression_r_squared)) {
    return {Number::judged_figures};
  }
  for (const double time_s : facts.bias_time_constants_s) {
    if (!finite(time_s) || !in_range<Number::bias_time_constant_s>(time_s)) {
      return {Number::bias_time_constant_s, time_s};
    }
  }
  return {};
}

template <class M>
using StatedVerdictOf = std::void_t<decltype(M::worse_than_mean), decltype(M::beats_linear_regression)>;
template <class M>
using TestFigureOf = decltype(double{M::test_r_squared});
template <class M>
using LinearFigureOf = decltype(double{M::linear_regression_r_squared});
template <class M>
using BiasTimeConstantsOf = decltype(M::bias_time_constants_s);

/// The facts of an exported header.
template <class M>
constexpr ModelFacts facts_of_header() noexcept {
  ModelFacts facts;
  facts.command_meaning = M::command_meaning;
  facts.command_lower = M::command_lower;
  facts.command_upper = M::command_upper;
  facts.sample_period_s = M::sample_period_s;
  facts.lag_removed_s = M::lag_removed_s;
  if constexpr (is_detected<StatedVerdictOf, M>) {
    facts.has_verdict = true;
    facts.worse_than_mean = M::worse_than_mean;
    facts.beats_linear_regression = M::beats_linear_regression;
  }
  if constexpr (is_detected<TestFigureOf, M>) {
    facts.has_r_squared = true;
    facts.test_r_squared = M::test_r_squared;
  }
  if constexpr (is_detected<LinearFigureOf, M>) facts.linear_regression_r_squared = M::linear_regression_r_squared;
  if constexpr (is_detected<BiasTimeConstantsOf, M>) {
    facts.has_bias = true;
    for (std::size_t i = 0; i < 4; ++i) facts.bias_time_constants_s[i] = double{M::bias_time_constants_s[i]};
  }
  return facts;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
