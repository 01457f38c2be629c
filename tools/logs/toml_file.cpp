// SPDX-License-Identifier: MIT
#include "logs/toml_file.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include "logs/nesting.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad::logs {
namespace {

std::size_t behind_byte_order_mark(const std::string& content) {
  return content.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0;
}

/// TOML has characters beyond ASCII in texts and comments alone.
void require_ascii_toml(const std::string& content, const std::string& path) {
  for (std::size_t i = behind_byte_order_mark(content); i < content.size();) {
    const std::size_t behind = behind_text(content, i);
    if (behind == i && static_cast<unsigned char>(content[i]) >= 0x80) {
      throw error_at(content, i, path, "TOML", "a character beyond ASCII outside texts and comments");
    }
    i = std::max(behind, i + 1);
  }
}

/// The same tables and texts, ASCII alone behind the byte order mark.
std::string in_ascii(std::string content) {
  for (std::size_t i = behind_byte_order_mark(content); i < content.size(); ++i) {
    if (static_cast<unsigned char>(content[i]) >= 0x80) content[i] = 'x';
  }
  return content;
}

}  // namespace

toml::table parse_toml(const std::string& content, const std::string& path) {
  require_shallow(content, path, "TOML");
  try {
    // toml++ 3.3 does not survive letters beyond ASCII in a faulty file: the tables are read without them first
    const std::string plain = in_ascii(content);
    if (plain != content) {
      require_ascii_toml(content, path);
      static_cast<void>(toml::parse(plain, path));
    }
    return toml::parse(content, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw InputError(path, at.line, at.column, "TOML", printable(error.description()));
  }
}

toml::table read_toml_file(const std::string& path, const std::string& what) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 20;
  require_regular_file(path);
  std::error_code absent;
  const std::uintmax_t bytes = std::filesystem::file_size(path, absent);
  if (!absent && bytes > most_bytes) throw InputError(path, 0, 0, what + " of at most 1 MiB", "a larger file");
  return parse_toml(file_text(path), path);
}

void refuse_toml(const std::string& path, const toml::source_region& where, const std::string& expected,
                 const std::string& found) {
  throw InputError(path, where.begin.line, where.begin.column, expected, found);
}

double toml_number(const toml::node& node) {
  return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
}

std::string described(const toml::node& node) {
  if (const auto* text = node.as_string()) return "\"" + printable(text->get()) + "\"";
  if (node.is_number()) return number_text(toml_number(node));
  if (node.is_array()) return "an array of " + std::to_string(node.as_array()->size());
  return node.is_table() ? "a table" : node.is_boolean() ? "a truth value" : "a date or time";
}

std::string text_of_toml(const std::string& path, const toml::value<std::string>& text) {
  if (text->find('\0') != std::string::npos) refuse_toml(path, text.source(), "a text without NUL", described(text));
  return text.get();
}

}  // namespace pinnquad::logs
