// SPDX-License-Identifier: MIT
// An output schema for an airframe as a value: its names, and the map between outputs and commands. Code that takes one
// is compiled once for all schemas.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/exported/run_time_outputs.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/training/described_predictor.hpp"

namespace pinnquad {

namespace detail {

/// Commands at outputs 0 and by each output, 4 + 4 x size, of a linear schema of a user's own; empty for another one.
template <class Outputs, class Scalar>
std::vector<double> affine_schema(const Airframe<Scalar>& airframe) {
  std::vector<double> numbers;
  using Map = OutputMap<Outputs>;
  if constexpr (!Map::takes_features && !is_known_schema<Outputs> && is_detected<IsLinear, Outputs>) {
    const auto setting = Map::setting(airframe);
    Scalar outputs[Map::size]{}, commands[rotor_count]{}, slopes[Map::slope_count]{};
    const Scalar* none = nullptr;
    Map::commands(none, static_cast<const Scalar*>(outputs), setting, static_cast<Scalar*>(commands));
    Map::slopes(none, static_cast<const Scalar*>(outputs), setting, static_cast<Scalar*>(slopes));
    for (const Scalar command : commands) numbers.push_back(static_cast<double>(command));
    for (int rotor = 0; rotor < rotor_count; ++rotor) {
      for (int k = 0; k < Map::size; ++k) {
        const bool reads = k >= Map::first_output(rotor) && k < Map::last_output(rotor);
        numbers.push_back(reads ? static_cast<double>(slopes[Map::slope_index(rotor, k)]) : 0.0);
      }
    }
  }
  return numbers;
}

}  // namespace detail

/// An output schema for an airframe, as a value.
struct GroundOutputs {
  std::string type, description, base;  ///< of the schema; description of its base, empty: none
  std::vector<std::string> names, units;
  std::vector<double> affine;  ///< detail::affine_schema()
  /// Outputs of features and commands, physical units.
  std::function<void(const double* x, const double* commands, double* y)> from_commands;
  std::function<Commands<float>(const float* x, const float* y)> commands;  ///< the inverse, as it flies
};

/// `airframe`: a GivenAirframe, or that of a context.
template <class Outputs, class AirframeSource>
GroundOutputs ground_outputs(const AirframeSource& airframe) {
  using Map = OutputMap<Outputs>;
  GroundOutputs value;
  value.type = type_name<Outputs>();
  value.description = detail::description_text<Outputs>();
  value.base = detail::description_text<typename detail::BaseOf<Outputs>::type>();
  value.names.assign(Map::names.begin(), Map::names.end());
  value.units.assign(Map::units.begin(), Map::units.end());
  value.affine = detail::affine_schema<Outputs>(airframe.template airframe<float>());
  value.from_commands = [setting = airframe.template output_setting<Outputs, double>()](
                            const double* x, const double* commands, double* y) {
    Map::from_commands(x, commands, setting, y);
  };
  value.commands = [setting = airframe.template output_setting<Outputs, float>()](const float* x, const float* y) {
    Commands<float> commands{};
    Map::commands(x, y, setting, commands.data());
    return commands;
  };
  return value;
}

}  // namespace pinnquad
