// SPDX-License-Identifier: MIT
// Writes headers as blocks by the library, from their types: what pinnquad block must write from their text.
//   block_driver FOLDER
#include <cstdio>
#include <exception>
#include <string>

#include "../../../examples/models/crazyflie_2_1.hpp"
#include "../../../examples/models/demo_quadrotor.hpp"
#include "models/v2/crazyflie_tanh.hpp"
#include "models/v3/own_racer.hpp"
#include "pinnquad/deploy/weight_file.hpp"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  const std::string folder = arguments[1];
  try {
    const auto write = [&folder](const char* name, const auto& block) {
      pinnquad::write_weight_file(folder + "/" + name + ".block", block);
    };
    write("demo_quadrotor", pinnquad::model_block<DemoQuadModel>());
    write("crazyflie_2_1", pinnquad::model_block<CrazyflieModel>());
    write("crazyflie_tanh", pinnquad::model_block<CrazyflieTanhV2>());
    write("v3_own_racer", pinnquad::model_block<OwnRacerV3>());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "block_driver: %s\n", error.what());
    return 1;
  }
  return 0;
}
