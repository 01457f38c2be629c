// SPDX-License-Identifier: MIT
// libFuzzer target over networks of others: behind a first letter N what networks.py answers, F a features file.
// Whatever the bytes, there is one line that says what is wrong, or a network; and of a network there is a model
// whose block opens.
// Build and run: scripts/heavy/fuzz.
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "convert/converted_model.hpp"
#include "convert/features_file.hpp"
#include "convert/foreign_network.hpp"
#include "fuzz/fuzzing.hpp"
#include "fuzz/line_mutator.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/run_time_model.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad_test::expect;

pinnquad_test::Tally tally;
pinnquad_test::LineMutator features_lines;

/// As many features as the network reads: a few of the motion, columns behind them.
programs::ForeignMeaning meaning_of(std::size_t inputs) {
  const char* names[] = {"wdot_x", "wdot_y", "wdot_z", "s_z"};
  programs::ForeignMeaning meaning;
  meaning.path = "features.toml";
  for (std::size_t i = 0; i < inputs; ++i) {
    programs::ForeignFeature feature{};
    feature.is_column = i >= std::size(names);
    feature.name = feature.is_column ? "column_" + std::to_string(i) : names[i];
    feature.unit = feature.is_column ? "1" : (i < 3 ? "rad/s^2" : "m/s^2");
    feature.unit_factor = 1;
    feature.lower = -20;
    feature.upper = 30;
    feature.scale = 1;
    meaning.features.push_back(feature);
  }
  meaning.outputs = {"u1", "u2", "u3", "u4"};
  meaning.output_mean.assign(4, 0);
  meaning.output_scale.assign(4, 1);
  meaning.schema = pinnquad::detail::description_text<pinnquad::CommandOutputs>();
  meaning.airframe = pinnquad::logs::chosen_airframe("paper_quadrotor");
  return meaning;
}

void use(programs::ForeignNetwork network) {
  ++tally.count["read"];
  constexpr std::size_t most_features = 36;
  if (network.inputs > most_features) return;
  const programs::ForeignMeaning meaning = meaning_of(network.inputs);
  if (network.outputs != meaning.outputs.size()) return;
  const programs::AskedRows rows = programs::asked_rows<double>(meaning);
  network.answers.resize(rows.features.size(), programs::Numbers(network.outputs, 0));
  const auto model = programs::converted_model<double>(network, meaning, rows, "Fuzzed");
  ++tally.count["ok"];
  const std::vector<unsigned char> block = pinnquad::detail::block_beside_header(model);
  expect(!pinnquad::detail::header_text(model).empty(), "a model has a header");
  std::vector<std::uint64_t> aligned((block.size() + 7) / 8);
  std::memcpy(aligned.data(), block.data(), block.size());
  const auto opened = std::make_unique<pinnquad::RunTimeModel<double>>();
  expect(pinnquad::RunTimeModel<double>::open(aligned.data(), block.size(), *opened) == pinnquad::Status::ok,
         "a converted model opens");
}

}  // namespace

/// Features files by lines, all others by bytes.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  if (size < 2 || data[0] != 'F') return LLVMFuzzerMutate(data, size, max_size);
  return 1 + features_lines(data + 1, size - 1, max_size - 1, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    if (data[0] == 'N') {
      use(programs::asked_network([&](const std::string&) { return bytes; }, "{}", "net.onnx"));
    } else {
      static_cast<void>(programs::parse_features(bytes, "features.toml"));
      ++tally.count["features"];
      features_lines.accepted(data + 1, size - 1);
    }
  } catch (const std::exception& error) {
    const std::string what = error.what();
    const bool refusal = dynamic_cast<const pinnquad::InputError*>(&error) != nullptr ||
                         dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
    expect(refusal, "what is wrong is a refusal");
    pinnquad_test::expect_one_line(what);
    ++tally.count["refused"];
  }
  return 0;
}
