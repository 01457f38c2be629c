// SPDX-License-Identifier: MIT
// Every format that was ever exported still flies: archived headers compile, pass their self test and answer as they
// did. So do archived blocks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "models/known_predictions.hpp"
#include "models/v1/demo_quadrotor.hpp"
#include "models/v2/crazyflie_tanh.hpp"
#include "models/v3/near_ground_quadrotor.hpp"
#include "models/v3/own_racer.hpp"
#include "models/v4/own_racer.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace {

using namespace pinnquad;

/// Headers included above and blocks opened below, by path below tests/models.
const std::vector<std::string> archived = {"v1/demo_quadrotor.hpp",        "v2/crazyflie_tanh.hpp",
                                           "v3/near_ground_quadrotor.hpp", "v3/own_racer.hpp",
                                           "v4/own_racer.block",           "v4/own_racer.hpp"};

template <class Model, class Known>
void replay() {
  using Scalar = typename Model::Scalar;
  const InverseDynamics<Model> inverse;
  CHECK(self_test(inverse) == Status::ok);
  REQUIRE(Known::features.size() >= 6);
  for (std::size_t i = 0; i < Known::features.size(); ++i) {
    Scalar x[Model::Features::size];
    REQUIRE(Known::features[i].size() == static_cast<std::size_t>(Model::Features::size));
    for (std::size_t k = 0; k < Known::features[i].size(); ++k) x[k] = static_cast<Scalar>(Known::features[i][k]);
    Commands<Scalar> commands{};
    REQUIRE(inverse.predict_features(x, commands) == Status::ok);
    for (std::size_t k = 0; k < commands.size(); ++k) {
      CHECK(std::abs(static_cast<double>(commands[k]) - Known::commands[i][k]) <= golden_tolerance);
    }
  }
}

}  // namespace

TEST_CASE("format 1: the demonstration's quadrotor") {
  static_assert(DemoQuadrotorV1::format_version == 1);
  replay<DemoQuadrotorV1, test::KnownDemoQuadrotorV1>();
}

TEST_CASE("format 2: another vehicle, feature set, scalar, activation and output") {
  static_assert(CrazyflieTanhV2::format_version == 2);
  replay<CrazyflieTanhV2, test::KnownCrazyflieTanhV2>();
}

TEST_CASE("format 3: a vehicle of the header's own, a window, a column, optional records") {
  static_assert(OwnRacerV3::format_version == 3);
  replay<OwnRacerV3, test::KnownOwnRacerV3>();
  // one that is monotone, and is shown the altitude
  static_assert(NearGroundQuadModel::format_version == 3);
  CHECK(self_test(InverseDynamics<NearGroundQuadModel>{}) == Status::ok);
}

TEST_CASE("format 4: the same racer, and its block, which describes itself") {
  static_assert(OwnRacerV4::format_version == 4);
  using Known = test::KnownOwnRacerV4;
  replay<OwnRacerV4, Known>();
  CHECK(OwnRacerV4::parameters == OwnRacerV3::parameters);
  CHECK(OwnRacerV4::envelope_lower == OwnRacerV3::envelope_lower);
  const BlockModel block(std::string(PINNQUAD_TESTS_DIR) + "/models/v4/own_racer.block");
  CHECK(block.contents_hash() == OwnRacerV4::contents_hash);
  CHECK(block.name() == "OwnRacerV4");
  CHECK(block.is_double());
  CHECK(block.airframe_name() == "own_racer");
  CHECK(block.features().window().taps == 2);
  REQUIRE(block.columns().size() == 1);
  CHECK(block.columns()[0].name == "battery_voltage");
  for (std::size_t i = 0; i < Known::features.size(); ++i) {
    const auto commands = block.commands({Known::features[i].begin(), Known::features[i].end()});
    for (std::size_t k = 0; k < commands.size(); ++k) {
      CHECK(std::abs(commands[k] - Known::commands[i][k]) <= golden_tolerance);
    }
  }
  ModelView<OwnRacerV4> view;
  REQUIRE(ModelView<OwnRacerV4>::open(block.data(), block.size(), view) == Status::ok);
  CHECK(self_test(InverseDynamics<ModelView<OwnRacerV4>>(view)) == Status::ok);
}

TEST_CASE("no header or block of the archive is left out, and each format has one") {
  const std::filesystem::path folder = std::filesystem::path(PINNQUAD_TESTS_DIR) / "models";
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().lexically_relative(folder).generic_string();
    if (entry.is_regular_file() && path.find('/') != std::string::npos) found.push_back(path);
  }
  std::sort(found.begin(), found.end());
  CHECK(found == archived);
  for (int format = oldest_model_format_version; format <= model_format_version; ++format) {
    CHECK(std::filesystem::is_directory(folder / ("v" + std::to_string(format))));
  }
}
