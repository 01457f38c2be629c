// SPDX-License-Identifier: MIT
// C++ that fills the Inputs of a model, to copy from its page.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/deploy/block_model.hpp"

namespace programs {

inline std::string inputs_code(const pinnquad::BlockModel& model, const std::string& name) {
  const std::vector<std::string> features = model.feature_names();
  const bool velocity = std::any_of(features.begin(), features.end(), [](const std::string& feature) {
    return feature.find("v_b") == 0 || feature.find("vv_b") == 0 || feature.find("vdot_b") == 0;
  });
  std::string code = "#include \"model.hpp\"\n\n" + name +
                     "::Inputs inputs;  // body: forward, right, down; SI units, rad\n"
                     "inputs.linear_acceleration_m_s2 = {0, 0, 0};     // wanted: derivative of the body velocity\n"
                     "inputs.angular_acceleration_rad_s2 = {0, 0, 0};  // wanted\n"
                     "inputs.velocity_m_s = {0, 0, 0};                 // " +
                     std::string(velocity ? "over the ground, in the body" : "this model does not look at it") +
                     "\n"
                     "inputs.body_rates_rad_s = {0, 0, 0};             // gyro\n"
                     "inputs.attitude = {1, 0, 0, 0};                  // w, x, y, z: body to world (NED)\n";
  if (model.features().asks_for_altitude()) {
    code += "inputs.altitude_m = 10;                          // above the ground\n";
  }
  std::size_t place = 0;
  for (const pinnquad::ColumnName& column : model.columns()) {
    code += "inputs.columns[" + std::to_string(place++) + "] = 0;  // " + pinnquad::printable(column.name) + ", " +
            pinnquad::printable(column.unit) + "\n";
  }
  if (model.features().window().taps > 1) {
    code += "// and its past: InputHistory fills inputs.others and inputs.complete (docs/in_flight.md)\n";
  }
  return code + "\nconst pinnquad::InverseDynamics<" + name +
         "> inverse;\n"
         "pinnquad::Commands<float> commands{};  // thrust, 0 to 1: front right, rear left, front left, rear right\n"
         "const pinnquad::Status status = inverse.predict(inputs, commands);\n";
}

}  // namespace programs
