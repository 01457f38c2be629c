// SPDX-License-Identifier: MIT
// CASE NOT_A_MODEL: pinnquad: this type is not an exported model
// CASE MEMBER_MISSING: pinnquad: this type is not an exported model
// CASE OTHER_FORMAT: pinnquad: the model was exported in another format
// CASE TOO_FEW_PARAMETERS: pinnquad: the exported parameters do not have the network's length
// CASE ENVELOPE_LENGTH: pinnquad: the envelope does not have the length of the feature set
// CASE SCALER_LENGTH: pinnquad: a scaler does not have the length of what it scales
// CASE NO_GOLDEN_VECTORS: pinnquad: the model has no golden vectors
// CASE GOLDEN_LENGTH: pinnquad: a golden vector does not have the length
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
// CASE OUTPUTS_DIFFER: pinnquad: the network's output count differs from the rotor count
#include <array>

#include "../support/small_model.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"

namespace {

using pinnquad::test::SmallModel;

/// The small model with one member changed by the case.
struct Changed : SmallModel {
#if defined(OTHER_FORMAT)
  static constexpr int format_version = SmallModel::format_version + 1;
#elif defined(TOO_FEW_PARAMETERS)
  static constexpr std::array<float, 171> parameters{};
#elif defined(ENVELOPE_LENGTH)
  static constexpr std::array<float, 15> envelope_upper{};
#elif defined(SCALER_LENGTH)
  static constexpr pinnquad::Scaler<float, 3> output{};
#elif defined(NO_GOLDEN_VECTORS)
  static constexpr std::array<std::array<float, 16>, 0> golden_features{};
  static constexpr std::array<std::array<float, 4>, 0> golden_commands{};
#elif defined(GOLDEN_LENGTH)
  static constexpr std::array<std::array<float, 15>, 6> golden_features{};
#elif defined(INPUTS_DIFFER)
  using Network = pinnquad::Network<float, pinnquad::Inputs<15>, pinnquad::Dense<4>>;
#elif defined(OUTPUTS_DIFFER)
  using Network = pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<8>>;
#endif
};

/// A header cut short.
struct Truncated {
  using Scalar = float;
  using Network = SmallModel::Network;
  using Features = SmallModel::Features;
};

struct Nothing {};

#if defined(NOT_A_MODEL)
using Model = Nothing;
#elif defined(MEMBER_MISSING)
using Model = Truncated;
#else
using Model = Changed;
#endif

}  // namespace

int main() {
  const pinnquad::InverseDynamics<Model> inverse;
  pinnquad::Commands<float> commands{};
  const pinnquad::Status status = inverse.predict({}, commands);
  return status == pinnquad::Status::ok ? static_cast<int>(sizeof(Nothing) + sizeof(Truncated) + sizeof(Changed)) : 0;
}
