// SPDX-License-Identifier: MIT
// What a network's four outputs mean, as a type (docs/paper.md, deviation 20): motor commands, or rotor speeds.
// Contract: `names`, `unit`, `from_command(u, airframe)`, `command(y, airframe)` and its derivative `command_slope`,
// all noexcept.
#pragma once

#include <array>
#include <cmath>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

/// The outputs are the commands u_1..u_4 (the paper's PWM, Sec. 4.1). Default.
struct CommandOutputs {
  static constexpr std::array<const char*, rotor_count> names = {"u1", "u2", "u3", "u4"};
  static constexpr const char* unit = "1";

  template <class Scalar>
  static constexpr Scalar from_command(Scalar command, const Airframe<Scalar>&) noexcept {
    return command;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE constexpr Scalar command(Scalar output, const Airframe<Scalar>&) noexcept {
    return output;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE constexpr Scalar command_slope(Scalar, const Airframe<Scalar>&) noexcept {
    return Scalar(1);
  }
};

/// The outputs are rotor speeds n_1..n_4 (the paper's 'motor speeds', Sec. 3.4), rev/s; u = (n / n_max)^2.
struct RotorSpeedOutputs {
  static constexpr std::array<const char*, rotor_count> names = {"n1", "n2", "n3", "n4"};
  static constexpr const char* unit = "rev/s";

  /// A command below 0 has no speed and counts as 0.
  template <class Scalar>
  static Scalar from_command(Scalar command, const Airframe<Scalar>& airframe) noexcept {
    return command < Scalar(0) ? Scalar(0) : speed_from_command(airframe, command);
  }
  /// A negative speed gives a negative command: monotone, so that a network's error keeps its direction.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE constexpr Scalar command(Scalar output, const Airframe<Scalar>& airframe) noexcept {
    const Scalar u = command_from_speed(airframe, output);
    return output < Scalar(0) ? -u : u;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE constexpr Scalar command_slope(Scalar output,
                                                               const Airframe<Scalar>& airframe) noexcept {
    const Scalar n_max = airframe.max_rotor_speed_rev_s;
    const Scalar magnitude = output < Scalar(0) ? -output : output;
    return Scalar(2) * magnitude / (n_max * n_max);
  }
};

namespace detail {
template <class T, class = void>
struct IsOutputSchema : std::false_type {};
template <class T>
struct IsOutputSchema<T, std::void_t<decltype(T::names), decltype(T::unit),
                                     decltype(T::from_command(0.0, std::declval<const Airframe<double>&>())),
                                     decltype(T::command(0.0, std::declval<const Airframe<double>&>())),
                                     decltype(T::command_slope(0.0, std::declval<const Airframe<double>&>()))>>
    : std::true_type {};
template <class T>
inline constexpr bool is_noexcept_output_schema =
    noexcept(T::command(0.0, std::declval<const Airframe<double>&>())) && noexcept(T::command_slope(
        0.0,
        std::declval<const Airframe<double>&>())) && noexcept(T::from_command(0.0,
                                                                              std::declval<const Airframe<double>&>()));
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_output_schema = detail::IsOutputSchema<T>::value;

}  // namespace pinnquad
