// SPDX-License-Identifier: MIT
// The meaning of a model's outputs, as a type: how they become commands of the rotors (docs/paper.md, deviation 20).
// Contract, all static and noexcept, Scalar deduced; x: features, y: `size` outputs, physical units; u: commands:
//   size, names, units                   count, and of each output its name and unit
//   commands(x, y, setting, u)           u = g(x, y). `setting`: the airframe, or the result of `prepare(airframe)`
//   from_commands(x, u, setting, y)      outputs with g(x, y) = u: the targets of a training
//   slopes(x, y, setting, by_outputs)    du/dy, rotor_count x size, row-major; not needed where the schema says
//                                        `linear = true`: g is affine in y, and its values give the slopes
//   feature_slopes<FeatureCount>(x, y, setting, by_x)
//                                        du/dx at fixed y, rotor_count x FeatureCount, row-major; only where g uses x
//   prepare(airframe)                    optional, constexpr: worked out by the compiler
//   takes_features                       optional, false: no function reads x, which may be null
//   command(y_i, setting, rotor)         optional: command i is of output i alone, and slopes() writes du_i/dy_i alone.
//                                        EachRotor makes the other functions of it
// commands(), command() and the slopes fly: PINNQUAD_ALWAYS_INLINE where a program links objects of other flags, and
// plain arrays then, no Eigen (docs/in_flight.md).
#pragma once

