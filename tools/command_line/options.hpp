// SPDX-License-Identifier: MIT
// Options of the programs: numbers taken as they are written or refused, paths that name something.
#pragma once

#include <CLI/CLI.hpp>

#include <charconv>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/parse_decimal.hpp"

namespace programs {

/// Largest seed: those that count on from it are seeds too.
inline constexpr std::uint64_t most_seed = ~std::uint64_t{0} >> 1;

/// The value of --lag: none for auto. Throws std::invalid_argument, one line.
inline std::optional<double> lag_of(const std::string& text) {
  constexpr double longest_s = 1;
  if (text == "auto") return {};
  double lag_s = 0;
  if (!parse_decimal(text, -longest_s, longest_s, lag_s)) {
    throw std::invalid_argument("--lag: expected auto, or seconds from -1 to 1, found '" + text + "'");
  }
  return lag_s;
}

/// An option that takes a number from `least` to `most`; whatever else it is given is refused in one line.
/// `Value` is a number, or a std::optional of one: it stays empty where the option is not given.
template <class Value, class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Value& value, Number least, Number most,
                        const std::string& description) {
  const auto text_of = [](Number number) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, number).ptr);
  };
  const std::string kind = std::is_integral_v<Number> ? "a whole number" : "a number";
  const std::string expected = "expected " + kind + " from " + text_of(least) + " to " + text_of(most);
  const auto take = [&value, name, least, most, expected](const std::string& text) {
    Number number{};
    if (!parse_decimal(text, least, most, number)) {
      throw CLI::ValidationError(name, expected + ", found '" + text + "'");
    }
    value = number;
  };
  CLI::Option* option =
      app.add_option_function<std::string>(name, take, description)->type_name(text_of(least) + ".." + text_of(most));
  if constexpr (std::is_same_v<Value, Number>) option->default_str(text_of(value));
  return option;
}

/// An option that takes a path.
inline CLI::Option* add_path(CLI::App& app, const std::string& name, std::string& path, const std::string& kind,
                             const std::string& description) {
  return app
      .add_option_function<std::string>(
          name, [&path](const std::string& text) { path = text; }, description)
      ->type_name(kind);
}

/// An option that takes one path or more.
inline CLI::Option* add_paths(CLI::App& app, const std::string& name, std::vector<std::string>& paths,
                              const std::string& kind, const std::string& description) {
  return app
      .add_option_function<std::vector<std::string>>(
          name, [&paths](const std::vector<std::string>& texts) { paths = texts; }, description)
      ->type_name(kind);
}

/// FLIGHTS of a command, told apart by their content, and the mapping that logs need.
inline void add_sources(CLI::App& app, std::vector<std::string>& flights, std::string& mapping,
                        const std::string& name = "flights") {
  add_paths(app, name, flights, "FLIGHTS", "recorded flights (CSV), a dataset of import, or logs");
  app.add_option("--mapping", mapping, "meaning of logs' columns, if not recognised: see import --list")
      ->type_name("NAME|FILE.toml");
}

/// MODEL, of a command that takes one.
inline void add_model(CLI::App& line, std::string& model) {
  add_path(line, "model", model, "MODEL",
           "a model block, as pinnquad train writes it (model.block), or the header beside it (model.hpp)")
      ->required();
}

/// The part of each log that counts, in a command's LogSettings or options.
template <class Options>
void add_time_range(CLI::App& app, Options& options) {
  constexpr double longest_s = 1e6;
  add_number(app, "--from", options.from_s, 0.0, longest_s, "use each log from this time on, s after its first row")
      ->default_str("");
  add_number(app, "--to", options.to_s, 0.0, longest_s, "and until this time")->default_str("");
}

/// Throws std::invalid_argument, one line, for a part of what are no logs, and for an empty one.
template <class Options>
void require_time_range(const Options& options, bool are_logs) {
  const bool given = options.from_s > 0 || options.to_s;
  if (given && !are_logs) throw std::invalid_argument("--from and --to go with logs: of other rows all count");
  if (options.to_s && *options.to_s <= options.from_s) {
    throw std::invalid_argument("--to: expected more than --from");
  }
}

/// Refuses an empty text wherever an option takes a value: it would be the root folder, every model, or nothing.
inline void refuse_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_expected_min() == 0) continue;  // a flag
    option->check(CLI::Validator(
        [kind = option->get_type_name()](const std::string& text) {
          return text.empty() ? "expected " + kind + ", found ''" : std::string();
        },
        ""));
  }
}

/// Reads options before it is asked which are missing, so that a wrong value is named, and --config gives what is
/// required: CLI11 2.6 asks first.
inline void read_before_required([[maybe_unused]] CLI::App& app) {
#if CLI11_VERSION_MAJOR > 2 || (CLI11_VERSION_MAJOR == 2 && CLI11_VERSION_MINOR >= 6)
  for (CLI::Option* option : app.get_options()) {
    if (option != app.get_help_ptr()) option->callback_priority(CLI::CallbackPriority::PreRequirementsCheckPreHelp);
  }
#endif
}

/// Runs the command that was chosen: its exit code.
inline int run_chosen(const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    if (command.line->parsed()) return command.run();
  }
  throw std::logic_error("no command was chosen");
}

}  // namespace programs
