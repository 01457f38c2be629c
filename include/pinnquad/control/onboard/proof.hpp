// SPDX-License-Identifier: MIT
// Proof of a sum that was learnt, before it flies: each rule is one question, and a refusal is the rule that said no.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pinnquad/control/onboard/forward_model.hpp"
#include "pinnquad/control/onboard/onboard_settings.hpp"
#include "pinnquad/core/finite.hpp"

namespace pinnquad {

/// Why a sum that was learnt does not fly.
enum class OnboardRule : std::uint8_t {
  none = 0,          ///< it flies
  few_rows,          ///< too little flight that can be trusted: on the ground, saturated, late, frozen, no number
  still,             ///< the vehicle does not answer to its commands: it stands or is held
  not_finite,        ///< a term is no number
  lag_unknown,       ///< the best lag is at an end of the bank, or the state comes later than it says: late samples
  slope_impossible,  ///< beyond what mass and propeller allow, or of the wrong sign
  unexcited,         ///< the vehicle makes too little of the sines that it was asked for
  sines_disagree,    ///< its answer to them is of another slope
  uncertain,         ///< its interval is too wide
  terms_large,       ///< the other terms may grow too large in the envelope
  contradicted,      ///< the next two seconds are much further from it than the rows that it is of
  no_gain,           ///< it explains the next two seconds no better than what flies
  frozen,            ///< nobody asked for another model
  went_back,         ///< it flew, and its residual doubled
};

/// The enumerator's own name.
constexpr const char* to_string(OnboardRule rule) noexcept {
  switch (rule) {
    case OnboardRule::none: return "none";
    case OnboardRule::few_rows: return "few_rows";
    case OnboardRule::still: return "still";
    case OnboardRule::not_finite: return "not_finite";
    case OnboardRule::lag_unknown: return "lag_unknown";
    case OnboardRule::slope_impossible: return "slope_impossible";
    case OnboardRule::unexcited: return "unexcited";
    case OnboardRule::sines_disagree: return "sines_disagree";
    case OnboardRule::uncertain: return "uncertain";
    case OnboardRule::terms_large: return "terms_large";
    case OnboardRule::contradicted: return "contradicted";
    case OnboardRule::no_gain: return "no_gain";
    case OnboardRule::frozen: return "frozen";
    case OnboardRule::went_back: return "went_back";
  }
  return "unknown rule";
}

namespace detail {

/// Certificate of a signed sum as it flies.
template <class Scalar>
struct OnboardSum {
  ForwardSum<Scalar> forward{};
  bool proven = false;                              ///< false: the start's
  OnboardRule refused_last{OnboardRule::few_rows};  ///< it refused a candidate last; `none` once one flies
  Scalar half_width{0};          ///< of the slope's interval, in its units; 0 of the start, which has none
  Scalar terms_bound{0};         ///< most that the other terms ask for beside the start's, in units of the sum
  Scalar left_square{0};         ///< mean square of its residual in the rows that it is of
  Scalar gain{1};                ///< mean square of its forward residual over that of the sum that flew before
  std::uint32_t proven_row = 0;  ///< the row after which it has flown
};

/// Error of a model of so few terms, as a share of the slope: rotors that differ, a curve that is another one, noise
/// that feedback has answered. It does not fall with the rows, as the standard error does.
template <class Scalar>
inline constexpr std::array<Scalar, 4> model_error{Scalar(0.07), Scalar(0.045), Scalar(0.045), Scalar(0.02)};
/// So that nine of ten intervals of 60 vehicles hold after 20 s, in calm air and in gusts (docs/onboard.md).
template <class Scalar>
inline constexpr std::array<Scalar, 4> coverage_factor{Scalar(1.1), Scalar(2.4), Scalar(2.4), Scalar(1.2)};

/// Half of the interval of a slope: coverage_factor sqrt(standard error^2 + (model error slope)^2).
template <class Scalar>
Scalar half_width(std::size_t k, const SumSolution<Scalar>& solution) noexcept {
  using std::sqrt;
  const Scalar model = model_error<Scalar>[k] * solution.theta[own_term];
  return coverage_factor<Scalar>[k] * sqrt(solution.standard_error * solution.standard_error + model * model);
}

/// Slopes that a vehicle which flies can have, whatever it is: thrust to weight 1.2 to 16; torque slopes over that of
/// thrust, times the propeller's diameter, between those of a heavy ring and of a point (m arm D / J .5 to 30, torque
/// over thrust m D / J_z .02 to 3). `thrust`: the slope of the first sum that comes with it.
template <class Scalar>
bool slope_possible(std::size_t k, Scalar slope, Scalar thrust, Scalar propeller_diameter_m) noexcept {
  constexpr Scalar each = standard_gravity_m_s2<Scalar> / Scalar(rotor_count);
  constexpr Scalar least = Scalar(1.2) * each, most = Scalar(16) * each;
  if (k == 0) return -slope >= least && -slope <= most;
  const Scalar pull = -thrust < least ? least : (-thrust > most ? most : -thrust);
  const Scalar ratio = slope * propeller_diameter_m / pull;
  return k == 3 ? ratio >= Scalar(0.02) && ratio <= Scalar(3) : ratio >= Scalar(0.5) && ratio <= Scalar(30);
}

/// Most that the other terms of a sum ask for beside the start's, in units of the sum, over an envelope of 6 m/s,
/// 4 rad/s (yaw 2) and half of the total sum beside hover.
template <class Scalar>
Scalar terms_bound(std::size_t k, const ForwardSum<Scalar>& sum, const ForwardSum<Scalar>& start) noexcept {
  constexpr Scalar envelope[4][rise_term] = {{Scalar(0), Scalar(3), Scalar(9), Scalar(6), Scalar(6)},
                                             {Scalar(0), Scalar(4), Scalar(4), Scalar(6), Scalar(1)},
                                             {Scalar(0), Scalar(4), Scalar(4), Scalar(6), Scalar(1)},
                                             {Scalar(0), Scalar(2), Scalar(8), Scalar(0), Scalar(1)}};
  Scalar bound(0);
  for (std::size_t i = 1; i < rise_term; ++i) {
    const Scalar beside = (sum.theta[i] - start.theta[i]) / sum.slope();
    bound += envelope[k][i] * (beside < Scalar(0) ? -beside : beside);
  }
  return bound;
}

/// The vehicle's answer to the sines.
template <class Scalar>
struct SineWitness {
  Scalar share{0}, slope{0};
};

/// The first rule that refuses it, but for the gain; `none` where it is proven. `thrust`: the slope of the first sum
/// that comes with it.
template <class Scalar>
OnboardRule refusal(std::size_t k, const ForwardSum<Scalar>& sum, const ForwardSum<Scalar>& start,
                    const SumSolution<Scalar>& solution, Scalar rows, Scalar thrust, const SineWitness<Scalar>& sines,
                    Scalar propeller_diameter_m, const typename OnboardSettings<Scalar>::Proof& settings) noexcept {
  const auto magnitude = [](Scalar value) noexcept { return value < Scalar(0) ? -value : value; };
  if (!(rows >= settings.least_rows)) return OnboardRule::few_rows;
  if (!(all_finite(sum.theta) && is_finite(solution.standard_error))) return OnboardRule::not_finite;
  if (sum.lag.lower + 2u == lag_count && !(sum.lag.beside < Scalar(1))) return OnboardRule::lag_unknown;
  if (!(sum.theta[rise_term] / sum.slope() >= -settings.most_late_s)) return OnboardRule::lag_unknown;
  if (!slope_possible(k, sum.slope(), thrust, propeller_diameter_m)) return OnboardRule::slope_impossible;
  if (!(sines.share >= settings.least_share)) return OnboardRule::unexcited;
  const Scalar slope = magnitude(sum.slope());
  const Scalar apart = magnitude(sines.slope - sum.slope());
  if (!(apart <= settings.most_disagreement[k] * slope)) return OnboardRule::sines_disagree;
  if (!(half_width(k, solution) <= settings.most_half_width[k] * slope)) return OnboardRule::uncertain;
  if (!(terms_bound(k, sum, start) <= settings.most_by_terms[k])) return OnboardRule::terms_large;
  return OnboardRule::none;
}

}  // namespace detail

}  // namespace pinnquad
