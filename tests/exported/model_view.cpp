// SPDX-License-Identifier: MIT
// A model block is read back to the bit, and a block that is not sound is refused with the view untouched.
#include "pinnquad/exported/model_view.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/nn/tanh.hpp"
#include "support/block_bytes.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::DoubleModel;
using pinnquad::test::SmallModel;

namespace {

/// A shape without any weights: types are enough to read a block.
struct ShapeAlone {
  using Scalar = float;
  using Network = SmallModel::Network;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
};

template <class Array>
bool same_bits(const Array& a, const Array& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

template <class Model, class View>
bool holds(const View& view) {
  bool same = same_bits(view.input.mean, Model::input.mean) &&
              same_bits(view.input.standard_deviation, Model::input.standard_deviation) &&
              same_bits(view.output.mean, Model::output.mean) &&
              same_bits(view.output.standard_deviation, Model::output.standard_deviation) &&
              same_bits(view.envelope_lower, Model::envelope_lower) &&
              same_bits(view.envelope_upper, Model::envelope_upper) &&
              view.golden_features.size() == Model::golden_features.size() &&
              view.golden_commands.size() == Model::golden_commands.size();
  for (std::size_t i = 0; same && i < Model::golden_features.size(); ++i) {
    same = same_bits(view.golden_features[i], Model::golden_features[i]) &&
           same_bits(view.golden_commands[i], Model::golden_commands[i]);
  }
  return same && view.training_data_hash == Model::training_data_hash &&
         view.training_rows == std::uint32_t(Model::training_rows);
}

/// The status, after a look at whether a refused block left the view as it was.
template <class Shape>
Status opened(const void* block, std::size_t length) {
  static const BlockBytes sound(model_block<SmallModel>());
  ModelView<Shape> view;
  if constexpr (std::is_same_v<typename Shape::Scalar, float> && Shape::Network::parameter_count == 172) {
    const Status before = ModelView<Shape>::open(sound.data(), sound.size(), view);
    REQUIRE((before == Status::ok || !std::is_same_v<Shape, SmallModel>));
  }
  const ModelView<Shape> copy = view;
  const Status status = ModelView<Shape>::open(block, length, view);
  if (status != Status::ok) {
    CHECK(same_bits(view.input.mean, copy.input.mean));
    CHECK(same_bits(view.output.standard_deviation, copy.output.standard_deviation));
    CHECK(same_bits(view.envelope_lower, copy.envelope_lower));
    CHECK(view.parameters() == copy.parameters());
    CHECK(view.golden_features.size() == copy.golden_features.size());
    CHECK(view.training_data_hash == copy.training_data_hash);
  }
  return status;
}

Status opened(const BlockBytes& block) { return opened<SmallModel>(block.data(), block.size()); }

/// The sound block after a change, its checksum right again.
template <class Change>
Status changed(const Change& change) {
  BlockBytes block(model_block<SmallModel>());
  change(block);
  block.seal();
  return opened(block);
}

template <class Base>
struct OtherActivation : Base {
  using Network = Mlp<float, InputSize<16>, Hidden<1, 8>, OutputSize<4>, Tanh>;
};
struct OwnLayer : Tanh {
  static constexpr const char* description = "mine/leaky 0.1";
};
struct RenamedFeatures : PaperFeatures {
  static constexpr auto names = [] {
    auto result = PaperFeatures::names;
    result[3] = "wdot_roll";
    return result;
  }();
};
struct FeaturesInDegrees : PaperFeatures {
  static constexpr auto units = [] {
    auto result = PaperFeatures::units;
    result[12] = "deg";
    return result;
  }();
};
struct RenamedVehicle : PaperQuadrotor {
  static constexpr const char* name = "other_quadrotor";
};
/// Rotors 1 and 2 change places; the name stays.
struct RewiredVehicle : PaperQuadrotor {
  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    auto a = PaperQuadrotor::value<Scalar>();
    const auto first = a.rotors[0];
    a.rotors[0] = a.rotors[1];
    a.rotors[1] = first;
    return a;
  }
};
template <class FeaturesType, class OutputsType, class VehicleType>
struct OtherShape : ShapeAlone {
  using Features = FeaturesType;
  using Outputs = OutputsType;
  using Vehicle = VehicleType;
};

}  // namespace

