// SPDX-License-Identifier: MIT
// A vehicle that nobody knows, learnt while it flies: rows of 20 ms from what the rotors really did -> triangles of
// each signed sum and lag -> candidate -> proof -> two seconds beside what flies -> swap. Inverse, bias and drag across
// the thrust fly from the first tick; where nothing is proven the inverse is the start's.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/control/onboard/excitation.hpp"
#include "pinnquad/control/onboard/forward_model.hpp"
#include "pinnquad/control/onboard/lag_bank.hpp"
#include "pinnquad/control/onboard/proof.hpp"
#include "pinnquad/control/onboard/triangle.hpp"
#include "pinnquad/control/tick_clock.hpp"

namespace pinnquad {

namespace detail {
template <class Scalar>
constexpr BiasSettings<Scalar> unknown_vehicle_bias() noexcept {
  BiasSettings<Scalar> settings;
  settings.most = {Scalar(2.4), Scalar(1), Scalar(1), Scalar(1)};
  return settings;
}
}  // namespace detail

/// Settings of an OnboardInverse.
template <class Scalar>
struct OnboardSettings {
  std::uint32_t period_us = 20'000;
  Scalar delay_s = Scalar(0.004);  ///< by which a state comes late beside the commands; the lags of the bank add to it
  Scalar forget_s = Scalar(20);
  Scalar forget_drag_s = Scalar(30);
  Scalar repeats = Scalar(3);            ///< rows that say the same, as two of them share a period
  std::uint32_t rows_of_candidate = 50;  ///< a candidate each second
  std::uint32_t rows_of_gain = 100;      ///< is judged for two
  BiasSettings<Scalar> bias = detail::unknown_vehicle_bias<Scalar>();
  ExcitationSettings<Scalar> excitation{};
  ProofSettings<Scalar> proof{};
};

/// Drag across the thrust over the mass: a = -(linear + quadratic |v|) v of the two axes across, FRD.
template <class Scalar>
struct LateralDrag {
  Scalar linear_1_s{0}, quadratic_1_m{0};
};

/// Certificate of a signed sum as it flies.
template <class Scalar>
struct OnboardSum {
  ForwardSum<Scalar> forward{};
  bool proven = false;           ///< false: the start's
  Scalar half_width{0};          ///< of the slope's interval, in its units; 0 of the start, which has none
  Scalar terms_bound{0};         ///< most that the other terms ask for beside the start's, in units of the sum
  Scalar gain{1};                ///< mean square of its forward residual over that of the model before
  std::uint32_t proven_row = 0;  ///< the row after which it has flown
  OnboardRule refused_last = OnboardRule::few_rows;  ///< of the last candidate; `none` where that flies
};
template <class Scalar>
using OnboardCertificate = std::array<OnboardSum<Scalar>, 4>;

/// A feed-forward policy (control/feed_forward.hpp) that learns in flight and knows of an acceleration across
/// (control/adaptive_inverse.hpp). Commands are thrust fractions through the start's curves; its signs are what is
/// known of the vehicle for sure.
template <class Scalar>
class OnboardInverse {
 public:
  explicit OnboardInverse(const Airframe<Scalar>& start, const OnboardSettings<Scalar>& settings = {}) noexcept
      : start_(start),
        settings_(settings),
        mix_(detail::signed_mix(start)),
        start_model_(forward_model(start)),
        motion_(FlownMotionSettings<Scalar>{settings.period_us, Scalar(0), Scalar(0)}),
        bank_(settings.period_us, settings.delay_s),
        bias_(start, settings.bias) {
    using std::exp;
    const Scalar period_s = Scalar(1e-6) * static_cast<Scalar>(settings.period_us);
    root_keep_ = exp(-period_s / (Scalar(2) * settings.forget_s));
    root_keep_drag_ = exp(-period_s / (Scalar(4) * settings.forget_drag_s));  // two rows a period
    for (std::size_t k = 0; k < 4; ++k) flown_[k].forward = start_model_[k];
  }

  /// Gentle sines on what is asked for, from the next tick on; without them only where a sum is unknown, fainter.
  void excite(bool on) noexcept {
    excited_ = on;
    begun_ = begun_ && on;
  }
  /// No model is swapped any more; the bias goes on.
  void freeze(bool on) noexcept { frozen_ = on; }

