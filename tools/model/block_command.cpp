// SPDX-License-Identifier: MIT
// Writes an exported header as a model block, from its text: the bytes that its training would have written
// (deploy/weight_file.hpp). A header that contradicts itself, or whose golden vectors its weights miss, is none.
//   pinnquad block my_model/model.hpp --out weights.block
#include "model/block_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/file_roles.hpp"
#include "command_line/options.hpp"
#include "model/asked_model.hpp"
#include "model/model_file.hpp"
#include "pinnquad/deploy/weight_file.hpp"

namespace {

using namespace pinnquad;
using programs::HeaderFile;

struct BlockOptions {
  std::string header;
  std::string out;
};

int write_block(const BlockOptions& options) {
  programs::FileRoles roles;
  roles.reads("header", options.header);
  roles.writes("--out", options.out);
  const HeaderFile header(options.header);
  programs::ModelHints hints;
  const std::vector<unsigned char> bytes = programs::header_block(header, hints);
  // what open() or the self test would refuse is not written
  const programs::Block block = programs::read_block(options.header, {bytes.begin(), bytes.end()});
  const std::optional<programs::Identity> identity = programs::find_identity(block, hints);
  if (identity) programs::asked_model(block, *identity, true);
  write_weight_file(options.out, bytes);
  std::printf("%s: %s as a block of %zu bytes%s\n", printable(options.out).c_str(),
              printable(header.quoted("name")).c_str(), bytes.size(),
              identity ? "" : "; of a shape unknown here: its golden vectors were not replayed");
  return 0;
}

}  // namespace

programs::Command programs::block_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand("block", "Writes an exported header as a model block, without compiling");
  const auto options = std::make_shared<BlockOptions>();
  add_path(*line, "header", options->header, "MODEL.hpp", "a header of format 2 or 3, as pinnquad train writes it")
      ->required();
  add_path(*line, "--out", options->out, "FILE", "the block to write")->required();
  line->footer(
      "Examples:\n"
      "  pinnquad block my_model/model.hpp --out my_model/weights.block\n"
      "  pinnquad evaluate my_model/weights.block --flight flight.csv\n"
      "Exit codes: 0; 2 bad input or a file that can't be read or written; 130 interrupted.");
  return {line, [options] { return write_block(*options); }};
}
