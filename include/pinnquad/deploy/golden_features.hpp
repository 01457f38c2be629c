// SPDX-License-Identifier: MIT
// The feature vectors that an export is tested with, before it arms: out of the rows that its model was trained on;
// and, of a model whose residual is bounded, beyond each bound, so that a bound that was changed fails the self test.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/exported/model_agreement.hpp"

namespace pinnquad {
namespace detail {

/// Feature vectors inside the envelope at which a bounded residual would leave its bounds. Deterministic: no number is
/// drawn.
template <class Model>
class BoundSearch {
 public:
  using FeatureVector = typename Model::FeatureVector;
  using Structure = StatedStructure<typename Model::Network>;
  static constexpr std::size_t bounds = 2 * std::size_t(Model::Network::outputs);  ///< lower ones, then upper ones

  explicit BoundSearch(const Model& model) : model_(model) {}

  /// One vector for each bound that none before it passes, as far as one is found; `most` of them.
  std::vector<FeatureVector> beyond(const std::vector<FeatureVector>& rows, std::size_t most) const {
    std::vector<FeatureVector> found;
    std::array<bool, bounds> missing{};
    for (std::size_t bound = 0; bound < bounds; ++bound) missing[bound] = has_range(bound);
    for (std::size_t bound = 0; bound < bounds && found.size() < most; ++bound) {
      if (!missing[bound]) continue;
      const FeatureVector far = climbed(nearest(rows, bound), bound, missing);
      const std::array<double, bounds> by = passed(far);
      if (by[bound] < enough) continue;
      found.push_back(far);
      for (std::size_t k = 0; k < bounds; ++k) missing[k] = missing[k] && by[k] < enough;
    }
    return found;
  }

 private:
  using Scalar = typename Model::Scalar;
  static constexpr std::size_t outputs = std::size_t(Model::Network::outputs);
  static constexpr double enough = 0.05;  ///< of the residual's range

  const Scalar* parameters() const { return model_.network.parameters.data() + Structure::at; }
  bool has_range(std::size_t bound) const {
    return parameters()[outputs + bound % outputs] > parameters()[bound % outputs];
  }

  /// How far beyond each bound the residual is without it, in shares of its range.
  std::array<double, bounds> passed(const FeatureVector& x) const {
    FeatureVector z{};
    model_.input.standardise(x.data(), z.data());
    Scalar y[outputs] = {};
    Structure::Inner::forward(parameters() + bounds, z.data(), y);
    std::array<double, bounds> by{};
    for (std::size_t k = 0; k < outputs; ++k) {
      const auto lower = static_cast<double>(parameters()[k]), upper = static_cast<double>(parameters()[outputs + k]);
      by[k] = (lower - static_cast<double>(y[k])) / (upper - lower);
      by[outputs + k] = (static_cast<double>(y[k]) - upper) / (upper - lower);
    }
    return by;
  }

  /// The row at which the residual is nearest to the bound.
  FeatureVector nearest(const std::vector<FeatureVector>& rows, std::size_t bound) const {
    const FeatureVector* best = &rows.front();
    double most = passed(*best)[bound];
    for (const FeatureVector& row : rows) {
      const double by = passed(row)[bound];
      if (by > most) {
        most = by;
        best = &row;
      }
    }
    return *best;
  }

  /// The search climbs for the bound first, then for the others that no vector passes.
  double height(const FeatureVector& x, std::size_t bound, const std::array<bool, bounds>& missing) const {
    const std::array<double, bounds> by = passed(x);
    double sum = 0;
    for (std::size_t k = 0; k < bounds; ++k) {
      if (missing[k]) sum += (k == bound ? double(bounds) : 1.0) * std::min(by[k], enough);
    }
    return sum;
  }

  /// From there, one feature after the other to a border of the envelope, the one that gains most first; then back
  /// along the line, as far as no bound that it passes is lost.
  FeatureVector climbed(const FeatureVector& start, std::size_t bound, const std::array<bool, bounds>& missing) const {
    FeatureVector x = start;
    double highest = height(x, bound, missing);
    for (std::size_t step = 0; step < x.size(); ++step) {
      FeatureVector best = x;
      const double before = highest;
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (const Scalar border : {model_.envelope_lower[i], model_.envelope_upper[i]}) {
          FeatureVector moved = x;
          moved[i] = border;
          const double reached = height(moved, bound, missing);
          if (reached > highest) {
            highest = reached;
            best = moved;
          }
        }
      }
      if (!(highest > before)) break;
      x = best;
    }
    const std::array<double, bounds> by = passed(x);
    const auto keeps = [&](const std::array<double, bounds>& other) {
      for (std::size_t k = 0; k < bounds; ++k) {
        if (missing[k] && by[k] >= enough && other[k] < enough) return false;
      }
      return true;
    };
    double near = 0, far = 1;
    for (int halving = 0; halving < 20; ++halving) {
      const double middle = (near + far) / 2;
      (keeps(passed(between(start, x, middle))) ? far : near) = middle;
    }
    return between(start, x, far);
  }

  FeatureVector between(const FeatureVector& from, const FeatureVector& to, double share) const {
    FeatureVector x = from;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double moved =
          static_cast<double>(from[i]) + share * (static_cast<double>(to[i]) - static_cast<double>(from[i]));
      x[i] = std::clamp(static_cast<Scalar>(moved), model_.envelope_lower[i], model_.envelope_upper[i]);
    }
    return x;
  }

  const Model& model_;
};

}  // namespace detail

/// `count` feature vectors, inside the envelope of a model that was trained on these rows. Of a model with a bounded
/// residual first those at which it is clipped, all but two at most; then rows, the first and the last among them, the
/// rest evenly between. Throws std::invalid_argument where no row has features, or for fewer than two.
template <class Model>
std::vector<typename Model::FeatureVector> golden_features(const Model& model, const RowSet& training,
                                                           std::size_t count = 8) {
  std::vector<typename Model::FeatureVector> all, golden;
  each_features<typename Model::Features, typename Model::Scalar>(
      training, [&all](const Flight&, std::size_t, const auto& x) { all.push_back(x); });
  if (all.empty()) throw std::invalid_argument("golden_features: expected rows that have features, found none");
  if (count < 2)
    throw std::invalid_argument("golden_features: expected a count from 2, found " + std::to_string(count));
  if constexpr (detail::has_bounded_residual<typename Model::Network>) {
    golden = detail::BoundSearch<Model>(model).beyond(all, count - 2);
  } else {
    static_cast<void>(model);
  }
  const std::size_t rows = count - golden.size();
  for (std::size_t i = 0; i < rows; ++i) golden.push_back(all[i * (all.size() - 1) / (rows - 1)]);
  return golden;
}

}  // namespace pinnquad
