// SPDX-License-Identifier: MIT
// An exported model asked for many motions at once, as rollouts (MPPI) and evaluation do: a Status for each.
#pragma once

#include <cstddef>

#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/nn/batched_network.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// A network over all lanes at once; any other answer, one sample after the other.
template <class Answer, bool IsNetwork = is_network<Answer>>
struct BatchedAnswer : BatchedNetwork<Answer> {};

template <class Answer>
struct BatchedAnswer<Answer, false> {
  using Scalar = typename Answer::Scalar;
  static constexpr int lanes = 1;

  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* y, int) noexcept {
    Answer::forward(parameters, x, y);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// For each sample s InverseDynamics::predict_features(), to rounding: x[k * samples + s] is its feature k in physical
/// units, commands[i * samples + s] its command i, statuses[s] its Status. Commands of a sample are written only if
/// has_output(statuses[s]). Of the guard, all but its fallback applies. Any model that shows its weights: a header's,
/// a ModelView. No heap; stack for 2 packs of samples.
template <class Model, class GuardType>
void predict_batch(const InverseDynamics<Model, GuardType>& inverse, const typename Model::Scalar* x,
                   typename Model::Scalar* commands, Status* statuses, int samples) noexcept {
  static_assert(GuardType::refuses_outside_envelope,
                "pinnquad: a batch refuses what is outside the envelope; take a guard with TrainingEnvelope");
  using Scalar = typename Model::Scalar;
  using Batched = detail::BatchedAnswer<typename Model::Network>;
  using Pipeline = detail::Pipeline<typename Model::Features, typename Model::Outputs, typename Model::Vehicle>;
  constexpr int size = Model::Features::size;
  constexpr int lanes = Batched::lanes;
  const Scalar* weights = detail::row_major_weights(inverse.model());
  const detail::Scales<Scalar> scales = detail::scales_of(inverse.model());

  if (weights == nullptr) {  // a view of no block: its envelope is empty
    for (int s = 0; s < samples; ++s) statuses[s] = Status::outside_envelope;
    return;
  }
  for (int first = 0; first < samples; first += lanes) {
    const int count = samples - first < lanes ? samples - first : lanes;
    alignas(64) Scalar answers[Model::Network::outputs * lanes];
    int outside[static_cast<std::size_t>(lanes)] = {};
    for (int k = 0; k < size; ++k) {
      const Scalar* feature = x + k * samples + first;
      for (int s = 0; s < count; ++s) {
        const bool column = detail::is_column<typename Model::Features>(k);
        const bool inside =
            is_finite(feature[s]) & (column | ((feature[s] >= scales.lower[k]) & (feature[s] <= scales.upper[k])));
        outside[s] |= inside ? 0 : 1;
      }
    }
    Pipeline::template ask<lanes>(scales, x + first, samples, count, answers,
                                  [weights](const Scalar* standardised, Scalar* made)
                                      PINNQUAD_INLINE_LAMBDA { Batched::forward(weights, standardised, made, lanes); });
    for (int s = 0; s < count; ++s) {
      Scalar outputs[Model::Network::outputs], sample[rotor_count];
      Pipeline::command(scales, x + first + s, samples, answers + s, lanes, outputs, sample);
      const Status checked = GuardType::check_commands(sample);
      Status status = outside[s] != 0 ? Status::outside_envelope : checked;
      if constexpr (GuardType::measures_distance) {
        Scalar features[static_cast<std::size_t>(size)], squared(0);
        for (int k = 0; k < size; ++k) features[k] = x[k * samples + first + s];
        if (outside[s] == 0 && !inverse.inside_distribution(features, squared)) status = Status::outside_distribution;
      }
      statuses[first + s] = status;
      if (has_output(status)) {
        for (int i = 0; i < rotor_count; ++i) commands[i * samples + first + s] = sample[i];
      }
    }
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
