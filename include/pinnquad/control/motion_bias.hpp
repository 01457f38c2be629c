// SPDX-License-Identifier: MIT
// The bias of an inverse: what its commands and the forces that it knows of lack, from a payload, a weak rotor or
// battery, wind. It is learnt from the past alone: the answer to a motion asked for shifts, and rises with it as
// before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"
#include "pinnquad/exported/model_facts.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"

namespace pinnquad {

/// A number per signed sum: all commands, then those of roll, pitch and yaw (outputs/axis_command_outputs.hpp).
template <class Scalar>
using SignedSums = std::array<Scalar, 4>;

/// Settings of a MotionBias.
template <class Scalar>
struct BiasSettings {
  SignedSums<Scalar> time_constants_s{Scalar(0.2), Scalar(0.45), Scalar(0.45), Scalar(0.45)};
  SignedSums<Scalar> most{Scalar(1.6), Scalar(0.4), Scalar(0.4), Scalar(0.4)};  ///< of a sum, either way; 0: no bias
  Scalar across_time_constant_s = Scalar(0.2);
  Scalar most_across_m_s2 = Scalar(3);  ///< its length; 0: none
  // noise makes time constants longer: at least so many s for each unit of it (MotionBias::Learnt), up to
  // longest_by_noise_s; 0: none
  Scalar roll_pitch_by_noise_s = Scalar(0);
  Scalar across_by_noise_s3_m = Scalar(0);
  static constexpr Scalar longest_by_noise_s = Scalar(0.1);
  /// The acceleration across the thrust is flown as its trend, a mean over trend_s, has it so much later: the attitude
  /// that answers it comes late. A swing of roll and pitch shortens it, to half at swing. 0: none.
  Scalar across_lead_s = Scalar(0);
  static constexpr Scalar trend_s = Scalar(0.2), swing = Scalar(0.06);
  Scalar hold_s = Scalar(0.5);  ///< without a residual it stays this long, then fades
  Scalar fade_s = Scalar(2);    ///< time constant of fading
};

namespace detail {
/// Times as a model says them; 0: no bias of this sum.
template <class Scalar, class Times>
constexpr BiasSettings<Scalar> bias_settings_of(const Times& times_s) noexcept {
  BiasSettings<Scalar> settings;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto time_s = static_cast<Scalar>(times_s[i]);
    settings.time_constants_s[i] = time_s > Scalar(0) ? time_s : std::numeric_limits<Scalar>::infinity();
  }
  return settings;
}
}  // namespace detail

/// With the time constants that a model's training chose, and the usual ones of a model that does not say any. Of an
/// exported header, in the loop's own Scalar.
template <class Model, class Scalar = typename Model::Scalar>
constexpr BiasSettings<Scalar> bias_settings() noexcept {
  if constexpr (is_detected<detail::BiasTimeConstantsOf, Model>) {
    return detail::bias_settings_of<Scalar>(Model::bias_time_constants_s);
  } else {
    return {};
  }
}
/// Settings by a block's facts: those of a ModelView, a RunTimeModel.
template <class Scalar>
constexpr BiasSettings<Scalar> bias_settings(const detail::ModelFacts& facts) noexcept {
  return facts.has_bias ? detail::bias_settings_of<Scalar>(facts.bias_time_constants_s) : BiasSettings<Scalar>{};
}

/// Period of the FlownMotion of a loop that has a new state in each tick, where the bias is quick_where_told().
inline constexpr std::uint32_t quick_period_us = 14'000;

