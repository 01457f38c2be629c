// SPDX-License-Identifier: MIT
// A residual that is shown the angular acceleration, and kept after each step from turning a slope round: its path
// bound (model/path_bound.hpp of the program) is less than the base's slope. Not proven by a certificate, which is of
// residuals that are not shown it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <stdexcept>
#include <vector>

#include "model/path_bound.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"

namespace study {

using namespace pinnquad;

/// Bounds of d(output)/d(input) of a Network for every input, both standardised. It has at most 3 Dense layers, with
/// activations of slope 0 to 1 between them: with each layer more the bound is further above what the network does.
template <class NetworkType>
programs::Intervals path_bound(const typename NetworkType::Parameters& parameters, int input) {
  static_assert(NetworkType::layer_count <= 5 && NetworkType::layer_count % 2 == 1);
  std::vector<std::size_t> widths;
  for (int layer = 0; layer < NetworkType::layer_count; layer += 2) {
    widths.push_back(static_cast<std::size_t>(NetworkType::Sizes::outputs[static_cast<std::size_t>(layer)]));
  }
  programs::Intervals first;
  for (std::size_t row = 0; row < widths[0]; ++row) {
    const auto weight =
        static_cast<double>(parameters[row * std::size_t(NetworkType::inputs) + static_cast<std::size_t>(input)]);
    first.least.push_back(weight < 0 ? weight : 0);
    first.most.push_back(weight > 0 ? weight : 0);
  }
  return programs::path_bound_behind_first(parameters.data(), std::size_t(NetworkType::inputs), widths, first);
}

namespace detail {

/// Keeps a network that is shown the angular acceleration from turning a base's slope round. Each column of its first
/// layer that takes an angular acceleration is scaled by min(1, share slope / d). d is the path bound of its effect on
/// the other three axis commands and of what it takes off the slope of its own, so that each rotor keeps its direction
/// too. d is proportional to the column: once is enough. Each tap of a window has an equal part of the lesser of the
/// present's slope and the held one.
///   trainer.epoch(data, progress, engine, [&](auto& trained) { trained.project(projection); });
template <class ContextType, class Residual>
class PathProjection {
  using Features = typename ContextType::Features;
  using Base = MonotoneBase<Features>;

 public:
  /// `map`: the base, standardised by `context`; its slopes are above 0. Throws std::invalid_argument for another one,
  /// and for a share outside 0 to below 1.
  PathProjection(const ContextType& context, const AffineMap& map, double share = 0.9) {
    if (!(share >= 0 && share < 1)) throw std::invalid_argument("path projection: expected a share from 0 to below 1");
    Base::Threes::each([&](int place, int tap) { places_[static_cast<std::size_t>(tap)] = place; });
    for (std::size_t k = 0; k < 4; ++k) output_deviation_[k] = context.output.standard_deviation[k];
    for (int axis = 0; axis < 3; ++axis) {
      double present = 0, held = 0;
      for (int tap = 0; tap < Base::taps; ++tap) {
        const int place = places_[static_cast<std::size_t>(tap)] + axis;
        const double deviation = context.input.standard_deviation[static_cast<std::size_t>(place)];
        deviation_[static_cast<std::size_t>(3 * tap + axis)] = deviation;
        const double slope = map.weights.at(static_cast<std::size_t>((1 + axis) * Features::size + place)) *
                             output_deviation_[static_cast<std::size_t>(1 + axis)] / deviation;
        if (tap == 0) present = slope;
        held += slope;
      }
      const double least = std::min(present, held);
      if (!(least > 0)) throw std::invalid_argument("path projection: expected a base whose slopes are above 0");
      allowed_[static_cast<std::size_t>(axis)] = share * least / Base::taps;
    }
  }

  void operator()(typename Residual::Parameters& parameters) const {
    constexpr int rows = Residual::template Layer<0>::outputs;
    for (int tap = 0; tap < Base::taps; ++tap) {
      for (int axis = 0; axis < 3; ++axis) {
        const int place = places_[static_cast<std::size_t>(tap)] + axis;
        const double most = danger(path_bound<Residual>(parameters, place), axis) /
                            deviation_[static_cast<std::size_t>(3 * tap + axis)];
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
  double danger(const programs::Intervals& bound, int axis) const noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double below = -bound.least[k], worst = std::max(below, bound.most[k]);
      sum += (static_cast<int>(k) == 1 + axis ? below : worst) * output_deviation_[k];
    }
    return sum;
  }

  std::array<int, static_cast<std::size_t>(Base::taps)> places_{};
  std::array<double, static_cast<std::size_t>(3 * Base::taps)> deviation_{};
  std::array<double, 4> output_deviation_{};
  std::array<double, 3> allowed_{};
};

}  // namespace detail

/// As fit_monotone(), but the residual is shown all features. `Residual`: as path_bound() takes it. `share`: of a
/// slope, the most that the residual may take away.
template <class Residual, class ContextType>
auto fit_path_bounded(const ContextType& context, const RowSet& training, const RowSet& validation,
                      const AffineMap& map, const ResidualTraining& how, std::mt19937_64& engine, const GoesOn& goes_on,
                      double share = 0.9) {
  using Features = typename ContextType::Features;
  using Base = MonotoneBase<Features>;
  using Predictor = Sum<Base, Saturated<Residual>>;
  const auto kind = pinnquad::detail::residual_kind<Residual, Predictor, Base>(
      true, [projection = detail::PathProjection<ContextType, Residual>(context, map, share)](auto& trained) {
        trained.project(projection);
      });
  return pinnquad::detail::fit_residual<Base, Predictor>(context, kind, training, validation, map, how, engine,
                                                         goes_on);
}

}  // namespace study
