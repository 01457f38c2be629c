// SPDX-License-Identifier: MIT
// Certificates that the compiler works out, with -fsanitize=undefined: g++ then takes a pointer into an array that is
// compared with null for no constant. A header with a residual, and a network that is shown the angular acceleration.
#include "models/near_ground_quadrotor.hpp"

namespace {

using namespace pinnquad;

struct Seeing {
  using Scalar = float;
  using Features = PhysicsFeatures;
  using Network =
      PathBoundedPredictor<Features, pinnquad::Network<float, InputSize<Features::size>, Dense<4>, Tanh, Dense<4>>>;
  using Outputs = AxisCommandOutputs;
  using Vehicle = PaperQuadrotor;
  static constexpr Network::Parameters parameters = [] {
    Network::Parameters all{};
    for (std::size_t axis = 0; axis < 3; ++axis) all[axis] = 0.5f;
    return all;
  }();
  static constexpr Scaler<float, Features::size> input{};
  static constexpr Scaler<float, 4> output{};
  static constexpr auto envelope_lower = std::array<float, std::size_t(Features::size)>{};
  static constexpr auto envelope_upper = detail::ones<float, Features::size>;
};
static_assert(require_certificate<Seeing>() && certificate_of<NearGroundQuadModel>().proven());

}  // namespace

int main() {}
