// SPDX-License-Identifier: MIT
// Two series of a flight that say the same: how a quantity changes, and what its rate integrates to. A column that is
// negated, in another unit, of another axis or late shows in how the two go together.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/core/types.hpp"

namespace pinnquad::detail {

/// The one rule by which a check of motion believes what it sees: a flight is cut into blocks of time, each tells by
/// how much one reading of the log beats the other, and their sum is three times as large as its deviation,
/// sqrt(sum of squares). Nine blocks that agree can do that, however small the others; one block can't, however wild:
/// a crash, a knock, a catch by hand, a take-off.
bool is_plain(const std::vector<double>& gains);

/// Blocks of `is_plain`: so many, unless they get shorter than what motions of one manoeuvre have in common.
std::size_t block_count(double duration_s);

/// Weights of blocks with such energies: the wildest fifth weigh as much as the liveliest of the others.
std::vector<double> block_weights(const std::vector<double>& energies);

/// Sums over steps: changes of three quantities, and the integrals of three rates.
struct MotionSums {
  Matrix<double, 3, 3> products = Matrix<double, 3, 3>::Zero();  ///< row: quantity that changes; column: rate
  Vector3<double> changes = Vector3<double>::Zero();             ///< squares
  Vector3<double> integrals = Vector3<double>::Zero();
  double steps = 0;

  void add(const Vector3<double>& change, const Vector3<double>& integral);
  void add(const MotionSums& other, double weight);
};

/// Sums of a whole flight, by blocks of time that weigh alike.
struct MotionBlocks : MotionSums {
  std::vector<MotionSums> blocks;

  /// The blocks weighted, and their sum.
  explicit MotionBlocks(std::vector<MotionSums> of);

  /// A number of each block.
  template <class Of>
  std::vector<double> each(const Of& of) const {
    std::vector<double> numbers;
    for (const MotionSums& block : blocks) numbers.push_back(of(block));
    return numbers;
  }

  /// Correlation over the flight; 0 where both stand still, or one of them to the last digit.
  double correlation(Eigen::Index axis, Eigen::Index column) const { return correlation(axis, column, *this); }
  /// The part of it that a block has.
  double correlation(Eigen::Index axis, Eigen::Index column, const MotionSums& block) const;
  /// The axes about which something moves.
  std::array<bool, 3> moving() const;
  /// 1 where change and integral are equal, -1 where they are opposite, 0 where they have nothing in common: mean over
  /// some axes; 1 where there are none.
  double agreement(const std::array<bool, 3>& of) const;
  double agreement(const std::array<bool, 3>& of, const MotionSums& block) const;
  /// True where the flight plainly agrees better so than it does here; of one flight, read in two ways.
  bool agrees_less_than(const MotionBlocks& so, const std::array<bool, 3>& axes) const;
  /// True where a rate plainly follows its own axis: it has been checked.
  bool confirms(Eigen::Index axis) const;
};

/// A rate that follows another axis than its own, or its own negated or in another unit.
struct AxisMistake {
  Eigen::Index column = 0;  ///< the rate's
  Eigen::Index axis = 0;    ///< the quantity's that it follows
  bool negated = false;
  double factor = 1;  ///< of the rate over what it should be
};

/// True where a rate can be that of an axis: noise makes them differ in size by as much as it leaves of their
/// correlation, a sensor that is mounted askew shows a few hundredths of another axis. Degrees for radians may be too.
bool can_be_of_axis(const MotionSums& sums, Eigen::Index axis, Eigen::Index column, double correlation);

/// The first that most blocks show. `follows`: least correlation with the other axis; `better`: by how much more than
/// with its own.
std::optional<AxisMistake> find_axis_mistake(const MotionBlocks& sums, double follows, double better);

/// Calls `begin()` at each stretch of rows without a gap, then with each of its rows `add(changed, integrated, dt_s)`.
/// `change(row)`: of a quantity from this row to the next; `rate(row)`: of it, per second, asked for once, row by row.
template <class Time, class Change, class Rate, class Begin, class Add>
void each_motion(std::size_t rows, const Time& time_s, const Change& change, const Rate& rate, const Begin& begin,
                 const Add& add) {
  constexpr double longest_step_s = 0.5, largest = 1e4;  // beyond is no motion, whatever the unit
  bool open = false;
  Vector3<double> next = rows > 0 ? Vector3<double>(rate(0)) : Vector3<double>::Zero();
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    const double dt_s = time_s(row + 1) - time_s(row);
    const Vector3<double> rate_before = next;
    next = rate(row + 1);
    const Vector3<double> mean = (rate_before + next) / 2;
    const bool usable = dt_s > 0 && dt_s <= longest_step_s && mean.squaredNorm() <= largest * largest;
    const Vector3<double> changed = usable ? Vector3<double>(change(row)) : mean;
    if (!usable || !(changed.squaredNorm() <= largest * largest)) {
      open = false;
      continue;
    }
    if (!open) begin();
    open = true;
    add(changed, Vector3<double>(mean * dt_s), dt_s);
  }
}

