// SPDX-License-Identifier: MIT
// A foreign network as a model of the library: what its header and block say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "convert/features_file.hpp"
#include "convert/foreign_network.hpp"
#include "pinnquad/deploy/written_model.hpp"
#include "pinnquad/exported/run_time_outputs.hpp"

namespace programs {

/// A converted model differs from its source by no more than this, a command's worth.
inline constexpr double converted_tolerance = 1e-6;

/// Features in the order of the file become the library's: `network` is shown what it was trained on all the same.
/// Golden commands are the source's own, in double. Throws InputError, one line: widths that the features file does not
/// have, layers that no block has room for. `Scalar`: float or double.
template <class Scalar>
pinnquad::detail::WrittenModel<Scalar> converted_model(const ForeignNetwork& network, const ForeignMeaning& meaning,
                                                       const std::string& name);

/// The source, asked for features in the model's order and units: its commands, in double. Network and meaning must
/// stay where they are.
class Source {
 public:
  Source(const ForeignNetwork& network, const ForeignMeaning& meaning);

  pinnquad::Commands<double> commands(const Numbers& features) const;

 private:
  const ForeignNetwork& network_;
  const ForeignMeaning& meaning_;
  std::vector<std::size_t> features_of_file_, outputs_of_file_;
  pinnquad::RunTimeOutputs<double> schema_;
};

/// Feature vectors inside the envelope, in the model's order: the middle of it, then random ones.
std::vector<Numbers> vectors_inside(const ForeignMeaning& meaning, std::size_t count, std::uint64_t seed);

}  // namespace programs
