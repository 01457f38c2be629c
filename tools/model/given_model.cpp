// SPDX-License-Identifier: MIT
// The model that a command is given.
#include "model/given_model.hpp"

#include <charconv>
#include <filesystem>

#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

namespace {

/// The number behind the last `line` of a header, 0 where there is none: nothing else is understood.
std::uint64_t stated(const std::string& text, const std::string& line, int base) {
  const std::size_t at = text.rfind(line);
  std::uint64_t number = 0;
  if (at == std::string::npos) return number;
  std::from_chars(text.data() + at + line.size(), text.data() + text.size(), number, base);
  return number;
}

}  // namespace

std::string block_path(const std::string& model) {
  const std::filesystem::path path(model);
  if (path.extension() != ".hpp") return model;
  const std::string text = pinnquad::file_text(model);
  const std::uint64_t format = stated(text, " format_version = ", 10);
  if (format != 0 && format != pinnquad::header_format_version) {
    throw pinnquad::InputError(model, 0, 0,
                               "a header of format " + std::to_string(pinnquad::header_format_version) +
                                   " (of another: train and export again)",
                               "format " + std::to_string(format));
  }
  const std::uint64_t hash = stated(text, " contents_hash = 0x", 16);
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

}  // namespace programs
