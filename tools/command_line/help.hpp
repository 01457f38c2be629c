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
    std::stringstream out;
    CLI::detail::format_help(out, name, wrapped(make_option_desc(option), width - name_column), name_column);
    return out.str();
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::stringstream out;
    CLI::detail::format_help(out, command->get_name(), wrapped(command->get_description(), width - name_column),
                             name_column);
    return out.str();
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
};

}  // namespace programs
