// SPDX-License-Identifier: MIT
// Writes a trained model as a C++ header that flight code includes: weights, feature schema, scaling, training
// envelope, golden vectors, provenance. Every number reads back bit for bit.
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "pinnquad/deploy/written_model.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

namespace detail {
/// The header of a model into `out`; returns its contents_hash. Of float and of double.
template <class Scalar>
std::uint64_t write_struct(std::ostream& out, const WrittenModel<Scalar>& model);
/// The header as a text; no locale plays a part.
template <class Scalar>
std::string header_text(const WrittenModel<Scalar>& model);
}  // namespace detail

/// Writes `struct <struct_name>` to `out`. `golden` are feature vectors inside the envelope, at least one; their
/// commands are computed here by the portable kernel. The contract of the struct: exported/model.hpp. No locale plays a
/// part. A GivenAirframe stands before the model as a struct of its own. A model that is worse than the mean says so at
/// its head. Throws std::invalid_argument, and writes nothing, for a name that no struct may have, for no golden
/// vector, for one outside the envelope, for a number that is not finite, for a provenance that no model has, and for a
/// model of proven structure that has no certificate.
template <class Scalar>
void write_model(std::ostream& stream, const std::string& struct_name, const GroundModel<Scalar>& model,
                 const std::vector<std::vector<double>>& golden, const Provenance& provenance);
/// The same for a model whose types are known.
template <class NetworkType, class ContextType>
void write_model(std::ostream& stream, const std::string& struct_name,
                 const TrainedModel<NetworkType, ContextType>& model,
                 const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
                 const Provenance& provenance) {
  write_model(stream, struct_name, detail::ground_without_rows(model), detail::as_numbers(golden), provenance);
}

/// The same into a file that appears whole or not at all.
template <class NetworkType, class ContextType>
void write_model_header(const std::string& path, const std::string& struct_name,
                        const TrainedModel<NetworkType, ContextType>& model,
                        const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
                        const Provenance& provenance) {
  AtomicFile file(path);
  write_model(file.stream(), struct_name, model, golden, provenance);
  file.commit();
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/header_writer.hpp"
#endif
