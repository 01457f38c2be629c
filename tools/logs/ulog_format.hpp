// SPDX-License-Identifier: MIT
// Format messages of a ULog file: `name:type field;type[length] field;...`, where a type may be another format. How
// large such a message is, and which numbers of it stand where.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "logs/ulog_types.hpp"
#include "pinnquad/io/csv_table.hpp"

namespace pinnquad::logs::ulog {

struct Field {
  std::string type;
  std::string name;
  std::size_t length = 1;
  bool is_array = false;
  bool is_padding() const { return name.rfind("_padding", 0) == 0; }
};

struct Format {
  std::string name;
  std::vector<Field> fields;
};

/// A number or a text of a message: a column of its topic.
struct Leaf {
  std::string column;  ///< "q[0]", "esc[0].esc_rpm"
  Basic type = Basic::uint8;
  std::size_t offset = 0;
  std::size_t length = 1;  ///< of a char array, which is one text
};

inline bool is_name(std::string_view text, std::string_view also) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  constexpr std::size_t longest = 255;
  if (text.empty() || text.size() > longest) return false;
  return std::all_of(text.begin(), text.end(), [&](char c) {
    return allowed.find(c) != std::string_view::npos || also.find(c) != std::string_view::npos;
  });
}

/// "float[3]" as type and length.
inline Field typed(std::string_view text) {
  Field field;
  const std::size_t bracket = text.find('[');
  field.type = text.substr(0, bracket);
  if (bracket == std::string_view::npos) return field;
  field.is_array = true;
  field.length = 0;
  const std::string_view digits = text.substr(bracket + 1, text.size() - bracket - 2);
  bool sound = text.back() == ']' && !digits.empty();
  for (const char c : digits) {
    sound = sound && c >= '0' && c <= '9' && field.length <= longest_message;
    if (sound) field.length = 10 * field.length + static_cast<std::size_t>(c - '0');
  }
  if (!sound || field.length == 0 || field.length > longest_message) {
    throw BadMessage{"an array of 1 to 65535 elements, such as float[3]", quoted_cell(text)};
  }
  return field;
}

/// "type name", as keys of parameters and information have it too.
inline Field parse_field(std::string_view text) {
  const std::size_t blank = text.find(' ');
  if (blank == std::string_view::npos) {
    throw BadMessage{"a field with type and name", quoted_cell(text)};
  }
  Field field = typed(text.substr(0, blank));
  field.name = text.substr(blank + 1);
  if (!is_name(field.type, "-/") || !is_name(field.name, "-/")) {
    throw BadMessage{"a field whose type and name are of letters, digits and underscores", quoted_cell(text)};
  }
  return field;
}

inline Format parse_format(std::string_view text) {
  Format format;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || !is_name(text.substr(0, colon), "-/") ||
      basic_type(text.substr(0, colon)) != nullptr) {
    throw BadMessage{"a format with a name before a colon", quoted_cell(text)};
  }
  format.name = text.substr(0, colon);
  text.remove_prefix(colon + 1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    if (end > 0) format.fields.push_back(parse_field(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (format.fields.empty()) throw BadMessage{"a format with a field", "none in " + format.name};
  return format;
}

/// The formats of a log. A format may name one that comes later.
class Formats {
 public:
  void add(Format format) {
    const auto known = formats_.find(format.name);
    if (known != formats_.end() && !same(known->second, format)) {
      throw BadMessage{"one format named " + format.name, "another one"};
    }
    formats_.emplace(format.name, std::move(format));
  }

  bool has(const std::string& name) const { return formats_.count(name) > 0; }

  /// Bytes of a message with all its padding. Throws BadMessage for a type that nothing defines, for formats that
  /// contain themselves, and for more than a message can hold.
  std::size_t size(const std::string& name) { return size(name, 0); }

  /// Bytes of the padding at the end, which a logger may leave out.
  std::size_t last_padding(const std::string& name) {
    std::size_t bytes = 0;
    const std::vector<Field>& fields = formats_.at(name).fields;
    for (auto field = fields.rbegin(); field != fields.rend() && field->is_padding(); ++field)
      bytes += bytes_of(*field, 0);
    return bytes;
  }

  /// Where the field of the outermost format that has this name and type begins; its size if there is none.
  std::size_t offset(const std::string& name, std::string_view type, std::string_view field_name) {
    std::size_t offset = 0;
    for (const Field& field : formats_.at(name).fields) {
      if (field.name == field_name && field.type == type && !field.is_array) return offset;
      offset += bytes_of(field, 0);
    }
    return offset;
  }

  /// Every number and text of a message whose size is known: padding is left out.
  std::vector<Leaf> leaves(const std::string& name) {
    std::vector<Leaf> result;
    std::size_t offset = 0;
    append(name, "", offset, result);
    return result;
  }

 private:
  static constexpr int deepest = 16;

  static bool same(const Format& a, const Format& b) {
    return std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(),
                      [](const Field& x, const Field& y) {
                        return x.type == y.type && x.name == y.name && x.length == y.length && x.is_array == y.is_array;
                      });
  }

  std::size_t size(const std::string& name, int depth) {
    const auto known = sizes_.find(name);
    if (known != sizes_.end()) return known->second;
    const auto format = formats_.find(name);
    if (format == formats_.end()) throw BadMessage{"a format named " + name, "none"};
    if (depth > deepest) {
      throw BadMessage{"formats in each other at most " + std::to_string(deepest) + " deep",
                       name + " deeper, or in itself"};
    }
    std::size_t bytes = 0;
    for (const Field& field : format->second.fields) {
      bytes += bytes_of(field, depth);
      if (bytes > longest_message) throw BadMessage{"a format of at most 65535 bytes", name + " with more"};
    }
    sizes_[name] = bytes;
    return bytes;
  }
  std::size_t bytes_of(const Field& field, int depth) {
    const BasicType* const basic = basic_type(field.type);
    return field.length * (basic != nullptr ? basic->size : size(field.type, depth + 1));
  }

  void append(const std::string& name, const std::string& prefix, std::size_t& offset, std::vector<Leaf>& leaves) {
    constexpr std::size_t longest_column_name = 255;
    for (const Field& field : formats_.at(name).fields) {
      if (field.is_padding()) {
        offset += bytes_of(field, 0);
        continue;
      }
      const BasicType* const basic = basic_type(field.type);
      if (basic != nullptr && basic->type == Basic::character) {
        leaves.push_back({prefix + field.name, basic->type, offset, field.length});
        offset += field.length;
        continue;
      }
      for (std::size_t i = 0; i < field.length; ++i) {
        const std::string column = prefix + field.name + (field.is_array ? "[" + std::to_string(i) + "]" : "");
        if (column.size() > longest_column_name)
          throw BadMessage{"a field whose name has at most 255 letters", "a longer one"};
        if (basic == nullptr) {
          append(field.type, column + ".", offset, leaves);
        } else {
          leaves.push_back({column, basic->type, offset, 1});
          offset += basic->size;
        }
      }
    }
  }

  std::map<std::string, Format> formats_;
  std::map<std::string, std::size_t> sizes_;
};

}  // namespace pinnquad::logs::ulog
