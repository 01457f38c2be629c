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
#include "command_line/in_words.hpp"
#include "command_line/options.hpp"
#include "convert/convert_network.hpp"
#include "convert/python_answer.hpp"
#include "model/given_model.hpp"
#include "model/model_evidence.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "pinnquad/training/training_data.hpp"

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

template <class Features>
std::string features_text(const RowSet& rows) {
  std::string text;
  const auto columns = pinnquad::detail::feature_statistics<Features>(rows);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto& column = columns[i];
    text += programs::in_words(
        "  { name = \"%s\", unit = \"%s\", lower = %.4g, upper = %.4g },  # mean = %.6g, scale = %.6g\n",
        Features::names[i], Features::units[i], column.lowest - column.margin(), column.highest + column.margin(),
        column.mean, column.scale());
  }
  return text;
}

/// A features file (docs/convert.md) to begin with, for a network that was trained on these flights: the features of
/// `set` ("paper", "physics" or "inverse") with the range that training would take, and as comments mean and scale.
/// Throws std::invalid_argument, one line, for another set and for flights without a row.
std::string begun_features(const Dataset& flights, const std::string& set) {
  const RowSet rows = all_rows(flights.flights());
  if (rows.size() == 0) throw std::invalid_argument("a features file begins with the rows of a flight; there are none");
  std::string features;
  if (set == "paper") {
    features = features_text<PaperFeatures>(rows);
  } else if (set == "physics") {
    features = features_text<PhysicsFeatures>(rows);
  } else if (set == "inverse") {
    features = features_text<InverseFeatures>(rows);
  } else {
    throw std::invalid_argument("--inputs " + set + ": paper, physics or inverse was expected");
  }
  return "# The numbers that the network reads, in its order. One that reads (value - mean) / scale says so in the "
         "braces.\n"
         "feature = [\n" +
         features +
         "]\n"
         "# Of safetensors alone, after each Linear but the last: activations = \"relu\"\n"
         "# Where its outputs were standardised too: [output] with mean and scale, four numbers each\n"
         "[airframe]\n"
         "name = \"paper_quadrotor\"  # or file = \"mine.toml\", beside this file\n";
}

/// Of flights a features file to begin with.
void begin_features(const ConvertOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".toml") {
    throw std::invalid_argument("--out " + options.out + ": of flights a name that ends in .toml was expected");
  }
  programs::FileRoles roles;
  roles.reads("source", options.source);
  roles.writes("--out", options.out);
  const std::string text = begun_features(logs::read_source({options.source}).flights, options.inputs);
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
