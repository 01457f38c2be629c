// SPDX-License-Identifier: MIT
// Every format that was ever exported still flies: archived headers compile, pass their self test and answer as they
// did.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "models/known_predictions.hpp"
#include "models/v1/demo_quadrotor.hpp"
#include "models/v2/crazyflie_tanh.hpp"
#include "models/v2/demo_quadrotor.hpp"
#include "models/v3/demo_quadrotor.hpp"
#include "models/v3/near_ground_quadrotor.hpp"
#include "models/v3/own_racer.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace {

using namespace pinnquad;

/// Headers included above, by path below tests/models.
const std::vector<std::string> archived = {"v1/demo_quadrotor.hpp",        "v2/crazyflie_tanh.hpp",
                                           "v2/demo_quadrotor.hpp",        "v3/demo_quadrotor.hpp",
                                           "v3/near_ground_quadrotor.hpp", "v3/own_racer.hpp"};

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

TEST_CASE("format 2: the demonstration's quadrotor; another vehicle, feature set, scalar, activation and output") {
  static_assert(DemoQuadrotorV2::format_version == 2 && CrazyflieTanhV2::format_version == 2);
  replay<DemoQuadrotorV2, test::KnownDemoQuadrotorV2>();
  replay<CrazyflieTanhV2, test::KnownCrazyflieTanhV2>();
}

TEST_CASE(
    "format 3: the demonstration's quadrotor; a vehicle of the header's own, a window, a column, optional records") {
  static_assert(DemoQuadrotorV3::format_version == 3 && OwnRacerV3::format_version == 3);
  replay<DemoQuadrotorV3, test::KnownDemoQuadrotorV3>();
  replay<OwnRacerV3, test::KnownOwnRacerV3>();
  CHECK(self_test(InverseDynamics<OwnRacerV3>{}) == Status::ok);
  // one that is monotone, and is shown the altitude
  static_assert(NearGroundQuadModel::format_version == 3);
  CHECK(self_test(InverseDynamics<NearGroundQuadModel>{}) == Status::ok);
}

TEST_CASE("the weights of a header are those it had in the format before") {
  CHECK(DemoQuadrotorV3::parameters == DemoQuadrotorV2::parameters);
  CHECK(DemoQuadrotorV3::golden_features == DemoQuadrotorV2::golden_features);
  CHECK(DemoQuadrotorV2::parameters == DemoQuadrotorV1::parameters);
  CHECK(DemoQuadrotorV2::golden_commands == DemoQuadrotorV1::golden_commands);
  CHECK(DemoQuadrotorV2::training_data_hash == DemoQuadrotorV1::training_data_hash);
}

TEST_CASE("no header of the archive is left out, and each format has one") {
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
