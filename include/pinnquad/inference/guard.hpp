// SPDX-License-Identifier: MIT
// The checks between a network and the motors, as a type: Guard<FiniteInputs, TrainingEnvelope>. The compiler
// checks that the policies go together; their order has no meaning. Every guard refuses commands that are not finite,
// as `output_not_finite`. In flight the inputs are checked first,
// then the envelope, the distance from the training rows, the commands' numbers and limits. Where one of them refuses,
// the fallback is asked.
#pragma once

#include <cstdint>
#include <type_traits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/held.hpp"
#include "pinnquad/core/instruction_set.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"
#include "pinnquad/inference/joint_distance.hpp"

namespace pinnquad {

/// Inputs and features are finite and the attitude is a rotation: else `not_finite`, `not_unit_quaternion`.
/// May be left out beside TrainingEnvelope, which refuses NaN and infinite features too; nothing checks the attitude's
/// norm then.
struct FiniteInputs {};

/// Every feature lies in its range of the training rows, margin included: else `outside_envelope`. A column
/// (features/extra_columns.hpp) outside its range is no refusal: the network is shown the range's edge.
/// The envelope is a box, feature by feature. A motion within it may be far from every training row; JointDistance
/// finds such motions.
struct TrainingEnvelope {};

/// A flight stack's clock in seconds. After 30 days doubles are 5e-10 s apart, floats 0.25 s.
constexpr double seconds_of(std::uint64_t time_us) noexcept { return 1e-6 * static_cast<double>(time_us); }

/// For a fallback with effects of place or time (ground effect, density, wind). Effects read the time in their
/// vehicle's scalar: in float it must count from the flight's start.
template <class Real>
struct PlaceAndTime {
  Vector3<Real> position_m = Vector3<Real>::Zero();  ///< NED, of the vehicle's site
  Real time_s{0};
};

/// The range of a rotor's command.
struct UnitCommands {
  static constexpr double lower = 0.0;
  static constexpr double upper = 1.0;
};

/// Commands outside the limits are refused: `outside_limits`. `Limits` has constants `lower` and `upper`.
template <class Limits = UnitCommands>
struct RefuseCommands {};

/// Commands outside the limits are clipped to them: `limited`. Beside RefuseCommands the refusal comes first.
template <class Limits = UnitCommands>
struct ClipCommands {};

/// Another inverse, asked where the network declines. Its commands pass the same output checks and the Status is
/// `fell_back`. Where it declines too, the Status is the network's and nothing is written.
/// Beside TrainingEnvelope, both answer a motion that is outside by its angular acceleration alone:
///   commands(w) = network(c) + fallback(w - c) - fallback(0),  c = w clamped to the envelope,  then ClipCommands
/// There is no jump at the edge. A certified model beside an analytic inverse with rotors alike keeps its order across
/// it: an axis' command sum does not fall where more is asked about the axis (docs/in_flight.md, which lists what does
/// not). Contract: `Status operator()(const Inputs&, Commands<Scalar>&) const noexcept`, or with a `const
/// PlaceAndTime<Real>&` in the middle, or both. It checks its inputs itself: it is asked with those that the guard
/// refused. Its commands are taken if has_output(status). inference/analytic_inverse.hpp is one.
template <class Inverse>
struct Fallback {};

namespace detail {

/// Stands for a fallback where there is none.
struct NoFallback {};

/// Stands for a distribution where the guard measures no distance.
struct NoDistribution {
  static constexpr double squared_distance_limit = 1;
};

/// Both limits are numbers of `Scalar`; what is compared with NaN or infinity is neither clipped nor refused.
template <class Limits, class Scalar = double>
inline constexpr bool finite_limits = is_finite_constant(Scalar(Limits::lower)) &&
                                      is_finite_constant(Scalar(Limits::upper));

/// The argument of the one `Template<...>` among the policies, else `Default`; and how many there are.
template <template <class> class Template, class Default, class... Policies>
struct ArgumentOf {
  using type = Default;
  static constexpr int count = 0;
};
template <template <class> class Template, class Default, class First, class... Rest>
struct ArgumentOf<Template, Default, First, Rest...> : ArgumentOf<Template, Default, Rest...> {};
template <template <class> class Template, class Default, class Argument, class... Rest>
struct ArgumentOf<Template, Default, Template<Argument>, Rest...> {
  using type = Argument;
  static constexpr int count = 1 + ArgumentOf<Template, Default, Rest...>::count;
};

}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A list of policies. A value: it holds the fallback, and is empty without one.
template <class... Policies>
class Guard : private detail::Held<typename detail::ArgumentOf<Fallback, detail::NoFallback, Policies...>::type> {
  template <class Policy>
  static constexpr int count = (int(std::is_same_v<Policy, Policies>) + ... + 0);
  using Refused = detail::ArgumentOf<RefuseCommands, UnitCommands, Policies...>;
  using Clipped = detail::ArgumentOf<ClipCommands, UnitCommands, Policies...>;
  using FallenBack = detail::ArgumentOf<Fallback, detail::NoFallback, Policies...>;
  using Distributed = detail::ArgumentOf<JointDistance, detail::NoDistribution, Policies...>;

