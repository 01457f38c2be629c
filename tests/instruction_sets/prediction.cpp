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
using instruction_sets::Model;
}  // namespace

extern "C" void PREDICT(const float* x, float* y) {
  packed.forward(x, y);
  packed_wide.forward(x, y + 4);
  portable.forward(x, y + 8);
  constexpr const float* golden = Model::golden_features[0].data();
  const pinnquad::InverseDynamics<Model> inverse;
  if (inverse.predict_features(golden, y + 12) != pinnquad::Status::ok) y[12] = -1.0f;
}
