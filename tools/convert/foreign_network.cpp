// SPDX-License-Identifier: MIT
#include "convert/foreign_network.hpp"

#include <nlohmann/json.hpp>

#include "convert/python_answer.hpp"

namespace programs {

ForeignNetwork asked_network(const AskPython& ask, const std::string& request, const std::string& path) {
  const nlohmann::json answer = python_answer(ask, request, path);
  ForeignNetwork network;
  network.inputs = answer.at("inputs").get<std::size_t>();
  network.outputs = answer.at("outputs").get<std::size_t>();
  for (const nlohmann::json& one : answer.at("layers")) {
    ForeignLayer& layer = network.layers.emplace_back();
    if (one.is_string()) {
      layer.activation = one.get<std::string>();
      continue;
    }
    layer.bias = one.at("bias").get<Numbers>();
    for (const nlohmann::json& row : one.at("weights")) {
      for (const nlohmann::json& weight : row) layer.weights.push_back(weight.get<double>());
    }
  }
  network.answers = answer.at("answers").get<std::vector<Numbers>>();
  return network;
}

}  // namespace programs
