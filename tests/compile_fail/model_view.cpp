// SPDX-License-Identifier: MIT
// CASE NO_SHAPE: pinnquad: this type names no Scalar, Network, Features, Outputs and Vehicle
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
// CASE LONG_DOUBLE: pinnquad: a model block is read in place: float or double of IEEE 754, on a little-endian machine
#include "pinnquad/exported/model_view.hpp"
#include "../support/small_model.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace {

using namespace pinnquad;

struct Sound {
  using Scalar = float;
  using Network = test::SmallModel::Network;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
};

#if defined(NO_SHAPE)
struct Shape {
  using Scalar = float;
  using Network = Sound::Network;
};
#elif defined(INPUTS_DIFFER)
struct Shape : Sound {
  using Features = PaperFeaturesWithAltitude;
};
#elif defined(LONG_DOUBLE)
struct Shape : Sound {
  using Scalar = long double;
  using Network = Sound::Network::Rebind<long double>;
};
#else
using Shape = Sound;
#endif

}  // namespace

int main() {
  alignas(8) static const unsigned char block[4096] = {};
  ModelView<Shape> view;
  ModelView<Shape>::Packed packed;
  if (ModelView<Shape>::open(block, sizeof block, view, packed) != Status::ok) return 1;
  return self_test(InverseDynamics<ModelView<Shape>>(view)) == Status::ok ? 0 : 1;
}
