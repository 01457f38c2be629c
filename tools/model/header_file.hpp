// SPDX-License-Identifier: MIT
// An exported header (deploy/header_writer.hpp) read as text: its constants by name, as its writer wrote them. No C++
// compiler; a header that was edited by hand may be refused.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

/// A header's text with LF at the ends of its lines: a checkout may have made them CRLF.
inline std::string header_text(const std::string& path) {
  const std::string text = pinnquad::file_text(path);
  std::string lines;
  lines.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "\r\n") != 0) lines += text[i];
  }
  return lines;
}

/// `static constexpr TYPE NAME = VALUE;` and `using NAME = VALUE;` of the model's struct.
class HeaderFile {
 public:
  /// Throws InputError: not readable, no exported header.
  explicit HeaderFile(const std::string& path) : path_(path) {
    const std::string text = header_text(path);
    // an airframe of its own is a struct before the model's
    const std::size_t model = text.find("\n  using Scalar = ");
    if (text.find("exported by pinnquad") == std::string::npos || model == std::string::npos) {
      refuse(0, "a header that pinnquad train exported", "something else");
    }
    take_all(text, model);
  }
  /// Of the struct that stands beside a model's: `first` is the name of its first constant, `expected` what the file
  /// is.
  HeaderFile(const std::string& path, const std::string& first, const std::string& expected) : path_(path) {
    const std::string text = header_text(path);
    const std::size_t name = text.find(" " + first + " = ");
    const std::size_t begin = name == std::string::npos ? name : text.rfind('\n', name);
    if (begin == std::string::npos) refuse(0, expected, "something else");
    take_all(text, begin);
  }

  const std::string& path() const { return path_; }
  bool has(const std::string& name) const { return entries_.count(name) > 0; }

  /// A value as it stands there, e.g. a type.
  const std::string& text(const std::string& name) const { return entry(name).value; }

  /// The text between quotes. A list of them: texts().
  std::string quoted(const std::string& name) const {
    const std::vector<std::string> all = texts(name);
    if (all.size() != 1) refuse(entry(name).line, "a text of `" + name + "`", std::to_string(all.size()));
    return all.front();
  }

  std::vector<std::string> texts(const std::string& name) const {
    const Entry& of = entry(name);
    std::vector<std::string> all;
    bool inside = false;
    for (std::size_t i = 0; i < of.value.size(); ++i) {
      char c = of.value[i];
      if (c == '"') {
        if (!inside) all.emplace_back();
        inside = !inside;
        continue;
      }
      if (!inside) continue;
      if (c == '\\' && i + 1 < of.value.size()) c = of.value[++i];
      all.back() += c;
    }
    if (inside) refuse(of.line, "a text of `" + name + "`", "one that does not end");
    return all;
  }

  /// Numbers in the order in which they stand, each read as the header's `Scalar` where it is marked as one.
  std::vector<double> numbers(const std::string& name) const {
    const Entry& of = entry(name);
    std::vector<double> all;
    const std::string_view value = of.value;
    for (std::size_t at = value.find_first_not_of(separators); at != std::string_view::npos;) {
      const std::size_t end = std::min(value.find_first_of(separators, at), value.size());
      all.push_back(number(of, value.substr(at, end - at), name));
      at = value.find_first_not_of(separators, end);
    }
    return all;
  }
  /// As many as expected. Throws InputError for another count.
  std::vector<double> numbers(const std::string& name, std::size_t count) const {
    std::vector<double> all = numbers(name);
    if (all.size() != count) {
      refuse(entry(name).line, std::to_string(count) + " numbers in `" + name + "`", std::to_string(all.size()));
    }
    return all;
  }
  double number(const std::string& name) const { return numbers(name, 1).front(); }

  std::uint64_t hexadecimal(const std::string& name) const {
    const Entry& of = entry(name);
    std::uint64_t value = 0;
    const char *first = of.value.data(), *last = first + of.value.size();
    const bool marked = of.value.compare(0, 2, "0x") == 0;
    if (!marked || std::from_chars(first + 2, last, value, 16).ptr == first + 2) {
      refuse(of.line, "a hexadecimal number in `" + name + "`", "`" + pinnquad::printable(of.value) + "`");
    }
    return value;
  }

  bool truth(const std::string& name) const {
    const Entry& of = entry(name);
    if (of.value != "true" && of.value != "false") refuse(of.line, "true or false in `" + name + "`", "something else");
    return of.value == "true";
  }

  /// Throws InputError where the header says a hash over all of it that is not that of its constants and this airframe
  /// (exported/contents_hash.hpp).
  void require_contents(const pinnquad::Airframe<double>& airframe) const {
    if (!has("contents_hash")) return;
    std::uint64_t sum = 0;
    for (const std::string_view name : pinnquad::hashed_constants) {
      pinnquad::detail::ConstantHash hash(name);
      const auto found = entries_.find(std::string(name));
      if (name == "Vehicle") {
        hash.add(airframe);
      } else if (found != entries_.end()) {
        add(hash, std::string(name), found->second);
      } else {
        continue;
      }
      sum += hash.value();
    }
    if (sum != hexadecimal("contents_hash")) {
      refuse("contents_hash", "a header as it was exported", "one that was edited since");
    }
  }

