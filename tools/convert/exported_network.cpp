// SPDX-License-Identifier: MIT
#include "convert/exported_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convert/converted_model.hpp"
#include "convert/folded_network.hpp"
#include "convert/safetensors.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {
namespace {

using namespace pinnquad;

bool are(const Numbers& numbers, double value) {
  return std::all_of(numbers.begin(), numbers.end(), [value](double v) { return !(std::abs(v - value) > 0); });
}

ForeignActivation activation_of(const RunTimeLayer& layer) {
  const std::string_view own = pinnquad::detail::run_time_activations<float>[layer.activation].description;
  std::size_t place = 0;
  while (layer_text(static_cast<ForeignActivation>(place)) != own) ++place;
  return static_cast<ForeignActivation>(place);
}

/// `at`: its first parameter. As RunTimeNetwork::run().
template <class Scalar>
ExportedPart part_of(const RunTimePart& from, const Scalar* at) {
  ExportedPart part;
  const auto take = [&at](std::size_t count) {
    Numbers numbers(count);
    for (double& number : numbers) number = static_cast<double>(*at++);
    return numbers;
  };
  const auto inputs = std::size_t(from.inputs), outputs = std::size_t(from.outputs);
  if (from.bounded) {
    part.lower = take(outputs);
    part.upper = take(outputs);
  }
  if (from.three_count > 0) {
    from.each_shown([&part](int feature) { part.shown.push_back(std::size_t(feature)); });
  }
  if (from.axis_aligned) {
    const std::size_t others = part.shown.size();
    const Numbers slopes = take(3 * std::size_t(from.three_count)), weights = take(4 * others);
    ForeignDense dense{inputs, Numbers(4 * inputs, 0), take(4)};
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t other = 0; other < others; ++other) {
        dense.weights[row * inputs + part.shown[other]] = weights[row * others + other];
      }
      for (std::size_t tap = 0; row > 0 && tap < std::size_t(from.three_count); ++tap) {
        dense.weights[row * inputs + std::size_t(from.threes[tap]) + row - 1] = slopes[3 * tap + row - 1];
      }
    }
    part.shown.clear();
    part.steps.push_back(dense_step(std::move(dense)));
    return part;
  }
  std::size_t width = part.shown.empty() ? inputs : part.shown.size();
  for (int i = 0; i < from.layer_count; ++i) {
    const RunTimeLayer& layer = from.layers[i];
    if (layer.outputs == 0) {
      part.steps.push_back(activation_step(activation_of(layer)));
      continue;
    }
    const auto rows = std::size_t(layer.outputs);
    Numbers weights = take(rows * width);
    part.steps.push_back(dense_step({width, std::move(weights), layer.has_bias ? take(rows) : Numbers(rows, 0)}));
    width = rows;
  }
  return part;
}

/// The affine map from outputs and features to commands, from where it is and how it rises there.
template <class Model>
void take_commands(const Model& model, ExportedNetwork& network) {
  using Scalar = std::decay_t<decltype(model.parameters()[0])>;
  const auto outputs = std::size_t(model.network().outputs());
  constexpr auto read = std::size_t(RunTimeOutputs<Scalar>::base_features), rotors = std::size_t(rotor_count);
  const Scalar* x = model.golden_features(0);
  std::vector<Scalar> y(outputs, Scalar(0)), by_outputs(rotors * outputs), by_x(rotors * read);
  Commands<Scalar> u{};
  model.outputs().commands(x, y.data(), u.data());
  model.outputs().slopes(x, y.data(), by_outputs.data(), by_x.data());
  network.of_outputs = {outputs, Numbers(by_outputs.begin(), by_outputs.end()), Numbers(u.begin(), u.end())};
  Numbers of_features(rotors * network.inputs, 0);
  for (std::size_t rotor = 0; rotor < rotors; ++rotor) {
    for (std::size_t i = 0; i < std::min(network.inputs, read); ++i) {
      const auto slope = static_cast<double>(by_x[rotor * read + i]);
      of_features[rotor * network.inputs + i] = slope;
      network.of_outputs.bias[rotor] -= slope * static_cast<double>(x[i]);
    }
  }
  if (!are(of_features, 0)) network.of_features = std::move(of_features);
}

Numbers commands_of(const ExportedNetwork& network, const Numbers& features) {
  Numbers x = features, y(network.of_outputs.inputs, 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!network.least.empty()) x[i] = std::clamp(x[i], network.least[i], network.most[i]);
  }
  Numbers z(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) z[i] = (x[i] - network.mean[i]) / network.deviation[i];
  for (const ExportedPart& part : network.parts) {
    Numbers v = part.shown.empty() ? z : Numbers();
    for (const std::size_t place : part.shown) v.push_back(z[place]);
    for (const ForeignStep& step : part.steps) v = taken(step, v);
    for (std::size_t k = 0; k < v.size(); ++k) {
      y[k] += part.lower.empty() ? v[k] : std::clamp(v[k], part.lower[k], part.upper[k]);
    }
  }
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = y[k] * network.output_deviation[k] + network.output_mean[k];
  Numbers u = taken(dense_step(network.of_outputs), y);
  for (std::size_t i = 0; i < network.of_features.size(); ++i) {
    u[i / network.inputs] += network.of_features[i] * features[i % network.inputs];
  }
  return u;
}

}  // namespace

bool ExportedNetwork::scales_outputs() const { return !are(output_deviation, 1) || !are(output_mean, 0); }

