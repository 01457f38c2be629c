// SPDX-License-Identifier: MIT
// A model of the library as others may have it: chains of affine maps and activations of standardised features, added
// up; commands that are affine in them and in the features.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "convert/foreign_network.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// A part of a sum.
struct ExportedPart {
  std::vector<std::size_t> shown;  ///< the features that it takes; empty: all
  std::vector<ForeignStep> steps;
  Numbers lower, upper;  ///< its outputs are clipped to them; empty: not at all
};

struct ExportedNetwork {
  std::string name;
  std::vector<std::pair<std::string, std::string>> facts;  ///< features, outputs, airframe, hash: in words
  bool is_double = false;
  std::size_t inputs = 0;
  Numbers least, most;  ///< of each feature, where one is a column, which is clipped to its range; else empty
  Numbers mean, deviation;
  std::vector<ExportedPart> parts;
  Numbers output_mean, output_deviation;
  ForeignDense of_outputs;  ///< commands of the outputs
  Numbers of_features;      ///< commands by the features in physical units, row by row; empty: none

  bool scales_outputs() const;   ///< by other numbers than 1 and 0
  bool is_plain_output() const;  ///< the commands are the outputs
};

/// Throws InputError, one line: outputs whose commands are no affine map, and a model that this one differs from by
/// more than 1e-6 of a command.
ExportedNetwork exported_network(const pinnquad::BlockModel& model);

/// One chain of all features, folded, as a state_dict: where there is one. Throws InputError.
std::string safetensors_of(const ExportedNetwork& network, const std::string& path);

}  // namespace programs
