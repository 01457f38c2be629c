// SPDX-License-Identifier: MIT
// JSON files as the programs take them: what is wrong with the text of one is said with line and column.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "pinnquad/data/file_error.hpp"
#include "pinnquad/data/text_file.hpp"

namespace programs {

/// Throws InputError: the file can't be read, or is no JSON.
inline nlohmann::json read_json_file(const std::string& path) {
  const std::string text = pinnquad::file_text(path);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto before = text.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t line = 1 + static_cast<std::size_t>(std::count(text.begin(), before, '\n'));
    const std::size_t start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t column = start == std::string::npos ? at + 1 : at - start;
    throw pinnquad::InputError(path, line, column, "JSON", at < text.size() ? "something else" : "its end");
  }
}

}  // namespace programs
