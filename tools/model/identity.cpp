// SPDX-License-Identifier: MIT
// Finds out what model a block is, of all kinds that `train` exports.
#include "model/identity.hpp"

#include <string>
#include <utility>

#include "model/log_schemas.hpp"
#include "model/model_file.hpp"
#include "pinnquad/deploy/cpp_text.hpp"

namespace programs {

std::optional<Identity> find_identity(const Block& block, const ModelHints& hints) {
  return find_identity(block, hints, [](const auto& function) {
    each_schema(function);
    each_log_schema(function);
  });
}

namespace {
/// A type as a header states it, by the names of today (exported/renamed.hpp).
std::string by_todays_names(std::string type) {
  for (const auto& [before, now] : {std::pair<std::string, std::string>{"SignedSumOutputs", "AxisCommandOutputs"},
                                    {"LinearizedInverse", "LinearizedBase"},
                                    {"RigidBodyInverse", "RigidBodyBase"}}) {
    for (std::size_t at = type.find(before); at != std::string::npos; at = type.find(before, at)) {
      type.replace(at, before.size(), now);
    }
  }
  return type;
}
}  // namespace

void require_names(const HeaderFile& header) {
  const auto same = [&header](const std::string& entry, const auto& texts) {
    const std::vector<std::string> said = header.texts(entry);
    return said == std::vector<std::string>(texts.begin(), texts.end());
  };
  const auto require = [&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    using Map = pinnquad::OutputMap<Outputs>;
    const std::string& features_text = header.text("Features");
    const std::string outputs_text = by_todays_names(header.text("Outputs"));
    if (features_text == pinnquad::type_name<Features>() &&
        !(same("feature_names", Features::names) && same("feature_units", Features::units))) {
      header.refuse("feature_names", "the names and units of " + features_text, "others");
    }
    if (outputs_text == pinnquad::type_name<Outputs>() && !same("output_names", Map::names)) {
      header.refuse("output_names", "the names of " + outputs_text, "others");
    }
  };
  each_schema(require);
  each_log_schema(require);
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
