// SPDX-License-Identifier: MIT
// Many motions through a model that its block describes, a lane of the vector unit each: the bits of
// RunTimeModel::commands(). For programs on the ground; no heap: the caller owns the workspace.
#pragma once

#include <cstddef>

#include "pinnquad/exported/run_time_model.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Motions that are worked out side by side.
inline constexpr int run_time_lanes = 16;

/// Entries of Scalar that commands_of_rows() works in.
template <class Scalar>
std::size_t batch_workspace(const RunTimeModel<Scalar>& model) noexcept {
  const auto inputs = std::size_t(model.features().size()), outputs = std::size_t(model.network().outputs());
  return (std::size_t(run_time_lanes) + 1) * (inputs + outputs) +
         std::size_t(run_time_lanes) * model.network().workspace();
}

/// Commands u[row * rotor_count + i] of features x[row * features + k], physical units; the envelope is not looked at.
template <class Scalar>
void commands_of_rows(const RunTimeModel<Scalar>& model, const Scalar* x, std::size_t rows, Scalar* u,
                      Scalar* work) noexcept {
  using Entry = RunTimeNetwork::Values<Scalar, run_time_lanes>;
  static_assert(sizeof(Entry) == run_time_lanes * sizeof(Scalar));
  const auto inputs = std::size_t(model.features().size()), outputs = std::size_t(model.network().outputs());
  const auto& scales = model.scales();
  Scalar* const own = work;  // of one motion: what goes into the network, then what comes out
  Scalar* const made = own + inputs;
  auto* const in = reinterpret_cast<Entry*>(made + outputs);
  Entry *const out = in + inputs, *const network_work = out + outputs;
  for (std::size_t first = 0; first < rows; first += run_time_lanes) {
    const std::size_t count = rows - first < std::size_t(run_time_lanes) ? rows - first : std::size_t(run_time_lanes);
    for (std::size_t lane = 0; lane < std::size_t(run_time_lanes); ++lane) {
      const Scalar* const motion = x + (first + (lane < count ? lane : count - 1)) * inputs;
      for (std::size_t k = 0; k < inputs; ++k) own[k] = (motion[k] - scales.input_mean[k]) / scales.input_deviation[k];
      model.saturate_columns(own);
      for (std::size_t k = 0; k < inputs; ++k) in[k][lane] = own[k];
    }
    model.network().template forward<Scalar, run_time_lanes, detail::RunTimeEntry::lanes>(model.parameters(), in, out,
                                                                                          network_work);
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (std::size_t k = 0; k < outputs; ++k) {
        made[k] = out[k][lane] * scales.output_deviation[k] + scales.output_mean[k];
      }
      model.outputs().commands(x + (first + lane) * inputs, made, u + (first + lane) * rotor_count);
    }
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad
