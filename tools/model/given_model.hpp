// SPDX-License-Identifier: MIT
// The model that a command is given: a block that describes itself, or an exported header, beside which its block
// stands.
#pragma once

#include <string>

#include "pinnquad/deploy/block_model.hpp"

namespace programs {

/// The path of the block: itself, or the one beside a header, which says the header's hash. Throws InputError, one
/// line: no block is there, or one of another header.
std::string block_path(const std::string& model);

/// Throws InputError as block_path() and BlockModel.
inline pinnquad::BlockModel read_model(const std::string& model) { return pinnquad::BlockModel(block_path(model)); }

}  // namespace programs
