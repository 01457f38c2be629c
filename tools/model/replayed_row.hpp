// SPDX-License-Identifier: MIT
// The result of one row of a log, and the words for it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "pinnquad/core/status.hpp"
#include "pinnquad/core/types.hpp"

namespace programs {

/// The source of the commands.
enum class Answerer {
  model,
  learner,  ///< the vehicle as a core learnt it
  analytic_inverse,
  nobody,
  not_asked,  ///< a core that its stack asked nothing: off, or flown by hand
};

constexpr const char* to_string(Answerer answerer) noexcept {
  switch (answerer) {
    case Answerer::model: return "model";
    case Answerer::learner: return "learner";
    case Answerer::analytic_inverse: return "analytic_inverse";
    case Answerer::nobody: return "nobody";
    case Answerer::not_asked: return "not_asked";
  }
  return "unknown";
}

using FourCommands = std::array<double, pinnquad::rotor_count>;
inline constexpr FourCommands no_commands = {
    std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
    std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

struct ReplayedRow {
  std::size_t flight = 0;  ///< of Replayed::flights
  std::size_t row = 0;     ///< in its flight, from 1; of a core its tick
  double time_s = 0;
  pinnquad::Status status = pinnquad::Status::ok;
  pinnquad::Status cause = pinnquad::Status::ok;  ///< of the network alone
  Answerer answerer = Answerer::nobody;
  FourCommands commands = no_commands;  ///< NaN where there are none
  FourCommands logged = no_commands;    ///< those of the log
  std::string reaction;                 ///< of a core
  std::string feature;                  ///< the one furthest outside the envelope
  double excess = 0;                    ///< by how many half-widths of its range
  std::string state;   ///< what it does, in a few words: an event is a row whose state is another than the one's before
  std::string reason;  ///< why; empty where the model answers
  std::string differs;  ///< from what the core logged, in words; empty where it does not
};

/// A whole log.
struct Replayed {
  std::vector<std::string> flights;  ///< their names
  std::vector<ReplayedRow> rows;
  std::vector<std::string> notes;
  bool of_core = false;         ///< a record of a core, run by a core
  std::size_t compared = 0;     ///< of a core: ticks whose state is known
  std::size_t at_the_edge = 0;  ///< differ by rounding alone: a feature on the border of the envelope
};

/// The largest difference of a command; NaN where there is nothing to compare. `rotor`: which, from 0.
inline double largest_difference(const FourCommands& a, const FourCommands& b, std::size_t& rotor) {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::fabs(a[i] - b[i]);
    if (std::isnan(difference) || difference <= largest) continue;
    largest = difference;
    rotor = i;
  }
  return largest;
}

}  // namespace programs
