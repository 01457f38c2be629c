// SPDX-License-Identifier: MIT
// Blocks of an exported model, sound and broken ones, as a flight's fault script offers them.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "../support/block_bytes.hpp"
#include "../support/trained_of_header.hpp"

namespace pinnquad::autopilot::test {

/// Aligned as a block must be: vectors of bytes come from the heap, which aligns by 16.
using Block = std::vector<unsigned char>;

using pinnquad::test::Trained;
using pinnquad::test::trained_model;

/// Limits of trust that go with a model, or void (trusting_stacks.hpp).
template <class Model>
struct TrustOf {
  using type = void;
};

/// The exported model.
template <class Model>
Block sound_block() {
  return pinnquad::model_block<Model, typename TrustOf<Model>::type>();
}

/// The model after a training that went on: its weights moved by a thousandth each.
template <class Model>
Block other_block() {
  Trained<Model> model = trained_model<Model>();
  for (float& weight : model.network.parameters) weight *= 1.001f;
  return pinnquad::model_block(model, {Model::golden_features.begin(), Model::golden_features.end()}, {});
}

/// One bit of one weight is another, with golden vectors to match: a sound model, not the exported one.
template <class Model>
Block bit_block() {
  Trained<Model> model = trained_model<Model>();
  std::uint32_t bits = 0;
  float& weight = model.network.parameters[0];
  std::memcpy(&bits, &weight, sizeof bits);
  bits ^= std::uint32_t{1} << 18;  // a weight that is a few percent off
  std::memcpy(&weight, &bits, sizeof bits);
  return pinnquad::model_block(model, {Model::golden_features.begin(), Model::golden_features.end()}, {});
}

/// Its envelope holds one golden vector and nothing else: passes the self test, declines every flight.
template <class Model>
Block narrow_block() {
  Trained<Model> model = trained_model<Model>();
  const auto& golden = Model::golden_features[0];
  for (std::size_t i = 0; i < golden.size(); ++i) {
    model.envelope_lower[i] = golden[i] - 1e-3f;
    model.envelope_upper[i] = golden[i] + 1e-3f;
  }
  return pinnquad::model_block(model, {golden}, {});
}

/// A sound model whose commands are 0.09 too low, each: in hover it needs 45 % of the greatest bias.
template <class Model>
Block low_block() {
  Trained<Model> model = trained_model<Model>();
  for (float& mean : model.output.mean) mean -= 0.18f;
  return pinnquad::model_block(model, {Model::golden_features.begin(), Model::golden_features.end()}, {});
}

template <class Model>
Block corrupt_block() {
  Block block = sound_block<Model>();
  block[block.size() / 2] ^= 0x10;
  return block;
}

/// With a contents hash and a checksum that are right.
inline Block sealed(const Block& block) {
  pinnquad::test::BlockBytes bytes(block);
  bytes.seal();
  return {bytes.data(), bytes.data() + bytes.size()};
}

/// A weight that is wrong under a hash and a checksum that are right.
template <class Model>
Block wrong_block() {
  Block block = sound_block<Model>();
  block[block.size() - 6] ^= 0x40;  // in the exponent of the last bias
  return sealed(block);
}

}  // namespace pinnquad::autopilot::test
