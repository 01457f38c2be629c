// SPDX-License-Identifier: MIT
// Weights in and out: a network of ONNX or safetensors becomes a model as any other, with golden vectors of its source;
// a model becomes a network of ONNX or safetensors.
//   pinnquad convert net.onnx --features features.toml --out my_model
//   pinnquad convert my_model/model.block --out net.onnx
//   pinnquad convert flight.csv --out features.toml
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/folder_lock.hpp"
#include "command_line/options.hpp"
#include "convert/begun_features.hpp"
#include "convert/converted_model.hpp"
#include "convert/exported_network.hpp"
#include "convert/features_file.hpp"
#include "convert/file_beside.hpp"
#include "convert/onnx_file.hpp"
#include "convert/safetensors.hpp"
#include "model/given_model.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace {

using namespace pinnquad;

struct ConvertOptions {
  std::string source, features, out;
  std::string name = "TrainedQuadModel", inputs = "paper";
  bool in_double = false;
};

programs::ForeignNetwork read_network(const ConvertOptions& options, const programs::ForeignMeaning& meaning) {
  const std::string bytes = programs::network_bytes(options.source);
  const auto beside = [&](const std::string& location, const std::string& tensor) {
    return programs::bytes_beside(options.source, location, tensor);
  };
  const bool is_onnx = std::filesystem::path(options.source).extension() == ".onnx";
  programs::ForeignNetwork network =
      is_onnx
          ? programs::read_onnx(bytes, options.source, beside)
          : programs::safetensors_network(programs::read_safetensors(bytes, options.source), options.source, meaning);
  network.source = printable(std::filesystem::path(options.source).filename().string());
  return network;
}

/// Largest difference of a model's commands from its source's, over motions inside its envelope; of a command beyond 1,
/// which no motor follows, the share.
double largest_difference(const BlockModel& model, const programs::ForeignNetwork& network,
                          const programs::ForeignMeaning& meaning) {
  constexpr std::size_t motions = 1000;
  double largest = 0;
  const programs::Source source(network, meaning);
  for (const programs::Numbers& x : programs::vectors_inside(meaning, motions, 2)) {
    programs::Numbers shown = x;
    if (!model.is_double()) {
      std::transform(x.begin(), x.end(), shown.begin(), [](double v) { return double(static_cast<float>(v)); });
    }
    const Commands<double> own = model.commands(shown), said = source.commands(shown);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double difference = std::abs(own[i] - said[i]) / std::max(1.0, std::abs(said[i]));
      if (!(difference <= largest)) largest = difference;  // NaN stays
    }
  }
  return largest;
}

[[noreturn]] void refuse_difference(const ConvertOptions& options, double difference) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", difference);
  throw InputError(options.source, 0, 0, "a network that the model's arithmetic answers within 1e-6 of a command",
                   std::string("a difference of ") + text + (options.in_double ? "" : " (--double has more digits)"));
}

/// Of a block whose weights may not give its golden commands: BlockModel refuses such a one.
template <class Scalar>
double golden_difference(const std::vector<unsigned char>& block) {
  std::vector<std::uint64_t> aligned((block.size() + 7) / 8);
  std::memcpy(aligned.data(), block.data(), block.size());
  const auto model = std::make_unique<RunTimeModel<Scalar>>();
  BlockFault fault;
  if (RunTimeModel<Scalar>::open(aligned.data(), block.size(), *model, fault) != Status::ok) return 0;  // it says why
  std::vector<Scalar> work(model->workspace());
  return static_cast<double>(model->golden_difference(work.data()));
}

