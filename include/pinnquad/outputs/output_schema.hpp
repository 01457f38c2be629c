// SPDX-License-Identifier: MIT
// What a model's outputs mean, as a type, and how they become the commands of the rotors (docs/paper.md, deviation 20).
// Contract, all static and noexcept, Scalar deduced; x: features in physical units, y: `size` outputs in theirs, u: commands:
//   size, names, units                      how many outputs, and of each its name and unit
//   commands(x, y, setting, u)              u = g(x, y). `setting`: the airframe, or what `prepare(airframe)` made of it
//   from_commands(x, u, setting, y)         outputs with g(x, y) = u: what a network is trained towards
//   slopes(x, y, setting, by_outputs)       du/dy, rotor_count x size, row-major; not asked of a schema that says
//                                           `linear = true`: g is affine in y, and its values give the slopes
//   feature_slopes<FeatureCount>(x, y, setting, by_x)
//                                           du/dx at fixed y, rotor_count x FeatureCount, row-major; only where g uses x
//   prepare(airframe)                       optional, constexpr: worked out by the compiler
//   takes_features                          optional, false: none of its functions looks at x, which may be null
// A schema of one output per rotor and one unit says `names`, `unit`, `from_command(u, airframe)`, `command(y, airframe)`,
// `command_slope(y, airframe)` instead, or these three with the rotor's index behind, for rotors that differ.
// commands() and the slopes fly: PINNQUAD_ALWAYS_INLINE where one program links objects of several instruction sets, and plain
// arrays then, no Eigen (docs/guide.md, Reproducibility).
#pragma once

#include <array>

#include "pinnquad/core/attributes.hpp"
#include "pinnquad/core/instruction_set.hpp"
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