/// Steps of two series, one after the other. Times are those of all stretches without a gap in a row.
struct MotionSteps {
  struct Step {
    double begin_s, end_s;
    Vector3<double> changed, integral;
    std::size_t stretch;
  };
  std::vector<Step> steps;
  std::vector<double> stretch_ends_s;

  MotionBlocks sums() const;

  /// The time by which the quantity comes after its rate, where the two agree far better with it than without, plainly:
  /// a tenth of a second or more, to half a second. To ask of two that agree worse than `in_time`. `integral`: of the
  /// rate, at times.
  std::optional<double> lateness_s(const std::vector<double>& time_s,
                                   const std::vector<Vector3<double>>& integral) const;
};

/// Steps of at least `step_s`; see each_motion().
template <class Time, class Change, class Rate>
MotionSteps motion_steps(std::size_t rows, const Time& time_s, const Change& change, const Rate& rate, double step_s) {
  constexpr double rounding_s = 1e-6;
  MotionSteps result;
  struct Place {
    double time_s = 0;
    Vector3<double> changed = Vector3<double>::Zero(), integral = Vector3<double>::Zero();
  };
  double before_s = 0;  // of the stretches that are over
  Place first, last;    // since the stretch's begin
  each_motion(
      rows, time_s, change, rate,
      [&] {
        before_s += last.time_s;
        first = last = {};
        result.stretch_ends_s.push_back(before_s);
      },
      [&](const Vector3<double>& changed, const Vector3<double>& integrated, double dt_s) {
        last.time_s += dt_s;
        last.changed += changed;
        last.integral += integrated;
        result.stretch_ends_s.back() = before_s + last.time_s;
        if (last.time_s - first.time_s < step_s - rounding_s) return;
        result.steps.push_back({before_s + first.time_s, before_s + last.time_s, last.changed - first.changed,
                                last.integral - first.integral, result.stretch_ends_s.size() - 1});
        first = last;
      });
  return result;
}

/// MotionSteps::lateness_s() of two series.
template <class Time, class Change, class Rate>
std::optional<double> motion_lateness_s(std::size_t rows, const Time& time_s, const Change& change, const Rate& rate,
                                        double step_s) {
  std::vector<double> at_s = {0.0};
  std::vector<Vector3<double>> integral = {Vector3<double>::Zero()};
  each_motion(
      rows, time_s, change, rate, [] {},
      [&](const Vector3<double>&, const Vector3<double>& integrated, double dt_s) {
        at_s.push_back(at_s.back() + dt_s);
        integral.push_back(integral.back() + integrated);
      });
  return motion_steps(rows, time_s, change, rate, step_s).lateness_s(at_s, integral);
}

}  // namespace pinnquad::detail

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/motion_pair.hpp"
#endif
