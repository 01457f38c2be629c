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

template <class Value>
using ElementOf = decltype(*std::declval<const Value&>().begin());

/// Adds a value of a header; a text as it is printed.
template <class Value>
void add_value(ConstantHash& hash, const Value& value) {
  if constexpr (std::is_convertible_v<Value, std::string_view>) {
    hash.add(std::string_view(printable(std::string(value))));
  } else if constexpr (is_detected<ElementOf, Value>) {
    for (const auto& one : value) add_value(hash, one);
  } else {
    hash.add(value);
  }
}

template <class Scalar>
std::uint64_t hash_of_header(const WrittenModel<Scalar>& model) {
  const NamesAndUnits features = names_and_units(model.feature_texts, 0),
                      outputs = names_and_units(model.output_texts, 1);  // behind the schema's description
  const ModelFacts& facts = model.facts;
  std::uint64_t sum = 0;
  const auto add = [&sum](std::string_view name, const auto&... values) {
    ConstantHash hash(name);
    (add_value(hash, values), ...);
    sum += hash.value();
  };
  add("format_version", contents_hash_version);
  add("training_data_hash", model.training_data_hash);
  add("training_rows", static_cast<int>(model.training_rows));
  if (facts.has_verdict) {
    add("worse_than_mean", facts.worse_than_mean);
    add("beats_linear_regression", facts.beats_linear_regression);
  }
  add("frame", model_frame);
  add("feature_names", features.names);
  add("feature_units", features.units);
  add("output_names", outputs.names);
  add("output_units", outputs.units);
  add("vehicle_name", model.vehicle_name);
  add("motor_torque_signs", motor_torque_signs(model.airframe));
  add("Vehicle", model.airframe);
  add("records", known_records);
  add("answer", model.answer);
  add("command_meaning", facts.command_meaning);
  add("command_lower", facts.command_lower);
  add("command_upper", facts.command_upper);
  add("sample_period_s", facts.sample_period_s);
  add("lag_removed_s", facts.lag_removed_s);
  add("window_taps", static_cast<int>(model.window_taps));
  add("causal", model.causal);
  add("column_names", model.column_names);
  add("column_units", model.column_units);
  add("allocation", model.allocation);
  add("base", model.base);
  add("input", model.input_mean, model.input_deviation);
  add("output", model.output_mean, model.output_deviation);
  add("envelope_lower", model.envelope_lower);
  add("envelope_upper", model.envelope_upper);
  add("golden_features", model.golden_features);
  add("golden_commands", model.golden_commands);
  add("parameters", model.parameters);
  return sum;
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
template std::uint64_t hash_of_header(const WrittenModel<float>&);
template std::uint64_t hash_of_header(const WrittenModel<double>&);
template void require_numbers(const WrittenModel<float>&);
template void require_numbers(const WrittenModel<double>&);
template WrittenModel<float> written_model(const GroundModel<float>&, const std::vector<std::vector<double>>&,
                                           const Provenance&, const std::string&);
template WrittenModel<double> written_model(const GroundModel<double>&, const std::vector<std::vector<double>>&,
                                            const Provenance&, const std::string&);
#endif

}  // namespace detail
}  // namespace pinnquad
