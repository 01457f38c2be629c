// SPDX-License-Identifier: MIT
// Lists what a model block contains: inputs, units, network, training, verdict (docs/blocks.md).
//   pinnquad block my_model/model.block
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "command_line/command.hpp"
#include "command_line/in_columns.hpp"
#include "command_line/in_words.hpp"
#include "command_line/options.hpp"
#include "model/given_model.hpp"
#include "pinnquad/io/decimal.hpp"
#include "training/certificate_words.hpp"

namespace {

using namespace pinnquad;

struct BlockOptions {
  std::string model;
  bool json = false;
};

nlohmann::json named(const detail::NameAndUnit& one) {
  return {{"name", std::string(one.name)}, {"unit", std::string(one.unit)}};
}

/// All but the weights and the golden vectors.
nlohmann::json description_of(const BlockModel& model) {
  const RunTimeFeatures& features = model.features();
  const RunTimeFeatures::Window& window = features.window();
  nlohmann::json all = {{"model", model.path()},
                        {"name", model.name()},
                        {"contents_hash", hexadecimal(model.contents_hash())},
                        {"checksum", hexadecimal(model.checksum())},
                        {"scalar", model.is_double() ? "double" : "float"},
                        {"network", model.answer()},
                        {"parameters", model.network().parameter_count()},
                        {"outputs_are", model.schema()},
                        {"airframe", model.airframe_name()},
                        {"golden_vectors", model.golden_count()},
                        {"golden_difference", model.golden_difference()}};
  if (window.taps > 1) {
    all["window"] = {{"taps", window.taps}, {"period_s", window.period_s}, {"causal", window.causal}};
  }
  model.with([&](const auto& own) {
    const auto& records = own.records();
    for (int i = 0; i < features.size(); ++i) {
      nlohmann::json feature = named(features[i]);
      feature["envelope"] = {own.scales().lower[i], own.scales().upper[i]};
      all["features"].push_back(feature);
    }
    for (int i = 0; i < features.column_count(); ++i) all["columns"].push_back(named(features.column(i)));
    for (int k = 0; k < own.network().outputs(); ++k) all["outputs"].push_back(named(own.output(k)));
    all["commands"] = {{"meaning", to_string(records.command_meaning)},
                       {"lower", records.command_lower},
                       {"upper", records.command_upper}};
    all["sample_period_s"] = 1e-9 * records.sample_period_ns;
    all["lag_removed_s"] = 1e-9 * records.lag_removed_ns;
    all["training_rows"] = own.training_rows();
    all["training_data_hash"] = hexadecimal(own.training_data_hash());
    if (records.has_bias) all["bias_time_constants_s"] = records.bias_time_constants_s;
    all["limits_of_trust"] = records.trust != nullptr;
    if (records.has_verdict) {
      all["worse_than_mean"] = records.worse_than_mean;
      all["beats_linear_regression"] = records.beats_linear_regression;
    }
    std::string_view rest = records.provenance, word, value;
    while (RunTimeFeatures::take_text(rest, word) && RunTimeFeatures::take_text(rest, value)) {
      all["provenance"][std::string(word)] = std::string(value);
    }
  });
  if (const auto certificate = model.certificate()) all["proven"] = certificate->proven();
  return all;
}

std::string line_of(const nlohmann::json& list) {
  std::string line;
  for (const auto& one : list) {
    const std::string unit = one["unit"];
    line += (line.empty() ? "" : ", ") + one["name"].get<std::string>() + (unit == "1" ? "" : " [" + unit + "]");
  }
  return printable(line);
}

void print_text(const nlohmann::json& all) {
  const auto text = [&](const char* key) { return printable(all[key].get<std::string>()); };
  std::printf("model       %s, contents_hash %s\n", text("name").c_str(), text("contents_hash").c_str());
  std::printf("network     %s, %d parameters\n", text("network").c_str(), all["parameters"].get<int>());
  programs::print_entry("features", line_of(all["features"]));
  if (all.contains("window")) {
    const auto& window = all["window"];
    std::printf("window      %d instants, %g ms apart, %s\n", window["taps"].get<int>(),
                1e3 * window["period_s"].get<double>(), window["causal"].get<bool>() ? "looking back" : "centred");
  }
  if (all.contains("columns")) programs::print_entry("columns", line_of(all["columns"]));
  std::printf("outputs     %s: %s\n", text("outputs_are").c_str(), line_of(all["outputs"]).c_str());
  std::printf("airframe    %s\n", text("airframe").c_str());
  std::printf("commands    %s, %g to %g\n", all["commands"]["meaning"].get<std::string>().c_str(),
              all["commands"]["lower"].get<double>(), all["commands"]["upper"].get<double>());
  if (all.contains("proven")) std::printf("structure   %s\n", all["proven"].get<bool>() ? "proven" : "not proven");
  std::printf("trust       %s\n", all["limits_of_trust"].get<bool>() ? "limits are there" : "no limits");
  if (all.contains("bias_time_constants_s")) {
    programs::print_entry(
        "bias", "learnt in flight, time constants " +
                    programs::time_constants_in_words(all["bias_time_constants_s"].get<std::vector<double>>()));
  }
  if (all.contains("provenance")) {
    for (const auto& [word, value] : all["provenance"].items()) {
      programs::print_entry(printable(word), printable(value.get<std::string>()));
    }
  }
  std::printf("rows        %u, data %s\n", all["training_rows"].get<unsigned>(), text("training_data_hash").c_str());
  std::printf("self test   %d golden vectors, largest difference %.1e\n", all["golden_vectors"].get<int>(),
              all["golden_difference"].get<double>());
}

int describe(const BlockOptions& options) {
  const nlohmann::json all = description_of(programs::read_model(options.model));
  if (options.json) {
    std::printf("%s\n", all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    print_text(all);
  }
  return 0;
}

}  // namespace

namespace programs {

Command block_command(CLI::App& program) {
  CLI::App* line =
      program.add_subcommand("block", "Lists what a model block contains: inputs, units, network, training, verdict");
  const auto options = std::make_shared<BlockOptions>();
  add_model(*line, options->model);
  line->add_flag("--json", options->json, "all of it as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad train d1.csv --out my_model\n"
      "  pinnquad block my_model/model.block\n"
      "Exit codes: 0; 2 bad input or a file that can't be read; 130 interrupted.");
  return {line, [options] { return describe(*options); }};
}

}  // namespace programs
