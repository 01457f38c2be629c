// SPDX-License-Identifier: MIT
// A vehicle that nobody knows, learnt while it flies: rows of 20 ms from what the rotors really did -> triangles of
// each signed sum and lag -> candidate -> proof -> two seconds beside what flies -> swap. Inverse, bias and drag across
// the thrust fly from the first tick; where nothing is proven the inverse is the start's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/control/onboard/affine_inverse.hpp"
#include "pinnquad/control/onboard/excitation.hpp"
#include "pinnquad/control/onboard/forward_model.hpp"
#include "pinnquad/control/onboard/lag_bank.hpp"
#include "pinnquad/control/onboard/onboard_settings.hpp"
#include "pinnquad/control/onboard/proof.hpp"
#include "pinnquad/control/onboard/sine_answer.hpp"
#include "pinnquad/control/onboard/sum_regression.hpp"
#include "pinnquad/control/tick_clock.hpp"

namespace pinnquad {

/// A feed-forward policy (control/feed_forward.hpp) that learns in flight and knows of an acceleration across. Commands
/// are thrust fractions through the start's curves; its signs are what is known of the vehicle for sure.
template <class Scalar>
class OnboardInverse {
 public:
  /// Certificate of a signed sum; of thrust, roll, pitch, yaw.
  using Sum = detail::OnboardSum<Scalar>;
  using Certificate = std::array<Sum, 4>;

  explicit OnboardInverse(const Airframe<Scalar>& start, const OnboardSettings<Scalar>& settings = {}) noexcept
      : start_(start),
        settings_(settings),
        regression_(settings.regression, settings.period_us),
        motion_(settings.period_us),
        bank_(settings.period_us, settings.delay_s),
        bias_(start, settings.bias) {
    const detail::ForwardModel<Scalar> model = forward_model(start);
    for (std::size_t k = 0; k < 4; ++k) {
      flown_[k].forward = before_[k].forward = model[k];
      start_terms_[k] = {model[k].theta[2], model[k].slope()};
    }
  }

  /// Gentle sines on what is asked for, from the next tick on; without them only where a sum is unknown, fainter.
  void excite(bool on) noexcept {
    begun_ = begun_ && on == excited_;
    excited_ = on;
  }
  /// No model is swapped any more; the bias goes on.
  void freeze(bool on) noexcept { frozen_ = on; }

  /// One tick, before the inverse is asked: the state, and the commands in force since the tick before. `known`: they
  /// drove the motors, in flight, and the state is fresh. A row is of two periods in which no command was at its end;
  /// the bias learns of the others too: the rotors follow a command at its end as any other one.
  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    const Scalar step_s = clock_.step_s(now_us);
    motion_.velocity(now_us, state.velocity_m_s);
    motion_.body_rates(now_us, state.body_rates_rad_s);
    const bool sound = known && step_s > Scalar(0) && all_finite(state) && all_finite(commands);
    const bool at_end = !sound || saturated(commands);
    const bool ended = motion_.tick(now_us, sound, state, commands);
    const std::uint64_t number = now_us / settings_.period_us;
    const bool is_row = !(at_end || at_end_before_ || at_end_now_);
    if (number != number_) {
      number_ = number;
      at_end_before_ = at_end_now_;
      at_end_now_ = false;
    }
    at_end_now_ = at_end_now_ || at_end;
    if (sound) {
      Commands<Scalar> fractions{};
      for (std::size_t i = 0; i < fractions.size(); ++i) {
        fractions[i] = thrust_fraction(start_.rotors[i].thrust_curve, commands[i]);
      }
      if (!follows_) bank_.restart(fractions, bias_.mix());
      if (ended && bank_.finish()) window(now_us, is_row);
      bank_.tick(now_us, step_s, fractions, bias_.mix());
    }
    follows_ = sound;
    if (!ended) bias_.wait(step_s);
  }

