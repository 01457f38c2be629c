// SPDX-License-Identifier: MIT
// A model from its file: a block, or an exported header as one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "model/header_airframe.hpp"
#include "model/header_block.hpp"
#include "model/identity.hpp"
#include "pinnquad/data/text_file.hpp"

namespace programs {

/// The bytes of a block, whichever the file is: a block, or an exported header as one. The hints become what the header states
/// where they were empty.
inline std::string block_bytes(const std::string& path, ModelHints& hints) {
  if (std::filesystem::path(path).extension() != ".hpp") return pinnquad::file_text(path);
  const HeaderFile header(path);
  if (hints.answer.empty()) hints.answer = answer_of(header);
  hints.own = own_airframe(header);
  const std::vector<unsigned char> bytes = block_of(header);
  return {bytes.begin(), bytes.end()};
}

}  // namespace programs
