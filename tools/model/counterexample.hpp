// SPDX-License-Identifier: MIT
// The search for two motions inside a model's envelope that differ in one angular acceleration alone, of which the one
// that asks for more gets less: a signed sum of the commands that falls, in the model's own arithmetic. Starts all over
// the envelope; from each, the feature is moved that lowers the exact derivative most, until the derivative is below 0
// over a whole step.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/core/random.hpp"

namespace programs {

/// More angular acceleration about an axis: now, or held over all instants of a window.
struct AskedMore {
  std::size_t axis = 0;  ///< roll, pitch, yaw
  bool held = false;
  std::vector<std::size_t> places;  ///< features that are larger
};

/// Two motions and what the model makes of them.
struct Counterexample {
  AskedMore asked;
  std::vector<double> x;            ///< features; `more` is another in the places
  double step = 0;                  ///< by which the second motion's angular acceleration is larger, rad/s^2
  double derivative = 0;            ///< of the signed sum at x, s^2/rad
  double sum = 0, sum_of_more = 0;  ///< signed sums of both: the second is less
};

/// A model, as the search asks it.
struct SearchedModel {
  std::vector<double> lower, upper;  ///< the envelope
  std::vector<AskedMore> ways;
  /// Of each way: d(signed sum about its axis)/d(angular acceleration about it).
  std::function<std::vector<double>(const std::vector<double>&)> derivatives;
  /// Signed sums about each axis, in the model's own scalar.
  std::function<std::array<double, 3>(const std::vector<double>&)> sums;
  std::vector<std::vector<double>> starts;  ///< motions to begin with, beside random ones
};

/// The find of the search, and how far it went.
struct Search {
  std::optional<Counterexample> found;
  std::vector<double> least;  ///< of each way the least derivative that was seen
  long evaluations = 0;
  double seconds = 0;  ///< of the processor
};

namespace detail {

class CounterexampleSearch {
 public:
  CounterexampleSearch(const SearchedModel& model, std::uint64_t seed, double seconds)
      : model_(model),
        engine_(seed),
        seconds_(seconds),
        begin_(std::clock()),
        best_(model.ways.size()),
        best_value_(model.ways.size(), unseen) {
    search_.least = best_value_;
  }

  Search run() {
    constexpr int random_starts = 64, rounds = 1000;
    for (const std::vector<double>& x : model_.starts) {
      if (!over()) look(x);
    }
    for (int round = 0; round < rounds && !over(); ++round) {
      for (int i = 0; i < random_starts && !over(); ++i) look(anywhere());
      for (std::size_t way = 0; way < best_.size() && !over(); ++way) descend(best_[way], way);
      for (std::size_t way = 0; way < best_.size(); ++way) {
        best_[way].clear();
        best_value_[way] = unseen;
      }
    }
    search_.seconds = spent();
    return search_;
  }

 private:
  /// Seconds of the processor: what else runs does not shorten the search.
  double spent() const { return static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC; }
  bool over() const {
    stop_if_interrupted();
    return search_.found || spent() > seconds_;
  }
  std::vector<double> anywhere() {
    std::vector<double> x(model_.lower.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = pinnquad::uniform(engine_, model_.lower[i], model_.upper[i]);
    return x;
  }
  std::vector<double> look(const std::vector<double>& x) {
    std::vector<double> slopes = model_.derivatives(x);
    ++search_.evaluations;
    for (std::size_t way = 0; way < slopes.size(); ++way) {
      search_.least[way] = std::min(search_.least[way], slopes[way]);
      if (slopes[way] < 0 && !search_.found) confirm(x, way, slopes[way]);
      if (slopes[way] < best_value_[way]) {
        best_value_[way] = slopes[way];
        best_[way] = x;
      }
    }
    return slopes;
  }
  /// Tries each feature in turn, anywhere in its range, and keeps what lowers the derivative.
  void descend(std::vector<double> x, std::size_t way) {
    if (x.empty()) return;
    constexpr int sweeps = 3;
    double least = best_value_[way];
    for (int sweep = 0; sweep < sweeps && !over(); ++sweep) {
      for (std::size_t i = 0; i < x.size() && !over(); ++i) {
        const double kept = x[i];
        double best = kept;
        for (const double tried :
             {model_.lower[i], model_.upper[i], pinnquad::uniform(engine_, model_.lower[i], model_.upper[i])}) {
          x[i] = tried;
          const double slope = look(x)[way];
          if (slope < least) {
            least = slope;
            best = tried;
          }
        }
        x[i] = best;
      }
    }
  }
  /// A derivative below 0 becomes a counterexample where the sum falls over a step that rounding does not see.
  void confirm(const std::vector<double>& x, std::size_t way, double slope) {
    const std::vector<std::size_t>& places = model_.ways[way].places;
    const std::size_t axis = model_.ways[way].axis;
    for (const double share : {0.01, 0.001, 0.05}) {
      const double step = share * (model_.upper[places.front()] - model_.lower[places.front()]);
      std::vector<double> more = x;
      bool inside = true;
      for (const std::size_t place : places) {
        more[place] += step;
        inside = inside && more[place] <= model_.upper[place];
      }
      if (!inside) continue;
      const double sum = model_.sums(x)[axis], sum_of_more = model_.sums(more)[axis];
      constexpr double seen = 1e-5;  // of a command: far above the rounding of a float
      if (!(sum_of_more < sum - seen)) continue;
      search_.found = Counterexample{model_.ways[way], x, step, slope, sum, sum_of_more};
      return;
    }
  }

  const SearchedModel& model_;
  std::mt19937_64 engine_;
  double seconds_;
  std::clock_t begin_;
  Search search_;
  static constexpr double unseen = 1e300;
  std::vector<std::vector<double>> best_;  ///< of each way the motion of the least derivative
  std::vector<double> best_value_;
};

}  // namespace detail

/// Searches for at most `seconds` of the processor; the same seed finds the same motions.
inline Search search_counterexample(const SearchedModel& model, std::uint64_t seed, double seconds) {
  return detail::CounterexampleSearch(model, seed, seconds).run();
}

}  // namespace programs
