// SPDX-License-Identifier: MIT
// A network of another size for docs/footprint.md: HIDDEN_LAYERS x HIDDEN_WIDTH between 16 inputs and 4 outputs, with
// what stands behind each hidden layer (BEHIND) and weights in flash that no compiler can fold away. Instructions don't
// depend on their values.
#include <cstdint>

#include "pinnquad/nn/layer_norm.hpp"
#include "pinnquad/nn/network.hpp"
#include "pinnquad/nn/relu.hpp"
#include "under_test.hpp"

namespace {

using namespace pinnquad;

using Net = detail::Mlp<float, InputSize<16>, Hidden<HIDDEN_LAYERS, HIDDEN_WIDTH>, OutputSize<4>, Dense, BEHIND>::type;

constexpr Net::Parameters numbers() {
  Net::Parameters result{};
  std::uint32_t state = 1;
  for (float& v : result) {
    state = state * 1664525u + 1013904223u;
    v = (static_cast<float>(state >> 8) / 16777216.0F - 0.5F) * 0.8F;
  }
  return result;
}

struct Model {
  static constexpr Net::Parameters parameters = numbers();
};
static_assert(sizeof(Model::parameters) == sizeof(float) * Net::parameter_count);

}  // namespace

void pinnquad_forward(const float* x, float* y) { Net::forward(Model::parameters.data(), x, y); }

unsigned pinnquad_workspace_bytes() { return Net::workspace_bytes; }
