// SPDX-License-Identifier: MIT
// Which model a block is, of all kinds that `train` exports.
#include "model/identity.hpp"

#include "model/log_schemas.hpp"

namespace programs {

std::optional<Identity> find_identity(const Block& block, const ModelHints& hints) {
  return find_identity(block, hints, [](const auto& function) {
    each_schema(function);
    each_log_schema(function);
  });
}

Identity identify(const Block& block, const ModelHints& hints) {
  const std::optional<Identity> found = find_identity(block, hints);
  if (!found && !hints.airframe.empty()) {
    ModelHints any = hints;
    any.airframe.clear();
    if (const std::optional<Identity> other = find_identity(block, any)) {
      throw std::invalid_argument(block.path + ": a model for the airframe " +
                                  pinnquad::printable(other->airframe.name) + ", not for --airframe " +
                                  pinnquad::printable(hints.airframe));
    }
  }
  if (!found) {
    throw std::invalid_argument(block.path + ": a network of " + std::to_string(block.inputs) + " inputs, " +
                                std::to_string(block.outputs) + " outputs and " +
                                std::to_string(block.parameter_count) +
                                " parameters whose shape is unknown here; say --airframe FILE.toml if it is for an "
                                "airframe of its own, --answer "
                                "TEXT as its header states it if its layers differ in width");
  }
  return *found;
}

}  // namespace programs
