// SPDX-License-Identifier: MIT
// Settings of an OnboardInverse, and its certificate of each signed sum that flies.
#pragma once

#include <array>
#include <cstdint>

#include "pinnquad/control/motion_bias.hpp"
#include "pinnquad/control/onboard/excitation.hpp"
#include "pinnquad/control/onboard/forward_model.hpp"
#include "pinnquad/control/onboard/proof.hpp"
#include "pinnquad/control/onboard/sum_regression.hpp"

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
  Scalar delay_s = Scalar(0.006);        ///< of a state beside the commands; what it lacks is learnt
  std::uint32_t rows_of_candidate = 50;  ///< a candidate each second
  std::uint32_t rows_of_gain = 100;      ///< is judged for two
  RegressionSettings<Scalar> regression{};
  BiasSettings<Scalar> bias = detail::unknown_vehicle_bias<Scalar>();
  Scalar young_bias_s = Scalar(0.1);  ///< its time constants at first; its age is added until they are the bias' own
  ExcitationSettings<Scalar> excitation{};
  ProofSettings<Scalar> proof{};
};

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
template <class Scalar>
using OnboardCertificate = std::array<OnboardSum<Scalar>, 4>;

}  // namespace pinnquad
