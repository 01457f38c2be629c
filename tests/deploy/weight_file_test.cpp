// SPDX-License-Identifier: MIT
// A block written on one machine is the block that another reads: fixed bytes, fixed checksum, exact numbers.
#include "pinnquad/deploy/weight_file.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/initialization.hpp"
#include "support/block_bytes.hpp"
#include "support/small_model_variants.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::SmallModel;

template <class Scalar, class Outputs>
using ModelOf = TrainedModel<Network<Scalar, InputSize<17>, Dense<7>, Relu, Dense<4>>,
                             Context<PaperFeaturesWithAltitude, PaperQuadrotor, Outputs>>;

template <class Model>
Model some_model(std::uint64_t seed) {
  using Scalar = typename Model::Scalar;
  std::mt19937_64 engine(seed);
  Model model;
  model.network = initialised<typename Model::Network>(engine);
  const auto draw = [&](double low, double high) { return static_cast<Scalar>(uniform(engine, low, high)); };
  for (std::size_t i = 0; i < 17; ++i) {
    model.input.mean[i] = draw(-1, 1);
    model.input.standard_deviation[i] = draw(0.5, 1.5);
    model.envelope_lower[i] = draw(-6, -5);
    model.envelope_upper[i] = draw(5, 6);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    model.output.mean[i] = draw(0.4, 0.6);
    model.output.standard_deviation[i] = draw(0.1, 0.2);
  }
  return model;
}

template <class Model>
std::vector<typename Model::FeatureVector> some_golden(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::vector<typename Model::FeatureVector> golden(count);
  for (auto& x : golden) {
    for (auto& v : x) v = static_cast<typename Model::Scalar>(uniform(engine, -5, 5));
  }
  return golden;
}

Provenance some_provenance() {
  Provenance from;
  from.training_data_hash = 0xfedcba9876543210u;
  from.training_rows = 12345;
  return from;
}

std::vector<unsigned char> read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE_TEMPLATE("what a training writes is what a view reads, bit for bit", Model, ModelOf<float, CommandOutputs>,
                   ModelOf<double, CommandOutputs>, ModelOf<float, RotorSpeedOutputs>) {
  using Scalar = typename Model::Scalar;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Model model = some_model<Model>(seed);
    const auto golden = some_golden<Model>(1 + 6 * seed, seed);
    const BlockBytes block(model_block(model, golden, some_provenance()));
    using Layout = ModelBlockLayout<Model>;
    CHECK(block.size() == Layout::length(golden.size()) + block.scalars() - detail::ModelBlockHeader::size);
    CHECK(block.size() <= Layout::length(golden.size()) + Layout::most_record_bytes());
    ModelView<Model> view;
    REQUIRE(ModelView<Model>::open(block.data(), block.size(), view) == Status::ok);
    CHECK(view.input.mean == model.input.mean);
    CHECK(view.input.standard_deviation == model.input.standard_deviation);
    CHECK(view.output.mean == model.output.mean);
    CHECK(view.output.standard_deviation == model.output.standard_deviation);
    CHECK(view.envelope_lower == model.envelope_lower);
    CHECK(view.envelope_upper == model.envelope_upper);
    CHECK(view.training_data_hash == 0xfedcba9876543210u);
    CHECK(view.training_rows == 12345);
    CHECK(std::memcmp(view.parameters(), model.network.parameters.data(), sizeof model.network.parameters) == 0);
    REQUIRE(view.golden_features.size() == golden.size());
    REQUIRE(view.golden_commands.size() == golden.size());
    for (std::size_t i = 0; i < golden.size(); ++i) {
      CHECK(view.golden_features[i] == golden[i]);
      CHECK(view.golden_commands[i] == model.predict(golden[i]));
      Scalar z[17], expected[4], y[4];
      model.input.standardise(golden[i].data(), z);
      model.network.forward(z, expected);
      view.forward(z, y);
      for (int k = 0; k < 4; ++k) CHECK(y[k] == expected[k]);
    }
  }
}

