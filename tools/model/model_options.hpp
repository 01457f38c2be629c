// SPDX-License-Identifier: MIT
// The options of a command that reads a model: which file, and what to take it for.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "airframe/names.hpp"
#include "command_line/options.hpp"
#include "model/identity.hpp"

namespace programs {

/// MODEL, of a command that takes one.
inline void add_model(CLI::App& line, std::string& model) {
  add_path(line, "model", model, "MODEL",
           "a header that pinnquad train exported (MODEL.hpp), or a model block, as --block writes it")
      ->required();
}

/// --airframe and --answer. What the model's header brings with it is not asked for: block_bytes() adds it to the
/// hints.
inline void add_model_hints(CLI::App& line, ModelHints& hints) {
  add_path(line, "--airframe", hints.airframe, "NAME|FILE.toml",
           "what flew: a file, or one of: " + airframe_names() + " (default: the one that the model was trained for)");
  line.add_option("--answer", hints.answer,
                  "the network as the model's header states it (answer = ...); needed of a block whose hidden layers "
                  "differ in width");
}

}  // namespace programs
