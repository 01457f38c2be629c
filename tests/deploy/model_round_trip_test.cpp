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
#include <vector>

#include "../examples/models/demo_quadrotor.hpp"
#include "models/own_racer.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "support/block_bytes.hpp"
#include "support/trained_of_header.hpp"

namespace {

using namespace pinnquad;
using test::Trained;
using test::trained_model;

std::string text_of(const std::string& path) {
  std::ifstream file(std::string(PINNQUAD_TESTS_DIR) + "/" + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The header's airframe as its trainer was given it.
template <class Header>
struct WithGivenAirframe : Header {
  using Vehicle = GivenAirframe;
};

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
  Provenance from{Header::training_data,
                  Header::training_data_hash,
                  static_cast<std::size_t>(Header::training_rows),
                  Header::seed,
                  Header::epochs,
                  Header::loss,
                  verdict};
  from.command_meaning = Header::command_meaning;
  from.command_lower = Header::command_lower;
  from.command_upper = Header::command_upper;
  from.sample_period_s = Header::sample_period_s;
  from.lag_removed_s = Header::lag_removed_s;
  return from;
}

template <class Header>
std::vector<typename Trained<Header>::FeatureVector> golden() {
  return {Header::golden_features.begin(), Header::golden_features.end()};
}

template <class Header>
std::string written(const Trained<Header>& model) {
  std::ostringstream out;
  write_model(out, Header::name, model, golden<Header>(), provenance<Header>());
  return out.str();
}

/// From `#pragma once` on (the library's version stands before it), without the golden commands: their last bits depend
/// on whether the machine that wrote them multiplies and adds in one rounding. Without the hash over all of it.
std::string comparable(std::string text) {
  const std::size_t begin = text.find("#pragma once");
  REQUIRE(begin != std::string::npos);
  text.erase(0, begin);
  const std::size_t commands = text.find(" golden_commands = {");
  REQUIRE(commands != std::string::npos);
  text.erase(commands, text.find(';', commands) - commands);
  const std::size_t hash = text.find("\n  // over all of this:");
  if (hash != std::string::npos) text.erase(hash, text.find("};", hash) - hash);
  return text;
}

/// The hash that is written against the one that the compiler works out, with the golden commands as they are computed
/// here.
template <class Header, class Written = Header>
bool says_its_hash(const Trained<Written>& model) {
  auto commands = Header::golden_commands;
  const std::uint64_t others = detail::contents_hash_of<Header>() - detail::constant_hash("golden_commands", commands);
  for (std::size_t i = 0; i < commands.size(); ++i) commands[i] = model.predict(Header::golden_features[i]);
  const std::string hash = hexadecimal(others + detail::constant_hash("golden_commands", commands));
  return written<Written>(model).find(" contents_hash = " + hash + ";\n};\n") != std::string::npos;
}

template <class Header>
double largest_golden_difference() {
  double largest = 0;
  const Trained<Header> model = trained_model<Header>();
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
  CHECK(comparable(written<DemoQuadModel>(trained_model<DemoQuadModel>())) ==
        comparable(text_of("../examples/models/demo_quadrotor.hpp")));
  CHECK(largest_golden_difference<DemoQuadModel>() <= golden_tolerance);
}

TEST_CASE("so is one in double, with a window, a column and an airframe that its trainer was given") {
  using Given = WithGivenAirframe<OwnRacer>;
  const GivenAirframe airframe(OwnRacerAirframe::name, OwnRacerAirframe::value<double>());
  CHECK(comparable(written<Given>(trained_model<Given>({airframe}))) == comparable(text_of("models/own_racer.hpp")));
  CHECK(largest_golden_difference<OwnRacer>() <= 1e-12);
}

TEST_CASE("the hash that is written is the one that the compiler works out") {
  CHECK(says_its_hash<DemoQuadModel>(trained_model<DemoQuadModel>()));
  using Given = WithGivenAirframe<OwnRacer>;
  const GivenAirframe airframe(OwnRacerAirframe::name, OwnRacerAirframe::value<double>());
  CHECK(says_its_hash<OwnRacer, Given>(trained_model<Given>({airframe})));
  auto other = OwnRacerAirframe::value<double>();
  other.mass_kg += 1e-15;
  const GivenAirframe heavier(OwnRacerAirframe::name, other);
  CHECK_FALSE(says_its_hash<OwnRacer, Given>(trained_model<Given>({heavier})));
}

namespace {

/// The block with hashes 0: golden commands are computed anew.
std::vector<unsigned char> without_hash(std::vector<unsigned char> block) {
  std::fill_n(block.begin() + detail::ModelBlockHeader::contents_hash, 16, 0);
  return block;
}

}  // namespace

TEST_CASE_TEMPLATE("a header's block is the block of its training", Header, DemoQuadModel, OwnRacer) {
  const auto from_header = without_hash(model_block<Header>());
  const auto from_training =
      without_hash(model_block(trained_model<Header>(), golden<Header>(), provenance<Header>(), Header::name));
  REQUIRE(from_header.size() == from_training.size());
  // up to the golden commands, which are computed anew
  const auto same =
      test::BlockBytes(from_header).scalars() +
      ModelBlockLayout<Header>::golden_commands(Header::golden_features.size()) * sizeof(typename Header::Scalar);
  CHECK(
      std::equal(from_header.begin(), from_header.begin() + static_cast<std::ptrdiff_t>(same), from_training.begin()));
}

TEST_CASE_TEMPLATE("header and block say one hash", Header, DemoQuadModel, OwnRacer) {
  const BlockModel block("model.block", model_block<Header>());
  CHECK(block.contents_hash() == detail::contents_hash_of<Header>());
  CHECK(block.name() == Header::name);
  CHECK(block.provenance("training_data") == Header::training_data);
}

TEST_CASE_TEMPLATE("the block of a training says the hash of the header that is written beside it", Header,
                   DemoQuadModel, OwnRacer) {
  const auto model = trained_model<Header>();
  const BlockModel block("model.block", model_block(model, golden<Header>(), provenance<Header>(), Header::name));
  const std::string said = "contents_hash = " + hexadecimal(block.contents_hash()) + ";";
  CHECK(written<Header>(model).find(said) != std::string::npos);
}