/// The outputs are rotor speeds n_1..n_4 (the paper's 'motor speeds', Sec. 3.4), rev/s; u = (n / n_max)^2, or the command at
/// which the rotor's thrust_curve gives that speed. `rotor`: which one, where the curves differ.
struct RotorSpeedOutputs {
  static constexpr std::array<const char*, rotor_count> names = {"n1", "n2", "n3", "n4"};
  static constexpr const char* unit = "rev/s";

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

/// The form rotor by rotor, its functions called with `Rotor` behind: nothing, or the rotor's index.
template <class T, class Enable, class... Rotor>
struct MapsEachRotor : std::false_type {};
template <class T, class... Rotor>
struct MapsEachRotor<T,
                     std::void_t<decltype(T::names), decltype(T::unit),
                                 decltype(T::from_command(0.0, std::declval<const Airframe<double>&>(), Rotor{}...)),
                                 decltype(T::command(0.0, std::declval<const Airframe<double>&>(), Rotor{}...)),
                                 decltype(T::command_slope(0.0, std::declval<const Airframe<double>&>(), Rotor{}...))>,
                     Rotor...> : std::bool_constant<T::names.size() == std::size_t(rotor_count)> {
  using Body = const Airframe<double>&;
  static constexpr bool forth = noexcept(T::from_command(0.0, std::declval<Body>(), Rotor{}...));
  static constexpr bool back = noexcept(T::command(0.0, std::declval<Body>(), Rotor{}...));
  static constexpr bool slope = noexcept(T::command_slope(0.0, std::declval<Body>(), Rotor{}...));
  static constexpr bool is_noexcept = forth && back && slope;
};
template <class T>
using MapsRotorByIndex = MapsEachRotor<T, void, std::size_t>;
template <class T>
using MapsRotorByRotor = std::conditional_t<MapsRotorByIndex<T>::value, MapsRotorByIndex<T>, MapsEachRotor<T, void>>;

template <class T, class = void>
struct Prepares : std::false_type {};
template <class T>
struct Prepares<T, std::void_t<decltype(T::prepare(std::declval<const Airframe<double>&>()))>> : std::true_type {};

/// What a schema is given beside features and outputs.
template <class Schema, class Scalar>
constexpr auto output_setting(const Airframe<Scalar>& airframe) noexcept {
  if constexpr (Prepares<Schema>::value) {
    return Schema::prepare(airframe);
  } else {
    return airframe;
  }
}
template <class Schema>
using SettingOf = decltype(output_setting<Schema>(std::declval<const Airframe<double>&>()));

/// A function of a schema, called as the contract says.
template <class Schema>
struct SchemaCall {
  using In = const double*;
  using Out = double*;
  using Setting = const SettingOf<Schema>&;
  template <class T>
  using Commands = decltype(T::commands(In{}, In{}, std::declval<Setting>(), Out{}));
  template <class T>
  using FromCommands = decltype(T::from_commands(In{}, In{}, std::declval<Setting>(), Out{}));
  template <class T>
  using Slopes = decltype(T::slopes(In{}, In{}, std::declval<Setting>(), Out{}));
  template <class T>
  using FeatureSlopes = decltype(T::template feature_slopes<16>(In{}, In{}, std::declval<Setting>(), Out{}));
};

template <class T, class = void>
struct IsLinear : std::false_type {};
template <class T>
struct IsLinear<T, std::enable_if_t<T::linear>> : std::true_type {};
template <class T, class = void>
struct TakesFeatures : std::true_type {};
template <class T>
struct TakesFeatures<T, std::void_t<decltype(T::takes_features)>> : std::bool_constant<T::takes_features> {};
template <class T, class = void>
struct HasSlopes : std::false_type {};
template <class T>
struct HasSlopes<T, std::void_t<typename SchemaCall<T>::template Slopes<T>>> : std::true_type {};
template <class T, class = void>
struct HasFeatureSlopes : std::false_type {};
template <class T>
struct HasFeatureSlopes<T, std::void_t<typename SchemaCall<T>::template FeatureSlopes<T>>> : std::true_type {};

template <class T, class = void>
struct MapsVector : std::false_type {};
template <class T>
struct MapsVector<
    T, std::void_t<std::enable_if_t<(T::size > 0)>, decltype(T::names), decltype(T::units),
                   typename SchemaCall<T>::template Commands<T>, typename SchemaCall<T>::template FromCommands<T>>>
    : std::bool_constant<T::names.size() == std::size_t(T::size) && T::units.size() == std::size_t(T::size) &&
                         (IsLinear<T>::value || HasSlopes<T>::value)> {};

template <class T>
constexpr bool output_schema_is_noexcept() noexcept {
  if constexpr (MapsVector<T>::value) {
    using Call = SchemaCall<T>;
    constexpr typename Call::In in = nullptr;
    constexpr typename Call::Out out = nullptr;
    using Setting = typename Call::Setting;
    bool all = noexcept(T::commands(in, in, std::declval<Setting>(), out))&& noexcept(
        T::from_commands(in, in, std::declval<Setting>(), out));
    if constexpr (HasSlopes<T>::value) all = all&& noexcept(T::slopes(in, in, std::declval<Setting>(), out));
    if constexpr (HasFeatureSlopes<T>::value) {
      all = all&& noexcept(T::template feature_slopes<16>(in, in, std::declval<Setting>(), out));
    }
    return all;
  } else {
    return MapsRotorByRotor<T>::is_noexcept;
  }
}
template <class T>
inline constexpr bool is_noexcept_output_schema = output_schema_is_noexcept<T>();

}  // namespace detail

/// True for a type that fulfils the contract at the head of this file, in one of its two forms.
template <class T>
inline constexpr bool is_output_schema = detail::MapsRotorByRotor<T>::value != detail::MapsVector<T>::value;

