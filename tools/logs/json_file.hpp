// SPDX-License-Identifier: MIT
// JSON files as the programs take them: what is wrong with the text of one is said with line and column.
#pragma once

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "logs/nesting.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad::logs {

/// Throws InputError: the file can't be read, is no JSON, or is nested too deep.
inline nlohmann::json read_json_file(const std::string& path) {
  const std::string text = file_text(path);
  require_shallow(text, path, "JSON");
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    throw error_at(text, at, path, "JSON", at < text.size() ? "something else" : "its end");
  } catch (const nlohmann::json::out_of_range&) {
    throw InputError(path, 0, 0, "JSON of numbers that a double holds", "a larger one");
  }
}

}  // namespace pinnquad::logs
