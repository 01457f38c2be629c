// SPDX-License-Identifier: MIT
// Writes sound blocks into a folder, for the fuzzer to begin with: model_view_seeds DIR
#include <cstdio>
#include <string>

#include "pinnquad/deploy/weight_file.hpp"
#include "support/small_model_variants.hpp"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fprintf(stderr, "model_view_seeds: expected a folder\n");
    return 2;
  }
  const std::string folder = arguments[1];
  try {
    pinnquad::write_weight_file(folder + "/float", pinnquad::model_block<pinnquad::test::SmallModel>());
    pinnquad::write_weight_file(folder + "/double", pinnquad::model_block<pinnquad::test::DoubleModel>());
  } catch (const pinnquad::OutputError& error) {
    std::fprintf(stderr, "model_view_seeds: %s\n", error.what());
    return 2;
  }
}