inline namespace PINNQUAD_INSTRUCTION_SET {

/// An output schema as everyone calls it, whichever form it is written in: here rotor by rotor.
template <class Schema, bool RotorByRotor = detail::MapsRotorByRotor<Schema>::value>
struct OutputMap {
  static constexpr int size = rotor_count;
  static constexpr const auto& names = Schema::names;
  static constexpr std::array<const char*, size> units = {Schema::unit, Schema::unit, Schema::unit, Schema::unit};
  static constexpr bool rotor_by_rotor = true;
  static constexpr bool takes_features = false;  ///< x may be null where it is false
  static constexpr bool has_feature_slopes = false;
  static constexpr int slope_count = size;  ///< numbers that slopes() writes

  /// Command i depends on the outputs from first_output(i) to before last_output(i); where du_i/dy_k stands in the slopes.
  static constexpr int first_output(int command) noexcept { return command; }
  static constexpr int last_output(int command) noexcept { return command + 1; }
  static constexpr int slope_index(int command, int) noexcept { return command; }

  template <class Scalar>
  static constexpr Airframe<Scalar> setting(const Airframe<Scalar>& airframe) noexcept {
    return airframe;
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE Scalar command(Scalar output, const Airframe<Scalar>& airframe, int rotor) noexcept {
    if constexpr (detail::MapsRotorByIndex<Schema>::value) {
      return Schema::command(output, airframe, static_cast<std::size_t>(rotor));
    } else {
      return Schema::command(output, airframe);
    }
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar*, const Scalar* outputs, const Airframe<Scalar>& airframe,
                                              Scalar* commands) noexcept {
    for (int i = 0; i < size; ++i) commands[i] = command(outputs[i], airframe, i);
  }
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar*, const Scalar* outputs, const Airframe<Scalar>& airframe,
                                            Scalar* slopes) noexcept {
    for (int i = 0; i < size; ++i) {
      if constexpr (detail::MapsRotorByIndex<Schema>::value) {
        slopes[i] = Schema::command_slope(outputs[i], airframe, static_cast<std::size_t>(i));
      } else {
        slopes[i] = Schema::command_slope(outputs[i], airframe);
      }
    }
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* commands, const Airframe<Scalar>& airframe,
                            Scalar* outputs) noexcept {
    for (int i = 0; i < size; ++i) {
      if constexpr (detail::MapsRotorByIndex<Schema>::value) {
        outputs[i] = Schema::from_command(commands[i], airframe, static_cast<std::size_t>(i));
      } else {
        outputs[i] = Schema::from_command(commands[i], airframe);
      }
    }
  }
};

/// Any number of outputs.
template <class Schema>
struct OutputMap<Schema, false> {
  static constexpr int size = Schema::size;
  static constexpr const auto& names = Schema::names;
  static constexpr const auto& units = Schema::units;
  static constexpr bool rotor_by_rotor = false;
  static constexpr bool takes_features = detail::TakesFeatures<Schema>::value;
  static constexpr bool has_feature_slopes = detail::HasFeatureSlopes<Schema>::value;
  static constexpr int slope_count = rotor_count * size;

  static constexpr int first_output(int) noexcept { return 0; }
  static constexpr int last_output(int) noexcept { return size; }
  static constexpr int slope_index(int command, int output) noexcept { return command * size + output; }

  template <class Scalar>
  static constexpr auto setting(const Airframe<Scalar>& airframe) noexcept {
    return detail::output_setting<Schema>(airframe);
  }
  template <class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void commands(const Scalar* x, const Scalar* outputs, const Setting& setting,
                                              Scalar* commands) noexcept {
    Schema::commands(x, outputs, setting, commands);
  }
  /// Of a linear schema: g(x, e_k) - g(x, 0).
  template <class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void slopes(const Scalar* x, const Scalar* outputs, const Setting& setting,
                                            Scalar* slopes) noexcept {
    if constexpr (detail::HasSlopes<Schema>::value) {
      Schema::slopes(x, outputs, setting, slopes);
    } else {
      Scalar unit[size] = {};
      Scalar origin[rotor_count], moved[rotor_count];
      Schema::commands(x, static_cast<const Scalar*>(unit), setting, origin);
      for (int k = 0; k < size; ++k) {
        unit[k] = Scalar(1);
        Schema::commands(x, static_cast<const Scalar*>(unit), setting, moved);
        unit[k] = Scalar(0);
        for (int i = 0; i < rotor_count; ++i) slopes[slope_index(i, k)] = moved[i] - origin[i];
      }
    }
  }
  template <int FeatureCount, class Scalar, class Setting>
  static PINNQUAD_ALWAYS_INLINE void feature_slopes(const Scalar* x, const Scalar* outputs, const Setting& setting,
                                                    Scalar* by_features) noexcept {
    Schema::template feature_slopes<FeatureCount>(x, outputs, setting, by_features);
  }
  template <class Scalar, class Setting>
  static void from_commands(const Scalar* x, const Scalar* commands, const Setting& setting, Scalar* outputs) noexcept {
    Schema::from_commands(x, commands, setting, outputs);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad
