// SPDX-License-Identifier: MIT
// A translation unit of flight code that only predicts, compiled once per instruction set; PREDICT names its function.
#include "prediction.hpp"

namespace {
using namespace instruction_sets;
constexpr Net::Parameters parameters = some_parameters<Net>();
constexpr WideNet::Parameters wide_parameters = some_parameters<WideNet>();
constexpr pinnquad::PackedNetwork<Net> packed{parameters};
constexpr pinnquad::PackedNetwork<WideNet> packed_wide{wide_parameters};
constexpr Net portable{parameters};
}  // namespace

extern "C" void PREDICT(const float* x, float* y) {
  // the calls under test: a model's predict_features(x, y) belongs here
  packed.forward(x, y);
  packed_wide.forward(x, y + 4);
  portable.forward(x, y + 8);
}
