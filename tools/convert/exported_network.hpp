// SPDX-License-Identifier: MIT
// A model of the library as others may have it: chains of affine maps and activations of standardised features, added
// up; commands that are affine in them and in the features.
#pragma once

#include <nlohmann/json.hpp>

#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// All its numbers, as networks.py takes them (class Model). Throws InputError, one line: outputs whose commands are no
/// affine map.
nlohmann::json exported_network(const pinnquad::BlockModel& model);

}  // namespace programs
