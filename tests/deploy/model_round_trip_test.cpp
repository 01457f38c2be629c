// SPDX-License-Identifier: MIT
// An exported header, taken back to a trained model and written again, is the same file: text, numbers, order.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>

#include "../examples/models/demo_quadrotor.hpp"
#include "models/v2/crazyflie_tanh.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "support/block_bytes.hpp"

namespace {

using namespace pinnquad;

std::string text_of(const std::string& path) {
  std::ifstream file(std::string(PINNQUAD_TESTS_DIR) + "/" + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <class Header>
using Trained = TrainedModel<typename Header::Network,
                             Context<typename Header::Features, typename Header::Vehicle, typename Header::Outputs>>;

template <class Header>
Trained<Header> trained() {
  Trained<Header> model;
  model.network.parameters = Header::parameters;
  model.input = Header::input;
  model.output = Header::output;
  model.envelope_lower = Header::envelope_lower;
  model.envelope_upper = Header::envelope_upper;
  return model;
}

template <class Header, class = void>
struct HasVerdict : std::false_type {};
template <class Header>
struct HasVerdict<Header, std::void_t<decltype(Header::test_r_squared)>> : std::true_type {};

template <class Header>
Provenance provenance() {
  std::optional<Verdict> verdict;
  if constexpr (HasVerdict<Header>::value) {
    const double worst_motor = Header::worse_than_mean ? -1.0 : 0.0;  // what the header says of it
    verdict = Verdict{Header::test_r_squared, Header::linear_regression_r_squared, worst_motor};
  }
  return {Header::training_data,
          Header::training_data_hash,
          static_cast<std::size_t>(Header::training_rows),
          Header::seed,
          Header::epochs,
          Header::loss,
          verdict};
}

template <class Header>
std::vector<typename Trained<Header>::FeatureVector> golden() {
  return {Header::golden_features.begin(), Header::golden_features.end()};
}

template <class Header>
std::string written() {
  std::ostringstream out;
  write_model(out, Header::name, trained<Header>(), golden<Header>(), provenance<Header>());
  return out.str();
}

/// From `#pragma once` on (the library's version stands before it), without the golden commands: their last bits depend
/// on whether the machine that wrote them multiplies and adds in one rounding.
std::string comparable(std::string text) {
  const std::size_t begin = text.find("#pragma once");
  REQUIRE(begin != std::string::npos);
  text.erase(0, begin);
  const std::size_t commands = text.find(" golden_commands = {");
  REQUIRE(commands != std::string::npos);
  text.erase(commands, text.find(';', commands) - commands);
  return text;
}

template <class Header>
double largest_golden_difference() {
  double largest = 0;
  const Trained<Header> model = trained<Header>();
  for (std::size_t i = 0; i < Header::golden_features.size(); ++i) {
    const auto commands = model.predict(Header::golden_features[i]);
    for (std::size_t k = 0; k < commands.size(); ++k) {
      largest = std::max(largest, static_cast<double>(std::abs(commands[k] - Header::golden_commands[i][k])));
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("the demonstration's header is what the writer writes") {
  CHECK(comparable(written<DemoQuadModel>()) == comparable(text_of("../examples/models/demo_quadrotor.hpp")));
  CHECK(largest_golden_difference<DemoQuadModel>() <= golden_tolerance);
}

TEST_CASE("so is one in double, with another feature set, output and vehicle") {
  std::string archived = text_of("models/v2/crazyflie_tanh.hpp");
  CHECK(comparable(written<CrazyflieTanhV2>()) == comparable(archived));
  CHECK(largest_golden_difference<CrazyflieTanhV2>() <= 1e-12);
}

TEST_CASE("a header's block is the block of its training") {
  const auto from_header = model_block<CrazyflieTanhV2>();
  const auto from_training =
      model_block(trained<CrazyflieTanhV2>(), golden<CrazyflieTanhV2>(), provenance<CrazyflieTanhV2>());
  REQUIRE(from_header.size() == from_training.size());
  // up to the golden commands, which are computed anew
  const auto same = test::BlockBytes(from_header).scalars() +
                    ModelBlockLayout<CrazyflieTanhV2>::golden_commands(4) * sizeof(double);
  CHECK(
      std::equal(from_header.begin(), from_header.begin() + static_cast<std::ptrdiff_t>(same), from_training.begin()));
}
