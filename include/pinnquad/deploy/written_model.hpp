// SPDX-License-Identifier: MIT
// All that header and block write of a model, as values: of a training, of an exported header's types, or of a network
// that was made elsewhere and that no type is of.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/stated_bounds.hpp"
#include "pinnquad/training/asked_model.hpp"

namespace pinnquad {
namespace detail {

/// The records of a model, and its numbers as its Scalar has them.
template <class Scalar>
struct WrittenModel : WrittenRecords {
  std::vector<Scalar> input_mean, input_deviation, output_mean, output_deviation;
  std::vector<Scalar> envelope_lower, envelope_upper;
  std::vector<std::vector<Scalar>> golden_features;
  std::vector<Commands<Scalar>> golden_commands;
  std::vector<Scalar> parameters;  ///< layer by layer: weights row-major, then biases
};

/// Texts in turn, apart.
struct NamesAndUnits {
  std::vector<std::string> names, units;
};
NamesAndUnits names_and_units(const std::vector<std::string>& texts, std::size_t first);

/// As detail::hash_of_shape(), of what is known when a program runs.
std::uint64_t hash_of_shape(const WrittenRecords& model);

/// Throws std::invalid_argument for a number that is not finite, for no golden vector, and for one outside the
/// envelope, which no self test could pass.
template <class Scalar>
void require_numbers(const WrittenModel<Scalar>& model);

/// `model` has scalers and envelope, as an object or as static members.
template <class Scalar, class Model>
void take_numbers(WrittenModel<Scalar>& written, const Model& model) {
  const auto take = [](const auto& from, std::vector<Scalar>& to) { to.assign(from.begin(), from.end()); };
  take(model.input.mean, written.input_mean);
  take(model.input.standard_deviation, written.input_deviation);
  take(model.output.mean, written.output_mean);
  take(model.output.standard_deviation, written.output_deviation);
  take(model.envelope_lower, written.envelope_lower);
  take(model.envelope_upper, written.envelope_upper);
}

}  // namespace detail

/// A trained model as an export takes it: whatever its types are, the export is compiled once.
template <class Scalar>
struct GroundModel : AskedModel {
  detail::WrittenModel<Scalar> written;  ///< but for its name, golden vectors and provenance
  double window_s = 0;                   ///< period of its window; 0 without one
};

namespace detail {
/// Without rows: to be written with given golden vectors.
template <class Model>
GroundModel<typename Model::Scalar> ground_without_rows(const Model& model) {
  using Scalar = typename Model::Scalar;
  using Outputs = typename Model::Outputs;
  GroundModel<Scalar> ground{asked_without_rows(model), {}, WindowOf<typename Model::Features>::period_s};
  WrittenModel<Scalar>& written = ground.written;
  static_cast<WrittenRecords&>(written) = records_of_types<Model>();
  take_numbers(written, model);
  written.parameters.assign(model.network.parameters.begin(), model.network.parameters.end());
  take_airframe<Outputs>(written, printable(model.airframe_name()), model.template airframe<double>(),
                         model.template airframe<Scalar>());
  if constexpr (has_certificate<Model>) written.certificate = certificate_of_trained(model);
  if constexpr (!std::is_same_v<typename Model::Vehicle, GivenAirframe>) {
    written.vehicle_type = type_name<typename Model::Vehicle>();
  }
  return ground;
}
}  // namespace detail

/// A model of types (training/trained_model.hpp) as a value.
template <class Model>
GroundModel<typename Model::Scalar> ground_model(const Model& model) {
  auto ground = detail::ground_without_rows(model);
  static_cast<AskedModel&>(ground) = AskedModel(model);
  return ground;
}

namespace detail {

/// All that is written of a model; the commands of its golden vectors are worked out by the portable kernel. Throws
/// std::invalid_argument where require_numbers() and take_provenance() do.
template <class Scalar>
WrittenModel<Scalar> written_model(const GroundModel<Scalar>& model, const std::vector<std::vector<double>>& golden,
                                   const Provenance& provenance, const std::string& name);

/// Feature vectors of types as numbers.
template <class FeatureVector>
std::vector<std::vector<double>> as_numbers(const std::vector<FeatureVector>& vectors) {
  std::vector<std::vector<double>> numbers;
  for (const FeatureVector& vector : vectors) numbers.emplace_back(vector.begin(), vector.end());
  return numbers;
}

}  // namespace detail
}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/written_model.hpp"
#endif
