// SPDX-License-Identifier: MIT
// A foreign network as a model of the library: what its header and block say.
#pragma once

#include <string>
#include <vector>

#include "convert/features_file.hpp"
#include "convert/foreign_network.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/written_model.hpp"

namespace programs {

/// A converted model differs from its source by no more than this, a command's worth: what float loses in layers of a
/// thousand numbers. The source is asked in double.
inline constexpr double converted_tolerance = 1e-5;

/// Features inside the envelope, in the model's order and numbers, and the same as the network reads them.
struct AskedRows {
  std::vector<Numbers> features, of_network;
};
/// The middle of the envelope, then random ones: eight that become golden vectors, and a thousand to compare with.
/// `Scalar`: the model's, float or double.
template <class Scalar>
AskedRows asked_rows(const ForeignMeaning& meaning);

/// Features in the order of the file become the library's: `network` is shown what it was trained on all the same.
/// Golden commands are the source's own. Throws InputError, one line: widths that the features file does not have,
/// layers that no block has room for.
template <class Scalar>
pinnquad::detail::WrittenModel<Scalar> converted_model(const ForeignNetwork& network, const ForeignMeaning& meaning,
                                                       const AskedRows& rows, const std::string& name);

/// Largest difference of a model's commands from its source's, by the largest of that command where it is beyond 1.
double largest_difference(const pinnquad::BlockModel& model, const ForeignNetwork& network,
                          const ForeignMeaning& meaning, const AskedRows& rows);

}  // namespace programs