  /// Throws InputError at the line of a constant.
  [[noreturn]] void refuse(const std::string& name, const std::string& expected, const std::string& found) const {
    refuse(entry(name).line, expected, found);
  }

 private:
  struct Entry {
    std::string value;
    std::size_t line = 0;
  };
  static constexpr std::string_view separators = "{}, \n";

  /// As the compiler has the constant.
  void add(pinnquad::detail::ConstantHash& hash, const std::string& name, const Entry& of) const {
    constexpr std::string_view meaning = "pinnquad::CommandMeaning::";
    const std::string_view value = of.value;
    if (value.find('"') != std::string_view::npos) {
      for (const std::string& one : texts(name)) hash.add(std::string_view(one));
    } else if (value.substr(0, meaning.size()) == meaning) {
      hash.add(value.substr(meaning.size()));
    } else if (value.substr(0, 2) == "0x") {
      hash.add(hexadecimal(name));
    } else if (value == "true" || value == "false") {
      hash.add(value == "true");
    } else {
      for (std::size_t at = value.find_first_not_of(separators); at != std::string_view::npos;) {
        const std::size_t end = std::min(value.find_first_of(separators, at), value.size());
        const std::string_view one = value.substr(at, end - at);
        const double read = number(of, one, name);
        if (one.back() == 'f') {
          hash.add(static_cast<float>(read));
        } else if (one.find_first_of(".en") != std::string_view::npos) {
          hash.add(read);
        } else {
          hash.add(static_cast<int>(read));
        }
        at = value.find_first_not_of(separators, end);
      }
    }
  }

  /// The semicolon that ends the statement, or the end of the text: not one within a text or a comment.
  static std::size_t statement_end(const std::string& text, std::size_t at) {
    bool inside = false;
    for (; at < text.size(); ++at) {
      if (inside && text[at] == '\\') {
        ++at;
      } else if (text[at] == '"') {
        inside = !inside;
      } else if (!inside && text.compare(at, 2, "//") == 0) {
        at = std::min(text.find('\n', at), text.size());
      } else if (!inside && text[at] == ';') {
        return at;
      }
    }
    return text.size();
  }

  static std::size_t leading_lines(const std::string& text, std::size_t at) {
    std::size_t lines = 0;
    for (; at < text.size() && (text[at] == '\n' || text[at] == ' ' || text.compare(at, 2, "//") == 0); ++at) {
      if (text.compare(at, 2, "//") == 0) at = std::min(text.find('\n', at), text.size() - 1);
      if (text[at] == '\n') ++lines;
    }
    return lines;
  }

  /// The statements from there on.
  void take_all(const std::string& text, std::size_t from) {
    const auto place = [&text](std::size_t at) { return text.begin() + static_cast<std::string::difference_type>(at); };
    std::size_t line = static_cast<std::size_t>(std::count(text.begin(), place(from), '\n')) + 1;
    for (std::size_t at = from; at < text.size();) {
      const std::size_t end = statement_end(text, at);
      take(text.substr(at, end - at), line + leading_lines(text, at));
      line += static_cast<std::size_t>(std::count(place(at), place(end), '\n'));
      at = end + 1;
    }
  }

  /// Takes the text between two semicolons, comments before it included.
  void take(std::string statement, std::size_t line) {
    for (std::size_t comment = statement.find_first_not_of(" \n");
         comment != std::string::npos && statement.compare(comment, 2, "//") == 0;
         comment = statement.find_first_not_of(" \n")) {
      statement.erase(0, std::min(statement.find('\n', comment), statement.size()));
    }
    const std::size_t begin = statement.find_first_not_of(" \n");
    const std::size_t equals = statement.find(" = ");
    if (begin == std::string::npos || equals == std::string::npos || equals < begin) return;
    const bool constant = statement.compare(begin, 17, "static constexpr ") == 0;
    if (!constant && statement.compare(begin, 6, "using ") != 0) return;
    const std::size_t name = statement.rfind(' ', equals - 1) + 1;
    entries_.emplace(statement.substr(name, equals - name), Entry{statement.substr(equals + 3), line});
  }

  const Entry& entry(const std::string& name) const {
    const auto found = entries_.find(name);
    if (found == entries_.end()) refuse(0, "`" + name + "` in an exported header", "none");
    return found->second;
  }

  double number(const Entry& of, std::string_view text, const std::string& name) const {
    const bool is_float = !text.empty() && text.back() == 'f';
    const char *first = text.data(), *last = first + text.size() - (is_float ? 1 : 0);
    float single = 0;
    double value = 0;
    const std::from_chars_result read =
        is_float ? std::from_chars(first, last, single) : std::from_chars(first, last, value);
    if (read.ec != std::errc() || read.ptr != last) {
      refuse(of.line, "numbers in `" + name + "`", "`" + pinnquad::printable(std::string(text)) + "`");
    }
    return is_float ? static_cast<double>(single) : value;
  }

  [[noreturn]] void refuse(std::size_t line, const std::string& expected, const std::string& found) const {
    throw pinnquad::InputError(path_, line, 0, expected, found);
  }

  std::string path_;
  std::map<std::string, Entry> entries_;
};

}  // namespace programs
