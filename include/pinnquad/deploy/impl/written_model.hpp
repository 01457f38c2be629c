// SPDX-License-Identifier: MIT
// Bodies of written_model.hpp.
#pragma once

#include "pinnquad/deploy/written_model.hpp"

namespace pinnquad {
namespace detail {

PINNQUAD_BODY NamesAndUnits names_and_units(const std::vector<std::string>& texts, std::size_t first) {
  NamesAndUnits apart;
  for (std::size_t i = first; i + 1 < texts.size(); i += 2) {
    apart.names.push_back(texts[i]);
    apart.units.push_back(texts[i + 1]);
  }
  return apart;
}

PINNQUAD_BODY std::uint64_t hash_of_shape(const WrittenRecords& model) {
  const NamesAndUnits features = names_and_units(model.feature_texts, 0),
                      outputs = names_and_units(model.output_texts, 1);
  Fnv1a fnv;
  fnv.absorb_text(model.answer);
  const auto at = [](const NamesAndUnits& of) {
    return [&of](std::size_t i) { return NameAndUnit{of.names[i], of.units[i]}; };
  };
  absorb_shape(fnv, features.names.size(), at(features), outputs.names.size(), at(outputs), model.vehicle_name,
               motor_torque_signs(model.airframe));
  return fnv.hash;
}

template <class Scalar>
void require_numbers(const WrittenModel<Scalar>& model) {
  require_finite(model.parameters, "the parameters");
  require_finite(model.input_mean, "the input means");
  require_finite(model.input_deviation, "the input standard deviations");
  require_finite(model.output_mean, "the output means");
  require_finite(model.output_deviation, "the output standard deviations");
  require_finite(model.envelope_lower, "the lower envelope");
  require_finite(model.envelope_upper, "the upper envelope");
  if (model.golden_features.empty()) throw std::invalid_argument("export: a model needs at least one golden vector");
  for (std::size_t i = 0; i < model.golden_features.size(); ++i) {
    const std::vector<Scalar>& x = model.golden_features[i];
    if (!inside_envelope(model.envelope_lower.data(), x.data(), model.envelope_upper.data(), x.size())) {
      throw std::invalid_argument("export: golden vector " + std::to_string(i + 1) + " lies outside the envelope");
    }
    require_finite(model.golden_commands[i], "the commands of golden vector " + std::to_string(i + 1));
  }
}

template <class Scalar>
WrittenModel<Scalar> written_model(const GroundModel<Scalar>& model, const std::vector<std::vector<double>>& golden,
                                   const Provenance& provenance, const std::string& name) {
  WrittenModel<Scalar> written = model.written;
  for (const std::vector<double>& x : golden) {
    written.golden_features.emplace_back();
    for (const double number : x) written.golden_features.back().push_back(static_cast<Scalar>(number));
    const Commands<double> commands = model.predict(x.data());
    written.golden_commands.emplace_back();
    for (std::size_t i = 0; i < commands.size(); ++i) {
      written.golden_commands.back()[i] = static_cast<Scalar>(commands[i]);
    }
  }
  require_numbers(written);
  take_provenance(written, provenance, model.window_s);
  written.name = name;
  return written;
}

#ifdef PINNQUAD_COMPILED
template void require_numbers(const WrittenModel<float>&);
template void require_numbers(const WrittenModel<double>&);
template WrittenModel<float> written_model(const GroundModel<float>&, const std::vector<std::vector<double>>&,
                                           const Provenance&, const std::string&);
template WrittenModel<double> written_model(const GroundModel<double>&, const std::vector<std::vector<double>>&,
                                            const Provenance&, const std::string&);
#endif

}  // namespace detail
}  // namespace pinnquad
