// SPDX-License-Identifier: MIT
// How --help looks: what CLI11 makes of a command, within the 80 columns of a terminal.
#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <sstream>
#include <string>

namespace programs {

/// Breaks lines at spaces where they are longer than `width`; a line that begins with a space (an example) stays as it
/// is.
inline std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (line.size() > width && line.front() != ' ') {
      std::size_t end = line.rfind(' ', width);
      if (end == std::string::npos) end = line.find(' ');
      if (end == std::string::npos) break;
      result += line.substr(0, end) + '\n';
      line.erase(0, end + 1);
    }
    result += line + '\n';
  }
  if (!result.empty()) result.pop_back();
  return result;
}

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() {
    column_width(name_column);
    label("Positionals", "Arguments");
    label("SUBCOMMAND", "COMMAND");
    label("REQUIRED", "(needed)");
  }

  std::string make_description(const CLI::App* app) const override {
    return wrapped(CLI::Formatter::make_description(app), width) + "\n";
  }
  /// The name and what it takes; the description behind it, after two spaces at least, or below.
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string name = make_option_name(option, is_positional) + make_option_opts(option);
    if (name.size() + 3 == name_column) name += ' ';
    return in_columns(name, make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return in_columns(command->get_name(), command->get_description());
  }
  /// Lines of a footer are a paragraph until a sentence ends; examples, which begin with a space, stay as they are.
  std::string make_footer(const CLI::App* app) const override {
    const auto is_text = [](const std::string& line) { return !line.empty() && line.front() != ' '; };
    std::string text, before;
    std::istringstream lines(CLI::Formatter::make_footer(app));
    for (std::string line; std::getline(lines, line); before = line) {
      const bool goes_on = is_text(line) && is_text(before) && before.back() != '.' && before.back() != ':';
      text += (text.empty() ? "" : goes_on ? " " : "\n") + line;
    }
    return wrapped(text, width) + "\n";
  }

 private:
  static constexpr std::size_t width = 79, name_column = 28;

  /// A name, and its description in a column of its own, below a name that is too long.
  static std::string in_columns(const std::string& name, const std::string& description) {
    std::string text = "  " + name;
    const std::string indent(name_column, ' ');
    if (!description.empty()) {
      if (text.size() >= name_column) {
        text += '\n' + indent;
      } else {
        text.resize(name_column, ' ');
      }
      for (const char c : wrapped(description, width - name_column)) text += c == '\n' ? c + indent : std::string(1, c);
    }
    return text + '\n';
  }
};

}  // namespace programs
