// SPDX-License-Identifier: MIT
// The records of a header, in which terms it was trained: each is compared with the model's types. `records` names
// those that a reader must understand; it may ignore any other constant.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/exported/model_agreement.hpp"
#include "pinnquad/exported/stated_numbers.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/model/description.hpp"
#include "pinnquad/outputs/base.hpp"

namespace pinnquad {

/// The mandatory records that this library knows. A header that names another one does not compile.
inline constexpr std::array<std::string_view, 7> known_records = {
    "answer",      // what the parameters are of: `answer`, a description
    "commands",    // `command_meaning`, `command_lower`, `command_upper`: of the commands that it was trained towards
    "clock",       // `sample_period_s` of its flights or window, 0 if not said; `lag_removed_s`
    "window",      // `window_taps` (1: the present alone), `causal`
    "columns",     // `column_names`, `column_units`
    "allocation",  // `allocation`: Eq. (2) at the rated density
    "base"};       // `base`: a description of what the outputs add to, "" if to nothing

namespace detail {
/// Row = rotor, in the order of the commands.
using TorqueSigns = std::array<std::array<int, 3>, rotor_count>;
}  // namespace detail

/// The motor order as data: how each rotor's command enters the torques about FRD x, y and z (roll, pitch, yaw), -1, 0
/// or 1. Row = rotor, in the order of the commands.
constexpr detail::TorqueSigns motor_torque_signs(const Airframe<double>& airframe) noexcept {
  detail::TorqueSigns result{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto signs = allocation_signs(airframe, static_cast<int>(axis));
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) result[rotor][axis] = static_cast<int>(signs[rotor]);
  }
  return result;
}
/// Of an airframe that is a type.
template <class Vehicle>
constexpr detail::TorqueSigns motor_torque_signs() noexcept {
  return motor_torque_signs(Vehicle::template value<double>());
}

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Numbers, texts, and arrays of them or of arrays.
template <class Value, class Other>
constexpr bool same_values(const Value& a, const Other& b) noexcept {
  if constexpr (std::is_convertible_v<Value, std::string_view>) {
    return std::string_view(a) == b;
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return a == b;
  } else {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!same_values(a[i], b[i])) return false;
    }
    return true;
  }
}

template <class Array>
constexpr bool all_finite_constants(const Array& values) noexcept {
  for (const auto& value : values) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      if (!is_finite_constant(value)) return false;
    } else {
      if (!all_finite_constants(value)) return false;
    }
  }
  return true;
}

/// A description's letters, without spaces: what a header and a block are compared with, made by the compiler.
template <std::size_t Most>
struct DescriptionLetters : LetterSink<DescriptionLetters<Most>> {
  char text[Most + 1] = {};
  std::size_t count = 0;

  constexpr void take(char c) noexcept { text[count++] = c; }
};
/// The most letters that a description has.
struct DescriptionLength {
  std::size_t letters = 0;
  constexpr void add(std::string_view text) noexcept { letters += text.size(); }
  constexpr void add(int number) noexcept { letters += number >= 10 ? 10 : 1; }
};
template <class T>
constexpr std::size_t description_length() noexcept {
  DescriptionLength length;
  describe<T>(length);
  return length.letters;
}
template <class T>
constexpr auto description_letters() noexcept {
  DescriptionLetters<description_length<T>()> letters;
  describe<T>(letters);
  return letters;
}

/// A description's letters against a text of chars or bytes; spaces don't count.
template <class Byte>
constexpr bool same_letters(const char* letters, std::size_t count, const Byte* text, std::size_t length) noexcept {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < length; ++i) {
    const char letter = static_cast<char>(text[i]);
    if (letter == ' ') continue;
    if (seen == count || letter != letters[seen]) return false;
    ++seen;
  }
  return seen == count;
}

/// True for the text of T's description (model/description.hpp).
template <class T>
constexpr bool describes(std::string_view text) noexcept {
  constexpr auto letters = description_letters<T>();
  return same_letters(letters.text, letters.count, text.data(), text.size());
}

/// The instants that a feature set sees.
struct PresentAlone {
  static constexpr int taps = 1;
  static constexpr bool causal = true;
  static constexpr double period_s = 0.0;  ///< no period
};
template <class Features, class = void>
struct WindowOf : PresentAlone {};
template <class Features>
struct WindowOf<Features, std::void_t<typename Features::Window>> : Features::Window {};

/// Two periods count as one if they differ by no more than this share: clocks are measured.
inline constexpr double period_tolerance = 0.01;

constexpr bool same_period(double a, double b) noexcept {
  const double difference = a < b ? b - a : a - b;
  return difference <= period_tolerance * b;
}

/// Entries of two allocations count as one if they differ by no more than this share of the largest of their row: what
/// a float's rounding makes of their products.
inline constexpr double allocation_tolerance = 4e-6;

