// SPDX-License-Identifier: MIT
// A monotone model made its own mirror image, exactly and for every input; what is proven of it stays proven
// (docs/certificate.md): a slope about an axis is the same on both sides.
#pragma once

#include <algorithm>

#include "pinnquad/model/symmetrised.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"

namespace pinnquad {

/// MonotonePredictor with a residual that is symmetrised: as many parameters, at the same places.
template <class Features, class Residual>
using SymmetricMonotonePredictor =
    MonotonePredictor<Features, SymmetricPredictor<ResidualFeatures<Features>, Residual>>;

/// The answer without what differs between left and right: weights of the base from features that a mirror turns to sums
/// that it leaves, and the other way round, are 0, bounds of a sum that it turns are as far on both sides. Fitted to rows
/// and their mirror images (training/symmetric_rows.hpp), standardised by context_of_mirror_images(), little is taken.
template <class Features, class Residual>
SymmetricMonotonePredictor<Features, Residual> own_mirror_image(const MonotonePredictor<Features, Residual>& fitted) {
  using Base = MonotoneBase<Features, typename Residual::Scalar>;
  constexpr auto turned = [](int sum) { return sum % 2 == 1; };  // those about roll and yaw
  SymmetricMonotonePredictor<Features, Residual> answer;
  answer.parameters = fitted.parameters;
  auto* const base = answer.parameters.data();
  auto* const lower = base + Base::parameter_count;
  auto* const upper = lower + 4;
  for (int sum = 0; sum < 4; ++sum) {
    Base::Threes::each_other([&](int feature, int n) {
      if (is_odd<Features>(feature) != turned(sum)) base[Base::weights + sum * Base::Threes::others + n] = 0;
    });
    if (!turned(sum)) continue;
    base[Base::intercepts + sum] = 0;
    upper[sum] = std::max(upper[sum], -lower[sum]);
    lower[sum] = -upper[sum];
  }
  return answer;
}

}  // namespace pinnquad
