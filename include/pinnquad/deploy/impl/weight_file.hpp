// SPDX-License-Identifier: MIT
// Bodies of weight_file.hpp.
#pragma once

#include "pinnquad/deploy/impl/block_writer.hpp"
#include "pinnquad/deploy/weight_file.hpp"

namespace pinnquad {
namespace detail {

template <class Scalar>
std::vector<unsigned char> block_of(const WrittenModel<Scalar>& model) {
  LittleEndianBytes<Scalar> scalars;
  for (const auto* numbers : {&model.input_mean, &model.input_deviation, &model.output_mean, &model.output_deviation,
                              &model.envelope_lower, &model.envelope_upper}) {
    scalars.add(*numbers);
  }
  scalars.add(model.golden_features);
  scalars.add(model.golden_commands);
  scalars.add(model.parameters);
  return whole_block({sizeof(Scalar), model.input_mean.size(), model.output_mean.size(), model.parameters.size(),
                      model.golden_features.size(), model.training_rows, hash_of_shape(model), model.training_data_hash,
                      model.contents_hash},
                     block_records<Scalar>(model), scalars.bytes);
}

template <class Scalar>
std::vector<unsigned char> block_beside_header(WrittenModel<Scalar> model) {
  std::ostream nowhere(nullptr);
  model.contents_hash = write_struct(nowhere, model);
  return block_of(model);
}

PINNQUAD_BODY void write_block(std::ostream& out, const std::vector<unsigned char>& block) {
  out.write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
}

}  // namespace detail

PINNQUAD_BODY void write_weight_file(const std::string& path, const std::vector<unsigned char>& block) {
  AtomicFile file(path);
  detail::write_block(file.stream(), block);
  file.commit();
}

template <class Scalar>
std::vector<unsigned char> model_block(const GroundModel<Scalar>& model, const std::vector<std::vector<double>>& golden,
                                       const Provenance& provenance, const std::string& name,
                                       const FittedTrust* trust) {
  auto written = detail::written_model(model, golden, provenance, name);
  if (trust != nullptr) {
    written.trust = {trust->squared_distance_limit,   trust->command_residual_factor, trust->command_residual_limit,
                     trust->command_residual_cleared, trust->update_period_s,         trust->distribution.mean,
                     trust->distribution.whitening};
  }
  return detail::block_beside_header(std::move(written));
}

#ifdef PINNQUAD_COMPILED
template std::vector<unsigned char> detail::block_of(const detail::WrittenModel<float>&);
template std::vector<unsigned char> detail::block_of(const detail::WrittenModel<double>&);
template std::vector<unsigned char> detail::block_beside_header(detail::WrittenModel<float>);
template std::vector<unsigned char> detail::block_beside_header(detail::WrittenModel<double>);
template std::vector<unsigned char> model_block(const GroundModel<float>&, const std::vector<std::vector<double>>&,
                                                const Provenance&, const std::string&, const FittedTrust*);
template std::vector<unsigned char> model_block(const GroundModel<double>&, const std::vector<std::vector<double>>&,
                                                const Provenance&, const std::string&, const FittedTrust*);
#endif

}  // namespace pinnquad
