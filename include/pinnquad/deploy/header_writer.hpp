// SPDX-License-Identifier: MIT
// Writes a trained model as a C++ header that flight code includes: weights, feature schema, scaling, training
// envelope, golden vectors, provenance. Every number reads back bit for bit.
#pragma once

#include <cmath>
#include <locale>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "pinnquad/deploy/identifier.hpp"
#include "pinnquad/deploy/literal.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/deploy/record_writer.hpp"
#include "pinnquad/deploy/type_name.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/training/trained_model.hpp"
#include "pinnquad/version.hpp"

namespace pinnquad {

namespace detail {

/// All numbers of a model but its golden vectors.
template <class Model>
void require_finite_model(const Model& model) {
  require_finite(model.network.parameters, "the parameters");
  require_finite(model.input.mean, "the input means");
  require_finite(model.input.standard_deviation, "the input spreads");
  require_finite(model.output.mean, "the output means");
  require_finite(model.output.standard_deviation, "the output spreads");
  require_finite(model.envelope_lower, "the lower envelope");
  require_finite(model.envelope_upper, "the upper envelope");
}

/// The commands of golden feature vectors, by the portable kernel.
/// Throws std::invalid_argument for none, for one outside the envelope, which no self test could pass, and for a model or
/// a command that is not finite.
template <class Model>
std::vector<Commands<typename Model::Scalar>> golden_commands(
    const Model& model, const std::vector<typename Model::FeatureVector>& golden) {
  if (golden.empty()) throw std::invalid_argument("export: a model needs at least one golden vector");
  require_finite_model(model);
  std::vector<Commands<typename Model::Scalar>> commands;
  for (const auto& x : golden) {
    if (!inside_envelope(model.envelope_lower.data(), x.data(), model.envelope_upper.data(), x.size())) {
      throw std::invalid_argument("export: golden vector " + std::to_string(commands.size() + 1) +
                                  " lies outside the envelope");
    }
    commands.push_back(model.predict(x));
    require_finite(commands.back(), "the commands of golden vector " + std::to_string(commands.size()));
  }
  return commands;
}

/// The records of a trained model; of one with a certificate what is proven is among them. Throws std::invalid_argument where
/// nothing is proven of a model that has the structure.
template <class Model>
WrittenRecords records_of_training(const Model& model, Provenance provenance) {
  const Airframe<double> airframe = model.template airframe<double>();
  if constexpr (has_certificate<Model>) {
    const Certificate certificate = certificate_of_trained(model);
    if (!certificate.proven()) {
      throw std::invalid_argument("export: " + std::string(certificate.bounded
                                                               ? "a slope of the model is not above its floor"
                                                               : "the bounds of the residual are none"));
    }
    provenance.slope_signs = motor_torque_signs(airframe);
    ResidualRange range;
    using Scalar = typename Model::Scalar;
    const auto outward = [](double bound, double to) {  // as the model's Scalar holds it
      const auto rounded = static_cast<Scalar>(bound);
      return std::abs(bound) > 0 ? static_cast<double>(std::nextafter(rounded, static_cast<Scalar>(to))) : 0.0;
    };
    for (const double bound : certificate.residual_lower) range.lower.push_back(outward(bound, -1e30));
    for (const double bound : certificate.residual_upper) range.upper.push_back(outward(bound, 1e30));
    provenance.residual_range = range;
  }
  return records_of_training<typename Model::Network, typename Model::Features, typename Model::Outputs>(provenance,
                                                                                                         airframe);
}

}  // namespace detail

/// Writes `struct <struct_name>` to `out`. `golden` are feature vectors inside the envelope, at least one; their
/// commands are computed here by the portable kernel. The contract of what is written: exported/model.hpp; no locale plays
/// a part. A GivenAirframe stands before the
/// model as a struct of its own. A model that is worse than the mean says so at its head. Throws std::invalid_argument, and writes nothing, for a
/// name that no struct may have, for no golden vector, for one outside the envelope, for a number that is not finite, for terms that no model has (deploy/provenance.hpp), and for a model of proven structure that has no certificate.
template <class NetworkType, class ContextType>
void write_model(std::ostream& stream, const std::string& struct_name,
                 const TrainedModel<NetworkType, ContextType>& model,
                 const std::vector<typename TrainedModel<NetworkType, ContextType>::FeatureVector>& golden,
                 const Provenance& provenance) {
  using Model = TrainedModel<NetworkType, ContextType>;
  using Scalar = typename Model::Scalar;
  if (!is_identifier(struct_name)) throw std::invalid_argument("export: '" + struct_name + "' is not a C++ identifier");
  const auto golden_commands = detail::golden_commands(model, golden);
  const auto records = detail::records_of_training(model, provenance);
  constexpr bool own_airframe = std::is_same_v<typename Model::Vehicle, GivenAirframe>;
  const std::string vehicle_name = model.airframe_name();
  std::ostringstream out;
  out.imbue(std::locale::classic());  // a global locale may group digits

  const std::string scalar = type_name<Scalar>();
  detail::ConstantWriter write(out);

  out << "// Inverse-dynamics model, exported by pinnquad " << PINNQUAD_VERSION
      << ". Generated: export again rather than edit.\n"
      << "// SI units, rad. Commands in the order of the airframe's rotors.\n";
  if (provenance.verdict && provenance.verdict->worse_than_mean()) {
    out << "// NOT FOR FLIGHT: on rows that it was not trained on this model is worse than the mean of the commands.\n";
  }
  out << "#pragma once\n\n#include \"pinnquad/flight.hpp\"\n\n";
  std::string vehicle;
  if constexpr (own_airframe) {
    vehicle = struct_name + "Airframe";
    write_airframe(out, vehicle, vehicle_name, model.template airframe<double>());
    out << '\n';
  } else {
    vehicle = type_name<typename Model::Vehicle>();
  }
  out << "struct " << struct_name << " {\n"
      << "  using Scalar = " << scalar << ";\n"
      << "  using Network = " << type_name<NetworkType>() << ";\n"
      << "  using Features = " << type_name<typename Model::Features>() << ";\n"
      << "  using Outputs = " << type_name<typename Model::Outputs>() << ";\n"
      << "  using Vehicle = " << vehicle << ";\n"
      << "  using Inputs = Features::Inputs<Scalar>;\n\n";
  write.number("format_version", model_format_version);
  write.text("name", struct_name);
  out << "\n  // provenance\n";
  write.text("training_data", provenance.training_data);
  write.constant("std::uint64_t", "training_data_hash", hexadecimal(provenance.training_data_hash),
                 provenance.training_data_hash);
  write.constant("int", "training_rows", std::to_string(provenance.training_rows),
                 static_cast<int>(provenance.training_rows));
  out << "  static constexpr std::uint64_t seed = " << provenance.seed << "u;\n";
  write.number("epochs", provenance.epochs);
  write.text("loss", provenance.loss);
  if (provenance.verdict) {
    const Verdict& verdict = *provenance.verdict;
    const auto figure = [&](const char* name, double value) {
      constexpr double digits = 1e6;  // as far as sums over the test rows are the same on every machine
      const double rounded = std::abs(value) < digits ? std::round(value * digits) / digits : value;
      if (is_finite(value)) write.number(name, rounded);
    };
    out << "\n  // how it was judged, on rows that it was not trained on: R^2, mean over the commands\n";
    figure("test_r_squared", verdict.test_r_squared);
    figure("linear_regression_r_squared", verdict.linear_regression_r_squared);
    write.truth("worse_than_mean", verdict.worse_than_mean());
    write.truth("beats_linear_regression", verdict.beats_linear_regression());
  }
  out << "\n  // what it was trained for; require_model() compares with Features, Outputs and Vehicle\n";
  write.text("frame", model_frame);
  write.list("const char*", "feature_names", Model::Features::names);
  write.list("const char*", "feature_units", Model::Features::units);
  write.list("const char*", "output_names", OutputMap<typename Model::Outputs>::names);
  write.list("const char*", "output_units", OutputMap<typename Model::Outputs>::units);
  write.text("vehicle_name", vehicle_name);
  out << "  // rotor by rotor: signs of its torque about x, y, z\n";
  write.table("int", "motor_torque_signs", motor_torque_signs(model.template airframe<double>()));
  detail::write_header_records<Scalar>(out, write, records);
  out << "\n  // standardisation: (value - mean) / spread\n";
  write.scaler(scalar, "input", model.input);
  write.scaler(scalar, "output", model.output);
  out << "\n  // training envelope per feature, margin included\n";
  write.list(scalar, "envelope_lower", model.envelope_lower);
  write.list(scalar, "envelope_upper", model.envelope_upper);

  out << "\n  // golden vectors: features in physical units -> commands\n";
  write.table(scalar, "golden_features", golden);
  write.table(scalar, "golden_commands", golden_commands);

  out << "\n  // layer by layer: weights row-major (row = output, column = input), then biases\n";
  write.list(scalar, "parameters", model.network.parameters);
  write.count("Vehicle", model.template airframe<double>());
  out << "\n  // over all of this: what was edited does not compile (exported/contents_hash.hpp)\n"
      << "  static constexpr std::uint64_t contents_hash = " << hexadecimal(write.contents_hash()) << ";\n";
  out << "};\n\nstatic_assert(pinnquad::require_model<" << struct_name << ">());\n";
  if constexpr (has_certificate<Model>) {
    out << "static_assert(pinnquad::require_certificate<" << struct_name << ">());  // docs/certificate.md\n";
  }
  stream << out.str();
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