/// For a loop that is told the rotors' lag and the delay of its states: as quick as the noise lets it be. The thrust is
/// quick whatever the noise; the yaw, which is the noisiest, slower. Told neither, such a bias follows its own answer
/// (docs/adaptive.md).
template <class Scalar>
constexpr BiasSettings<Scalar> quick_where_told(BiasSettings<Scalar> settings) noexcept {
  constexpr SignedSums<Scalar> most_s{Scalar(0.0025), Scalar(0.0025), Scalar(0.0025), Scalar(0.05)};
  constexpr Scalar most_across_s = Scalar(0.01);
  for (std::size_t k = 0; k < most_s.size(); ++k) {
    Scalar& time_s = settings.time_constants_s[k];
    if (time_s > most_s[k] && time_s <= std::numeric_limits<Scalar>::max()) time_s = most_s[k];
  }
  if (settings.across_time_constant_s > most_across_s) settings.across_time_constant_s = most_across_s;
  settings.roll_pitch_by_noise_s = Scalar(0.35);
  settings.across_by_noise_s3_m = Scalar(0.011);
  settings.across_lead_s = Scalar(0.04);
  return settings;
}

/// Most that the bias changes each command, either way: |A| most, A the inverse of the signs. The bound of a
/// certificate (docs/certificate.md) widens by it.
template <class Scalar>
constexpr Commands<Scalar> largest_bias(const Airframe<Scalar>& airframe,
                                        const BiasSettings<Scalar>& settings = {}) noexcept {
  const detail::SignedMix<Scalar> mix = detail::signed_mix(airframe);
  Commands<Scalar> largest{};
  for (std::size_t i = 0; i < rotor_count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      largest[i] += (mix.by[i][k] < Scalar(0) ? -mix.by[i][k] : mix.by[i][k]) * settings.most[k];
    }
  }
  return largest;
}

namespace detail {

/// b <- b + T / (T + c) (r - b) of each signed sum of commands, |b| <= most. T: the period of r. c: the time constant,
/// for roll, pitch and across longer in noise.
/// r: the residual, commands flown - commands that the inverse gives for the motion flown.
/// The same of d, the acceleration across the thrust (NED, m/s^2) that no rotor makes.
/// A b is added to the inverse's commands; A: the inverse of the signs. A time constant of 0 is the last residual, an
/// infinite one none.
template <class Scalar>
class MotionBias {
 public:
  /// All that it has learnt: a tick logs it, a replay goes on from it.
  struct Learnt {
    SignedSums<Scalar> sums{};
    Vector3<Scalar> across_m_s2 = Vector3<Scalar>::Zero();       ///< d
    Vector3<Scalar> across_rate_m_s3 = Vector3<Scalar>::Zero();  ///< the trend of d, level
    /// The innovations' mean lengths over a second: what is left of a residual beside its bias is mostly noise, and,
    /// where the loop swings, the swing. |roll| + |pitch| of the sums' residuals, |x| + |y| + |z| across the thrust; 0
    /// where the settings let noise make no time constant longer.
    Scalar roll_pitch_noise{0}, across_noise_m_s2{0};
    Scalar waited_s{0};  ///< time in which nothing could be learnt
    /// `ok`: it learns. `limited`: at a bound. `warming_up`: nothing has been learnt yet, or for longer than `hold_s`.
    /// `not_finite`: the last residual was no number.
    Status status{Status::warming_up};
  };

  /// A vehicle whose signs do not distinguish the axes has no bias of its sums.
  explicit constexpr MotionBias(const Airframe<Scalar>& airframe, const BiasSettings<Scalar>& settings = {}) noexcept
      : settings_(settings), mix_(detail::signed_mix(airframe)) {
    if (!is_finite(mix_.by[0][0])) mix_ = {};
  }

  constexpr const BiasSettings<Scalar>& settings() const noexcept { return settings_; }
  /// From now on, as of another model; what was learnt stays.
  constexpr void time_constants(const SignedSums<Scalar>& times_s) noexcept { settings_.time_constants_s = times_s; }
  const Learnt& learnt() const noexcept { return learnt_; }
  const SignedSums<Scalar>& sums() const noexcept { return learnt_.sums; }
  /// All 0 of a vehicle whose signs do not distinguish the axes.
  constexpr const detail::SignedMix<Scalar>& mix() const noexcept { return mix_; }
  const Vector3<Scalar>& across_m_s2() const noexcept { return learnt_.across_m_s2; }
  /// d with its lead, which is flown.
  Vector3<Scalar> across_ahead_m_s2() const noexcept {
    const Scalar swings = learnt_.roll_pitch_noise / BiasSettings<Scalar>::swing;
    return within_most(learnt_.across_m_s2 +
                       settings_.across_lead_s / (Scalar(1) + swings * swings) * learnt_.across_rate_m_s3);
  }
  Status status() const noexcept { return learnt_.status; }
  /// The greatest share of its bound that a sum has, 0 to 1.
  Scalar share_of_bound() const noexcept {
    Scalar greatest(0);
    for (std::size_t k = 0; k < sums().size(); ++k) {
      if (length(sums()[k]) > greatest * settings_.most[k]) greatest = length(sums()[k]) / settings_.most[k];
    }
    return greatest;
  }

