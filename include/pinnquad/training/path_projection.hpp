// SPDX-License-Identifier: MIT
// Keeps a network that is shown the angular acceleration from turning a base's slope round, step by step of a training:
//   trainer.epoch(data, progress, engine, [&](auto& trained) { trained.project(projection); });
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>

#include "pinnquad/model/path_bound.hpp"
#include "pinnquad/training/closed_form.hpp"

namespace pinnquad {

/// Of a residual on a monotone base (training/monotone_base.hpp): each column of its first layer that takes an angular
/// acceleration is scaled by min(1, share slope / d), d = what the path bound allows it to take off the slope of its own
/// signed sum and to do to the other three, so that each rotor keeps its direction too. d is proportional to the column:
/// once is enough. Of a window each tap has an equal part of the lesser of the present's slope and the held one.
template <class ContextType, class Residual>
class PathProjection {
  using Features = typename ContextType::Features;
  using Base = MonotoneBase<Features>;
  using Path = PathBounded<Residual>;

 public:
  /// `map`: the base, standardised by `context`; its slopes are above 0. Throws std::invalid_argument for another one, and
  /// for a share that is not one of 0 to below 1.
  PathProjection(const ContextType& context, const AffineMap& map, double share = 0.9) {
    if (!(share >= 0 && share < 1)) throw std::invalid_argument("path projection: expected a share from 0 to below 1");
    Base::Threes::each([&](int place, int tap) { places_[static_cast<std::size_t>(tap)] = place; });
    for (std::size_t k = 0; k < 4; ++k) output_spread_[k] = context.output.standard_deviation[k];
    for (int axis = 0; axis < 3; ++axis) {
      double present = 0, held = 0;
      for (int tap = 0; tap < Base::taps; ++tap) {
        const int place = places_[static_cast<std::size_t>(tap)] + axis;
        const double spread = context.input.standard_deviation[static_cast<std::size_t>(place)];
        spread_[static_cast<std::size_t>(3 * tap + axis)] = spread;
        const double slope = map.weights.at(static_cast<std::size_t>((1 + axis) * Features::size + place)) *
                             output_spread_[static_cast<std::size_t>(1 + axis)] / spread;
        if (tap == 0) present = slope;
        held += slope;
      }
      const double least = std::min(present, held);
      if (!(least > 0)) throw std::invalid_argument("path projection: expected a base whose slopes are above 0");
      allowed_[static_cast<std::size_t>(axis)] = share * least / Base::taps;
    }
  }

  void operator()(typename Residual::Parameters& parameters) const noexcept {
    constexpr int rows = Residual::template Layer<0>::outputs;
    for (int tap = 0; tap < Base::taps; ++tap) {
      for (int axis = 0; axis < 3; ++axis) {
        const int place = places_[static_cast<std::size_t>(tap)] + axis;
        const double most =
            danger(Path::bound(parameters.data(), place), axis) / spread_[static_cast<std::size_t>(3 * tap + axis)];
        const double allowed = allowed_[static_cast<std::size_t>(axis)];
        if (!(most > allowed)) continue;
        const auto factor = static_cast<typename Residual::Scalar>(allowed / most);
        for (int row = 0; row < rows; ++row) {
          parameters[static_cast<std::size_t>(row * Residual::inputs + place)] *= factor;
        }
      }
    }
  }

 private:
  double danger(const PathBound<4>& bound, int axis) const noexcept {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const double below = -bound.lower[k], worst = std::max(below, bound.upper[k]);
      sum += (k == 1 + axis ? below : worst) * output_spread_[static_cast<std::size_t>(k)];
    }
    return sum;
  }

  std::array<int, static_cast<std::size_t>(Base::taps)> places_{};
  std::array<double, static_cast<std::size_t>(3 * Base::taps)> spread_{};
  std::array<double, 4> output_spread_{};
  std::array<double, 3> allowed_{};
};

}  // namespace pinnquad
