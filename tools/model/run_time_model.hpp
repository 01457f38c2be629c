// SPDX-License-Identifier: MIT
// A model put together at run time, from what a header or a block says of itself, as the flying pipeline has it
// (inference/pipeline.hpp): scale -> network -> restore -> schema.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "model/block.hpp"
#include "model/identity.hpp"
#include "model/run_time_answer.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "training/derivatives.hpp"

namespace programs {

/// A block's answer between its scalers, in the block's scalar.
template <class Features, class Outputs, class Scalar>
class RunTimeModel {
 public:
  using FeatureVector = std::array<Scalar, static_cast<std::size_t>(Features::size)>;
  using Map = pinnquad::OutputMap<Outputs>;

  RunTimeModel(const Block& block, const Identity& identity)
      : network_(identity.networks, block.parameters),
        airframe_(identity.airframe.name, identity.airframe.value),
        input_(scaler_of<pinnquad::Scaler<Scalar, Features::size>>(block.input_mean, block.input_deviation)),
        output_(scaler_of<pinnquad::Scaler<Scalar, Map::size>>(block.output_mean, block.output_deviation)) {}

  pinnquad::Commands<Scalar> predict(const FeatureVector& x) const {
    std::vector<Scalar> standardised(x.size());
    input_.standardise(x.data(), standardised.data());
    return answer(x.data(), standardised);
  }
  /// Of features that are standardised already, for a caller that did it itself.
  pinnquad::Commands<Scalar> answer(const Scalar* x, const std::vector<Scalar>& standardised) const {
    const std::vector<Scalar> made = network_.forward(standardised);
    std::array<Scalar, static_cast<std::size_t>(Map::size)> outputs{};
    output_.restore(made.data(), outputs.data());
    pinnquad::Commands<Scalar> commands{};
    Map::commands(x, static_cast<const Scalar*>(outputs.data()), airframe_.template output_setting<Outputs, Scalar>(),
                  commands.data());
    return commands;
  }
  const pinnquad::Scaler<Scalar, Features::size>& input() const noexcept { return input_; }

 private:
  RunTimeAnswer<Scalar> network_;
  RunTimeAirframe airframe_;
  pinnquad::Scaler<Scalar, Features::size> input_;
  pinnquad::Scaler<Scalar, Map::size> output_;
};

}  // namespace programs