#include <array>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A schema of one output per rotor derives from it, and has names, units and three functions of a rotor, which is
/// given by its index, as rotors may differ:
///   from_command(u, airframe, rotor), command(y, airframe, rotor), command_slope(y, airframe, rotor)
template <class Schema>
struct EachRotor {
  using Functions = Schema;  ///< whose three functions it calls
  static constexpr int size = rotor_count;
  static constexpr bool takes_features = false;

  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar*, const Scalar* y, const Airframe<Scalar>& airframe,
                                              Scalar* u) noexcept(noexcept(Schema::command(*y, airframe, 0))) {
    for (std::size_t i = 0; i < rotor_count; ++i) u[i] = Schema::command(y[i], airframe, i);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar*, const Scalar* y, const Airframe<Scalar>& airframe,
                                            Scalar* own) noexcept(noexcept(Schema::command_slope(*y, airframe, 0))) {
    for (std::size_t i = 0; i < rotor_count; ++i) own[i] = Schema::command_slope(y[i], airframe, i);
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Airframe<Scalar>& airframe,
                            Scalar* y) noexcept(noexcept(Schema::from_command(*u, airframe, 0))) {
    for (std::size_t i = 0; i < rotor_count; ++i) y[i] = Schema::from_command(u[i], airframe, i);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

/// The outputs are the commands u_1..u_4 (the paper's PWM, Sec. 4.1). Default.
struct CommandOutputs : EachRotor<CommandOutputs> {
  static constexpr std::array<const char*, rotor_count> names = {"u1", "u2", "u3", "u4"};
  static constexpr std::array<const char*, rotor_count> units = {"1", "1", "1", "1"};

  template <class Scalar>
  static constexpr Scalar from_command(Scalar command, const Airframe<Scalar>&, std::size_t = 0) noexcept {
    return command;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE constexpr Scalar command(Scalar output, const Airframe<Scalar>&,
                                                         std::size_t = 0) noexcept {
    return output;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE constexpr Scalar command_slope(Scalar, const Airframe<Scalar>&,
                                                               std::size_t = 0) noexcept {
    return Scalar(1);
  }
};

/// The outputs are rotor speeds n_1..n_4 (the paper's 'motor speeds', Sec. 3.4), rev/s; u = (n / n_max)^2, or the
/// command at which the rotor's thrust_curve gives that speed.
struct RotorSpeedOutputs : EachRotor<RotorSpeedOutputs> {
  static constexpr std::array<const char*, rotor_count> names = {"n1", "n2", "n3", "n4"};
  static constexpr std::array<const char*, rotor_count> units = {"rev/s", "rev/s", "rev/s", "rev/s"};

  /// A command below 0 has no speed and counts as 0.
  template <class Scalar>
  static Scalar from_command(Scalar command, const Airframe<Scalar>& airframe, std::size_t rotor = 0) noexcept {
    return command < Scalar(0) ? Scalar(0) : speed_from_command(airframe, rotor, command);
  }
  /// A negative speed gives a negative command: monotone, so that a network's error keeps its direction.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE Scalar command(Scalar output, const Airframe<Scalar>& airframe,
                                               std::size_t rotor = 0) noexcept {
    return command_from_speed(airframe, rotor, output);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE Scalar command_slope(Scalar output, const Airframe<Scalar>& airframe,
                                                     std::size_t rotor = 0) noexcept {
    return command_slope_of_speed(airframe, rotor, output);
  }
};

namespace detail {

template <class T>
using PrepareOf = decltype(T::prepare(std::declval<const Airframe<double>&>()));

/// The argument `setting` of a schema's functions.
template <class Schema, class Scalar>
constexpr auto output_setting(const Airframe<Scalar>& airframe) noexcept {
  if constexpr (is_detected<PrepareOf, Schema>) {
    return Schema::prepare(airframe);
  } else {
    return airframe;
  }
}

/// The functions of a schema.
template <class T>
struct VectorCalls {
  using In = const double*;
  using Out = double*;
  using Setting = const decltype(output_setting<T>(std::declval<const Airframe<double>&>()))&;
  template <class S>
  using Both = std::void_t<std::enable_if_t<(S::size > 0) && S::names.size() == std::size_t(S::size) &&
                                            S::units.size() == std::size_t(S::size)>,
                           decltype(S::commands(In{}, In{}, std::declval<Setting>(), Out{})),
                           decltype(S::from_commands(In{}, In{}, std::declval<Setting>(), Out{}))>;
  template <class S>
  using Slopes = decltype(S::slopes(In{}, In{}, std::declval<Setting>(), Out{}));
  template <class S>
  using FeatureSlopes = decltype(S::template feature_slopes<16>(In{}, In{}, std::declval<Setting>(), Out{}));
  template <class S>
  using Linear = std::enable_if_t<S::linear>;
  template <class S>
  using OfRotor = decltype(S::command(0.0, std::declval<Setting>(), std::size_t{}));
  static constexpr bool has_slopes = is_detected<Slopes, T>;
  static constexpr bool has_feature_slopes = is_detected<FeatureSlopes, T>;
  static constexpr bool rotor_by_rotor = is_detected<OfRotor, T>;

  static constexpr bool exist = is_detected<Both, T> && (is_detected<Linear, T> || has_slopes);
  static constexpr bool are_noexcept() noexcept {
    bool all = noexcept(T::commands(In{}, In{}, std::declval<Setting>(), Out{}))&& noexcept(
        T::from_commands(In{}, In{}, std::declval<Setting>(), Out{}));
    if constexpr (has_slopes) all = all&& noexcept(T::slopes(In{}, In{}, std::declval<Setting>(), Out{}));
    if constexpr (has_feature_slopes) {
      all = all&& noexcept(T::template feature_slopes<16>(In{}, In{}, std::declval<Setting>(), Out{}));
    }
    if constexpr (rotor_by_rotor) all = all&& noexcept(T::command(0.0, std::declval<Setting>(), 0));
    return all;
  }
};

template <class T>
inline constexpr bool is_noexcept_output_schema = VectorCalls<T>::are_noexcept();

template <class T>
using SchemaFunctions = typename T::Functions;
/// False for a schema that derives from one of EachRotor, which would not call its functions.
template <class T>
constexpr bool calls_its_own() noexcept {
  if constexpr (is_detected<SchemaFunctions, T>) return std::is_same_v<typename T::Functions, T>;
  return true;
}

template <class T>
using IgnoresFeatures = std::enable_if_t<!T::takes_features>;

}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_output_schema = detail::VectorCalls<T>::exist;

inline namespace PINNQUAD_INSTRUCTION_SET {

/// An output schema, and what follows from it.
template <class Schema>
struct OutputMap : Schema {
  static_assert(detail::calls_its_own<Schema>(),
                "pinnquad: this output schema derives from another one, which is EachRotor's and would not call the "
                "functions of this one: let it derive from EachRotor of itself (outputs/output_schema.hpp)");
  using Schema::size;
  static constexpr bool rotor_by_rotor = detail::VectorCalls<Schema>::rotor_by_rotor;  ///< it has command()
  static constexpr bool takes_features =
      !is_detected<detail::IgnoresFeatures, Schema>;  ///< x may be null where it is false
  static constexpr bool has_feature_slopes = detail::VectorCalls<Schema>::has_feature_slopes;
  static constexpr int slope_count = rotor_by_rotor ? size : rotor_count * size;  ///< numbers that slopes() writes

  /// Command i depends on the outputs from first_output(i) to before last_output(i). du_i/dy_k stands at
  /// slope_index(i, k) of the slopes.
  static constexpr int first_output(int command) noexcept { return rotor_by_rotor ? command : 0; }
  static constexpr int last_output(int command) noexcept { return rotor_by_rotor ? command + 1 : size; }
  static constexpr int slope_index(int command, int output) noexcept {
    return rotor_by_rotor ? command : command * size + output;
  }

  template <class Scalar>
  static constexpr auto setting(const Airframe<Scalar>& airframe) noexcept {
    return detail::output_setting<Schema>(airframe);
  }
  /// Slopes of a linear schema without slopes(): g(x, e_k) - g(x, 0).
  template <class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar* x, const Scalar* outputs, const Setting& setting,
                                            Scalar* slopes) noexcept {
    if constexpr (detail::VectorCalls<Schema>::has_slopes) {
      Schema::slopes(x, outputs, setting, slopes);
    } else {
      Scalar unit[size] = {};
      Scalar origin[rotor_count], moved[rotor_count];
      Schema::commands(x, static_cast<const Scalar*>(unit), setting, static_cast<Scalar*>(origin));
      for (int k = 0; k < size; ++k) {
        unit[k] = Scalar(1);
        Schema::commands(x, static_cast<const Scalar*>(unit), setting, static_cast<Scalar*>(moved));
        unit[k] = Scalar(0);
        for (int i = 0; i < rotor_count; ++i) slopes[slope_index(i, k)] = moved[i] - origin[i];
      }
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
