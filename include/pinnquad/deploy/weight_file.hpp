// SPDX-License-Identifier: MIT
// Writes a trained or an exported model as a block of bytes, to be read in place by a ModelView: weights that change
// without a new firmware. Layout: exported/model_block.hpp; the same bytes on every machine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/exported/model_block.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/training/structured/trust_limits.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

namespace detail {

template <class Scalar>
std::vector<unsigned char> block_of(const WrittenModel<Scalar>& model);

/// The block beside the header that write_struct() writes of the same model.
template <class Scalar>
std::vector<unsigned char> block_beside_header(WrittenModel<Scalar> model);

}  // namespace detail

/// The block of a trained model. `golden` as for write_model(): feature vectors inside the envelope, at least one.
/// `name`: of the header's struct. `trust`: limits of trust, or null.
/// Throws std::invalid_argument where write_model() does.
template <class Scalar>
std::vector<unsigned char> model_block(const GroundModel<Scalar>& model, const std::vector<std::vector<double>>& golden,
                                       const Provenance& provenance, const std::string& name = "Model",
                                       const FittedTrust* trust = nullptr);
/// The same for a model whose types are known.
template <class NetworkType, class ContextType>
std::vector<unsigned char> model_block(
    const TrainedModel<NetworkType, ContextType>& model,
    const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
    const Provenance& provenance, const std::string& name = "Model", const FittedTrust* trust = nullptr) {
  return model_block(detail::ground_without_rows(model), detail::as_numbers(golden), provenance, name, trust);
}

/// The block of an exported header: the bytes that its training would have written as a block.
/// `Trust`: the struct of trust.hpp beside it; void: none.
template <class Model, class Trust = void>
std::vector<unsigned char> model_block() {
  static_assert(require_model<Model>());
  detail::WrittenModel<typename Model::Scalar> written;
  static_cast<detail::WrittenRecords&>(written) = detail::records_of_header<Model>();
  if constexpr (!std::is_void_v<Trust>) {
    written.trust = {Trust::squared_distance_limit,
                     Trust::command_residual_factor,
                     Trust::command_residual_limit,
                     Trust::command_residual_cleared,
                     Trust::update_period_s,
                     detail::converted<double>(Trust::distribution_mean),
                     detail::converted<double>(Trust::whitening)};
  }
  detail::take_numbers(written, Model{});
  for (const auto& x : Model::golden_features) written.golden_features.emplace_back(x.begin(), x.end());
  for (const auto& u : Model::golden_commands) {
    std::copy(u.begin(), u.end(), written.golden_commands.emplace_back().begin());
  }
  written.parameters.assign(Model::parameters.begin(), Model::parameters.end());
  written.training_data_hash = Model::training_data_hash;
  written.training_rows = static_cast<std::size_t>(Model::training_rows);
  return detail::block_of(written);
}

namespace detail {
void write_block(std::ostream& out, const std::vector<unsigned char>& block);
}  // namespace detail

/// A block as a file that appears whole or not at all.
void write_weight_file(const std::string& path, const std::vector<unsigned char>& block);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/weight_file.hpp"
#endif
