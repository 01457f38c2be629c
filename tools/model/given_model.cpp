// SPDX-License-Identifier: MIT
// The model that a command is given.
#include "model/given_model.hpp"

#include <charconv>
#include <filesystem>

#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

void add_model(CLI::App& line, std::string& model) {
  add_path(line, "model,--model", model, "MODEL",
           "a model block, as pinnquad train writes it (model.block), or the header beside it (model.hpp)")
      ->required();
}

namespace {

/// The hash that a header says, 0 where it says none: one line of it is looked up, nothing is understood.
std::uint64_t stated_hash(const std::string& header) {
  const std::string text = pinnquad::file_text(header), line = " contents_hash = 0x";
  const std::size_t at = text.rfind(line);
  std::uint64_t hash = 0;
  if (at == std::string::npos) return hash;
  const char* first = text.data() + at + line.size();
  std::from_chars(first, text.data() + text.size(), hash, 16);
  return hash;
}

}  // namespace

std::string block_path(const std::string& model) {
  const std::filesystem::path path(model);
  if (path.extension() != ".hpp") return model;
  const std::uint64_t hash = stated_hash(model);
  const std::string block = std::filesystem::path(path).replace_extension(".block").string();
  if (!std::filesystem::exists(block)) {
    throw pinnquad::InputError(
        model, 0, 0,
        "the block of this header beside it, " + pinnquad::printable(block) + " (docs/blocks.md says how to write it)",
        "none");
  }
  const pinnquad::BlockModel own(block);
  if (hash == 0 || own.contents_hash() != hash) {
    throw pinnquad::InputError(
        block, 0, 0,
        "the block of " + pinnquad::printable(model) + " (contents_hash " + pinnquad::hexadecimal(hash) + ")",
        "one of another header (" + pinnquad::hexadecimal(own.contents_hash()) + ")");
  }
  return block;
}

void require_provable(const pinnquad::BlockModel& model) {
  const auto certificate = model.certificate();
  if (certificate && !certificate->proven()) {
    throw pinnquad::InputError(model.path(), 0, 0, "slopes and bounds of which its certificate is proven", "others");
  }
}

}  // namespace programs