  /// u + A b.
  void add_to(Commands<Scalar>& commands) const noexcept {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      for (std::size_t k = 0; k < sums().size(); ++k) commands[i] += mix_.by[i][k] * sums()[k];
    }
  }

  /// Signed sums of the commands that the rotors followed, over those that the inverse gives for that motion.
  SignedSums<Scalar> residual(const Commands<Scalar>& flown, const Commands<Scalar>& said) const noexcept {
    SignedSums<Scalar> sums{};
    for (std::size_t k = 0; k < sums.size(); ++k) {
      for (std::size_t i = 0; i < rotor_count; ++i) sums[k] += mix_.signs[k][i] * (flown[i] - said[i]);
    }
    return sums;
  }

  /// A motion that was flown, the commands that the rotors followed in it, and those that the inverse gives for it.
  /// `known`: the acceleration across the thrust that somebody accounts for, NED. As learn() of a residual.
  Status learn(const MotionInputs<Scalar>& motion, const Commands<Scalar>& flown, const Commands<Scalar>& said,
               Scalar period_s, const Vector3<Scalar>& known = Vector3<Scalar>::Zero()) noexcept {
    Vector3<Scalar> across = SpecificForce::of<Scalar>(motion);
    across[2] = Scalar(0);
    return learn(residual(flown, said), body_to_world<Scalar>(motion.attitude, across) - known, period_s);
  }
  /// A residual, what was found across the thrust, and the period that they are of. `not_finite`: of one that is no
  /// number, or no period; nothing changes.
  Status learn(const SignedSums<Scalar>& residual, const Vector3<Scalar>& across_m_s2, Scalar period_s) noexcept {
    const bool sound = all_finite(residual) && all_finite(across_m_s2) && is_finite(period_s) && period_s > Scalar(0);
    if (!sound) return learnt_.status = Status::not_finite;
    const Vector3<Scalar> beside = across_m_s2 - learnt_.across_m_s2;
    if (settings_.roll_pitch_by_noise_s > Scalar(0) || settings_.across_by_noise_s3_m > Scalar(0)) {
      listen(residual, beside, period_s);
    }
    const Scalar roll_pitch_s = by_noise(settings_.roll_pitch_by_noise_s * learnt_.roll_pitch_noise);
    bool bound = false;
    for (std::size_t k = 0; k < sums().size(); ++k) {
      const Scalar time_s = longer(settings_.time_constants_s[k], k == 1 || k == 2 ? roll_pitch_s : Scalar(0));
      bound |= move(k, share(time_s, period_s) * (residual[k] - sums()[k]));
    }
    const Scalar across_s = by_noise(settings_.across_by_noise_s3_m * learnt_.across_noise_m_s2);
    Vector3<Scalar>&across = learnt_.across_m_s2, &rate = learnt_.across_rate_m_s3;
    const Vector3<Scalar> before = across;
    const Vector3<Scalar> wanted =
        across + share(longer(settings_.across_time_constant_s, across_s), period_s) * beside;
    across = within_most(wanted);
    bound |= across != wanted;
    rate += (across - before - period_s * rate) / (period_s + BiasSettings<Scalar>::trend_s);
    rate[2] = Scalar(0);  // up and down it is the thrust's to answer
    learnt_.waited_s = Scalar(0);
    return learnt_.status = bound ? Status::limited : Status::ok;
  }

