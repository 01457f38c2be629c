// SPDX-License-Identifier: MIT
#include "pinnquad/exported/model_view.hpp"
#include "../support/small_model.hpp"
#include "pinnquad/inference/self_test.hpp"

using namespace pinnquad;

struct Sound {
  using Scalar = float;
  using Network = test::SmallModel::Network;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
};

template <class Shape>
Status opened() {
  alignas(8) static const unsigned char block[4096] = {};
  ModelView<Shape> view;
  typename ModelView<Shape>::Packed packed;
  const Status status = ModelView<Shape>::open(block, sizeof block, view, packed);
  return status == Status::ok ? self_test(InverseDynamics<ModelView<Shape>>(view)) : status;
}

// SOUND
const auto status = opened<Sound>();

// CASE NO_SHAPE: pinnquad: this type names no Scalar, Network, Features, Outputs and Vehicle
struct Shape {
  using Scalar = float;
  using Network = Sound::Network;
};
const auto status = opened<Shape>();
// CASE INPUTS_DIFFER: pinnquad: the network's input count differs from the feature set's size
struct Shape : Sound {
  using Features = PaperFeaturesWithAltitude;
};
const auto status = opened<Shape>();
// CASE LONG_DOUBLE: pinnquad: a model block is read in place: float or double of IEEE 754, on a little-endian machine
struct Shape : Sound {
  using Scalar = long double;
  using Network = Sound::Network::Rebind<long double>;
};
const auto status = opened<Shape>();
