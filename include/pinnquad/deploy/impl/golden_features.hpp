// SPDX-License-Identifier: MIT
// Bodies of golden_features.hpp.
#pragma once

#include <algorithm>

#include "pinnquad/deploy/golden_features.hpp"

namespace pinnquad {
namespace detail {

/// Feature vectors inside the envelope at which a bounded residual would leave its bounds. Deterministic: no number is
/// drawn.
class BoundSearch {
 public:
  using Vector = std::vector<double>;

  explicit BoundSearch(const AskedModel& model) : model_(model), outputs_(model.residual_lower.size()) {}

  /// One vector for each bound that none before it passes, as far as one is found; `most` of them.
  std::vector<Vector> beyond(const std::vector<Vector>& rows, std::size_t most) const {
    std::vector<Vector> found;
    std::vector<bool> missing(2 * outputs_);  // lower ones, then upper ones
    for (std::size_t bound = 0; bound < missing.size(); ++bound) missing[bound] = has_range(bound);
    for (std::size_t bound = 0; bound < missing.size() && found.size() < most; ++bound) {
      if (!missing[bound]) continue;
      const Vector far = climbed(nearest(rows, bound), bound, missing);
      const Vector by = passed(far);
      if (by[bound] < enough) continue;
      found.push_back(far);
      for (std::size_t k = 0; k < missing.size(); ++k) missing[k] = missing[k] && by[k] < enough;
    }
    return found;
  }

 private:
  static constexpr double enough = 0.05;  ///< of the residual's range

  bool has_range(std::size_t bound) const {
    return model_.residual_upper[bound % outputs_] > model_.residual_lower[bound % outputs_];
  }

  /// How far beyond each bound the residual is without it, in shares of its range.
  Vector passed(const Vector& x) const {
    Vector y(outputs_), by(2 * outputs_);
    model_.residual(x.data(), y.data());
    for (std::size_t k = 0; k < outputs_; ++k) {
      const double lower = model_.residual_lower[k], upper = model_.residual_upper[k];
      by[k] = (lower - y[k]) / (upper - lower);
      by[outputs_ + k] = (y[k] - upper) / (upper - lower);
    }
    return by;
  }

  /// The row at which the residual is nearest to the bound.
  Vector nearest(const std::vector<Vector>& rows, std::size_t bound) const {
    const Vector* best = &rows.front();
    double most = passed(*best)[bound];
    for (const Vector& row : rows) {
      const double by = passed(row)[bound];
      if (by > most) {
        most = by;
        best = &row;
      }
    }
    return *best;
  }

  /// The search climbs for the bound first, then for the others that no vector passes.
  double height(const Vector& x, std::size_t bound, const std::vector<bool>& missing) const {
    const Vector by = passed(x);
    double sum = 0;
    for (std::size_t k = 0; k < by.size(); ++k) {
      if (missing[k]) sum += (k == bound ? static_cast<double>(by.size()) : 1.0) * std::min(by[k], enough);
    }
    return sum;
  }

  /// From there, one feature after the other to a border of the envelope, the one that gains most first; then back
  /// along the line, as far as no bound that it passes is lost.
  Vector climbed(const Vector& start, std::size_t bound, const std::vector<bool>& missing) const {
    Vector x = start;
    double highest = height(x, bound, missing);
    for (std::size_t step = 0; step < x.size(); ++step) {
      Vector best = x;
      const double before = highest;
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (const double border : {model_.envelope_lower[i], model_.envelope_upper[i]}) {
          Vector moved = x;
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
    const Vector by = passed(x);
    const auto keeps = [&](const Vector& other) {
      for (std::size_t k = 0; k < by.size(); ++k) {
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

  Vector between(const Vector& from, const Vector& to, double share) const {
    Vector x = from;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double moved = from[i] + share * (to[i] - from[i]);
      const double own = model_.is_double ? moved : static_cast<double>(static_cast<float>(moved));
      x[i] = std::clamp(own, model_.envelope_lower[i], model_.envelope_upper[i]);
    }
    return x;
  }

  const AskedModel& model_;
  std::size_t outputs_;
};

}  // namespace detail

PINNQUAD_BODY std::vector<std::vector<double>> golden_features(const AskedModel& model, const RowSet& training,
                                                               std::size_t count) {
  std::vector<std::vector<double>> all, golden;
  model.each_row(training, [&](const Flight&, std::size_t, const double* x) { all.emplace_back(x, x + model.size()); });
  if (all.empty()) throw std::invalid_argument("golden_features: expected rows that have features, found none");
  if (count < 2)
    throw std::invalid_argument("golden_features: expected a count from 2, found " + std::to_string(count));
  if (model.residual) golden = detail::BoundSearch(model).beyond(all, count - 2);
  const std::size_t rows = count - golden.size();
  for (std::size_t i = 0; i < rows; ++i) golden.push_back(all[i * (all.size() - 1) / (rows - 1)]);
  return golden;
}

}  // namespace pinnquad
