// SPDX-License-Identifier: MIT
// The terms of a training that header, block and trainer hash and compare: frames, motor order, window, allocation,
// descriptions of types.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/model/description.hpp"
#include "pinnquad/outputs/base.hpp"

namespace pinnquad {

/// The frames of every feature set.
inline constexpr const char* model_frame = "body FRD, world NED";

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
/// Torque signs of an airframe that is a type.
template <class Vehicle>
constexpr detail::TorqueSigns motor_torque_signs() noexcept {
  return motor_torque_signs(Vehicle::template value<double>());
}

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

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

constexpr std::uint32_t nanoseconds(double seconds) noexcept { return static_cast<std::uint32_t>(seconds * 1e9 + 0.5); }
constexpr double seconds_of(std::uint32_t nanoseconds) noexcept { return nanoseconds / 1e9; }

constexpr bool same_period_ns(std::uint32_t a, std::uint32_t b) noexcept {
  const std::uint32_t difference = a < b ? b - a : a - b;
  return difference <= b / std::uint32_t(1.0 / period_tolerance);
}

/// Numbers in the lower triangle of a Size x Size matrix.
constexpr std::size_t triangle(std::size_t size) noexcept { return size * (size + 1) / 2; }

template <class M>
constexpr bool same_header_allocation() noexcept {
  constexpr AllocationMatrix<double> expected = allocation(M::Vehicle::template value<double>());
  return same_allocation<double>([](std::size_t row, std::size_t column) { return double(M::allocation[row][column]); },
                                 [&](std::size_t row, std::size_t column) { return expected[row][column]; });
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail
}  // namespace pinnquad