TEST_CASE_TEMPLATE("a block gives back every number of the model, bit for bit", Model, SmallModel, DoubleModel) {
  const BlockBytes block(model_block<Model>());
  ModelView<Model> view;
  REQUIRE(ModelView<Model>::open(block.data(), block.size(), view) == Status::ok);
  CHECK(holds<Model>(view));
  CHECK(std::memcmp(view.parameters(), Model::parameters.data(), sizeof Model::parameters) == 0);
  const auto* begin = reinterpret_cast<const unsigned char*>(view.parameters());
  CHECK(begin >= block.data());  // in place
  CHECK(begin + sizeof Model::parameters + 4 == block.data() + block.size());
}

TEST_CASE_TEMPLATE("forward() of a view is the portable kernel's, of a packed one the vector unit's", Model, SmallModel,
                   DoubleModel) {
  using Scalar = typename Model::Scalar;
  using View = ModelView<Model>;
  BlockBytes block(model_block<Model>());
  View view, packed_view;
  typename View::Packed packed;
  REQUIRE(View::open(block.data(), block.size(), view) == Status::ok);
  REQUIRE(View::open(block.data(), block.size(), packed_view, packed) == Status::ok);
  CHECK(holds<Model>(packed_view));
  CHECK(view.packed() == nullptr);
  CHECK(packed_view.packed() == (has_vector_unit<Scalar> ? &packed : nullptr));
  Scalar z[16], expected[4], y[4];
  for (const auto& x : Model::golden_features) {
    view.input.standardise(x.data(), z);
    view.forward(z, y);
    Model::Network::forward(Model::parameters.data(), z, expected);
    for (int i = 0; i < 4; ++i) CHECK(y[i] == expected[i]);
  }
  // the weights in the block move; those that were packed do not
  const auto first = reinterpret_cast<const unsigned char*>(view.parameters()) - block.data();
  for (std::size_t i = 0; i < sizeof Model::parameters; ++i) block[std::size_t(first) + i] = 0;
  for (const auto& x : Model::golden_features) {
    view.input.standardise(x.data(), z);
    packed_view.forward(z, y);
    Model::Network::forward(Model::parameters.data(), z, expected);
    for (int i = 0; i < 4; ++i) {
      CHECK(std::abs(y[i] - (has_vector_unit<Scalar> ? expected[i] : Scalar(0))) <= Scalar(1e-5));
    }
  }
  const BlockBytes other(model_block<Model>());
  REQUIRE(View::open(other.data(), other.size(), packed_view) == Status::ok);
  CHECK(packed_view.packed() == nullptr);  // opened anew without memory
}

TEST_CASE("types are enough to read a block, and trailing bytes are no concern of it") {
  std::vector<unsigned char> bytes = model_block<SmallModel>();
  bytes.resize(bytes.size() + 100, 0xff);  // the rest of a flash partition
  const BlockBytes block(bytes);
  ModelView<ShapeAlone> view;
  REQUIRE(ModelView<ShapeAlone>::open(block.data(), block.size(), view) == Status::ok);
  CHECK(holds<SmallModel>(view));
}

TEST_CASE("a block that is not aligned is refused, not read") {
  const std::vector<unsigned char> bytes = model_block<SmallModel>();
  for (std::size_t offset = 0; offset <= model_block_alignment; ++offset) {
    std::vector<unsigned char> shifted(offset, 0);
    shifted.insert(shifted.end(), bytes.begin(), bytes.end());
    const BlockBytes memory(shifted);
    const Status expected = offset % model_block_alignment == 0 ? Status::ok : Status::block_truncated;
    CHECK(opened<SmallModel>(memory.data() + offset, bytes.size()) == expected);
  }
}

