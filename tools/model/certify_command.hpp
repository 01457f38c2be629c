// SPDX-License-Identifier: MIT
// The command `certify`: what is proven of a model's response to an angular acceleration, or an example against it.
#pragma once

#include <optional>

#include "command_line/command.hpp"
#include "model/asked_model.hpp"
#include "pinnquad/inference/certificate.hpp"

namespace programs {

Command certify_command(CLI::App& program);

/// Of a model that has the structure; none of another one.
std::optional<pinnquad::Certificate> certificate_of_block(const Block& block, const Identity& identity,
                                                          const AskedModel& model);

}  // namespace programs
