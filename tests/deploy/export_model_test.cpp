// SPDX-License-Identifier: MIT
// An export appears whole or not at all, and no limits of trust of another model stay beside it.
#include "pinnquad/deploy/export_model.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/nn/dense.hpp"
#include "support/temporary_folder.hpp"
#include "support/training_sets.hpp"

using namespace pinnquad;
namespace fs = std::filesystem;

namespace {

using Setting = Context<PaperFeatures, PaperQuadrotor>;
using Model = TrainedModel<Network<float, InputSize<16>, Dense<4>>, Setting>;

struct Material {
  Dataset flights;
  RowSplit split;
  Model model;
  Provenance from;

  /// A model of half the mean command; limits of trust need 1600 validation rows.
  explicit Material(std::size_t rows) {
    Flight flight = test::random_flight_rows(rows, 8);
    flight.name = "made";
    flights.add(std::move(flight));
    split = split_for_training(flights);
    Model::Network network;
    model = make_trained_model(network, make_context<Setting>(split.train), split.train);
    from = provenance_of(flights, split, 5, 6, "nothing", {0.5, 0.4});
  }
  Material(const Material&) = delete;
  Material& operator=(const Material&) = delete;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("header, block and limits of trust are of one model") {
  const Material made(9000);
  const pinnquad_test::TemporaryFolder folder;
  const fs::path out = fs::path(folder.path()) / "new" / "model";
  const Exported exported = export_model(out.string(), "SomeModel", ground_model(made.model), made.split, made.from);
  CHECK(exported.no_trust_because == "");
  CHECK(!exported.certificate);
  const auto golden = golden_features(made.model, made.split.train);
  std::ostringstream header;
  write_model(header, "SomeModel", made.model, golden, made.from);
  CHECK(text_of(out / "model.hpp") == header.str());
  const auto limits = fit_trust(made.model, made.split.train, made.split.validation);
  const auto block = model_block(made.model, golden, made.from, "SomeModel", &limits);
  CHECK(text_of(out / "model.block") == std::string(block.begin(), block.end()));
  CHECK(exported.block_bytes == block.size());
  const BlockModel opened((out / "model.block").string());
  CHECK(opened.name() == "SomeModel");
  CHECK(header.str().find("contents_hash = " + hexadecimal(opened.contents_hash())) != std::string::npos);
  double stated[5];  // as the core of a flight stack reads them
  opened.with([&](const auto& own) {
    REQUIRE(own.records().trust != nullptr);
    std::memcpy(stated, own.records().trust, sizeof stated);
  });
  CHECK(stated[0] == limits.squared_distance_limit);
  CHECK(stated[1] == limits.command_residual_factor);
  CHECK(stated[2] == limits.command_residual_limit);
  CHECK(stated[3] == limits.command_residual_cleared);
  CHECK(stated[4] == limits.update_period_s);
  const std::string trust = text_of(out / "trust.hpp");
  const std::string hash = hexadecimal(content_hash(made.flights));
  CHECK(trust.find("struct SomeModelTrust") != std::string::npos);
  CHECK(trust.find(hash) != std::string::npos);
  CHECK(header.str().find(hash) != std::string::npos);
  CHECK(header.str().find("training_data = \"made\"") != std::string::npos);
}

TEST_CASE("a block says the R^2 of its model and that of linear regression, each under its name") {
  Material made(300);
  made.from.verdict = Verdict{0.75, 0.5, 0.25};
  const pinnquad_test::TemporaryFolder folder;
  export_model(folder.path(), "SomeModel", made.model, made.split, made.from);
  const BlockModel opened((fs::path(folder.path()) / "model.block").string());
  CHECK(std::stod(opened.provenance("test_r_squared")) == 0.75);
  CHECK(std::stod(opened.provenance("linear_regression_r_squared")) == 0.5);
}

TEST_CASE("validation rows that are too few: why there are no limits, and those of another model are gone") {
  const Material made(300);
  const pinnquad_test::TemporaryFolder folder;
  std::ofstream(fs::path(folder.path()) / "trust.hpp") << "of another model";
  const Exported exported = export_model(folder.path(), "SomeModel", made.model, made.split, made.from);
  CHECK(exported.no_trust_because.find("80 s") != std::string::npos);
  CHECK(!fs::exists(fs::path(folder.path()) / "trust.hpp"));
  CHECK(fs::exists(fs::path(folder.path()) / "model.hpp"));
}

TEST_CASE("a block or limits that can't be written leave the header as it was, and nothing half done") {
  const Material made(9000);
  for (const char* blocked : {"model.block", "trust.hpp"}) {
    const pinnquad_test::TemporaryFolder folder;
    std::ofstream(fs::path(folder.path()) / "model.hpp") << "before";
    fs::create_directory(fs::path(folder.path()) / blocked);
    CHECK_THROWS_AS(export_model(folder.path(), "SomeModel", made.model, made.split, made.from), OutputError);
    CHECK(text_of(fs::path(folder.path()) / "model.hpp") == "before");
    CHECK(std::distance(fs::directory_iterator(fs::path(folder.path())), fs::directory_iterator()) == 2);
  }
  const pinnquad_test::TemporaryFolder folder;
  CHECK_THROWS_AS(export_model(folder.path(), "no name", made.model, made.split, made.from), std::invalid_argument);
  CHECK(fs::is_empty(fs::path(folder.path())));
}
