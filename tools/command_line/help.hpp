// SPDX-License-Identifier: MIT
// How --help looks: what CLI11 makes of a command, within 100 columns.
#pragma once

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

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
  HelpFormatter() { label("REQUIRED", "(needed)"); }

  /// All of it: names, order and empty lines of CLI11's own change from version to version.
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode /*mode*/) const override {
    return wrapped(app->get_description(), width) + "\n" + make_usage(app, name) + make_lists(app) + "\n" +
           make_footer(app);
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    std::string text = "Usage:" + (name.empty() ? "" : " " + name);
    const auto options = app->get_options([](const CLI::Option* option) { return option->nonpositional(); });
    if (!options.empty()) text += " [OPTIONS]";
    for (const CLI::Option* argument : arguments(app)) text += " " + make_option_usage(argument);
    if (!commands(app).empty()) text += app->get_require_subcommand_min() == 0 ? " [COMMAND]" : " COMMAND";
    return text + "\n";
  }
  /// An option's values: their type, the default, how many.
  std::string make_option_opts(const CLI::Option* option) const override {
    if (!option->get_option_text().empty()) return " " + option->get_option_text();
    std::string text;
    if (option->get_type_size() != 0) {
      if (!option->get_type_name().empty()) text += " " + in_words(option->get_type_name());
      if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
      if (option->get_expected_max() == CLI::detail::expected_max_vector_size && option->get_delimiter() == '\0') {
        text += " ...";
      } else if (option->get_expected_min() > 1) {
        text += " x " + std::to_string(option->get_expected());
      }
      if (option->get_required()) text += " " + get_label("REQUIRED");
    }
    return text;
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
    std::istringstream lines(app->get_footer());
    for (std::string line; std::getline(lines, line); before = line) {
      const bool goes_on = is_text(line) && is_text(before) && before.back() != '.' && before.back() != ':';
      text += (text.empty() ? "" : goes_on ? " " : "\n") + line;
    }
    return wrapped(text, width) + "\n";
  }

 private:
  static constexpr std::size_t width = 99, name_column = 28;

  /// "TEXT:{a,b}", CLI11's words for one of a few, as a|b.
  static std::string in_words(std::string type) {
    const std::size_t begin = type.find(":{");
    if (begin == std::string::npos) return type;
    const std::string name = type.substr(0, begin);
    if (name != "TEXT") return name;
    type = type.substr(begin + 2, type.size() - begin - 3);
    std::replace(type.begin(), type.end(), ',', '|');
    return type;
  }
  static std::vector<const CLI::Option*> arguments(const CLI::App* app) {
    return app->get_options(
        [](const CLI::Option* option) { return option->get_positional() && !option->get_group().empty(); });
  }
  static std::vector<const CLI::App*> commands(const CLI::App* app) {
    return app->get_subcommands([](const CLI::App* command) {
      return !command->get_disabled() && !command->get_name().empty() && !command->get_group().empty();
    });
  }
  /// Arguments, options by group, commands by group, in the order of their definition.
  std::string make_lists(const CLI::App* app) const {
    std::string text;
    if (!arguments(app).empty()) text += "\nArguments:\n";
    for (const CLI::Option* argument : arguments(app)) text += make_option(argument, true);
    for (const std::string& group : app->get_groups()) {
      const auto options = app->get_options(
          [&group](const CLI::Option* option) { return option->nonpositional() && option->get_group() == group; });
      if (group.empty() || options.empty()) continue;
      text += "\n" + (group == "OPTIONS" ? "Options" : group) + ":\n";
      for (const CLI::Option* option : options) text += make_option(option, false);
      if (group != app->get_groups().back()) text += "\n";
    }
    std::vector<std::string> groups;
    for (const CLI::App* command : commands(app)) {
      const std::string group = command->get_group();
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
    for (const std::string& group : groups) {
      text += "\n" + (group == "SUBCOMMANDS" ? "Subcommands" : group) + ":\n";
      for (const CLI::App* command : commands(app)) {
        if (command->get_group() == group) text += make_subcommand(command);
      }
    }
    return text;
  }

  /// A name, and its description in a column of its own, whose first line begins behind a name that is too long.
  static std::string in_columns(const std::string& name, const std::string& description) {
    std::string text = "  " + name;
    const std::string indent(name_column, ' ');
    if (description.empty()) return text + '\n';
    text.resize(std::max(name_column, text.size() + 2), ' ');
    const std::size_t taken = text.size() - name_column;
    const std::string lines = wrapped(std::string(taken, '.') + description, width - name_column);
    for (const char c : lines.substr(taken)) text += c == '\n' ? c + indent : std::string(1, c);
    return text + '\n';
  }
};

}  // namespace programs
