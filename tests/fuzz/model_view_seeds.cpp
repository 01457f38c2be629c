// SPDX-License-Identifier: MIT
// Writes sound blocks into a folder, for the fuzzer to begin with: model_view_seeds DIR
#include "fuzz/seeds.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "support/small_model_variants.hpp"

int main(int argument_count, char** arguments) {
  using namespace pinnquad;
  using pinnquad_test::as_text;
  return pinnquad_test::write_seeds(
      argument_count, arguments, {as_text(model_block<test::SmallModel>()), as_text(model_block<test::DoubleModel>())});
}
