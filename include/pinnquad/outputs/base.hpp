// SPDX-License-Identifier: MIT
// A base: an analytic inverse that a model's outputs are added to, so that the network learns what it leaves.
// Contract, all static and noexcept, Scalar deduced, x: features in physical units:
//   reads                                constexpr array of ReadFeature; a feature set that lacks one does not compile
//   prepare(airframe)                    constexpr: all that needs the airframe alone
//   commands(x, prepared, u)             the commands of the rotors
//   slopes<FeatureCount>(x, prepared, by_x)  du/dx, rotor_count x FeatureCount, row-major, into zeros
//   least_thrust_slope(airframe)         optional, for a certificate (outputs/rigid_body_base.hpp)
//   description                          optional text for headers and blocks (model/description.hpp)
#pragma once

#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/features/shown_acceleration.hpp"

namespace pinnquad {

/// A feature that a base reads: its place in X, name and unit.
struct ReadFeature {
  int place;
  const char* name;
  const char* unit;
};

namespace detail {

template <class T>
using ReadsOf = decltype(T::reads);
template <class T>
using BasePrepared = decltype(T::prepare(std::declval<const Airframe<double>&>()));
template <class T>
using BaseCalls = std::enable_if_t<noexcept(
    T::prepare(std::declval<const Airframe<double>&>()),
    T::commands(std::declval<const double*>(), std::declval<const BasePrepared<T>&>(), std::declval<double*>()),
    T::template slopes<16>(std::declval<const double*>(), std::declval<const BasePrepared<T>&>(),
                           std::declval<double*>()))>;
template <class Outputs>
using BaseInside = typename Outputs::Base;

/// The base of an output schema that has none.
struct NoBase {
  static constexpr const char* description = "";
  static constexpr std::array<ReadFeature, 0> reads{};
};

/// The `Base` of an output schema, or NoBase.
template <class Outputs, bool = is_detected<BaseInside, Outputs>>
struct BaseOf {
  using type = NoBase;
};
template <class Outputs>
struct BaseOf<Outputs, true> {
  using type = typename Outputs::Base;
};

/// True where the base reads an angular acceleration, or a column that may be one.
template <class Base>
constexpr bool reads_angular_acceleration() noexcept {
  for (const ReadFeature& read : Base::reads) {
    constexpr bool whatever_it_is = true;
    if (shown_acceleration(read.name, read.unit, whatever_it_is) != ShownAcceleration::none) return true;
  }
  return false;
}

}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_base = is_detected<detail::ReadsOf, T>&& is_detected<detail::BaseCalls, T>;

/// True where the base of an output schema finds each feature that it reads at its place, by name and unit.
template <class Features, class Outputs>
constexpr bool base_reads() noexcept {
  for (const ReadFeature& read : detail::BaseOf<Outputs>::type::reads) {
    if (read.place < 0 || read.place >= Features::size) return false;
    const auto place = static_cast<std::size_t>(read.place);
    if (std::string_view(Features::names[place]) != read.name) return false;
    if (std::string_view(Features::units[place]) != read.unit) return false;
  }
  return true;
}

}  // namespace pinnquad
