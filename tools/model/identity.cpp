// SPDX-License-Identifier: MIT
// Which model a block is, of all kinds that `train` exports.
#include "model/identity.hpp"

#include "model/log_schemas.hpp"

namespace programs {

Identity identify(const Block& block, const ModelHints& hints) {
  return identify(block, hints, [](const auto& function) {
    each_schema(function);
    each_log_schema(function);
  });
}

}  // namespace programs
