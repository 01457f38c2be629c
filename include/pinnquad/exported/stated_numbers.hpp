// SPDX-License-Identifier: MIT
// The ranges of the numbers that a model states, one table for the compiler (a header) and for open() (a block), and
// the words of a refusal. A number outside its range is no measurement of a quadrotor, whatever a checksum says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "pinnquad/core/clock_time.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/exported/stated_bounds.hpp"
#include "pinnquad/model/predictor.hpp"

namespace pinnquad {

/// The longest lag of rotors that a model can state: a quadrotor whose rotors are slower can't hold its attitude.
inline constexpr double longest_lag_s = 1.0;

namespace detail {

/// A number that is refused of a model: a number, or what several say together.
enum class StatedNumber : std::uint8_t {
  none,
  layout,  ///< records that do not fit their place
  unknown_record,
  command_range,
  command_meaning,
  sample_period_s,
  lag_removed_s,
  window,
  verdict,
  affine,
  bias_time_constant_s,
  trust_distance_limit,
  trust_factor,
  trust_limit,
  trust_cleared,
  trust_period_s,
  trust_mean,
  trust_whitening,
  r_squared,
  judged_figures,
  seed,
  epochs,
  words,
  weight,
  scaler,
  deviation,
  border,  ///< of the envelope
  envelope,
  golden_command,
  golden_vector,
  contents,
  count
};

struct StatedRange {
  double least, most;  ///< of a lone number
  bool or_zero;        ///< 0 says that there is none
  const char* expected;
  const char* found;
};

/// Between which a time constant of a bias is one: a faster bias answers to noise and to its own change.
inline constexpr double shortest_bias_time_constant_s = 0.02, longest_bias_time_constant_s = 60;

inline namespace PINNQUAD_INSTRUCTION_SET {

/// The reach of a training (stated_bounds.hpp) bounds a norm of standardised features too.
inline constexpr double furthest_squared = furthest_deviations * furthest_deviations;
inline constexpr double no_bound = std::numeric_limits<double>::max();

/// In the order of StatedNumber. `found`: where no lone number is the fault.
inline constexpr StatedRange stated_ranges[] = {
    {0, 0, false, "", ""},
    {0, 0, false, "records that fit, each once", "others"},
    {0, 0, false, "records that are known", "a newer one"},
    // a command is a share of the full one, whatever it means; below 0 of a rotor that reverses
    {-1, 1, false, "a range of commands within -1 to 1, in order (record commands)", "another"},
    {0, 0, false, "a known meaning of the commands (record commands)", "another"},
    {1e-5, longest_clock_s, true, "a sample period of 0.00001 to 4 s, or 0 (record clock)", ""},
    {0, longest_lag_s, false, "a removed lag of 0 to 1 s (record clock, lag_removed_s)", ""},
    {0, 0, false, "a window of 1 tap or more, causal or not (record window)", "another"},
    {0, 0, false, "a verdict of two bits (record verdict)", "others"},
    {-no_bound, no_bound, false, "numbers of a linear schema (record affine)", "NaN or Inf"},
    {shortest_bias_time_constant_s, longest_bias_time_constant_s, true,
     "time constants of the bias of 0.02 to 60 s, or 0 (record bias)", ""},
    {1e-30, furthest_squared, false, "a limit of the squared distance above 0 (record trust, squared_distance_limit)",
     ""},
    {1e-30, 1, false, "a factor above 0, to 1 (record trust, command_residual_factor)", ""},
    // commands are 0 to 1: no mean error of theirs is above 1
    {1e-30, 1, false, "a limit above 0, to 1 (record trust, command_residual_limit)", ""},
    {1e-30, 1, false, "a number above 0, to the limit (record trust, command_residual_cleared)", ""},
    {1e-5, longest_clock_s, false, "a period of 0.00001 to 4 s (record trust, update_period_s)", ""},
    {0, 0, false, "a mean inside the envelope (record trust, distribution_mean)", "one outside of it"},
    {0, 0, false, "numbers, above 0 on the diagonal (record trust, whitening)", "others"},
    {-no_bound, 1, false, "an R^2 of at most 1 (record provenance)", "another"},
    {0, 0, false, "a verdict that its R^2 bear out (records verdict and provenance)", "another"},
    {0, 0, false, "a seed that is a whole number (record provenance)", "another"},
    {0, 0, false, "epochs that are a whole number, 0 or more (record provenance)", "another"},
    {0, 0, false, "names and values in turn (record provenance)", "others"},
    {0, 0, false, "weights that are numbers", "NaN or Inf"},
    {0, 0, false, "scalers of numbers", "NaN or Inf"},
    {0, 0, false, "standard deviations above 0", "another"},
    {0, 0, false, "an envelope of numbers", "NaN or Inf"},
    {0, 0, false, "an envelope about the features' mean, as far as their standard deviation lets a training reach",
     "another"},
    {0, 0, false, "golden commands that are numbers", "NaN or Inf"},
    {0, 0, false, "golden vectors of numbers inside the envelope", "one outside of it"},
    {0, 0, false, "contents of which its hash is", "others: it was edited after its export"},
};
static_assert(sizeof stated_ranges / sizeof stated_ranges[0] == std::size_t(StatedNumber::count));

/// A refusal; `number` none: nothing to refuse.
struct StatedFault {
  StatedNumber number = StatedNumber::none;
  double value = 0;  ///< the number found, where the table says nothing else
};

/// False for NaN.
template <StatedNumber number>
constexpr bool in_range(double value) noexcept {
  constexpr StatedRange range = stated_ranges[std::size_t(number)];
  return (range.or_zero && value >= 0 && value <= 0) || (value >= range.least && value <= range.most);
}

/// In order, and in range. False for NaN.
constexpr bool is_command_range(double lower, double upper) noexcept {
  return in_range<StatedNumber::command_range>(lower) && in_range<StatedNumber::command_range>(upper) && lower < upper;
}

/// Judged figures are rounded to this (deploy/provenance.hpp): closer ones are not told apart.
inline constexpr double figure_rounding = 1e-6;

/// `worse_than_mean` and `beats_linear_regression` against the R^2 that they are of.
constexpr bool bears_out(bool worse_than_mean, bool beats_linear_regression, double test_r_squared,
                         double linear_r_squared) noexcept {
  const double lead = test_r_squared - linear_r_squared;
  const bool close_to_mean = -figure_rounding <= test_r_squared && test_r_squared <= figure_rounding;
  const bool close_to_linear = -figure_rounding <= lead && lead <= figure_rounding;
  return (close_to_mean || worse_than_mean == (test_r_squared < 0)) &&
         (close_to_linear || beats_linear_regression == (lead > 0));
}

/// For numbers that are read when a program runs, and for constants.
struct FiniteNumber {
  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE bool operator()(const Scalar& value) const noexcept {
    return is_finite(value);
  }
};
struct FiniteConstant {
  template <class Scalar>
  constexpr bool operator()(Scalar value) const noexcept {
    return is_finite_constant(value);
  }
};
template <class IsFinite, class Scalar>
constexpr bool are_finite(const IsFinite& finite, const Scalar* numbers, std::size_t count) noexcept {
  bool sound = true;
  for (std::size_t i = 0; i < count; ++i) sound = finite(numbers[i]) && sound;
  return sound;
}
template <class Scalar>
constexpr bool are_positive(const Scalar* numbers, std::size_t count) noexcept {
  bool sound = true;
  for (std::size_t i = 0; i < count; ++i) sound = sound && numbers[i] > Scalar(0);
  return sound;
}

/// The numbers that every model has, of a header or a block: of `inputs` features, `outputs`, weights and golden
/// vectors. `features`, `commands`: pointers to those of golden vector i.
template <class IsFinite, class Scalar, class Features, class GoldenCommands>
constexpr StatedNumber fault_of_numbers(const IsFinite& finite, const Scales<Scalar>& scales, std::size_t inputs,
                                        std::size_t outputs, const Scalar* weights, std::size_t weight_count,
                                        const Features& features, const GoldenCommands& commands,
                                        std::size_t golden) noexcept {
  if (!are_finite(finite, weights, weight_count)) return StatedNumber::weight;
  if (!are_finite(finite, scales.input_mean, inputs) || !are_finite(finite, scales.input_deviation, inputs) ||
      !are_finite(finite, scales.output_mean, outputs) || !are_finite(finite, scales.output_deviation, outputs)) {
    return StatedNumber::scaler;
  }
  if (!are_finite(finite, scales.lower, inputs) || !are_finite(finite, scales.upper, inputs)) {
    return StatedNumber::border;
  }
  if (!are_positive(scales.input_deviation, inputs) || !are_positive(scales.output_deviation, outputs)) {
    return StatedNumber::deviation;
  }
  if (!is_envelope(scales.input_mean, scales.input_deviation, scales.lower, scales.upper, inputs)) {
    return StatedNumber::envelope;
  }
  for (std::size_t i = 0; i < golden; ++i) {
    if (!are_finite(finite, commands(i), std::size_t(rotor_count))) return StatedNumber::golden_command;
    if (!are_finite(finite, features(i), inputs) || !inside_envelope(scales.lower, features(i), scales.upper, inputs)) {
      return StatedNumber::golden_vector;
    }
  }
  return StatedNumber::none;
}

/// A triangle of numbers, stored column after column, whose diagonal is above 0.
template <class Scalar>
bool is_triangle(const Scalar* triangle, std::size_t size) noexcept {
  bool sound = true;
  for (std::size_t count = size; count > 0; triangle += count--) {
    sound = sound && are_finite(FiniteNumber{}, triangle, count) && triangle[0] > Scalar(0);
  }
  return sound;
}

/// Limits of trust (docs/trust.md), in the order of a block's record.
inline StatedFault fault_of_trust(const double (&limits)[5]) noexcept {
  constexpr auto first = static_cast<unsigned>(StatedNumber::trust_distance_limit);
  const bool sound[] = {in_range<StatedNumber::trust_distance_limit>(limits[0]),
                        in_range<StatedNumber::trust_factor>(limits[1]), in_range<StatedNumber::trust_limit>(limits[2]),
                        in_range<StatedNumber::trust_cleared>(limits[3]) && limits[3] <= limits[2],
                        in_range<StatedNumber::trust_period_s>(limits[4])};
  for (unsigned i = 0; i < 5; ++i) {
    if (!is_finite(limits[i]) || !sound[i]) return {static_cast<StatedNumber>(first + i), limits[i]};
  }
  return {};
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
