// SPDX-License-Identifier: MIT
// Writes a trained or an exported model as a block of bytes, to be read in place by a ModelView: weights that change
// without a new firmware. Layout: exported/model_block.hpp; the same bytes on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pinnquad/deploy/block_writer.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/exported/model_block.hpp"
#include "pinnquad/exported/renamed.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/training/structured/trust_limits.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

namespace detail {

/// `model` has scalers and envelope, as an object or as static members.
template <class Shape, class Model, class GoldenFeatures, class GoldenCommands, class Parameters>
std::vector<unsigned char> block_of(const Model& model, const GoldenFeatures& golden_features,
                                    const GoldenCommands& golden_commands, const Parameters& parameters,
                                    const WrittenRecords& records, std::uint64_t shape,
                                    std::uint64_t training_data_hash, std::uint64_t training_rows) {
  using Layout = ModelBlockLayout<Shape>;
  using Scalar = typename Shape::Scalar;
  LittleEndianBytes<Scalar> scalars;
  scalars.add(model.input.mean);
  scalars.add(model.input.standard_deviation);
  scalars.add(model.output.mean);
  scalars.add(model.output.standard_deviation);
  scalars.add(model.envelope_lower);
  scalars.add(model.envelope_upper);
  scalars.add(golden_features);
  scalars.add(golden_commands);
  scalars.add(parameters);
  return whole_block({sizeof(Scalar), Layout::inputs, Layout::outputs, Layout::parameter_count, golden_features.size(),
                      training_rows, shape, training_data_hash},
                     block_records<Scalar>(records), scalars.bytes);
}

}  // namespace detail

/// The block of a trained model. `golden` as for write_model(): feature vectors inside the envelope, at least one.
/// `name`: of the header's struct. `trust`: limits of trust, or null.
/// Throws std::invalid_argument where write_model() does.
template <class NetworkType, class ContextType>
std::vector<unsigned char> model_block(
    const TrainedModel<NetworkType, ContextType>& model,
    const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
    const Provenance& provenance, const std::string& name = "Model",
    const FittedTrust<ContextType::Features::size>* trust = nullptr) {
  using Model = TrainedModel<NetworkType, ContextType>;
  const auto golden_commands = detail::golden_commands(model, golden);
  auto records = detail::records_of_training(model, provenance);
  std::ostream nowhere(nullptr);
  records.name = name;
  records.contents_hash = detail::write_struct(nowhere, name, model, golden, golden_commands, records, provenance);
  if (trust != nullptr) {
    records.trust = {trust->squared_distance_limit,
                     trust->command_residual_factor,
                     trust->command_residual_limit,
                     trust->command_residual_cleared,
                     trust->update_period_s,
                     {trust->distribution.mean.begin(), trust->distribution.mean.end()},
                     {trust->distribution.whitening.begin(), trust->distribution.whitening.end()}};
  }
  const std::uint64_t shape = detail::hash_of_shape<Model>(printable(model.airframe_name()),
                                                           motor_torque_signs(model.template airframe<double>()));
  return detail::block_of<Model>(model, golden, golden_commands, model.network.parameters, records, shape,
                                 provenance.training_data_hash, provenance.training_rows);
}

/// The block of an exported header, of format 2 or later: the bytes that its training would have written as a block.
/// `Trust`: the struct of trust.hpp beside it; void: none.
template <class Model, class Trust = void>
std::vector<unsigned char> model_block() {
  static_assert(require_model<Model>());
  static_assert(Model::format_version >= 2,
                "pinnquad: a header of format 1 does not check its own names; export it again");
  auto records = detail::records_of_header<Model>();
  if constexpr (!std::is_void_v<Trust>) {
    using Distance = detail::DistanceTrust<Trust>;
    using Residual = detail::ResidualTrust<Trust>;
    records.trust = {Distance::squared_distance_limit,
                     Residual::command_residual_factor,
                     Residual::command_residual_limit,
                     Residual::command_residual_cleared,
                     Trust::update_period_s,
                     detail::converted<double>(Trust::distribution_mean),
                     detail::converted<double>(Trust::whitening)};
  }
  return detail::block_of<Model>(Model{}, Model::golden_features, Model::golden_commands, Model::parameters, records,
                                 shape_hash<Model>, Model::training_data_hash,
                                 static_cast<std::uint64_t>(Model::training_rows));
}

namespace detail {
inline void write_block(std::ostream& out, const std::vector<unsigned char>& block) {
  out.write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
}
}  // namespace detail

/// A block as a file that appears whole or not at all.
inline void write_weight_file(const std::string& path, const std::vector<unsigned char>& block) {
  AtomicFile file(path);
  detail::write_block(file.stream(), block);
  file.commit();
}

}  // namespace pinnquad
