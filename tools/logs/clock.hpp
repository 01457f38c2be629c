// SPDX-License-Identifier: MIT
// One topic's clock made usable, and one uniform clock for all: what is out of order, twice, stale or not a time is put
// right or left out, and counted. And a topic's values on another clock: NaN where the topic has none, in gaps and
// outside its time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace pinnquad::logs {

/// The cleaning of a topic's clock, in rows.
struct ClockReport {
  std::size_t rows_read = 0;
  std::size_t not_a_time = 0;  ///< NaN or infinite: left out
  std::size_t wild = 0;        ///< a few that fit no row around them: left out
  double first_wild_s = 0;
  std::size_t out_of_order = 0;    ///< earlier than a row before them: sorted in
  std::size_t same_time = 0;       ///< left out: of rows with one time the last of the file stays
  std::size_t stale_first = 0;     ///< left out: one or two latched values from before the log began
  std::size_t restarts = 0;        ///< steps back by more than a second: two recordings in one, or a clock that was set
  double largest_step_back_s = 0;  ///< before sorting
  double nominal_period_s = 0;     ///< median step; 0 for fewer than two rows
  double largest_step_s = 0;       ///< after sorting
  std::size_t gaps = 0;            ///< steps longer than `gap_periods` nominal ones
  double time_in_gaps_s = 0;
  std::size_t rows_kept = 0;
};

/// Steps longer than this, in nominal periods, are gaps: nothing bridges them.
inline constexpr double gap_periods = 3.5;

/// Times that increase strictly, and the topic's row that each is of.
struct CleanClock {
  std::vector<double> time_s;
  std::vector<std::size_t> row;
  ClockReport report;

  std::size_t size() const noexcept { return time_s.size(); }
};

/// A step back is no restart up to this: queues and buses reorder within it.
inline constexpr double restart_step_s = 1.0;

/// Puts a topic's clock right; a few stamps (1 %, or three) more than a second off the rows around them are left out.
/// The last of several rows with one time stays (a publisher that corrects itself does so later). Never throws: a topic
/// without one usable row has an empty clock.
CleanClock clean_clock(const std::vector<double>& time_s);

/// begin, begin + period, ..., `rows` of them.
struct UniformClock {
  double begin_s = 0;
  double period_s = 0;
  std::size_t rows = 0;

  double at(std::size_t row) const noexcept { return begin_s + static_cast<double>(row) * period_s; }
};

/// The clock on which every topic has values on both sides: from the latest begin to the earliest end. `begin_s` is a
/// multiple of the period, so that clocks of one log with different topics have rows in common. No rows where the
/// topics don't meet. Throws std::invalid_argument for a period that is not above 0 and for no topics.
UniformClock common_clock(const std::vector<const CleanClock*>& topics, double period_s);

enum class Resampling {
  linear,    ///< between the neighbours: signals that are smooth at their own rate
  hold,      ///< the last one before: commands, set points, flags
  low_pass,  ///< line under a triangle of +- one period of the new clock: a noisy signal that is faster than it
};

/// The resampling that suits a topic: a signal at more than 1.5 times the new clock's rate is low-passed, or what it
/// has above half the new rate would fold into the band (the triangle's gain is 0.41 at half the new rate, below 0.05
/// beyond it once and a half; no phase). Held signals too: their mean over a period is what the motor saw.
constexpr Resampling resampling_of(double topic_period_s, double new_period_s, bool held) noexcept {
  if (topic_period_s > 0 && topic_period_s * 1.5 < new_period_s) return Resampling::low_pass;
  return held ? Resampling::hold : Resampling::linear;
}

/// The longest step between neighbours that is bridged, s: beyond it rows are NaN.
double bridged_gap_s(const CleanClock& clock) noexcept;

/// `values` by the topic's own row, as in its file; a cell that is NaN is a row that the topic does not have, so that a
/// step over it may become too long to bridge. `largest_gap_s`: of bridged_gap_s().
std::vector<double> resample(const CleanClock& clock, const std::vector<double>& values, const UniformClock& to,
                             Resampling kind, double largest_gap_s);

/// w, x, y, z by row. Between neighbours q and the one of +-q' that is nearer, along the great arc (by the normalised
/// line where they are within 1e-6 rad, where both agree to rounding). What is no unit quaternion (up to 5 %; it is
/// normalised) is a missing row. Sign-continuous from row to row.
std::array<std::vector<double>, 4> resample_attitude(const CleanClock& clock,
                                                     const std::array<const std::vector<double>*, 4>& wxyz,
                                                     const UniformClock& to, double largest_gap_s);

}  // namespace pinnquad::logs
