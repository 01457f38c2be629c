// SPDX-License-Identifier: MIT
// A network from elsewhere becomes model.hpp and model.block; a model becomes a network for elsewhere.
#pragma once

#include <string>

#include "convert/foreign_network.hpp"
#include "pinnquad/deploy/block_model.hpp"

namespace programs {

struct Conversion {
  std::string source;    ///< a file, or the words for what Python has in memory
  std::string features;  ///< features.toml (docs/convert.md)
  std::string out;       ///< a folder, for model.hpp and model.block
  std::string name = "TrainedQuadModel";
  std::string prefix = {};  ///< of the tensors that are taken, where a file has several networks
  std::string output = {};  ///< of a graph that has several
  bool in_double = false;
};

/// Writes both files, or none. The lines that say what became of it. Throws InputError, std::invalid_argument.
std::string convert_network(const Conversion& conversion, const AskPython& ask);

/// The bytes of a network of `model`. `ending`: ".onnx", ".safetensors". Throws InputError.
std::string network_of(const pinnquad::BlockModel& model, const std::string& ending, const AskPython& ask);

}  // namespace programs
