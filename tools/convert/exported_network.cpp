// SPDX-License-Identifier: MIT
#include "convert/exported_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convert/features_file.hpp"
#include "pinnquad/exported/run_time_activation.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {
namespace {

using namespace pinnquad;

using nlohmann::json;

json dense(std::size_t width, const Numbers& weights, const Numbers& bias) {
  json rows = json::array();
  for (std::size_t row = 0; row < bias.size(); ++row) {
    rows.push_back(
        Numbers(weights.begin() + std::ptrdiff_t(row * width), weights.begin() + std::ptrdiff_t((row + 1) * width)));
  }
  return {{"weights", rows}, {"bias", bias}};
}

/// `at`: its first parameter. As RunTimeNetwork::run().
template <class Scalar>
json part_of(const RunTimeNetwork::Part& from, const Scalar* at) {
  json part = {{"shown", std::vector<std::size_t>()}, {"steps", json::array()}, {"lower", nullptr}, {"upper", nullptr}};
  std::vector<std::size_t> shown_features;
  const auto take = [&at](std::size_t count) {
    Numbers numbers(count);
    for (double& number : numbers) number = static_cast<double>(*at++);
    return numbers;
  };
  const auto inputs = std::size_t(from.inputs), outputs = std::size_t(from.outputs);
  if (from.bounded) {
    part["lower"] = take(outputs);
    part["upper"] = take(outputs);
  }
  if (from.three_count > 0) {
    from.each_shown([&](int feature) { shown_features.push_back(std::size_t(feature)); });
  }
  if (from.axis_aligned) {
    const std::size_t others = shown_features.size();
    const Numbers slopes = take(3 * std::size_t(from.three_count)), weights = take(4 * others);
    Numbers all(4 * inputs, 0);
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t other = 0; other < others; ++other) {
        all[row * inputs + shown_features[other]] = weights[row * others + other];
      }
      for (std::size_t tap = 0; row > 0 && tap < std::size_t(from.three_count); ++tap) {
        all[row * inputs + std::size_t(from.threes[tap]) + row - 1] = slopes[3 * tap + row - 1];
      }
    }
    part["steps"].push_back(dense(inputs, all, take(4)));
    return part;
  }
  part["shown"] = shown_features;
  std::size_t width = shown_features.empty() ? inputs : shown_features.size();
  for (int i = 0; i < from.layer_count; ++i) {
    const RunTimeNetwork::Layer& layer = from.layers[i];
    if (layer.normalised > 0) {
      const Numbers gamma = take(std::size_t(layer.normalised));
      part["steps"].push_back(
          {{"norm", layer.centred ? "layer_norm" : "rms_norm"}, {"weights", gamma}, {"bias", take(gamma.size())}});
      continue;
    }
    if (layer.gated > 0) {
      part["steps"].push_back({{"glu", layer.gated}});
      width -= std::size_t(layer.gated);
      continue;
    }
    if (layer.outputs == 0) {
      const auto& activations = pinnquad::detail::run_time_activations<float>;
      part["steps"].push_back(activation_word(activations[std::size_t(layer.activation)].description));
      continue;
    }
    const auto rows = std::size_t(layer.outputs);
    const Numbers weights = take(rows * width);
    part["steps"].push_back(dense(width, weights, layer.has_bias ? take(rows) : Numbers(rows, 0)));
    width = rows;
  }
  return part;
}

/// The affine map from outputs and features to commands, from where it is and how it rises there.
template <class Model>
void take_commands(const Model& model, std::size_t inputs, json& network) {
  using Scalar = std::decay_t<decltype(model.parameters()[0])>;
  const auto outputs = std::size_t(model.network().outputs());
  constexpr auto read = std::size_t(RunTimeOutputs<Scalar>::base_features), rotors = std::size_t(rotor_count);
  const Scalar* x = model.golden_features(0);
  std::vector<Scalar> y(outputs, Scalar(0)), by_outputs(rotors * outputs), by_x(rotors * read);
  Commands<Scalar> u{};
  model.outputs().commands(x, y.data(), u.data());
  model.outputs().slopes(x, y.data(), by_outputs.data(), by_x.data());
  Numbers bias(u.begin(), u.end()), of_features(rotors * inputs, 0);
  bool reads_features = false;
  for (std::size_t rotor = 0; rotor < rotors; ++rotor) {
    for (std::size_t i = 0; i < std::min(inputs, read); ++i) {
      const auto slope = static_cast<double>(by_x[rotor * read + i]);
      of_features[rotor * inputs + i] = slope;
      bias[rotor] -= slope * static_cast<double>(x[i]);
      reads_features = reads_features || std::abs(slope) > 0;
    }
  }
  network.update(dense(outputs, Numbers(by_outputs.begin(), by_outputs.end()), bias));
  network["of_features"] = nullptr;
  if (reads_features) network["of_features"] = dense(inputs, of_features, bias).at("weights");
}

}  // namespace

json exported_network(const BlockModel& model) {
  if (!model.has_affine_schema()) {
    throw InputError(model.path(), 0, 0, "outputs of which the commands are an affine map",
                     model.schema() + " of " + model.airframe_name());
  }
  const auto inputs = std::size_t(model.features().size());
  json network = {{"name", model.name()}, {"is_double", model.is_double()}, {"least", nullptr}, {"most", nullptr}};
  model.with([&](const auto& own) {
    const auto numbers = [](const auto* from, std::size_t count) { return Numbers(from, from + count); };
    const auto& scales = own.scales();
    const auto outputs = std::size_t(own.network().outputs());
    network["mean"] = numbers(scales.input_mean, inputs);
    network["deviation"] = numbers(scales.input_deviation, inputs);
    network["output_mean"] = numbers(scales.output_mean, outputs);
    network["output_deviation"] = numbers(scales.output_deviation, outputs);
    if (own.features().column_count() > 0) {
      const double unbounded = double(std::numeric_limits<float>::max());
      Numbers least(inputs, -unbounded), most(inputs, unbounded);
      for (std::size_t i = 0; i < inputs; ++i) {
        if (!own.features().is_column(int(i))) continue;
        least[i] = static_cast<double>(scales.lower[i]);
        most[i] = static_cast<double>(scales.upper[i]);
      }
      network["least"] = least;
      network["most"] = most;
    }
    const auto* parameters = own.parameters();
    for (int i = 0; i < own.network().part_count(); ++i) {
      network["parts"].push_back(part_of(own.network().part(i), parameters));
      parameters += own.network().part(i).parameter_count;
    }
    take_commands(own, inputs, network);
  });
  std::string features;
  for (int i = 0; i < model.features().size(); ++i) {
    const auto [name, unit] = model.features()[i];
    features += (i > 0 ? ", " : "") + std::string(name) + " [" + std::string(unit) + "]";
  }
  network["facts"] = {{"features", printable(features)},
                      {"outputs", "u1, u2, u3, u4"},
                      {"airframe", model.airframe_name()},
                      {"contents_hash", hexadecimal(model.contents_hash())}};
  for (int vector = 0; vector < model.golden_count(); ++vector) {
    const Numbers x = model.golden_features(vector);
    network["golden_features"].push_back(x);
    network["golden_commands"].push_back(model.commands(x));
  }
  return network;
}

}  // namespace programs
