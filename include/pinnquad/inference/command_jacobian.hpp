// SPDX-License-Identifier: MIT
// Commands and how they change with each feature, in one pass: for incremental control (u + du/dw' dw') and as the
// linear model of an MPC step.
#pragma once

#include <cstddef>

#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/nn/jacobian.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// commands = u(x) and jacobian[i * Features::size + k] = du_i / dx_k, 4 x Features::size, row-major, in physical units
/// (for the angular accelerations: per rad/s^2). Exact derivatives of network and output schema. Of the guard, the
/// envelope, the distance and the checks of the commands apply; a fallback is not asked. Where the commands are clipped
/// (`limited`) the Jacobian is that of the unclipped ones. Any model that shows its weights: a header's, a ModelView.
/// Both outputs are untouched unless has_output(status).
template <class Model, class GuardType>
Status predict_with_jacobian(const InverseDynamics<Model, GuardType>& inverse, const typename Model::Scalar* x,
                             typename Model::Scalar* commands, typename Model::Scalar* jacobian) noexcept {
  static_assert(GuardType::refuses_outside_envelope,
                "pinnquad: derivatives outside the envelope mean nothing; take a guard with TrainingEnvelope");
  using Scalar = typename Model::Scalar;
  using Network = typename Model::Network;
  using Pipeline = detail::Pipeline<typename Model::Features, typename Model::Outputs, typename Model::Vehicle>;
  constexpr int size = Model::Features::size;
  if (!inverse.inside_envelope(x)) return Status::outside_envelope;
  Scalar squared_distance(0);
  if (!inverse.inside_distribution(x, squared_distance)) return Status::outside_distribution;

  const detail::Scales<Scalar> scales = detail::scales_of(inverse.model());
  Scalar outputs[Network::outputs] = {}, slopes[Network::outputs * size];
  Scalar result[static_cast<std::size_t>(rotor_count)], by_features[static_cast<std::size_t>(rotor_count * size)];
  const Scalar* weights = detail::row_major_weights(inverse.model());
  Pipeline::run(scales, x, outputs, result, [&](const Scalar* standardised, Scalar* made) PINNQUAD_INLINE_LAMBDA {
    if constexpr (detail::may_be_packed<Model> && is_network<Network>) {
      if (const auto* const packed = detail::packed_weights(inverse.model())) {
        JacobianPass<Network>::run(*packed, weights, standardised, made, slopes);
        return;
      }
    }
    predictor_jacobian<Network>(weights, standardised, made, slopes);
  });
  Pipeline::chain(scales, x, outputs, slopes, by_features);
  if (!all_finite(by_features, rotor_count * size)) return Status::output_not_finite;
  const Status status = GuardType::check_commands(result);
  if (!has_output(status)) return status;
  for (int i = 0; i < rotor_count; ++i) commands[i] = result[i];
  for (int i = 0; i < rotor_count * size; ++i) jacobian[i] = by_features[i];
  return status;
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
