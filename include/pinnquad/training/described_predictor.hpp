// SPDX-License-Identifier: MIT
// A predictor by its description (model/description.hpp) and its parameters: code that asks one is compiled once.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/exported/run_time_network.hpp"
#include "pinnquad/model/description.hpp"

namespace pinnquad::detail {

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

/// A predictor by its description, with the bits of the compiled one.
class DescribedPredictor {
 public:
  DescribedPredictor(const std::string& description, std::vector<float> parameters)
      : parameters_(std::move(parameters)) {
    if (!network_->parse(description) || network_->parameter_count() != static_cast<int>(parameters_.size())) {
      throw std::logic_error("structured fit: no predictor of these parameters: " + description);
    }
    x_.resize(static_cast<std::size_t>(network_->inputs()));
    y_.resize(static_cast<std::size_t>(network_->outputs()));
    work_.resize(network_->workspace());
  }
  /// Inputs of the last layer of its first part.
  int last_width() const {
    const RunTimePart& part = network_->part(0);
    int width = part.shown(), last = width;
    for (int i = 0; i < part.layer_count; ++i) {
      if (part.layers[i].outputs == 0) continue;
      last = width;
      width = part.layers[i].outputs;
    }
    return last;
  }
  /// The outputs of standardised features; they stay until it is asked again.
  const std::vector<std::array<float, 1>>& operator()(const float* x) {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i][0] = x[i];
    network_->forward<float, 1>(parameters_.data(), x_.data(), y_.data(), work_.data());
    return y_;
  }

 private:
  std::unique_ptr<RunTimeNetwork> network_ = std::make_unique<RunTimeNetwork>();
  std::vector<float> parameters_;
  std::vector<std::array<float, 1>> x_, y_, work_;
};

}  // namespace pinnquad::detail
