// SPDX-License-Identifier: MIT
// Bodies of text_file.hpp.
#pragma once

#include "pinnquad/io/text_file.hpp"

namespace pinnquad {

PINNQUAD_BODY void require_regular_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) throw InputError(path, 0, 0, "a readable file", "a folder");
  if (!fs::is_regular_file(status)) throw InputError(path, 0, 0, "a regular file", "a device or a pipe");
  const std::uintmax_t bytes = fs::file_size(path, ignored);
  if (!ignored && bytes > detail::most_input_bytes) detail::refuse_size(path);
}

PINNQUAD_BODY std::string file_text(const std::string& path) {
  detail::TextFile file(path);
  std::string text;
  std::vector<char> block(detail::read_block);
  while (const std::size_t count = file.read(block.data(), block.size())) text.append(block.data(), count);
  return text;
}

}  // namespace pinnquad