bool ExportedNetwork::is_plain_output() const {
  if (!of_features.empty() || !are(of_outputs.bias, 0) || of_outputs.inputs != of_outputs.outputs()) return false;
  for (std::size_t i = 0; i < of_outputs.weights.size(); ++i) {
    const double one = i % of_outputs.inputs == i / of_outputs.inputs ? 1 : 0;
    if (std::abs(of_outputs.weights[i] - one) > 0) return false;
  }
  return true;
}

ExportedNetwork exported_network(const BlockModel& model) {
  if (!model.has_affine_schema()) {
    throw InputError(model.path(), 0, 0, "outputs of which the commands are an affine map",
                     model.schema() + " of " + model.airframe_name());
  }
  ExportedNetwork network;
  network.name = model.name();
  network.is_double = model.is_double();
  network.inputs = std::size_t(model.features().size());
  model.with([&](const auto& own) {
    const auto numbers = [](const auto* from, std::size_t count) { return Numbers(from, from + count); };
    const auto& scales = own.scales();
    const auto outputs = std::size_t(own.network().outputs());
    network.mean = numbers(scales.input_mean, network.inputs);
    network.deviation = numbers(scales.input_deviation, network.inputs);
    network.output_mean = numbers(scales.output_mean, outputs);
    network.output_deviation = numbers(scales.output_deviation, outputs);
    if (own.features().column_count() > 0) {
      network.least.assign(network.inputs, -double(std::numeric_limits<float>::max()));
      network.most.assign(network.inputs, double(std::numeric_limits<float>::max()));
      for (std::size_t i = 0; i < network.inputs; ++i) {
        if (!own.features().is_column(int(i))) continue;
        network.least[i] = static_cast<double>(scales.lower[i]);
        network.most[i] = static_cast<double>(scales.upper[i]);
      }
    }
    const auto* parameters = own.parameters();
    for (int i = 0; i < own.network().part_count(); ++i) {
      network.parts.push_back(part_of(own.network().part(i), parameters));
      parameters += own.network().part(i).parameter_count;
    }
    take_commands(own, network);
  });
  std::string features;
  for (int i = 0; i < model.features().size(); ++i) {
    const auto [name, unit] = model.features()[i];
    features += (i > 0 ? ", " : "") + std::string(name) + " [" + std::string(unit) + "]";
  }
  network.facts = {{"features", printable(features)},
                   {"outputs", "u1, u2, u3, u4"},
                   {"airframe", model.airframe_name()},
                   {"contents_hash", hexadecimal(model.contents_hash())}};
  for (int vector = 0; vector < model.golden_count(); ++vector) {
    const Numbers x = model.golden_features(vector), u = commands_of(network, x);
    const Commands<double> own = model.commands(x);
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (!(std::abs(u[i] - own[i]) <= converted_tolerance)) {
        throw InputError(model.path(), 0, 0, "a model whose arithmetic double follows within 1e-6 of a command",
                         number_text(std::abs(u[i] - own[i])));
      }
    }
  }
  return network;
}

std::string safetensors_of(const ExportedNetwork& network, const std::string& path) {
  const auto refuse = [&path](const std::string& found) {
    throw InputError(path, 0, 0, "one chain of layers, for safetensors (.onnx holds any model)", found);
  };
  if (network.parts.size() != 1) refuse("a sum of " + std::to_string(network.parts.size()));
  const ExportedPart& part = network.parts.front();
  if (!part.lower.empty()) refuse("bounds");
  if (!network.least.empty()) refuse("columns that are clipped to their range");
  if (!network.of_features.empty()) refuse("a base that reads the features");
  Folder folder(network.inputs);
  Numbers scale(network.inputs), shift(network.inputs);
  for (std::size_t i = 0; i < network.inputs; ++i) {
    scale[i] = 1 / network.deviation[i];
    shift[i] = -network.mean[i] / network.deviation[i];
  }
  folder.add(affine_step(std::move(scale), std::move(shift)));
  if (!part.shown.empty()) {
    const std::size_t shown = part.shown.size();
    ForeignDense picked{network.inputs, Numbers(shown * network.inputs, 0), Numbers(shown, 0)};
    for (std::size_t i = 0; i < shown; ++i) picked.weights[i * network.inputs + part.shown[i]] = 1;
    folder.add(dense_step(std::move(picked)));
  }
  for (const ForeignStep& step : part.steps) folder.add(step);
  if (network.scales_outputs()) {
    folder.add(affine_step(network.output_deviation, network.output_mean));
  }
  if (!network.is_plain_output()) folder.add(dense_step(network.of_outputs));
  std::vector<std::pair<std::string, Tensor>> tensors;
  std::string activations;
  const std::vector<FoldedLayer> layers = std::move(folder).layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const ForeignDense& dense = layers[i].dense;
    if (dense.outputs() == 0) {
      const auto* word = foreign_activations[static_cast<std::size_t>(layers[i].activation)];
      activations += (activations.empty() ? "" : ", ") + std::string(word);
      continue;
    }
    tensors.push_back({std::to_string(i) + ".weight", {{dense.outputs(), dense.inputs}, dense.weights}});
    tensors.push_back({std::to_string(i) + ".bias", {{dense.outputs()}, dense.bias}});
  }
  std::map<std::string, std::string> metadata(network.facts.begin(), network.facts.end());
  metadata["activations"] = activations;
  return safetensors_bytes(tensors, network.is_double, metadata);
}

}  // namespace programs