 public:
  using FallbackInverse = typename FallenBack::type;
  /// JointDistance's.
  using Distribution = typename Distributed::type;

  static constexpr bool checks_inputs = count<FiniteInputs> > 0;
  static constexpr bool refuses_outside_envelope = count<TrainingEnvelope> > 0;
  static constexpr bool refuses_commands = Refused::count > 0;
  static constexpr bool clips_commands = Clipped::count > 0;
  static constexpr bool falls_back = FallenBack::count > 0;
  static constexpr bool measures_distance = Distributed::count > 0;

  static_assert(count<FiniteInputs> + count<TrainingEnvelope> + Refused::count + Clipped::count + FallenBack::count +
                        Distributed::count ==
                    int(sizeof...(Policies)),
                "pinnquad: this type is not a policy of a Guard (inference/guard.hpp)");
  static_assert(
      checks_inputs || refuses_outside_envelope,
      "pinnquad: a Guard without FiniteInputs needs TrainingEnvelope, which refuses NaN and infinity too: a ReLU "
      "turns -infinity into 0, and the outputs would look sound");
  static_assert(((count<Policies> == 1) && ...) && Refused::count <= 1 && Clipped::count <= 1 &&
                    FallenBack::count <= 1 && Distributed::count <= 1,
                "pinnquad: a policy of a Guard is named twice");
  static_assert(detail::finite_limits<typename Refused::type> && detail::finite_limits<typename Clipped::type>,
                "pinnquad: a Guard's command limits must be numbers: NaN or infinity would let every command pass");
  static_assert(Refused::type::lower <= Refused::type::upper && Clipped::type::lower <= Clipped::type::upper,
                "pinnquad: a Guard's lower command limit lies above the upper one");

  static_assert(detail::sound_distance_limit<Distribution>(),
                "pinnquad: the distance limit of a JointDistance must be a positive number");

  Guard() = default;
  /// A fallback that has values of its own must be given.
  Guard(const FallbackInverse& fallback) noexcept : detail::Held<FallbackInverse>(fallback) {}  // NOLINT: implicit

  const FallbackInverse& fallback() const noexcept { return detail::Held<FallbackInverse>::held(); }

  /// Checks of the commands, the network's or the fallback's: `ok`, `limited` (and the commands are clipped) or a
  /// refusal.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE Status check_commands(Scalar* commands) noexcept {
    static_assert(
        detail::finite_limits<typename Refused::type, Scalar> && detail::finite_limits<typename Clipped::type, Scalar>,
        "pinnquad: a Guard's command limits must be numbers of the model's Scalar, to which these overflow");
    if (!all_finite(commands, rotor_count)) return Status::output_not_finite;
    if constexpr (refuses_commands) {
      constexpr Scalar lower = Scalar(Refused::type::lower), upper = Scalar(Refused::type::upper);
      bool inside = true;
      for (int i = 0; i < rotor_count; ++i) inside &= commands[i] >= lower && commands[i] <= upper;
      if (!inside) return Status::outside_limits;
    }
    if constexpr (clips_commands) {
      constexpr Scalar lower = Scalar(Clipped::type::lower), upper = Scalar(Clipped::type::upper);
      bool inside = true;
      for (int i = 0; i < rotor_count; ++i) {
        const Scalar v = commands[i];
        inside &= v >= lower && v <= upper;
        commands[i] = v < lower ? lower : (upper < v ? upper : v);
      }
      if (!inside) return Status::limited;
    }
    return Status::ok;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
template <class GuardType, class... More>
struct Extended;
template <class... Policies, class... More>
struct Extended<Guard<Policies...>, More...> {
  using type = Guard<Policies..., More...>;
};
}  // namespace detail

template <class T>
inline constexpr bool is_guard = false;
template <class... Policies>
inline constexpr bool is_guard<Guard<Policies...>> = true;

/// The guard of an InverseDynamics that names none: refuses bad inputs, motions beyond the training data, bad outputs.
using TrainingGuard = Guard<FiniteInputs, TrainingEnvelope>;

/// A guard with more policies: `Extend<TrainingGuard, ClipCommands<>, Fallback<AnalyticInverse<Vehicle>>>`.
template <class GuardType, class... More>
using Extend = typename detail::Extended<GuardType, More...>::type;

}  // namespace pinnquad
