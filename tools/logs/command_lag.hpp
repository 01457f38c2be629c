// SPDX-License-Identifier: MIT
// The time from a command to the motion, by how well the delayed commands explain the motion; and commands moved by it.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"

namespace pinnquad::logs {

inline constexpr std::size_t lag_motions = 4;  ///< angular acceleration about x, y, z; specific force along z

/// One segment as series: four commands, three body rates, four motions.
struct LagSeries {
  std::array<std::vector<double>, rotor_count> commands;
  std::array<std::vector<double>, 3> rates;
  std::array<std::vector<double>, lag_motions> motions;
  std::vector<double> weights;  ///< of rows in the sums; empty: 1

  std::size_t size() const noexcept { return rates[0].size(); }
};

std::vector<LagSeries> lag_series(const std::vector<Flight>& segments);

/// All series up to a frequency, without phase.
std::vector<LagSeries> low_passed(std::vector<LagSeries> all, double period_s, double corner_Hz);

/// Sums of products of 1, commands, rates and motions.
inline constexpr std::size_t lag_columns = 1 + rotor_count + 3 + lag_motions;
using LagMoments = std::array<std::array<double, lag_columns>, lag_columns>;

/// Of each `step`-th row but for the first `ahead` and the last `behind`, with the commands of `lag` rows before.
/// `rows`: how many.
LagMoments lag_moments(const std::vector<LagSeries>& all, std::size_t ahead, std::size_t behind, int lag,
                       std::size_t step, std::size_t& rows);

/// Takes out of all columns what column k explains, unless no more than `least` is left of its own square.
void take_out(LagMoments& moments, std::size_t k, double least);

/// Of one motion: angular acceleration about x, y, z, or specific force along z.
struct MotionLag {
  double lag_s = 0;
  double explained = 0;     ///< R^2 by the commands at the lag, beyond what a constant and the body rates explain
  double sharpness = 0;     ///< how much of -log(1 - R^2) is lost 50 ms away on the better side, 0..1
  bool found = false;       ///< a maximum inside the range, above and sharper than chance
  bool low_passed = false;  ///< a filter makes a blow as sharp as it is wide
  bool alone = false;       ///< no other motion has this lag to 20 ms

  /// The commands leave too little unexplained to move the maximum, or the maximum is too sharp to be moved; a
  /// sharp one before the command is the controller's answer to a gyro's noise, one that no other motion has is chance.
  bool told() const noexcept {
    constexpr double nearly_all = 0.8, sharp = 0.78, most = 0.6, least = 0.1, shortest_s = 0.008;
    const bool enough = explained >= most || (!low_passed && explained >= least);
    return found && (explained >= nearly_all || (sharpness >= sharp && enough && !alone && lag_s > shortest_s));
  }
};

struct CommandLag {
  std::array<MotionLag, lag_motions> motions;  ///< roll, pitch, yaw, collective
  double lag_s = 0;                            ///< where those found are explained best together
  double spread_s = 0;        ///< largest distance of one of them, with half the best one's say or more, to it
  double confidence = 0;      ///< sharpness of all found together, 0..1
  double give_or_take_s = 0;  ///< half of the 95 % interval of lag_s
  double low_pass_Hz = 0;     ///< up to where commands and motion were compared; 0: as they are
  bool found = false;         ///< otherwise lag_s is 0 and nothing should be removed
  bool told = false;          ///< by a motion that tells it: lag_s is of those
  std::string warning;        ///< why it is not known, or that it is negative; empty for none
  std::size_t rows = 0;

  static constexpr double spread_of_doubt_s = 0.01, confidence_of_doubt = 0.2, likely_s = 0.01, known_s = 0.005;
  /// Told by a motion, the same by all that tell one, to 10 ms, and one 50 ms away explains clearly less: nearer than
  /// any guess, but no measurement.
  bool likely() const noexcept {
    return found && told && spread_s <= spread_of_doubt_s && confidence >= confidence_of_doubt &&
           give_or_take_s <= likely_s;
  }
  /// Likely, and to 5 ms: never of rows 50 ms apart.
  bool known() const noexcept { return likely() && give_or_take_s <= known_s; }
};

/// The lags that are tried: motors and links are faster, and motion before its command is what a clock that is wrong or
/// feedback looks like.
struct LagRange {
  double shortest_s = -0.06, longest_s = 0.2;
};

/// The lag at which the four commands explain angular accelerations and vertical specific force best: the multiple
/// correlation, so that neither the order of the motors nor the battery has to be known; a constant and the body rates
/// (damping) explain what they can first. Both sides are compared as they are, up to 15 Hz and up to 8 Hz, without
/// phase, and the band in which most is explained is taken: gyro noise that comes back through the controller as
/// commands pulls the plain correlation to shorter lags, by tens of milliseconds in calm flights. So do gusts, to
/// longer ones, by as much: a lag is known only by motions that tell it (MotionLag::told()). Blocks of time count as
/// those of motion_pair.hpp: a catch by hand or a knock doesn't decide. Commands of rows that are far apart are
/// compared between the rows too, every 10 ms.
/// Segments of one log, each on a uniform clock of `period_s`, commands as they were logged, idle and ground left out.
/// Limits: a motor behaves like a first-order lag, of which the best pure delay depends on how fast the commands
/// change: 36 to 40 ms for a time constant of 50 ms. A filter's delay in what was measured counts as lag.
CommandLag estimate_command_lag(const std::vector<Flight>& segments, double period_s, const LagRange& range = {});
/// The same in several ranges.
std::vector<CommandLag> estimate_command_lags(const std::vector<Flight>& segments, double period_s,
                                              const std::vector<LagRange>& ranges);

/// A series on a uniform clock, each row with the value of `lag_s` earlier, by lines between rows; NaN where there is
/// none.
std::vector<double> remove_lag(const std::vector<double>& series, double period_s, double lag_s);

/// The commands of each row replaced by those of `lag_s` earlier; rows that have none are gone. Extra columns stay as
/// they are.
Flight remove_lag(Flight segment, double period_s, double lag_s);

}  // namespace pinnquad::logs
