// SPDX-License-Identifier: MIT
#include "convert/foreign_network.hpp"

#include <nlohmann/json.hpp>

#include "convert/features_file.hpp"
#include "convert/python_answer.hpp"
#include "pinnquad/io/file_error.hpp"

namespace programs {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& path, const std::string& found) {
  throw pinnquad::InputError(path, 0, 0, "layers one after the other, of networks.py", found);
}

/// `width`: what the layer before makes.
ForeignLayer layer_of(const json& one, std::size_t width, const std::string& path) {
  ForeignLayer layer;
  if (one.is_string()) {
    layer.activation = one.get<std::string>();
    if (activation_layer(layer.activation).empty()) refuse(path, "'" + pinnquad::printable(layer.activation) + "'");
    return layer;
  }
  if (one.contains("glu")) {
    layer.activation = "glu";
    layer.gated = one.at("glu").get<std::size_t>();
    if (layer.gated < 1 || 2 * layer.gated > width) refuse(path, "a Glu of other numbers");
    return layer;
  }
  layer.bias = one.at("bias").get<Numbers>();
  if (one.contains("norm")) {
    layer.activation = one.at("norm").get<std::string>();
    layer.weights = one.at("weights").get<Numbers>();
    if (counted_layer(layer.activation).empty()) refuse(path, "'" + pinnquad::printable(layer.activation) + "'");
    if (layer.bias.empty() || layer.bias.size() > width || layer.weights.size() != layer.bias.size()) {
      refuse(path, "a norm of other numbers");
    }
    return layer;
  }
  for (const json& row : one.at("weights")) {
    const auto weights = row.get<Numbers>();
    if (weights.size() != width) refuse(path, "a row of " + std::to_string(weights.size()) + " weights");
    layer.weights.insert(layer.weights.end(), weights.begin(), weights.end());
  }
  if (layer.bias.empty() || layer.weights.size() != layer.bias.size() * width) refuse(path, "weights without biases");
  return layer;
}

ForeignNetwork network_of(const json& answer, const std::string& path) {
  ForeignNetwork network;
  network.inputs = answer.at("inputs").get<std::size_t>();
  network.outputs = answer.at("outputs").get<std::size_t>();
  std::size_t width = network.inputs;
  for (const json& one : answer.at("layers")) {
    network.layers.push_back(layer_of(one, width, path));
    const ForeignLayer& last = network.layers.back();
    width = last.activation.empty() ? last.outputs() : width - last.gated;
  }
  if (network.layers.empty() || !network.layers.front().activation.empty() ||
      !network.layers.back().activation.empty() || width != network.outputs) {
    refuse(path, "others");
  }
  network.answers = answer.at("answers").get<std::vector<Numbers>>();
  for (const Numbers& row : network.answers) {
    if (row.size() != network.outputs) refuse(path, "an answer of " + std::to_string(row.size()) + " numbers");
  }
  return network;
}

}  // namespace

ForeignNetwork asked_network(const AskPython& ask, const std::string& request, const std::string& path) {
  const json answer = python_answer(ask, request, path);
  try {
    return network_of(answer, path);
  } catch (const json::exception&) {
    refuse(path, "none");
  }
}

}  // namespace programs
