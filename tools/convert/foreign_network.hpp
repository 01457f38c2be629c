// SPDX-License-Identifier: MIT
// A network from elsewhere as layers of the library, in double, and what its source says that it answers
// (tools/python/pinnquad/networks.py).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace programs {

using Numbers = std::vector<double>;

/// A request as JSON, and the answer to it: networks.py, in a process of its own or in the Python that asks.
using AskPython = std::function<std::string(const std::string& request)>;

/// y = W x + b, row by row (row = output); or an activation, a norm of as many numbers as it has biases, or a Glu.
struct ForeignLayer {
  std::string activation;  ///< as a features file names it, or layer_norm, rms_norm, glu; empty: dense
  Numbers weights, bias;
  std::size_t gated = 0;  ///< outputs of a Glu, of twice as many numbers

  std::size_t outputs() const { return gated > 0 ? gated : bias.size(); }
  std::size_t inputs() const { return weights.size() / bias.size(); }
};

struct ForeignNetwork {
  std::size_t inputs = 0, outputs = 0;
  std::vector<ForeignLayer> layers;  ///< the first and the last are dense
  std::vector<Numbers> answers;      ///< of the source, by its own operators, to the rows that were asked
  std::string source;                ///< in words: what it was read from
};

/// The network that answers `request`, a JSON text. Throws InputError with what was wrong with the source at `path`.
ForeignNetwork asked_network(const AskPython& ask, const std::string& request, const std::string& path);

}  // namespace programs
