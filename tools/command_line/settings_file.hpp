// SPDX-License-Identifier: MIT
// Options from a file: a TOML table per command, an entry per option, named as on the command line.
//   [fly]
//   seed = 3
//   [airframe.convert]
//   name = "racer"
#pragma once

#include <CLI/CLI.hpp>

#include <stdexcept>
#include <string>
#include <vector>

#include "logs/toml_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {

namespace logs = pinnquad::logs;

namespace detail {

/// A value as it would stand on the command line. Throws InputError: a table, a date, a list in a list.
inline std::string as_argument(const std::string& path, const toml::node& node) {
  if (const auto* text = node.as_string()) return logs::text_of_toml(path, *text);
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
  if (node.is_floating_point()) return pinnquad::number_text(logs::toml_number(node));
  logs::refuse_toml(path, node.source(), "a text, a number or a truth value", logs::described(node));
}

/// Gives an option its values, unless the command line has given it some.
inline void take_setting(const std::string& path, const toml::key& key, const toml::node& node, CLI::Option& option) {
  std::vector<std::string> values;
  if (const toml::array* list = node.as_array()) {
    for (const toml::node& value : *list) values.push_back(as_argument(path, value));
  } else {
    values.push_back(as_argument(path, node));
  }
  const bool is_flag = option.get_expected_min() == 0;
  if (is_flag != node.is_boolean()) {
    logs::refuse_toml(path, node.source(), is_flag ? "true or false" : "a value of --" + std::string(key.str()),
                      logs::described(node));
  }
  if (!option.empty() || (is_flag && values.front() == "false")) return;
  try {
    for (const std::string& value : values) option.add_result(value);
    option.run_callback();
  } catch (const CLI::ParseError& error) {
    const toml::source_position at = node.source().begin;
    throw std::invalid_argument(pinnquad::printable(path) + ":" + std::to_string(at.line) + ":" +
                                std::to_string(at.column) + ": " + error.what());
  }
}

inline void take_table(const std::string& path, const toml::table& table, CLI::App& command) {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (const toml::table* part = node.as_table()) {
      const auto chosen = command.get_subcommands([&name](const CLI::App* c) { return c->get_name() == name; });
      if (chosen.empty()) {
        logs::refuse_toml(path, key.source(), "a command of " + command.get_name(),
                          "`" + pinnquad::printable(name) + "`");
      }
      take_table(path, *part, *chosen.front());
      continue;
    }
    CLI::Option* option = command.get_option_no_throw("--" + name);
    if (option == nullptr) option = command.get_option_no_throw(name);
    if (option == nullptr || !option->get_configurable()) {
      logs::refuse_toml(path, key.source(), "an option of " + command.get_name(),
                        "`" + pinnquad::printable(name) + "`");
    }
    take_setting(path, key, node, *option);
  }
}

}  // namespace detail

/// Options of the program's commands from a file, whichever command was chosen. Throws InputError or
/// std::invalid_argument, one line with line and column: no TOML, a command or option that there is not, a value that
/// the option refuses.
inline void take_settings(CLI::App& program, const std::string& path) {
  detail::take_table(path, logs::read_toml_file(path, "options"), program);
}

}  // namespace programs
