// SPDX-License-Identifier: MIT
// Header and block of today's format, as files: the format did not change by accident, and they answer as a program
// without the library says.
#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "models/known_predictions.hpp"
#include "models/near_ground_quadrotor.hpp"
#include "models/own_racer.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "support/block_bytes.hpp"

namespace {

using namespace pinnquad;
using Known = test::KnownOwnRacer;
constexpr std::size_t vectors = Known::features.size();

/// Within golden_tolerance of known commands.
bool answers(std::size_t i, const Commands<double>& commands) {
  double largest = 0;
  for (std::size_t k = 0; k < commands.size(); ++k) {
    largest = std::fmax(largest, std::abs(commands[k] - Known::commands[i][k]));
  }
  return largest <= golden_tolerance;
}

BlockModel golden_block() { return BlockModel(std::string(PINNQUAD_TESTS_DIR) + "/models/own_racer.block"); }

}  // namespace

TEST_CASE("the header: a vehicle of its own, a window, a column, double, optional records") {
  static_assert(OwnRacer::format_version == header_format_version);
  const InverseDynamics<OwnRacer> inverse;
  CHECK(self_test(inverse) == Status::ok);
  static_assert(vectors >= 6);
  for (std::size_t i = 0; i < vectors; ++i) {
    Commands<double> commands{};
    REQUIRE(inverse.predict_features(Known::features[i].data(), commands) == Status::ok);
    CHECK(answers(i, commands));
  }
  CHECK(self_test(InverseDynamics<NearGroundQuadModel>{}) == Status::ok);  // monotone, and is shown the altitude
}

TEST_CASE("the block describes itself") {
  const BlockModel block = golden_block();
  CHECK(block.contents_hash() == OwnRacer::contents_hash);
  CHECK(block.name() == "OwnRacer");
  CHECK(block.is_double());
  CHECK(block.airframe_name() == "own_racer");
  CHECK(block.features().window().taps == 2);
  REQUIRE(block.columns().size() == 1);
  CHECK(block.columns()[0].name == "battery_voltage");
  for (std::size_t i = 0; i < vectors; ++i) {
    CHECK(answers(i, block.commands({Known::features[i].begin(), Known::features[i].end()})));
  }
  ModelView<OwnRacer> view;
  REQUIRE(ModelView<OwnRacer>::open(block.data(), block.size(), view) == Status::ok);
  CHECK(self_test(InverseDynamics<ModelView<OwnRacer>>(view)) == Status::ok);
}

TEST_CASE("the block of the header is the golden one, but for the library's version") {
  const BlockModel block = golden_block();
  const std::vector<unsigned char> golden(block.data(), block.data() + block.size());
  const auto bare = [](const std::vector<unsigned char>& bytes) {
    auto records = test::records_of(bytes);
    test::find(records, detail::BlockRecord::provenance).bytes.clear();
    const test::BlockBytes without = test::with_records(bytes, records);
    return std::vector<unsigned char>(without.data(), without.data() + without.size());
  };
  CHECK(bare(model_block<OwnRacer>()) == bare(golden));
}
