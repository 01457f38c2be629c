// SPDX-License-Identifier: MIT
// What an export says of a model beside its numbers: where it comes from, in which terms it was trained, what was found out
// about it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/exported/model.hpp"

namespace pinnquad {

/// Between which a residual's outputs stay, one bound per output, in the outputs' units.
struct ResidualRange {
  std::vector<double> lower;
  std::vector<double> upper;
};

/// Where the training features lie together: x is near them if |L^-1 (x - mean)| <= limit, L L^T their covariance.
struct DistanceStatistics {
  std::vector<double> mean;              ///< one per feature
  std::vector<double> inverse_cholesky;  ///< lower triangle of L^-1, row by row: n (n + 1) / 2
  double limit = 0;                      ///< above 0
};

/// Where a model comes from; printed into the header as strings.
struct Provenance {
  std::string training_data;             ///< name of the flight, not a path of the machine
  std::uint64_t training_data_hash = 0;  ///< content_hash() of the flight
  std::size_t training_rows = 0;
  std::uint64_t seed = 0;
  int epochs = 0;
  std::string loss;                               ///< in words
  std::optional<Verdict> verdict = std::nullopt;  ///< how the model was judged; none: the header says nothing of it

  /// What a recorded command meant; none: what the airframe's curves say (command_meaning_of()).
  std::optional<CommandMeaning> command_meaning = std::nullopt;
  double command_lower = 0;  ///< the range that commands were given in
  double command_upper = 1;
  double sample_period_s = 0;  ///< of the flights; 0: not said, or that of the features' window
  double lag_removed_s = 0;    ///< of the rotors, taken out of the commands before the training

  // what was found out besides, for guards and certificates
  std::optional<std::array<TorqueSigns, rotor_count>> slope_signs = std::nullopt;  ///< proven signs of du/d(ang. acc.)
  std::optional<ResidualRange> residual_range = std::nullopt;
  std::optional<DistanceStatistics> distance = std::nullopt;
};

}  // namespace pinnquad