  /// One tick, before the inverse is asked: the state, and the commands in force since the tick before. `known`: they
  /// drove the motors, in flight, and the state is fresh. A row is of two periods in which no command was at its end.
  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s = clock_.step_s(now_us);
    motion_.velocity(now_us, state.velocity_m_s);
    motion_.body_rates(now_us, state.body_rates_rad_s);
    const bool sound = known && step_s > Scalar(0) && all_finite(state) && all_finite(commands);
    const bool ended = motion_.tick(now_us, sound && !saturated(commands), state, commands);
    if (sound) {
      Commands<Scalar> fractions{};
      for (std::size_t i = 0; i < fractions.size(); ++i) {
        fractions[i] = thrust_fraction(start_.rotors[i].thrust_curve, commands[i]);
      }
      if (!follows_) bank_.restart(fractions, mix_);
      bank_.tick(now_us, step_s, ended, fractions, mix_);
    }
    follows_ = sound;
    if (ended && sound) {
      row();
    } else if (sound && saturated(commands)) {
      bias_.freeze();
    } else {
      bias_.wait(step_s);
    }
  }

  /// `not_finite` of a state or motion that is no number, `output_not_finite`, else `ok`. Commands may lie beyond 0 and
  /// 1: they are to be desaturated (control/desaturate.hpp).
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t now_us,
                    Commands<Scalar>& commands) noexcept {
    if (!(all_finite(state) && all_finite(wanted.linear_m_s2) && all_finite(wanted.angular_rad_s2))) {
      return Status::not_finite;
    }
    const Accelerations<Scalar> added = sines(now_us);
    const SumMotion<Scalar> motion = sum_motion(
        motion_inputs(state, {wanted.linear_m_s2 + added.linear_m_s2, wanted.angular_rad_s2 + added.angular_rad_s2}));
    SignedSums<Scalar> sums{};
    for (std::size_t k = 0; k < 4; ++k) {
      sums[k] = flown_[k].forward.needed(k, motion, sums[0]) + bias_.sums()[k];
    }
    Commands<Scalar> result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
      Scalar fraction(0);
      for (std::size_t k = 0; k < 4; ++k) fraction += mix_.by[i][k] * sums[k];
      result[i] = command_of_fraction(start_.rotors[i].thrust_curve, fraction);
    }
    if (!all_finite(result)) return Status::output_not_finite;
    commands = result;
    return Status::ok;
  }
  /// Time in seconds would be truncated.
  template <class Seconds, std::enable_if_t<std::is_floating_point_v<Seconds>, int> = 0>
  Status operator()(const State<Scalar>&, const Accelerations<Scalar>&, Seconds, Commands<Scalar>&) = delete;

  /// Drag across the thrust and the bias beside it, NED.
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    return drag_across(state.attitude, body_velocity(state)) + bias_.across_ahead_m_s2();
  }

  /// The sums that fly now, at any tick.
  const OnboardCertificate<Scalar>& certificate() const noexcept { return flown_; }
  const LateralDrag<Scalar>& drag() const noexcept { return drag_; }
  const MotionBias<Scalar>& bias() const noexcept { return bias_; }
  std::uint32_t rows() const noexcept { return rows_; }
  /// The start with the slopes that fly, for limits and desaturation: thrust by coefficient, torques by inertia.
  Airframe<Scalar> airframe() const noexcept {
    Airframe<Scalar> flown = start_;
    const Scalar thrust = flown_[0].forward.slope() / start_model_[0].slope();
    flown.thrust_coefficient *= thrust;
    flown.power_coefficient *= thrust;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      flown.inertia_kg_m2[axis] *= thrust * start_model_[axis + 1].slope() / flown_[axis + 1].forward.slope();
    }
    return flown;
  }

 private:
  /// Beside what flies, over the rows of a judgement: with a bias of its own, as the one that flies has.
  struct Shadow {
    SignedSums<Scalar> bias{};
    std::array<Scalar, 4> square{};  ///< sums of the forward residuals' squares, acceleration units
  };

  Accelerations<Scalar> sines(std::uint64_t now_us) noexcept {
    if (!begun_) begun_us_ = now_us;
    begun_ = true;
    std::array<Scalar, 4> slopes{}, shares{};
    for (std::size_t k = 0; k < 4; ++k) {
      slopes[k] = flown_[k].forward.slope();
      const bool unknown = !flown_[k].proven && !frozen_;
      shares[k] = excited_ ? Scalar(1) : (unknown ? settings_.excitation.share_unknown : Scalar(0));
    }
    return excitation(settings_.excitation, now_us - begun_us_, slopes, shares);
  }

  Vector3<Scalar> drag_across(const Quaternion<Scalar>& attitude, const Vector3<Scalar>& velocity_m_s) const noexcept {
    using std::sqrt;
    const Scalar speed = sqrt(dot<Scalar>(velocity_m_s, velocity_m_s));
    const Scalar by = -(drag_.linear_1_s + drag_.quadratic_1_m * speed);
    return body_to_world<Scalar>(attitude, Vector3<Scalar>(by * velocity_m_s[0], by * velocity_m_s[1], Scalar(0)));
  }

  /// A row: two periods of flight.
  void row() noexcept {
    const MotionInputs<Scalar>& flown = motion_.motion();
    const SumMotion<Scalar> motion = sum_motion(flown);
    const auto& sums = bank_.means();
    SignedSums<Scalar> residual{};
    for (std::size_t k = 0; k < 4; ++k) residual[k] = lacking(k, flown_[k].forward, motion, sums);
    judge(motion, sums, residual);
    Vector3<Scalar> across = SpecificForce::of<Scalar>(flown);
    teach_drag(motion.velocity_m_s, across);
    across[2] = Scalar(0);
    const Vector3<Scalar> beside =
        body_to_world<Scalar>(flown.attitude, across) - drag_across(flown.attitude, motion.velocity_m_s);
    if (!has_output(bias_.learn(residual, beside, motion_.period_s(Scalar(0))))) return;
    for (std::size_t lag = 0; lag < lag_count; ++lag) {
      for (std::size_t k = 0; k < 4; ++k) {
        const Terms<Scalar> x = terms_of(k, motion, sums[lag][0], sums[lag][k]);
        typename Triangle<Scalar, term_count>::Row row{};
        for (std::size_t i = 0; i < term_count; ++i) row[i] = x[i];
        row[term_count] = motion.accelerations[k];
        triangles_[lag][k].add(row, root_keep_);
      }
    }
    ++rows_;
    if (++rows_since_ < settings_.rows_of_candidate) return;
    if (!judging_) {
      propose();
    } else if (judged_ >= settings_.rows_of_gain) {
      decide();
      propose();
    }
  }

  /// Of the sum that the rotors followed, over that which the model says.
  static Scalar lacking(std::size_t k, const ForwardSum<Scalar>& sum, const SumMotion<Scalar>& motion,
                        const typename LagBank<Scalar>::Sums& sums) noexcept {
    return sums[sum.lag][k] - sum.needed(k, motion, sums[sum.lag][0]);
  }

  void teach_drag(const Vector3<Scalar>& velocity_m_s, const Vector3<Scalar>& force_m_s2) noexcept {
    using std::sqrt;
    const Scalar speed = sqrt(dot<Scalar>(velocity_m_s, velocity_m_s));
    for (int axis = 0; axis < 2; ++axis) {
      const Scalar v = velocity_m_s[axis];
      drag_triangle_.add({-v, -speed * v, force_m_s2[axis]}, root_keep_drag_);
    }
    if (frozen_ || rows_ % settings_.rows_of_candidate != 0) return;
    const TrianglePrior<Scalar, 2> prior{{Scalar(0), Scalar(0)}, {Scalar(0.2), Scalar(0.05)}};
    const TriangleSolution<Scalar, 2> solution = drag_triangle_.solve(prior, settings_.repeats);
    if (!all_finite(solution.values)) return;
    const auto within = [](Scalar value, Scalar most) noexcept {
      return value < Scalar(0) ? Scalar(0) : (value > most ? most : value);
    };
    drag_ = {within(solution.values[0], Scalar(2)), within(solution.values[1], Scalar(0.5))};
  }

  /// Forward residuals of what flies and of the candidate, each past a bias of its own that is as quick.
  void judge(const SumMotion<Scalar>& motion, const typename LagBank<Scalar>::Sums& sums,
             const SignedSums<Scalar>& residual) noexcept {
    const Scalar period_s = motion_.period_s(Scalar(0));
    for (std::size_t k = 0; k < 4; ++k) {
      const Scalar share = period_s / (period_s + settings_.bias.time_constants_s[k]);
      const Scalar own = residual[k] - own_.bias[k];
      own_.bias[k] += share * own;
      if (!judging_) continue;
      const Scalar said = lacking(k, candidate_[k].forward, motion, sums);
      if (judged_ == 0) shadow_.bias[k] = said;
      const Scalar other = said - shadow_.bias[k];
      shadow_.bias[k] += share * other;
      if (judged_ < rows_to_settle) continue;
      const Scalar a = own * flown_[k].forward.slope(), b = other * candidate_[k].forward.slope();
      own_.square[k] += a * a;
      shadow_.square[k] += b * b;
    }
    if (judging_) ++judged_;
  }

  /// A candidate of each sum, at the lag that leaves least of the angular accelerations; yaw counts a third.
  void propose() noexcept {
    using std::log;
    rows_since_ = 0;
    std::uint8_t best = 0;
    Scalar least(0);
    for (std::uint8_t lag = 0; lag < lag_count; ++lag) {
      Scalar left(0);
      for (std::size_t k = 1; k < 4; ++k) {
        const Scalar square = triangles_[lag][k].residual_square() + Scalar(1e-12);
        left += (k == 3 ? Scalar(0.3) : Scalar(1)) * log(square);
      }
      if (lag == 0 || left < least) {
        least = left;
        best = lag;
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Triangle<Scalar, term_count>& triangle = triangles_[best][k];
      const auto solution = triangle.solve(prior_of(k, start_model_[k]), settings_.repeats);
      OnboardSum<Scalar>& sum = candidate_[k];
      sum.forward = {solution.values, best};
      sum.half_width = half_width(solution);
      sum.terms_bound = terms_bound(k, sum.forward, start_model_[k]);
      sum.refused_last = refusal(k, sum.forward, start_model_[k], solution, triangle.rows(),
                                 candidate_[0].forward.slope(), start_.propeller_diameter_m, settings_.proof);
      sum.proven = sum.refused_last == OnboardRule::none;
      flown_[k].refused_last = sum.refused_last;
      solved_[k] = solution;
    }
    own_.square = shadow_.square = {};
    judged_ = 0;
    judging_ = true;
  }

  /// Each sum by itself: what is proven and explains the rows since it was proposed better flies.
  void decide() noexcept {
    judging_ = false;
    for (std::size_t k = 0; k < 4; ++k) {
      OnboardSum<Scalar>& sum = candidate_[k];
      if (!sum.proven) continue;
      const Scalar apart = sum.forward.slope() - flown_[k].forward.slope();
      const bool elsewhere = (apart < Scalar(0) ? -apart : apart) > sum.half_width;
      sum.gain = shadow_.square[k] / own_.square[k];
      const bool gains = sum.gain < (elsewhere ? Scalar(1.005) : Scalar(0.98));
      if (!gains || frozen_) {
        flown_[k].refused_last = gains ? OnboardRule::frozen : OnboardRule::no_gain;
        continue;
      }
      sum.proven_row = rows_;
      flown_[k] = sum;
      own_.bias[k] = shadow_.bias[k];
      SignedSums<Scalar> biases = bias_.sums();
      biases[k] = shadow_.bias[k];
      bias_.resume(biases, bias_.across_m_s2(), bias_.across_rate_m_s3(), bias_.noise(), Scalar(0), bias_.status());
    }
  }

 public:
  const auto& candidate() const noexcept { return candidate_; }
  const auto& solved() const noexcept { return solved_; }

 private:
  static constexpr std::uint32_t rows_to_settle = 6;

  Airframe<Scalar> start_;
  OnboardSettings<Scalar> settings_;
  detail::SignedMix<Scalar> mix_;
  ForwardModel<Scalar> start_model_;
  OnboardCertificate<Scalar> flown_{}, candidate_{};
  std::array<TriangleSolution<Scalar, term_count>, 4> solved_{};
  Shadow own_{}, shadow_{};
  std::array<std::array<Triangle<Scalar, term_count>, 4>, lag_count> triangles_{};
  Triangle<Scalar, 2> drag_triangle_{};
  LateralDrag<Scalar> drag_{};
  FlownMotion<Scalar> motion_;
  LagBank<Scalar> bank_;
  MotionBias<Scalar> bias_;
  detail::TickClock<Scalar> clock_;
  Scalar root_keep_{0}, root_keep_drag_{0};
  std::uint64_t begun_us_ = 0;
  std::uint32_t rows_ = 0, rows_since_ = 0, judged_ = 0;
  bool excited_ = false, begun_ = false, frozen_ = false, follows_ = false, judging_ = false;
};

}  // namespace pinnquad
