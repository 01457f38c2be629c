// SPDX-License-Identifier: MIT
// A program of several commands: one is chosen by name, its options stand behind it or, by --config, in a file.
#pragma once

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "command_line/build_facts.hpp"
#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/help.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "command_line/settings_file.hpp"
#include "logs/nearest_names.hpp"
#include "pinnquad/version.hpp"

namespace programs {

namespace detail {

/// The command that was chosen: of `airframe list` it is list; the program itself where none was.
inline const CLI::App& chosen_command(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

/// --version, the look of --help, and one command at a time, for the program and all its commands.
inline void complete(CLI::App& command, const std::string& version) {
  command.set_version_flag("--version", version, "Print the version and exit");
  command.get_help_ptr()->description("Print this help and exit");
  command.formatter(std::make_shared<HelpFormatter>());
  refuse_empty_values(command);
  read_before_required(command);
  command.require_subcommand(0, 1);  // `airframe list check` is a word too many
  for (CLI::App* part : command.get_subcommands({})) {
    part->group("Commands");
    complete(*part, version);
  }
}

/// Options that there are no more, and what is written now.
inline constexpr std::pair<const char*, const char*> gone_options[] = {
    {"--flight", "FLIGHTS"},           {"--dataset", "DIR"},
    {"--log", "LOGS --mapping NAME"},  {"--model", "MODEL"},
    {"--recipe", "--models NAME,..."}, {"--loss", "--models NAME,..."}};

/// The first example of a command's help that calls it, without what is behind it after two spaces. Empty where it has
/// none.
inline std::string first_example(const CLI::App& command) {
  std::istringstream lines(command.get_footer());
  for (std::string line; std::getline(lines, line);) {
    if (line.compare(0, 10, "  pinnquad") != 0 || line.find(" " + command.get_name() + " ") == std::string::npos)
      continue;
    return line.substr(2, line.find("  ", 2) - 2);
  }
  return "";
}

/// Throws, one line, for words that are left over: of options that there are not, the first is named.
[[noreturn]] inline void refuse_words(const CLI::App& command, const std::vector<std::string>& words) {
  const auto is_option = [](const std::string& word) {
    const std::size_t at = word.find_first_not_of('-');
    return at != std::string::npos && (at == 1 || at == 2) && std::isalpha(static_cast<unsigned char>(word[at])) != 0;
  };
  const auto option = std::find_if(words.begin(), words.end(), is_option);
  if (option == words.end()) throw std::invalid_argument("expected no word more, found '" + words.front() + "'");
  std::vector<std::string> known;
  for (const CLI::Option* one : command.get_options()) {
    if (one->nonpositional() && one != command.get_help_ptr()) known.push_back(one->get_name());
  }
  const std::string name = option->substr(0, option->find('='));
  throw std::invalid_argument("no option " + name + "; " + pinnquad::logs::nearest_names(name, known));
}

/// Throws, one line, where a command is missing or words are left over. They are left with the program: what a command
/// does not know is handed up. `elsewhere` ends the line about a command that there is not.
inline void require_command(const CLI::App& program, const std::string& elsewhere) {
  const CLI::App& command = chosen_command(program);
  const std::vector<std::string> unknown = program.remaining();
  const std::string known = listed(command.get_subcommands([](const CLI::App*) { return true; }),
                                   [](const CLI::App* part) { return part->get_name(); });
  if (known.empty()) {
    const bool has_arguments =
        !command.get_options([](const CLI::Option* option) { return option->get_positional(); }).empty();
    const bool has_models = command.get_option_no_throw("--models") != nullptr;
    for (const std::string& word : unknown) {
      const std::string option = word.substr(0, word.find('='));
      for (const auto& [gone, instead] : gone_options) {
        if (option != gone || !(*instead == '-' ? has_models : has_arguments)) continue;
        throw std::invalid_argument("no option " + option + "; write: " + command.get_name() + " ... " + instead);
      }
    }
    if (!unknown.empty()) refuse_words(command, unknown);
    return;
  }
  if (unknown.empty()) throw std::invalid_argument("expected a command: " + known);
  if (unknown.front().compare(0, 1, "-") == 0) {
    throw std::invalid_argument("expected a command before " + unknown.front() + ": " + known);
  }
  std::vector<std::string> names;
  for (const CLI::App* part : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(part->get_name());
  throw std::invalid_argument("no command named '" + unknown.front() + "'; " +
                              pinnquad::logs::nearest_names(unknown.front(), names) + "; known: " + known + elsewhere);
}

}  // namespace detail

/// Adds --version and --config to a program whose commands are complete, and parses. Empty to go on; else the exit
/// code. `name` becomes that of the command as soon as it is known: messages name it. `elsewhere` says, to
/// who asks for a command that there is not, which program has it.
inline std::optional<int> choose_command(CLI::App& program, int argument_count, char** arguments, std::string& name,
                                         const std::string& elsewhere = {}) {
  detail::complete(program, program.get_name() + " " + PINNQUAD_VERSION + "\ninstruction set: " + instruction_set());
  program
      .add_option_function<std::string>(
          "--config", [&program](const std::string& path) { take_settings(program, path); },
          "options from a file: a table per command, such as [" + program.get_subcommands({}).front()->get_name() +
              "], an entry per option, such as seed = 3; the command line overrides the file")
      ->type_name("FILE.toml");
  read_before_required(program);
  program.allow_extras();
  for (CLI::App* command : program.get_subcommands({})) {
    command->preparse_callback([&name, command](std::size_t /*words*/) { name = command->get_name(); });
  }
  try {
    program.parse(argument_count, arguments);
    detail::require_command(program, elsewhere);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);
    const bool lacks = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    const std::string example = lacks ? detail::first_example(detail::chosen_command(program)) : "";
    const std::string what = error.what() + (example.empty() ? "" : "; for example: " + example);
    complain(name.c_str(), with_help(what, help_of(program.get_name(), name)));
    return exit_bad_input;
  }
  return {};
}

}  // namespace programs
