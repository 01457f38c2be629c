// SPDX-License-Identifier: MIT
// One motion at a time through a model that its block describes, the outputs of a layer side by side in the vector
// unit: the bits of RunTimeModel::commands() in a third of its time.
#pragma once

#include <cstddef>
#include <vector>

#include "pinnquad/exported/run_time_model.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The model's parameters, weights column by column; rows are filled up to whole packs, no bias is 0. It refers to the
/// model, which must outlive it; it never changes.
template <class Scalar>
class RunTimeRow {
 public:
  explicit RunTimeRow(const RunTimeModel<Scalar>& model) : model_(&model) {
    const Scalar* next = model.parameters();
    for (int i = 0; i < model.network().part_count(); ++i) next = take(model.network().part(i), next);
  }

  const RunTimeModel<Scalar>& model() const noexcept { return *model_; }
  /// Entries of Scalar that commands() works in.
  std::size_t workspace() const noexcept {
    const RunTimeNetwork& network = model_->network();
    return std::size_t(network.inputs()) + std::size_t(network.outputs()) + network.workspace<Scalar, turned>();
  }

  /// Commands u[0, rotor_count) of features x in physical units; the envelope is not looked at.
  void commands(const Scalar* x, Scalar* u, Scalar* work) const noexcept {
    model_->template commands<turned>(parameters_.data(), x, u, work);
  }

 private:
  static constexpr auto turned = detail::RunTimeEntry::turned;

  const Scalar* copy(const Scalar* numbers, int count) {
    parameters_.insert(parameters_.end(), numbers, numbers + count);
    return numbers + count;
  }

  /// Takes a part's parameters in the order in which RunTimeNetwork reads them; gives what is behind.
  const Scalar* take(const RunTimeNetwork::Part& part, const Scalar* next) {
    if (part.axis_aligned) return copy(next, part.parameter_count);
    if (part.bounded) next = copy(next, 2 * part.outputs);
    int width = part.shown();
    for (int i = 0; i < part.layer_count; ++i) {
      const RunTimeNetwork::Layer& layer = part.layers[i];
      next = copy(next, 2 * layer.normalised);
      width -= layer.gated;
      if (layer.outputs == 0) continue;
      const auto fill = std::size_t(padded<NativePack<Scalar>>(layer.outputs) - layer.outputs);
      for (int column = 0; column < width; ++column) {
        for (int row = 0; row < layer.outputs; ++row) parameters_.push_back(next[row * width + column]);
        parameters_.insert(parameters_.end(), fill, Scalar(0));
      }
      next += width * layer.outputs;
      width = layer.outputs;
      if (layer.has_bias) next = copy(next, width);
      parameters_.insert(parameters_.end(), fill + std::size_t(layer.has_bias ? 0 : width), Scalar(0));
    }
    return next;
  }

  const RunTimeModel<Scalar>* model_;
  std::vector<Scalar> parameters_;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