/// Entries `get(row, column)` against those expected.
template <class Scalar, class Get, class Expected>
constexpr bool same_allocation(const Get& get, const Expected& expected) noexcept {
  constexpr std::size_t rows = 4, columns = static_cast<std::size_t>(rotor_count);
  for (std::size_t row = 0; row < rows; ++row) {
    Scalar largest(0);
    for (std::size_t column = 0; column < columns; ++column) {
      const Scalar entry = expected(row, column);
      const Scalar magnitude = entry < Scalar(0) ? -entry : entry;
      largest = magnitude > largest ? magnitude : largest;
    }
    for (std::size_t column = 0; column < columns; ++column) {
      const Scalar difference = get(row, column) - expected(row, column);
      const Scalar magnitude = difference < Scalar(0) ? -difference : difference;
      if (!(magnitude <= Scalar(allocation_tolerance) * largest)) return false;
    }
  }
  return true;
}

template <class M>
constexpr bool knows_records() noexcept {
  for (const char* name : M::records) {
    bool known = false;
    for (const std::string_view record : known_records) known = known || record == name;
    if (!known) return false;
  }
  return true;
}

template <class M>
using RecordsOf =
    std::void_t<decltype(M::records), decltype(M::answer), decltype(CommandMeaning{M::command_meaning}),
                decltype(M::command_lower), decltype(M::command_upper), decltype(M::sample_period_s),
                decltype(M::lag_removed_s), decltype(M::window_taps), decltype(M::causal), decltype(M::column_names),
                decltype(M::column_units), decltype(M::allocation), decltype(M::base)>;
template <class M>
using StatedVerdictOf = std::void_t<decltype(M::worse_than_mean), decltype(M::beats_linear_regression)>;

/// Optional constants:
///   slope_signs                     of du_i/d(angular acceleration), rotor by rotor about x, y, z; 0: not proven
///   residual_lower, residual_upper  the bounds of a residual's outputs
///   distance_mean, distance_inverse_cholesky, distance_limit: z = L^-1 (x - mean), rows of the triangle one after the
///     other; |z| no larger than the limit is near the training features
///   bias_time_constants_s           sum by sum (of all commands, about roll, pitch, yaw): of the bias that an inverse
///     learns in flight (control/motion_bias.hpp), 0: none of this sum. It may be edited: no hash is over it
template <class M>
using SlopeSignsOf = decltype(M::slope_signs);
template <class M>
using ResidualRangeOf = std::void_t<decltype(M::residual_lower), decltype(M::residual_upper)>;
template <class M>
using BiasTimeConstantsOf = decltype(M::bias_time_constants_s);
template <class M>
using DistanceStatisticsOf =
    std::void_t<decltype(M::distance_mean), decltype(M::distance_inverse_cholesky), decltype(M::distance_limit)>;

constexpr std::uint32_t nanoseconds(double seconds) noexcept { return static_cast<std::uint32_t>(seconds * 1e9 + 0.5); }
/// The double nearest to it, under any maths: contents_hash is over its bits. A compiler that may rearrange maths, as
/// PX4's is, makes a division by a constant a product, whose last bit is another; it does not know a volatile's value.
inline double seconds_of(std::uint32_t nanoseconds) noexcept {
  const volatile double per_second = 1e9;
  return nanoseconds / per_second;
}

constexpr bool same_period_ns(std::uint32_t a, std::uint32_t b) noexcept {
  const std::uint32_t difference = a < b ? b - a : a - b;
  return difference <= b / std::uint32_t(1.0 / period_tolerance);
}

/// True for four times that are one each; false for NaN.
template <class Times>
constexpr bool are_bias_time_constants(const Times& times_s) noexcept {
  return all_in_range<StatedNumber::bias_time_constant_s>(times_s, 4);
}
/// Numbers in the lower triangle of a Size x Size matrix.
constexpr std::size_t triangle(std::size_t size) noexcept { return size * (size + 1) / 2; }

template <class M>
constexpr bool same_header_allocation() noexcept {
  constexpr AllocationMatrix<double> expected = allocation(M::Vehicle::template value<double>());
  return same_allocation<double>([](std::size_t row, std::size_t column) { return double(M::allocation[row][column]); },
                                 [&](std::size_t row, std::size_t column) { return expected[row][column]; });
}

/// Of an answer whose structure says them.
template <class M>
constexpr bool true_slope_signs() noexcept {
  if constexpr (!StatedStructure<typename M::Network>::known) return true;
  const TorqueSigns signs = motor_torque_signs<typename M::Vehicle>();
  for (std::size_t rotor = 0; rotor < signs.size(); ++rotor) {
    for (std::size_t axis = 0; axis < signs[rotor].size(); ++axis) {
      if (!true_slope_sign(M::slope_signs[rotor][axis], signs[rotor][axis])) return false;
    }
  }
  return true;
}

/// The stated range of a residual is in order, and that of its parameters where their answer has bounds.
template <class M>
constexpr bool true_residual_range() noexcept {
  for (std::size_t i = 0; i < M::residual_lower.size(); ++i) {
    if (!(M::residual_lower[i] <= M::residual_upper[i])) return false;
  }
  using Structure = StatedStructure<typename M::Network>;
  if constexpr (Structure::known) {
    const typename M::Scalar* bounds = nullptr;
    if constexpr (Structure::at >= 0) bounds = M::parameters.data() + Structure::at;
    return same_residual_range(M::residual_lower.data(), M::residual_upper.data(), Structure::at >= 0, bounds,
                               M::output.standard_deviation.data(), M::residual_lower.size());
  } else {
    return true;
  }
}

