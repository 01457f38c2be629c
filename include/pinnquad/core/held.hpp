// SPDX-License-Identifier: MIT
// A value kept as a base class. One of an empty type takes no room and need not be given: the InverseDynamics of an
// exported model is empty.
#pragma once

#include <type_traits>

#include "pinnquad/core/instruction_set.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// All values of an empty type are one. The type is no base of Held: its members would be found in ours.
template <class T, bool Empty = std::is_empty_v<T>&& std::is_trivially_default_constructible_v<T>>
class Held {
 public:
  Held() = default;
  explicit Held(const T&) noexcept {}
  static const T& held() noexcept { return value_; }
  static void hold(const T&) noexcept {}

 private:
  static constexpr T value_{};
};

template <class T>
class Held<T, false> {
 public:
  explicit Held(const T& value) noexcept : value_(value) {}
  const T& held() const noexcept { return value_; }
  void hold(const T& value) noexcept { value_ = value; }

 private:
  T value_;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