  /// `not_finite` of a state or motion that is no number, `output_not_finite`, else `ok`. Commands may lie beyond 0 and
  /// 1: they are to be desaturated (control/desaturate.hpp).
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t now_us,
                    Commands<Scalar>& commands) noexcept {
    const bool finite = all_finite(state) && all_finite(wanted.linear_m_s2) && all_finite(wanted.angular_rad_s2);
    if (!finite) return Status::not_finite;
    const Accelerations<Scalar> added = sines(now_us);
    const detail::SumMotion<Scalar> motion = detail::sum_motion(
        motion_inputs(state, {wanted.linear_m_s2 + added.linear_m_s2, wanted.angular_rad_s2 + added.angular_rad_s2}));
    const detail::AffineInverse<Scalar> inverse = detail::affine_inverse(forward());
    const SignedSums<Scalar>& bias = bias_.sums();
    SignedSums<Scalar> sums{};
    for (std::size_t k = 0; k < 4; ++k) {
      sums[k] = inverse[k].of(k, motion) + (bias[k] + inverse[k].by_total * bias[0]);
    }
    const detail::SignedMix<Scalar>& mix = bias_.mix();
    Commands<Scalar> result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
      Scalar fraction(0);
      for (std::size_t k = 0; k < 4; ++k) fraction += mix.by[i][k] * sums[k];
      result[i] = command_of_fraction(start_.rotors[i].thrust_curve, fraction);
    }
    // a mix of 0 is none: the vehicle's signs do not distinguish the axes
    if (!all_finite(result) || !(mix.signs[0][0] > Scalar(0))) return Status::output_not_finite;
    commands = result;
    return Status::ok;
  }
  /// Time in seconds would be truncated.
  template <class Seconds, std::enable_if_t<std::is_floating_point_v<Seconds>, int> = 0>
  Status operator()(const State<Scalar>&, const Accelerations<Scalar>&, Seconds, Commands<Scalar>&) = delete;

  /// Drag across the thrust and the bias beside it, NED.
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept {
    return body_to_world<Scalar>(state.attitude, drag_.of(body_velocity(state))) + bias_.across_ahead_m_s2();
  }

  /// The sums that fly now, at any tick.
  const Certificate& certificate() const noexcept { return flown_; }
  /// Their model; inverted (affine_inverse()) it answers, with sines and bias beside it.
  detail::ForwardModel<Scalar> forward() const noexcept {
    return {flown_[0].forward, flown_[1].forward, flown_[2].forward, flown_[3].forward};
  }
  /// The motion of the last row.
  const MotionInputs<Scalar>& motion() const noexcept { return motion_.motion(); }
  /// The sums that were proposed last, whether they will fly or not.
  const Certificate& candidate() const noexcept { return candidate_; }
  const OnboardSettings<Scalar>& settings() const noexcept { return settings_; }
  const detail::LateralDrag<Scalar>& drag() const noexcept { return drag_; }
  const detail::MotionBias<Scalar>& bias() const noexcept { return bias_; }
  std::uint32_t rows() const noexcept { return rows_; }  ///< since the start
  /// The start with the slopes that fly, for limits and desaturation: thrust by coefficient, torques by inertia.
  Airframe<Scalar> airframe() const noexcept {
    Airframe<Scalar> flown = start_;
    const Scalar thrust = flown_[0].forward.slope() / start_terms_[0].slope;
    flown.thrust_coefficient *= thrust;
    flown.power_coefficient *= thrust;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      flown.inertia_kg_m2[axis] *= thrust * start_terms_[axis + 1].slope / flown_[axis + 1].forward.slope();
    }
    return flown;
  }

 private:
  using Motion = detail::SumMotion<Scalar>;
  static constexpr std::uint32_t rows_to_settle = 6;

  /// The forward residuals of sums, past a bias of their own, as the one that flies has.
  struct Shadow {
    SignedSums<Scalar> bias{};
    std::array<Scalar, 4> left{};    ///< until they make a row
    std::array<Scalar, 4> square{};  ///< sums of squares
  };
  Accelerations<Scalar> sines(std::uint64_t now_us) noexcept {
    if (!begun_) begun_us_ = now_us;
    begun_ = true;
    std::array<Scalar, 4> slopes{}, shares{};
    for (std::size_t k = 0; k < 4; ++k) {
      slopes[k] = flown_[k].forward.slope();
      shares[k] = sine_share(k);
    }
    return excitation(settings_.excitation, now_us - begun_us_, slopes, shares);
  }
  Scalar sine_share(std::size_t k) const noexcept {
    const bool unknown = !flown_[k].proven && !frozen_;
    return excited_ ? Scalar(1) : (unknown ? settings_.excitation.share_unknown : Scalar(0));
  }
  void listen(std::uint64_t now_us, const Motion& motion) noexcept {
    std::array<Scalar, 4> amplitudes{};
    for (std::size_t k = 0; k < 4; ++k)
      amplitudes[k] = detail::sine_amplitudes(settings_.excitation, k, flown_[k].forward.slope(), sine_share(k)).fast;
    if (!begun_ || now_us - begun_us_ < settings_.period_us) return;
    const Scalar t_s = detail::sine_time_s<Scalar>(now_us - begun_us_ - settings_.period_us);  // a row's middle
    const detail::AskedSines<Scalar> asked = detail::asked_sines(t_s, settings_.excitation, amplitudes);
    answer_.add(asked, motion, bank_, regression_.keep());
    second_.add(asked, motion, bank_, Scalar(1));
  }

  /// Two periods of flight; a row where no command was at its end.
  void window(std::uint64_t now_us, bool is_row) noexcept {
    if (!taught(now_us, is_row)) return;
    ++rows_;
    if (++rows_since_ < settings_.rows_of_candidate) return;
    rows_since_ = 0;
    if (!answers()) return;
    if (!frozen_) drag_ = regression_.drag();
    if (judging_ && judged_ < settings_.rows_of_gain) return;
    if (judging_) decide();
    propose();
  }
  /// Teaches bias and regression; false: no row. Out of line: its motion is off the stack as a candidate is made.
  PINNQUAD_NOINLINE bool taught(std::uint64_t now_us, bool is_row) noexcept {
    const MotionInputs<Scalar>& flown = motion_.motion();
    const Motion motion = detail::sum_motion(flown);
    SignedSums<Scalar> residual{};
    for (std::size_t k = 0; k < 4; ++k) residual[k] = lacking(k, flown_[k].forward, motion);
    // desaturation gives yaw up, and its sum swings: by the start's slope a bias of such swings is none
    if (!is_row && !flown_[3].proven) residual[3] = bias_.sums()[3];
    Vector3<Scalar> across = SpecificForce::of<Scalar>(flown);
    const Vector3<Scalar> force = across;
    across[2] = Scalar(0);
    across -= drag_.of(motion.velocity_m_s);
    bias_.time_constants(bias_times_s());
    if (!has_output(bias_.learn(residual, body_to_world<Scalar>(flown.attitude, across), period_s()))) return false;
    bias_age_s_ += period_s();
    if (!is_row) return false;
    judge(motion, residual);
    listen(now_us, motion);
    regression_.teach(now_us, motion, bank_, force);
    return true;
  }

  Scalar period_s() const noexcept { return motion_.period_s(Scalar(0)); }
  static constexpr Scalar magnitude(Scalar value) noexcept { return value < Scalar(0) ? -value : value; }

  /// Nothing is known of a young bias: it is nearly the mean of its rows, before a centre of gravity that is off turns
  /// the vehicle over.
  SignedSums<Scalar> bias_times_s() const noexcept {
    SignedSums<Scalar> times_s = settings_.bias.time_constants_s;
    for (Scalar& time_s : times_s) {
      if (time_s > settings_.young_bias_s + bias_age_s_) time_s = settings_.young_bias_s + bias_age_s_;
    }
    return times_s;
  }

  /// The sum that the rotors followed, less the one that the model says.
  Scalar lacking(std::size_t k, const detail::ForwardSum<Scalar>& sum, const Motion& motion) const noexcept {
    const detail::Followed<Scalar> own = bank_.at(k, sum.lag);
    return own.sum - sum.needed(k, motion, bank_.at(0, sum.lag).sum, own.rise_1_s);
  }

  /// False where roll and pitch make little of a second of sines: the vehicle stands or is held. What it was taught is
  /// of no flight, and is forgotten, bias and all.
  bool answers() noexcept {
    const Scalar least = settings_.proof.least_share;
    const bool still = second_.asked(1) && second_.asked(2) && second_.share(1) < least && second_.share(2) < least;
    second_ = {};
    const bool any = still || stood_;  // the second of the lift-off too
    stood_ = still;
    if (!any) return true;
    regression_.forget();
    answer_ = {};
    bias_.reset();
    bias_age_s_ = Scalar(0);
    judging_ = false;
    for (Sum& sum : flown_) sum.refused_last = OnboardRule::still;
    return false;
  }

  /// Forward residuals of what flies, of what flew before, and of the candidate.
  void judge(const Motion& motion, const SignedSums<Scalar>& residual) noexcept {
    const bool settled = judging_ && judged_ >= rows_to_settle;
    for (std::size_t k = 0; k < 4; ++k) {
      add(own_, k, residual[k], flown_[k].forward.slope(), settled);
      if (judging_) {
        const Scalar said = lacking(k, candidate_[k].forward, motion);
        if (judged_ == 0) shadow_.bias[k] = said;
        add(shadow_, k, said, candidate_[k].forward.slope(), settled);
      }
    }
    if (judging_) ++judged_;
    watch(motion, residual);
  }
  /// A torque's residuals count as its rows do: by means.
  void add(Shadow& of, std::size_t k, Scalar residual, Scalar slope, bool settled) const noexcept {
    const Scalar beside = residual - of.bias[k];
    of.bias[k] += period_s() / (period_s() + settings_.bias.time_constants_s[k]) * beside;
    if (!settled) return;
    const std::uint32_t rows = k == 0 ? 1 : settings_.regression.rows_of_torque;
    of.left[k] += beside * slope;
    if ((judged_ - rows_to_settle + 1) % rows != 0) return;
    of.square[k] += of.left[k] * of.left[k] / Scalar(rows);
    of.left[k] = Scalar(0);
  }

  /// A candidate of each sum.
  void propose() noexcept {
    const detail::LagPlace<Scalar> lag =
        regression_.best_lag(detail::lag_place(start_.rotor_time_constant_s).seconds());
    judging_ = false;
    for (std::size_t k = 0; k < 4; ++k) {
      detail::ForwardSum<Scalar> start{};
      start.theta[2] = start_terms_[k].second;
      start.theta[detail::own_term] = start_terms_[k].slope;
      const detail::SumSolution<Scalar> solution = regression_.solution(k, lag, start);
      Sum& sum = candidate_[k];
      sum.forward = {solution.theta, lag};
      sum.half_width = detail::half_width(k, solution);
      sum.terms_bound = detail::terms_bound(k, sum.forward, start);
      sum.left_square = solution.left_square;
      const detail::SineWitness<Scalar> sines{answer_.share(k), answer_.slope(k, sum.forward, settings_.excitation)};
      sum.refused_last =
          detail::refusal(k, sum.forward, start, solution, regression_.rows(k), candidate_[0].forward.slope(), sines,
                          start_.propeller_diameter_m, settings_.proof);
    }
    const auto late = [this](std::size_t k) noexcept { return candidate_[k].refused_last == OnboardRule::lag_unknown; };
    const bool any_late = late(1) || late(2);  // samples that come late are of all sums
    for (std::size_t k = 0; k < 4; ++k) {
      Sum& sum = candidate_[k];
      if (any_late && sum.refused_last == OnboardRule::none) sum.refused_last = OnboardRule::lag_unknown;
      sum.proven = sum.refused_last == OnboardRule::none;
      judging_ = judging_ || sum.proven;
      if (!sum.proven) flown_[k].refused_last = sum.refused_last;
    }
    own_.square = shadow_.square = own_.left = shadow_.left = {};
    judged_ = 0;
  }

  /// Each sum by itself: what is proven flies where it explains the rows since it was proposed better.
  void decide() noexcept {
    const auto rows = Scalar(judged_ - rows_to_settle);
    for (std::size_t k = 0; k < 4; ++k) {
      Sum& sum = candidate_[k];
      if (!sum.proven) continue;
      sum.gain = shadow_.square[k] / own_.square[k];
      flown_[k].refused_last = verdict(k, sum, shadow_.square[k] / rows);
      if (flown_[k].refused_last == OnboardRule::none) swap(k, sum, shadow_.bias[k]);
    }
  }
  static bool elsewhere(const Sum& sum, const Sum& other) noexcept {
    return magnitude(sum.forward.slope() - other.forward.slope()) > sum.half_width;
  }
  /// An interval that is narrower, or elsewhere, is worth a swap by itself, if nothing is lost.
  OnboardRule verdict(std::size_t k, const Sum& sum, Scalar square) const noexcept {
    const Sum& flown = flown_[k];
    if (square > settings_.proof.most_contradiction * sum.left_square) return OnboardRule::contradicted;
    const bool tighter = !flown.proven || sum.half_width < flown.half_width;
    if (!(sum.gain < (elsewhere(sum, flown) || tighter ? Scalar(1.005) : Scalar(0.98)))) return OnboardRule::no_gain;
    return frozen_ ? OnboardRule::frozen : OnboardRule::none;
  }
  void swap(std::size_t k, const Sum& sum, Scalar bias) noexcept {
    if (elsewhere(sum, flown_[k])) {  // a finer one of the same slope is no other model
      before_[k] = flown_[k];
      past_bias_[k] = own_.bias[k];
    }
    flown_[k] = sum;
    flown_[k].proven_row = rows_;
    past_square_[k] = watched_square_[k] = first_square_[k] = Scalar(0);
    watched_rows_[k] = 0;
    own_.bias[k] = bias;
    bias_.resume(k, bias);
  }

  /// A proven sum whose residual over two seconds is twice that of its first two flies no longer where the one before
  /// it has less.
  void watch(const Motion& motion, const SignedSums<Scalar>& residual) noexcept {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!flown_[k].proven) continue;
      const Scalar said = lacking(k, before_[k].forward, motion) - past_bias_[k];
      past_bias_[k] += period_s() / (period_s() + settings_.bias.time_constants_s[k]) * said;
      const Scalar a = (residual[k] - own_.bias[k]) * flown_[k].forward.slope(), b = said * before_[k].forward.slope();
      watched_square_[k] += a * a;
      past_square_[k] += b * b;
      if (++watched_rows_[k] < settings_.rows_of_gain) continue;
      if (!(first_square_[k] > Scalar(0))) first_square_[k] = watched_square_[k];
      const bool doubled = watched_square_[k] > Scalar(4) * first_square_[k];
      if (doubled && past_square_[k] < Scalar(0.8) * watched_square_[k] && !frozen_) {
        const Sum again = before_[k];
        swap(k, again, past_bias_[k]);
        flown_[k].refused_last = OnboardRule::went_back;
        judging_ = false;
      }
      watched_square_[k] = past_square_[k] = Scalar(0);
      watched_rows_[k] = 0;
    }
  }

  /// Terms of the start's sums that are not 0: of drag along z or the product of body rates, and the own.
  struct StartTerms {
    Scalar second, slope;
  };

  Airframe<Scalar> start_;
  std::array<StartTerms, 4> start_terms_{};
  OnboardSettings<Scalar> settings_;
  detail::SumRegression<Scalar> regression_;
  Certificate flown_{}, candidate_{}, before_{};
  Shadow own_{}, shadow_{};
  SignedSums<Scalar> past_bias_{};                                           ///< of the sum that flew before
  std::array<Scalar, 4> past_square_{}, watched_square_{}, first_square_{};  ///< over two seconds; the first two
  std::array<std::uint32_t, 4> watched_rows_{};
  detail::SineAnswer<Scalar> answer_{}, second_{};  ///< of the rows remembered, and of the last second
  detail::LateralDrag<Scalar> drag_{};
  FlownMotion<Scalar, detail::RotorFollower<Scalar, 0>> motion_;
  detail::LagBank<Scalar> bank_;
  detail::MotionBias<Scalar> bias_;
  detail::TickClock<Scalar> clock_;
  std::uint64_t begun_us_ = 0, number_ = 0;  ///< of the period
  Scalar bias_age_s_{0};                     ///< time of the rows that it has learnt from
  std::uint32_t rows_ = 0, rows_since_ = 0, judged_ = 0;
  bool at_end_now_ = false, at_end_before_ = false;  ///< a command was, in this period and in the one before
  bool excited_ = false, begun_ = false, frozen_ = false, follows_ = false, judging_ = false, stood_ = false;
};

}  // namespace pinnquad