template <class M>
constexpr void require_optional_records() noexcept {
  if constexpr (is_detected<SlopeSignsOf, M>) {
    constexpr bool three = M::slope_signs.size() == std::size_t(rotor_count) && M::slope_signs[0].size() == 3;
    static_assert(three, "pinnquad: the model's slope signs are not three per rotor (slope_signs)");
    if constexpr (three) {
      static_assert(true_slope_signs<M>(),
                    "pinnquad: a slope sign of the model is not that of the torque that its Vehicle's rotor makes "
                    "(slope_signs)");
    }
  }
  if constexpr (is_detected<ResidualRangeOf, M>) {
    constexpr bool numbers = M::residual_lower.size() == std::size_t(M::Network::outputs) &&
                             M::residual_upper.size() == std::size_t(M::Network::outputs) &&
                             all_finite_constants(M::residual_lower) && all_finite_constants(M::residual_upper);
    static_assert(numbers,
                  "pinnquad: the model's range of a residual is not one of numbers per output (residual_lower)");
    if constexpr (numbers) {
      static_assert(true_residual_range<M>(),
                    "pinnquad: the model's range of a residual is upside down, or not that of the bounds among its "
                    "parameters (residual_lower, residual_upper)");
    }
  }
  if constexpr (is_detected<BiasTimeConstantsOf, M>) {
    constexpr bool four = M::bias_time_constants_s.size() == 4;
    static_assert(four, "pinnquad: the model's time constants of a bias are not four (bias_time_constants_s)");
    if constexpr (four) {
      static_assert(are_bias_time_constants(M::bias_time_constants_s),
                    "pinnquad: a time constant of the model's bias is no time of 0 to 60 s that a bias can have: 0 "
                    "(none of this sum), or 0.02 s and more (bias_time_constants_s)");
    }
  }
  if constexpr (is_detected<DistanceStatisticsOf, M>) {
    constexpr auto size = static_cast<std::size_t>(M::Features::size);
    constexpr bool numbers = M::distance_mean.size() == size && M::distance_inverse_cholesky.size() == triangle(size) &&
                             all_finite_constants(M::distance_mean) &&
                             all_finite_constants(M::distance_inverse_cholesky) &&
                             in_range<StatedNumber::distance_limit>(static_cast<double>(M::distance_limit));
    static_assert(
        numbers,
        "pinnquad: the model's statistics of a distance don't have the length of the feature set, or hold what "
        "is no number (distance_mean)");
    if constexpr (numbers) {
      static_assert(
          inside_envelope(M::envelope_lower.data(), M::distance_mean.data(), M::envelope_upper.data(), size) &&
              is_triangle(FiniteConstant{}, M::distance_inverse_cholesky.data(), size, false),
          "pinnquad: the model's statistics of a distance have a mean outside the envelope, or a diagonal that "
          "is not above 0 (distance_mean, distance_inverse_cholesky)");
    }
  }
}

/// Compares the records of a header with its types.
template <class M>
constexpr void require_records() noexcept {
  static_assert(knows_records<M>(),
                "pinnquad: the model has a record that must be understood and that this pinnquad does not know "
                "(records); update the library");
  using Window = WindowOf<typename M::Features>;
  static_assert(describes<typename M::Network>(M::answer),
                "pinnquad: the model's parameters are of another answer than its Network now is (answer)");
  static_assert(is_command_range(M::command_lower, M::command_upper),
                "pinnquad: the range of the model's commands is none, or beyond -1 to 1: a command is a share of the "
                "full one (command_lower, command_upper)");
  static_assert(in_range<StatedNumber::sample_period_s>(M::sample_period_s) &&
                    in_range<StatedNumber::lag_removed_s>(M::lag_removed_s),
                "pinnquad: the model's sample period or removed lag is no time of 0 to 4 s that it can be: a period "
                "is 0 (not said) or 0.00001 s and more, a lag 1 s at most (sample_period_s, lag_removed_s)");
  static_assert(M::window_taps == Window::taps && M::causal == Window::causal,
                "pinnquad: the model has another window than its feature set now has (window_taps, causal)");
  static_assert(Window::period_s <= 0.0 || same_period(M::sample_period_s, Window::period_s),
                "pinnquad: the model's sample period is another than its window's (sample_period_s)");
  static_assert(
      same_values(M::column_names, extra_column_names<typename M::Features>) &&
          same_values(M::column_units, extra_column_units<typename M::Features>),
      "pinnquad: the model has other extra columns than its feature set now has (column_names, column_units)");
  static_assert(same_header_allocation<M>(),
                "pinnquad: the model was trained for another allocation than its Vehicle now has (allocation)");
  static_assert(describes<typename BaseOf<typename M::Outputs>::type>(M::base),
                "pinnquad: the model's outputs add to another base than its output schema's (base)");
  require_optional_records<M>();
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
