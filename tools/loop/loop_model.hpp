// SPDX-License-Identifier: MIT
// The model that flies in a loop: its block, the columns at which it is held, its airframe or another one.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/options.hpp"
#include "flight/battery_options.hpp"
#include "loop/model_flight.hpp"
#include "model/given_model.hpp"

namespace programs {

struct LoopModelOptions {
  std::string model;
  std::string airframe;
  std::vector<std::string> columns;
  BatteryOptions battery;
};

struct LoopModel : LoopVehicle {
  pinnquad::BlockModel model;
};

inline void add_loop_model(CLI::App& line, LoopModelOptions& options) {
  add_model(line, options.model);
  line.add_option("--column", options.columns, "of each input column once (default: middle of its training range)")
      ->allow_extra_args(false)  // a model that follows is no column
      ->type_name("NAME=VALUE");
  line.add_option("--airframe", options.airframe, "fly this vehicle, of the same motor order: see airframe list")
      ->type_name("NAME|FILE.toml");
  add_battery(line, options.battery);
}

/// Throws InputError and std::invalid_argument, one line, for what can't fly.
inline LoopModel read_loop_model(const LoopModelOptions& options) {
  LoopModel result{{}, read_model(options.model)};
  std::optional<NamedAirframe> airframe;
  if (!options.airframe.empty()) airframe = chosen_airframe(options.airframe);
  static_cast<LoopVehicle&>(result) = loop_vehicle(result.model, options.columns, options.battery, airframe);
  return result;
}

/// Lines of a help: each name with what it is.
template <class Named>
std::string described(const char* title, const Named& all) {
  std::string result = title;
  for (const auto& each : all) {
    std::string name = each.name;
    name.resize(20, ' ');
    result += "\n  " + name + each.summary;
  }
  return result + "\n";
}

template <class Named>
std::vector<std::string> names_of(const Named& all) {
  std::vector<std::string> names;
  for (const auto& each : all) names.emplace_back(each.name);
  return names;
}

/// An option that takes some of these names, parted by commas.
inline CLI::Option* add_names(CLI::App& line, const char* option, std::vector<std::string>& value,
                              const std::vector<std::string>& names, const std::string& text) {
  CLI::IsMember known(names);
  known.description("");  // the help says them elsewhere
  return line.add_option(option, value, text)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME,...")
      ->check(known);
}

/// Each name once; `usual` where none is given.
inline std::vector<std::string> names_or(const std::vector<std::string>& named, std::vector<std::string> usual) {
  std::vector<std::string> once;
  for (const std::string& name : named.empty() ? usual : named) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  return once;
}

}  // namespace programs