/// The expected values are those of a script with its own CRC-32 and FNV-1a.
TEST_CASE("the bytes of a block are fixed") {
  const std::vector<unsigned char> block = model_block<SmallModel>();
  std::vector<unsigned char> begin(block.begin(), block.begin() + 128);
  std::fill_n(begin.begin() + detail::ModelBlockHeader::own_hash, 8, 0);  // it is over the version of the library too
  const std::vector<unsigned char> expected = {
      'P',  'I',  'N',  'N',  'Q',  'U',  'A',  'D',               // magic
      5,    0,    0,    0,                                         // version
      0xcc, 0x0b, 0,    0,                                         // length: 72 + 1488 + 4 (72 + 6 * 20 + 172) + 4
      4,    0,    0,    0,    16,   0,    0,    0,    4, 0, 0, 0,  // bytes of a scalar, inputs, outputs
      172,  0,    0,    0,    6,    0,    0,    0,                 // parameters, golden vectors
      0x70, 0x17, 0,    0,                                         // 6000 rows
      0x87, 0x3c, 0x5b, 0x04, 0x18, 0xb0, 0xf9, 0xf6,              // shape hash: see tests/exported/model_view.cpp
      0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01,              // training data
      0xfe, 0xbd, 0x1a, 0xee, 0x1b, 0x7f, 0xb5, 0xe1,              // contents_hash of the header
      0,    0,    0,    0,    0,    0,    0,    0,                 // own hash
      9,    0,    0,    0,    0xc8, 5,    0,    0,                 // 9 records of 1480 bytes
      1,    0x80, 0,    0,    16,   0,    0,    0,                 // commands, mandatory
      0,    0,    0,    0,    0,    0,    0,    0,                 // thrust
      0,    0,    0,    0,    0,    0,    0x80, 0x3f,              // 0 to 1
      2,    0x80, 0,    0,    8,    0,    0,    0,                 // clock
      0,    0,    0,    0,    0,    0,    0,    0,                 // not said
      3,    0x80, 0,    0,    8,    0,    0,    0};                // window
  CHECK(block.size() == 3020);
  CHECK(begin == expected);
  CHECK(crc32(block.data(), block.size()) == 0x2144df1cu);  // of anything that ends in its own CRC-32
  // of the records up to the last one, which says the version of the library, and of the scalars
  CHECK(crc32(block.data() + 80, 1312 - 80) == 0x67c9dc88u);
  CHECK(detail::read_u32(block.data() + 1312) == static_cast<std::uint32_t>(detail::BlockRecord::provenance));
  CHECK(crc32(block.data() + 1560, 3020 - 4 - 1560) == 0x2d309b64u);
  // the block's own hash, word by word
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t at = 0; at < 3020 - 4; at += 4) {
    if (at != 64 && at != 68) hash = (hash ^ detail::read_u32(block.data() + at)) * 0x100000001b3u;
  }
  CHECK(detail::read_u64(block.data() + 64) == hash);
}

TEST_CASE("a file holds the block, whole or not at all, and reads back") {
  const pinnquad_test::TemporaryFolder folder;
  const std::vector<unsigned char> block = model_block<SmallModel>();
  write_weight_file(folder.path("model.block"), block);
  CHECK(folder.listing().size() == 1);
  CHECK(read_bytes(folder.path("model.block")) == block);
  CHECK_THROWS_AS(write_weight_file(folder.path("no/such/folder/model.block"), block), OutputError);
}

TEST_CASE("no golden vector, or one outside the envelope, is no block") {
  using Model = ModelOf<float, CommandOutputs>;
  const Model model = some_model<Model>(1);
  CHECK_THROWS_AS(model_block(model, {}, {}), std::invalid_argument);
  auto golden = some_golden<Model>(3, 1);
  CHECK_NOTHROW(model_block(model, golden, {}));
  golden[2][16] = 7;
  CHECK_THROWS_WITH(model_block(model, golden, {}), "export: golden vector 3 lies outside the envelope");
  Provenance from;
  from.training_rows = std::size_t{1} << 32;
  CHECK_THROWS_AS(model_block(model, some_golden<Model>(3, 1), from), std::invalid_argument);
}
