// SPDX-License-Identifier: MIT
// Types of a model as texts, and a predictor by its description (model/description.hpp) and its parameters: code that
// asks one is compiled once.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/core/type_text.hpp"
#include "pinnquad/exported/run_time_network.hpp"
#include "pinnquad/model/description.hpp"

namespace pinnquad {

/// "pinnquad::Network<float, pinnquad::InputSize<16>, ...>" (core/type_text.hpp), lists closed as ">>".
template <class T>
std::string type_name() {
  std::string name(detail::type_text<T>());
  for (std::size_t at = name.find("> >"); at != std::string::npos; at = name.find("> >", at)) name.erase(at + 1, 1);
  return name;
}

namespace detail {

/// A predictor by what names it.
struct PredictorText {
  std::string description;  ///< model/description.hpp
  std::string type;         ///< as a header names it
};

/// A description as a text (model/description.hpp).
struct DescriptionText {
  std::string text;
  void add(std::string_view piece) { text += piece; }
  void add(int number) { text += std::to_string(number); }
};
template <class T>
std::string description_text() {
  DescriptionText sink;
  describe<T>(sink);
  return sink.text;
}

template <class Predictor>
PredictorText predictor_text() {
  return {description_text<Predictor>(), type_name<Predictor>()};
}

/// A predictor by its description, with the bits of the compiled one.
class DescribedPredictor {
 public:
  DescribedPredictor(const std::string& description, std::vector<float> parameters)
      : parameters_(std::move(parameters)) {
    auto network = std::make_shared<RunTimeNetwork>();
    if (!network->parse(description) || network->parameter_count() != static_cast<int>(parameters_.size())) {
      throw std::logic_error("structured fit: no predictor of these parameters: " + description);
    }
    network_ = std::move(network);
  }
  DescribedPredictor(const PredictorText& text, std::vector<float> parameters)
      : DescribedPredictor(text.description, std::move(parameters)) {}
  /// Inputs of the last layer of its first part.
  int last_width() const {
    const RunTimeNetwork::Part& part = network_->part(0);
    int width = part.shown(), last = width;
    for (int i = 0; i < part.layer_count; ++i) {
      if (part.layers[i].outputs == 0) continue;
      last = width;
      width = part.layers[i].outputs;
    }
    return last;
  }
  /// The outputs of standardised features.
  std::vector<float> operator()(const float* x) const {
    using Entry = RunTimeNetwork::Values<float, 1>;
    static_assert(sizeof(Entry) == sizeof(float));
    const auto outputs = static_cast<std::size_t>(network_->outputs());
    std::vector<float> y(outputs + network_->workspace());
    Entry* const made = reinterpret_cast<Entry*>(y.data());
    network_->forward<float, 1>(parameters_.data(), reinterpret_cast<const Entry*>(x), made, made + outputs);
    y.resize(outputs);
    return y;
  }

 private:
  std::shared_ptr<const RunTimeNetwork> network_;
  std::vector<float> parameters_;
};

}  // namespace detail
}  // namespace pinnquad