  /// Time in flight in which nothing could be learnt: it holds, then fades.
  void wait(Scalar step_s) noexcept {
    if (!(step_s > Scalar(0))) return;
    learnt_.waited_s += step_s;
    if (learnt_.waited_s <= settings_.hold_s) return;
    const Scalar kept = settings_.fade_s / (settings_.fade_s + step_s);
    for (Scalar& sum : learnt_.sums) sum *= kept;
    learnt_.across_m_s2 *= kept;
    learnt_.across_rate_m_s3 *= kept;
    if (learnt_.status != Status::not_finite) learnt_.status = Status::warming_up;
  }
  /// Time in flight that says nothing of it, as with commands at their ends: it stays.
  void freeze() noexcept { learnt_.waited_s = Scalar(0); }
  /// A motion that its inverse does not answer for: it moves with the bias of another inverse, as the vehicle has
  /// changed for both.
  void follow(const SignedSums<Scalar>& before, const SignedSums<Scalar>& now) noexcept {
    for (std::size_t k = 0; k < sums().size(); ++k) move(k, now[k] - before[k]);
    freeze();
  }

  /// Forgets: for another model, on the ground.
  void reset() noexcept { learnt_ = {}; }
  /// Goes on from what was logged; a number that is none changes nothing.
  void resume(const Learnt& logged) noexcept {
    const Scalar numbers[] = {logged.roll_pitch_noise, logged.across_noise_m_s2, logged.waited_s};
    const bool sound = all_finite(logged.sums) && all_finite(logged.across_m_s2) &&
                       all_finite(logged.across_rate_m_s3) && all_finite(numbers, 3);
    if (sound) learnt_ = logged;
  }
  /// Goes on from a sum that somebody else has learnt.
  void resume(std::size_t k, Scalar sum) noexcept {
    if (!is_finite(sum)) return;
    learnt_.sums[k] = sum;
    freeze();
  }

 private:
  /// True where the bound limits it.
  bool move(std::size_t k, Scalar by) noexcept {
    const Scalar wanted = sums()[k] + by, most = settings_.most[k];
    learnt_.sums[k] = wanted > most ? most : (wanted < -most ? -most : wanted);
    return wanted > most || wanted < -most;
  }
  static Scalar share(Scalar time_constant_s, Scalar period_s) noexcept {
    return period_s / (period_s + time_constant_s);
  }
  static Scalar by_noise(Scalar time_s) noexcept {
    return time_s < BiasSettings<Scalar>::longest_by_noise_s ? time_s : BiasSettings<Scalar>::longest_by_noise_s;
  }
  static Scalar longer(Scalar own_s, Scalar least_s) noexcept { return own_s < least_s ? least_s : own_s; }
  Vector3<Scalar> within_most(const Vector3<Scalar>& across) const noexcept {
    const Scalar norm = across.norm();
    if (!(norm > settings_.most_across_m_s2)) return across;
    return settings_.most_across_m_s2 / norm * across;
  }
  static Scalar length(Scalar value) noexcept { return value < Scalar(0) ? -value : value; }

  /// Slowly: a time constant that changes from motion to motion lets through what cancels from one to the next.
  void listen(const SignedSums<Scalar>& residual, const Vector3<Scalar>& beside, Scalar period_s) noexcept {
    const Scalar by = share(Scalar(1), period_s);
    const Scalar roll_pitch = length(residual[1] - sums()[1]) + length(residual[2] - sums()[2]);
    learnt_.roll_pitch_noise += by * (roll_pitch - learnt_.roll_pitch_noise);
    const Scalar across = length(beside[0]) + length(beside[1]) + length(beside[2]);
    learnt_.across_noise_m_s2 += by * (across - learnt_.across_noise_m_s2);
  }

  BiasSettings<Scalar> settings_;
  SignedMix<Scalar> mix_;
  Learnt learnt_{};
};

}  // namespace detail
}  // namespace pinnquad
