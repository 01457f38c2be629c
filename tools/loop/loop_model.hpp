// SPDX-License-Identifier: MIT
// The model that flies in a loop: its block, the columns at which it is held, its airframe or another one.
#pragma once

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/held_columns.hpp"
#include "command_line/options.hpp"
#include "flight/battery_options.hpp"
#include "flight/block_loop.hpp"
#include "model/given_model.hpp"

namespace programs {

struct LoopModelOptions {
  std::string model;
  std::string airframe;
  std::vector<std::string> columns;
  BatteryOptions battery;
};

struct LoopModel {
  pinnquad::BlockModel model;
  std::vector<double> columns{};  ///< in the model's order
  std::optional<pinnquad::Battery> battery{};
  NamedAirframe airframe{};
};

inline void add_loop_model(CLI::App& line, LoopModelOptions& options) {
  add_model(line, options.model);
  line.add_option("--column", options.columns, "value of an input column (default: middle of its training range)")
      ->type_name("NAME=VALUE");
  line.add_option("--airframe", options.airframe, "fly this vehicle, of the same motor order: see airframe list")
      ->type_name("NAME|FILE.toml");
  add_battery(line, options.battery);
}

/// Throws InputError and std::invalid_argument, one line, for what can't fly.
inline LoopModel read_loop_model(const LoopModelOptions& options) {
  LoopModel result{read_model(options.model)};
  const pinnquad::BlockModel& model = result.model;
  if (model.features().window().latest_s > 0) {
    throw std::invalid_argument(model.path() + ": its window looks ahead of the present, which no loop can");
  }
  result.columns = held_columns(range_of(model).columns(), options.columns);
  result.battery = battery_of(options.battery);
  const std::string held = std::string(pinnquad::BatteryVoltage::name) + "=";
  const bool is_held = std::any_of(options.columns.begin(), options.columns.end(),
                                   [&held](const std::string& column) { return column.rfind(held, 0) == 0; });
  if (is_held && result.battery)
    throw std::invalid_argument("--column " + held + ": the vehicle's --battery has a voltage");
  if (!is_held && !result.battery && voltage_among(model, result.columns) != nullptr) {
    throw std::invalid_argument(model.path() +
                                ": asks for battery_voltage, which the vehicle does not have: give it one " +
                                "(--battery 3x2200), or hold the column (--column battery_voltage=11.5)");
  }
  if (options.airframe.empty()) {
    result.airframe = {model.airframe_name(), model.airframe()};
    return result;
  }
  result.airframe = chosen_airframe(options.airframe);
  if (motor_torque_signs(result.airframe.value) != motor_torque_signs(model.airframe())) {
    throw std::invalid_argument("--airframe: the motors of " + pinnquad::printable(result.airframe.name) +
                                " stand or turn otherwise than those of " + model.airframe_name() +
                                ", which the model commands");
  }
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
  return line.add_option(option, value, text)->delimiter(',')->type_name("NAME,...")->check(known);
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