template <class Scalar>
void write_model(const ConvertOptions& options, const programs::ForeignNetwork& network,
                 const programs::ForeignMeaning& meaning) {
  pinnquad::detail::WrittenModel<Scalar> written = programs::converted_model<Scalar>(network, meaning, options.name);
  const std::string block_path = options.out + "/model.block", header_path = options.out + "/model.hpp";
  const std::vector<unsigned char> block = pinnquad::detail::block_beside_header(written);
  double difference = golden_difference<Scalar>(block);
  if (!(difference <= golden_tolerance)) refuse_difference(options, difference);
  const BlockModel model(block_path, block);
  difference = std::max(difference, largest_difference(model, network, meaning));
  if (!(difference <= programs::converted_tolerance)) refuse_difference(options, difference);
  if (!model.angular_accelerations().empty()) {
    if (const auto proven = model.proven_signs()) {
      written.proven_slopes = {proven->held_slope[0], proven->held_slope[1], proven->held_slope[2]};
    } else {
      written.signs_unproven = true;
    }
  }
  const programs::FolderLock folder(options.out);
  AtomicFile header_file(header_path), block_file(block_path);
  header_file.stream() << pinnquad::detail::header_text(written);
  pinnquad::detail::write_block(block_file.stream(), block);
  header_file.close();
  block_file.close();
  header_file.commit();
  block_file.commit();
  std::printf("%s: struct %s, %s, %d parameters\n", printable(header_path).c_str(), options.name.c_str(),
              model.answer().c_str(), model.network().parameter_count());
  std::printf(
      "%s: %zu bytes; at most %.1e from the source's commands, over %d golden vectors and 1000 motions inside "
      "the envelope\n",
      printable(block_path).c_str(), block.size(), difference, model.golden_count());
  if (written.signs_unproven) {
    std::printf("not proven to follow the angular acceleration that is asked: pinnquad certify %s\n",
                printable(block_path).c_str());
  }
}

/// Of a network a model.
void convert_network(const ConvertOptions& options) {
  require_identifier("--name", options.name);
  if (options.features.empty()) {
    throw std::invalid_argument("--features is required: no file of weights says what its numbers mean");
  }
  programs::FileRoles roles;
  roles.reads("source", options.source);
  roles.reads("--features", options.features);
  roles.writes("--out", options.out + "/model.hpp");
  roles.writes("--out", options.out + "/model.block");
  const programs::ForeignMeaning meaning = programs::read_features_file(options.features);
  const programs::ForeignNetwork network = read_network(options, meaning);
  options.in_double ? write_model<double>(options, network, meaning) : write_model<float>(options, network, meaning);
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
  const programs::ExportedNetwork network = programs::exported_network(programs::read_model(options.source));
  const std::string bytes = ending == ".onnx" ? programs::onnx_bytes(network, options.out)
                                              : programs::safetensors_of(network, options.source);
  AtomicFile file(options.out);
  file.stream() << bytes;
  file.commit();
  std::printf("%s: %zu bytes, from %zu features in physical units to the commands\n", printable(options.out).c_str(),
              bytes.size(), network.inputs);
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
  std::printf(
      "%s: look at ranges and units, add mean and scale where the network was standardised, name the airframe\n",
      printable(options.out).c_str());
}

int convert(const ConvertOptions& options) {
  const std::string ending = std::filesystem::path(options.source).extension().string();
  if (ending == ".csv" || std::filesystem::is_directory(options.source)) {
    begin_features(options);
    return 0;
  }
  const bool is_model = ending == ".block" || ending == ".hpp";
  if (!is_model && ending != ".onnx" && ending != ".safetensors") {
    throw std::invalid_argument(options.source +
                                ": a name that ends in .onnx, .safetensors, .block, .hpp or .csv was expected");
  }
  is_model ? convert_model(options) : convert_network(options);
  return 0;
}

}  // namespace

namespace programs {

Command convert_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "convert", "Makes a model of a network that was trained elsewhere, or a network for elsewhere of a model");
  const auto options = std::make_shared<ConvertOptions>();
  add_path(*line, "source", options->source, "FILE",
           "a network (.onnx, .safetensors), a model (.block, .hpp), or flights (.csv, a dataset)")
      ->required();
  add_path(*line, "--features", options->features, "FILE.toml",
           "of a network: what its numbers mean (docs/convert.md)");
  add_path(*line, "--out", options->out, "DIR|FILE",
           "of a network the folder for model.hpp and model.block; of a model the network to write (.onnx, "
           ".safetensors); of flights the features file")
      ->required();
  line->add_option("--name", options->name, "name of the exported struct")->type_name("NAME")->capture_default_str();
  line->add_option("--inputs", options->inputs,
                   "of flights: paper, physics or inverse, the features that the file begins with")
      ->type_name("SET")
      ->capture_default_str();
  line->add_flag("--double", options->in_double, "numbers of the model in double, not in float");
  line->footer(
      "Examples:\n"
      "  pinnquad convert flight.csv --out features.toml   to begin with: ranges of the flights\n"
      "  pinnquad convert net.onnx --features features.toml --out my_model\n"
      "  pinnquad convert my_model/model.block --out net.onnx\n"
      "Exit codes: 0; 2 bad input or a file that can't be read or written; 130 interrupted.");
  return {line, [options] { return convert(*options); }};
}

}  // namespace programs
