// SPDX-License-Identifier: MIT
// Checks of the numbers of a training's policies (losses, schedules, optimisers). A policy with numbers that could make
// no sense has `void check() const`, which throws std::invalid_argument, one line; a policy made of others checks them.
// The Trainer checks before it begins.
#pragma once

#include <limits>
#include <type_traits>
#include <utility>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/detected.hpp"

namespace pinnquad {

namespace detail {
template <class T>
using CheckOf = std::enable_if_t<std::is_void_v<decltype(std::declval<const T&>().check())>>;
/// A class that has a member `check`, whatever it is, and joins CheckName has two of one name: `&check` is ambiguous.
struct CheckName {
  void check();
};
template <class T>
struct JoinedWithCheck : T, CheckName {};
template <class T>
using OnlyCheckOf = decltype(&JoinedWithCheck<T>::check);

/// False where a policy has a check that isn't `void check() const`. A `final` class is not looked into.
template <class T>
constexpr bool has_whole_check() noexcept {
  if constexpr (std::is_class_v<T> && !std::is_final_v<T>) {
    return is_detected<CheckOf, T> != is_detected<OnlyCheckOf, T>;
  } else {
    return true;
  }
}

[[noreturn]] void refuse_setting(const char* setting, const char* expected, double found);

/// Usable in constant expressions: there a setting that is refused is a compile error.
constexpr void expect_finite(const char* setting, double value) {
  constexpr double largest = std::numeric_limits<double>::max();
  if (!(value >= -largest && value <= largest)) refuse_setting(setting, "a finite number", value);
}
constexpr void expect_from_zero(const char* setting, double value) {
  if (!(value >= 0.0 && value <= std::numeric_limits<double>::max())) {
    refuse_setting(setting, "a finite number from 0", value);
  }
}
}  // namespace detail

/// Runs a policy's check(), if it has one.
template <class Policy>
constexpr void check_settings(const Policy& policy) {
  static_assert(
      detail::has_whole_check<Policy>(),
      "pinnquad: a policy's check() must be `void check() const` without parameters; this one would be passed "
      "over (schedule/settings.hpp)");
  if constexpr (is_detected<detail::CheckOf, Policy>) policy.check();
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/schedule/impl/settings.hpp"
#endif