TEST_CASE("another magic, version or shape is incompatible, whatever the checksum says") {
  using Header = detail::ModelBlockHeader;
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(changed([&](BlockBytes& block) { block[i] ^= 0x20; }) == Status::block_incompatible);
  }
  CHECK(changed([](BlockBytes& block) { block.set_u32(Header::version, 0); }) == Status::block_incompatible);
  CHECK(changed([](BlockBytes& block) { block.set_u32(Header::version, model_format_version + 1); }) ==
        Status::block_incompatible);
  CHECK(changed([](BlockBytes& block) { block.set_u32(Header::scalar_bytes, 8); }) == Status::block_incompatible);
  CHECK(changed([](BlockBytes& block) { block.set_u32(Header::inputs, 15); }) == Status::block_incompatible);
  CHECK(changed([](BlockBytes& block) { block.set_u32(Header::outputs, 5); }) == Status::block_incompatible);
  CHECK(changed([](BlockBytes& block) { block.set_u32(Header::parameters, 171); }) == Status::block_incompatible);
  CHECK(changed([](BlockBytes& block) { block[Header::shape_hash + 7] ^= 1; }) == Status::block_incompatible);

  const BlockBytes block(model_block<SmallModel>());
  const auto incompatible = [&](auto shape) {
    return opened<decltype(shape)>(block.data(), block.size()) == Status::block_incompatible;
  };
  CHECK(opened<ShapeAlone>(block.data(), block.size()) == Status::ok);
  CHECK(incompatible(OtherActivation<ShapeAlone>{}));
  CHECK(incompatible(OtherShape<RenamedFeatures, CommandOutputs, PaperQuadrotor>{}));
  CHECK(incompatible(OtherShape<FeaturesInDegrees, CommandOutputs, PaperQuadrotor>{}));
  CHECK(incompatible(OtherShape<PaperFeatures, RotorSpeedOutputs, PaperQuadrotor>{}));
  CHECK(incompatible(OtherShape<PaperFeatures, CommandOutputs, RenamedVehicle>{}));
  CHECK(incompatible(OtherShape<PaperFeatures, CommandOutputs, RewiredVehicle>{}));
  CHECK(incompatible(DoubleModel{}));
}

TEST_CASE("a count of golden vectors that its length does not have is corrupt, however large") {
  using Header = detail::ModelBlockHeader;
  for (const std::uint32_t golden : {0u, 5u, 7u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
    CHECK(changed([&](BlockBytes& block) { block.set_u32(Header::golden_vectors, golden); }) == Status::block_corrupt);
  }
  // no golden vector, and a count of them whose length is 0 modulo 2^32
  const std::size_t records = BlockBytes(model_block<SmallModel>()).scalars() - Header::size;
  BlockBytes wrapped(model_block<SmallModel>(), ModelBlockLayout<SmallModel>::length(0) + records);
  wrapped.set_u32(Header::length, static_cast<std::uint32_t>(wrapped.size()));
  for (const std::uint32_t golden : {0u, 0x80000000u}) {
    wrapped.set_u32(Header::golden_vectors, golden);
    wrapped.seal();
    CHECK(opened(wrapped) == Status::block_corrupt);
  }
}

TEST_CASE("a view of no block declines") {
  const ModelView<SmallModel> view;
  CHECK(view.parameters() == nullptr);
  CHECK(view.envelope_lower[0] > view.envelope_upper[0]);
  CHECK(view.golden_features.size() == 1);  // so that a self test has something to fail by
  CHECK(view.golden_features[0][0] == 0.0f);
  float y[4] = {};
  view.forward(SmallModel::golden_features[0].data(), y);
  for (const float v : y) CHECK(std::isnan(v));

  ModelView<SmallModel> packed_view;
  ModelView<SmallModel>::Packed packed;
  CHECK(ModelView<SmallModel>::open(nullptr, 10000, packed_view, packed) == Status::block_truncated);
  CHECK(packed_view.parameters() == nullptr);
  CHECK(packed_view.packed() == nullptr);
}

TEST_CASE("the shape's hash is the same from every compiler") {
  CHECK(shape_hash<SmallModel> == 0xf6f9b018045b3c87u);
  CHECK(shape_hash<ShapeAlone> == shape_hash<SmallModel>);
  static_assert(shape_hash<DoubleModel> != shape_hash<SmallModel>);
  // what it is over: a layer of a user's own by the name that it gives itself
  using Own = Network<float, InputSize<16>, Dense<25>, OwnLayer, Dense<4>>;
  CHECK(detail::description_text<Own>() ==
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<25>, mine/leaky 0.1, pinnquad::Dense<4>>");
}
