// SPDX-License-Identifier: MIT
// How an InverseDynamics asks its guard's fallback: alone, and beyond the envelope's edge together with the network.
#pragma once

#include <type_traits>

#include "pinnquad/features/features.hpp"
#include "pinnquad/inference/guard.hpp"
#include "pinnquad/inference/pipeline.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// With place and time if they are known and it takes them.
template <class Fallback, class Inputs, class Scalar, class... Place>
Status ask_fallback(const Fallback& fallback, const Inputs& inputs, Commands<Scalar>& commands,
                    const Place&... place) noexcept {
  constexpr bool with_place =
      std::is_invocable_r_v<Status, const Fallback&, const Inputs&, const Place&..., Commands<Scalar>&>;
  static_assert(with_place
                    ? std::is_nothrow_invocable_v<const Fallback&, const Inputs&, const Place&..., Commands<Scalar>&>
                    : std::is_nothrow_invocable_v<const Fallback&, const Inputs&, Commands<Scalar>&> ||
                          !std::is_invocable_v<const Fallback&, const Inputs&, Commands<Scalar>&>,
                "pinnquad: a fallback's call must be noexcept (Fallback in inference/guard.hpp)");
  if constexpr (with_place) {
    return fallback(inputs, place..., commands);
  } else {
    static_assert(std::is_invocable_r_v<Status, const Fallback&, const Inputs&, Commands<Scalar>&>,
                  "pinnquad: this fallback can't be asked with the model's inputs, or must be told place and time: "
                  "predict(inputs, place, commands) (Fallback in inference/guard.hpp)");
    return fallback(inputs, commands);
  }
}

/// True where a motion that leaves the envelope by its angular acceleration alone is answered by both.
template <class Inverse>
inline constexpr bool answers_beyond_envelope =
    Inverse::Guard::falls_back&& Inverse::Guard::refuses_outside_envelope&& Inverse::Features::angular_acceleration >=
        0 &&
    std::is_base_of_v<MotionInputs<typename Inverse::Scalar>, typename Inverse::Inputs>;

/// The network at the angular acceleration clamped to the envelope, and what the fallback adds for the rest of it; true
/// if that was written. False where other features lie outside too, JointDistance refuses or the fallback declines.
///   commands(w) = network(c) + fallback(w - c) - fallback(0),  c = w clamped
/// The fallback is not asked for c: its part depends on the rest alone, and each part rises by itself. Out of line: the
/// network's way is the hot one.
template <class Inverse, class Report, class... Place>
PINNQUAD_NOINLINE bool answer_beyond_envelope(const Inverse& inverse, const typename Inverse::Inputs& inputs,
                                              Commands<typename Inverse::Scalar>& commands, Report& report,
                                              const Place&... place) noexcept {
  using Scalar = typename Inverse::Scalar;
  using Features = typename Inverse::Features;
  const Scales<Scalar> scales = scales_of(inverse.model());
  const Scalar* lower = scales.lower + Features::angular_acceleration;
  const Scalar* upper = scales.upper + Features::angular_acceleration;
  typename Inverse::Inputs asked = inputs;
  Vector3<Scalar> rest;
  for (int i = 0; i < 3; ++i) {
    const Scalar wanted = inputs.angular_acceleration_rad_s2[i];
    const Scalar clamped = wanted < lower[i] ? lower[i] : (upper[i] < wanted ? upper[i] : wanted);
    asked.angular_acceleration_rad_s2[i] = clamped;
    rest[i] = wanted - clamped;
  }
  Scalar x[Features::size];
  Features::extract(asked, x);
  Scalar squared(0);
  if (!inverse.inside_envelope(x) || !inverse.inside_distribution(x, squared)) return false;
  Commands<Scalar> made{}, with{}, without{};
  inverse.evaluate_over(x, made.data());
  asked.angular_acceleration_rad_s2 = rest;
  if (!has_output(ask_fallback(inverse.guard().fallback(), asked, with, place...))) return false;
  asked.angular_acceleration_rad_s2 = Vector3<Scalar>::Zero();
  if (!has_output(ask_fallback(inverse.guard().fallback(), asked, without, place...))) return false;
  for (std::size_t i = 0; i < rotor_count; ++i) made[i] += with[i] - without[i];
  const Status checked = Inverse::Guard::check_commands(made.data());
  if (!has_output(checked)) return false;
  if constexpr (!std::is_empty_v<Report>) {
    report.fallback_asked = true;
    report.fallback = checked;
    report.squared_distance = squared;
    report.commands_clipped = checked == Status::limited;
  }
  commands = made;
  return true;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail
