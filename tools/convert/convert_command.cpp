// SPDX-License-Identifier: MIT
// Weights in and out: a network of ONNX or safetensors becomes a model as any other, with golden vectors of its source;
// a model becomes a network of ONNX or safetensors.
//   pinnquad convert net.onnx --features features.toml --out my_model
//   pinnquad convert my_model/model.block --out net.onnx
//   pinnquad convert flight.csv --out features.toml
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/in_columns.hpp"
#include "command_line/options.hpp"
#include "convert/begun_features.hpp"
#include "convert/convert_network.hpp"
#include "convert/python_answer.hpp"
#include "model/given_model.hpp"
#include "model/model_evidence.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace {

using namespace pinnquad;

struct ConvertOptions : programs::Conversion {
  std::string inputs = "paper";
};

/// Of a network a model.
void convert_network(const ConvertOptions& options) {
  if (options.features.empty()) {
    throw std::invalid_argument(
        "--features is required: no file of weights says what its numbers mean; begin the file: pinnquad convert "
        "flight.csv --out features.toml");
  }
  programs::FileRoles roles;
  roles.reads("source", options.source);
  roles.reads("--features", options.features);
  roles.writes("--out", options.out + "/model.hpp");
  roles.writes("--out", options.out + "/model.block");
  const std::string files = programs::convert_network(options, programs::run_python);
  programs::print_verdict(programs::model_verdict(programs::evidence_of(BlockModel(options.out + "/model.block"))));
  std::fputs(files.c_str(), stdout);
}

/// Of a model a network.
void convert_model(const ConvertOptions& options) {
  const std::string ending = std::filesystem::path(options.out).extension().string();
  if (ending != ".onnx" && ending != ".safetensors") {
    throw std::invalid_argument("--out " + options.out +
                                ": of a model a name that ends in .onnx or .safetensors was "
                                "expected");
  }
  if (!options.features.empty()) throw std::invalid_argument("--features is of a network; a model says its own");
  programs::FileRoles roles;
  roles.reads("source", options.source);
  roles.writes("--out", options.out);
  const BlockModel model = programs::read_model(options.source);
  const std::string bytes = programs::network_of(model, ending, programs::run_python);
  AtomicFile file(options.out);
  file.stream() << bytes;
  file.commit();
  std::printf("%s: %zu bytes, from %d features in physical units to the commands\n", printable(options.out).c_str(),
              bytes.size(), model.features().size());
}

/// Of flights a features file to begin with.
void begin_features(const ConvertOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".toml") {
    throw std::invalid_argument("--out " + options.out + ": of flights a name that ends in .toml was expected");
  }
  programs::FileRoles roles;
  roles.reads("source", options.source);
  roles.writes("--out", options.out);
  const std::string text = programs::begun_features(logs::read_source({options.source}).flights, options.inputs);
  AtomicFile file(options.out);
  file.stream() << text;
  file.commit();
  programs::print_entry("next", "look at ranges and units in " + printable(options.out) +
                                    ", add mean and scale if the network was standardised, name the airframe; then: "
                                    "pinnquad convert NETWORK --features " +
                                    printable(options.out) + " --out my_model");
}

int convert(const ConvertOptions& options) {
  const std::string ending = std::filesystem::path(options.source).extension().string();
  const bool begins = options.features.empty() && std::filesystem::path(options.out).extension() == ".toml";
  if (begins || ending == ".csv" || std::filesystem::is_directory(options.source)) {
    begin_features(options);
    return 0;
  }
  const bool is_model = ending == ".block" || ending == ".hpp";
  is_model ? convert_model(options) : convert_network(options);
  return 0;
}

}  // namespace

namespace programs {

Command convert_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "convert",
      "Converts a PyTorch, ONNX, flax or scikit-learn network to a model, or a model to ONNX or safetensors");
  const auto options = std::make_shared<ConvertOptions>();
  add_path(*line, "source", options->source, "FILE",
           "a network (.onnx, .safetensors), a model (.block, .hpp), or flights (.csv, a dataset)")
      ->required();
  add_path(*line, "--features", options->features, "FILE.toml",
           "names, units and ranges of the network's inputs and outputs (docs/convert.md)");
  add_path(*line, "--out", options->out, "DIR|FILE",
           "of a network the folder for model.hpp and model.block; of a model the network to write (.onnx, "
           ".safetensors); of flights the features file")
      ->required();
  line->add_option("--name", options->name, "name of the exported struct")->type_name("NAME")->capture_default_str();
  line->add_option("--inputs", options->inputs,
                   "of flights: paper, physics or inverse, the features that the file begins with")
      ->type_name("SET")
      ->capture_default_str();
  line->add_option("--prefix", options->prefix, "read only tensors whose names begin with this, such as actor.")
      ->type_name("TEXT");
  line->add_option("--output", options->output, "the output that makes the commands, of a network with several")
      ->type_name("NAME");
  line->add_flag("--double", options->in_double, "a model in double instead of float");
  line->footer(
      "Examples:\n"
      "  pinnquad convert flight.csv --out features.toml   to begin with: ranges of the flights\n"
      "  pinnquad convert net.onnx --features features.toml --out my_model\n"
      "  pinnquad convert my_model/model.block --out net.onnx\n"
      "Exit codes: 0; 2 bad input or a file that can't be read or written; 130 interrupted.");
  return {line, [options] { return convert(*options); }};
}

}  // namespace programs
