// SPDX-License-Identifier: MIT
// Features that a formula reads out of X, each by its place, name and unit: a feature set that has another one there is
// refused by the compiler. A formula says so in `reads`, a constexpr array of ReadFeature.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

namespace pinnquad {

/// A feature that a formula reads.
struct ReadFeature {
  int place;  ///< in X
  const char* name;
  const char* unit;
};

namespace detail {

template <class Formula, class = void>
struct SaysWhatItReads : std::false_type {};
template <class Formula>
struct SaysWhatItReads<Formula, std::void_t<decltype(Formula::reads)>> : std::true_type {};

/// A feature that the angular acceleration moves is among those that the formula reads.
template <class Formula>
constexpr bool reads_angular_acceleration() noexcept {
  for (const ReadFeature& read : Formula::reads) {
    if (std::string_view(read.name).substr(0, 5) == "wdot_") return true;
  }
  return false;
}

/// Names and units of what an answer is asked.
struct NamedFeatures {
  const char* const* names;
  const char* const* units;
  int count;

  constexpr bool has(const ReadFeature& read) const noexcept {
    if (read.place < 0 || read.place >= count) return false;
    return std::string_view(names[read.place]) == read.name && std::string_view(units[read.place]) == read.unit;
  }
};

/// All that the formula reads stands where it reads it.
template <class Formula>
constexpr bool reads_of(const NamedFeatures& features) noexcept {
  for (const ReadFeature& read : Formula::reads) {
    if (!features.has(read)) return false;
  }
  return true;
}

/// The formulas inside an answer: none, but in the compositions (model/composition.hpp).
template <class Answer>
struct FormulasOf {
  static constexpr bool read(const NamedFeatures&) noexcept { return true; }
};

/// The formula that an output schema adds its outputs to: its `Base`, or nothing.
struct NoBase {
  static constexpr const char* description = "";
  static constexpr std::array<ReadFeature, 0> reads{};
};
template <class Outputs, class = void>
struct BaseOf {
  using type = NoBase;
};
template <class Outputs>
struct BaseOf<Outputs, std::void_t<typename Outputs::Base>> {
  using type = typename Outputs::Base;
};

template <class Features>
inline constexpr NamedFeatures named_features = {Features::names.data(), Features::units.data(), Features::size};

}  // namespace detail

/// True where the base of an output schema finds the features that it reads.
template <class Features, class Outputs>
constexpr bool base_reads() noexcept {
  return detail::reads_of<typename detail::BaseOf<Outputs>::type>(detail::named_features<Features>);
}

/// True where the formulas inside an answer do.
template <class Features, class Answer>
constexpr bool formulas_read() noexcept {
  return detail::FormulasOf<Answer>::read(detail::named_features<Features>);
}

}  // namespace pinnquad
