// SPDX-License-Identifier: MIT
#include "convert/converted_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <type_traits>

#include "pinnquad/core/random.hpp"
#include "pinnquad/exported/run_time_features.hpp"
#include "pinnquad/exported/run_time_network.hpp"
#include "pinnquad/exported/run_time_outputs.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {
namespace {

using namespace pinnquad;

/// The library's feature sets without a window or a column.
using FeatureSets = std::tuple<PaperFeatures, PaperFeaturesWithAltitude, AccelerationFeatures, PhysicsFeatures,
                               PhysicsFeaturesWithoutVelocity, InverseFeatures, InverseFeaturesWithAltitude,
                               InverseFeaturesWithoutVelocity, InverseAccelerations>;

/// The model's features: places of the file's in the model's order, and the type that has them so.
struct FeatureOrder {
  std::vector<std::size_t> of_file;
  std::string type, own_types;
};

std::size_t place_of(const std::vector<std::string>& names, const std::string& name) {
  return std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
}

template <class Set>
bool take_set(const std::vector<std::string>& names, FeatureOrder& order) {
  if (names.size() != std::size_t(Set::size)) return false;
  order.of_file.clear();
  for (const char* name : Set::names) {
    const std::size_t place = place_of(names, name);
    if (place == names.size()) return false;
    order.of_file.push_back(place);
  }
  order.type = type_name<Set>();
  return true;
}
template <class... Set>
bool take_set(const std::vector<std::string>& names, FeatureOrder& order, const std::tuple<Set...>*) {
  return (take_set<Set>(names, order) || ...);
}

/// Features of the motion in the library's order, measured columns behind them.
FeatureOrder feature_order(const ForeignMeaning& meaning, const std::string& model) {
  using Named = NamedFeaturesWithAltitude;
  FeatureOrder order;
  std::vector<std::string> motion, columns;
  for (const ForeignFeature& feature : meaning.features) {
    (feature.is_column ? columns : motion).push_back(feature.name);
  }
  if (motion.empty()) throw InputError(meaning.path, 0, 0, "a feature of the motion", "measured columns alone");
  if (!take_set(motion, order, static_cast<const FeatureSets*>(nullptr))) {
    order.of_file.clear();
    std::string places;
    bool altitude = false;
    for (std::size_t i = 0; i < std::size_t(Named::size); ++i) {
      if (place_of(motion, Named::names[i]) == motion.size()) continue;
      order.of_file.push_back(place_of(motion, Named::names[i]));
      places += ", " + std::to_string(i);
      altitude = altitude || i == std::size_t(NamedFeatures::size);
    }
    order.type =
        "pinnquad::Chosen<pinnquad::NamedFeatures" + std::string(altitude ? "WithAltitude" : "") + places + ">";
  }
  // places among the features of the motion become those among all of the file's
  std::vector<std::size_t> all;
  for (const std::size_t place : order.of_file) {
    all.push_back(std::size_t(std::find_if(meaning.features.begin(), meaning.features.end(),
                                           [&](const ForeignFeature& one) { return one.name == motion[place]; }) -
                              meaning.features.begin()));
  }
  if (order.type.find("Chosen") != std::string::npos) {
    order.own_types = "#include \"pinnquad/features/chosen_features.hpp\"\n\n";
  }
  std::string column_types;
  for (std::size_t i = 0; i < meaning.features.size(); ++i) {
    const ForeignFeature& feature = meaning.features[i];
    if (!feature.is_column) continue;
    const std::string type = model + "Column" + std::to_string(all.size() - motion.size() + 1);
    all.push_back(i);
    column_types += ", " + type;
    order.own_types +=
        "struct " + type + " {\n  static constexpr const char* name = " + pinnquad::detail::quoted(feature.name) +
        ";\n  static constexpr const char* unit = " + pinnquad::detail::quoted(feature.unit) + ";\n};\n\n";
  }
  if (!columns.empty()) order.type = "pinnquad::WithColumns<" + order.type + column_types + ">";
  order.of_file = std::move(all);
  return order;
}

/// y = scale x + shift.
struct Line {
  double scale, shift;
};

/// The scaler of a feature, in the library's unit: the file's, or one by which the envelope has a spread of 1.
template <class Scalar>
struct FeatureScaler {
  Scalar mean, deviation;
  Line to_network;  ///< what the network reads of the standardised feature, in double: nothing is lost to rounding
};
template <class Scalar>
FeatureScaler<Scalar> scaler_of(const ForeignFeature& feature) {
  const double middle = (feature.lower + feature.upper) / 2, spread = (feature.upper - feature.lower) / std::sqrt(12.0);
  const double mean = (feature.is_standardised ? feature.mean : middle) / feature.unit_factor;
  const double deviation = (feature.is_standardised ? feature.scale : spread) / feature.unit_factor;
  FeatureScaler<Scalar> scaler{static_cast<Scalar>(mean), static_cast<Scalar>(deviation), {}};
  // (factor (mean' + deviation' z) - file's mean) / file's scale
  scaler.to_network.scale = feature.unit_factor * static_cast<double>(scaler.deviation) / feature.scale;
  scaler.to_network.shift = (feature.unit_factor * static_cast<double>(scaler.mean) - feature.mean) / feature.scale;
  return scaler;
}

/// The schema of the file: `use(schema)`.
template <class Use>
void with_schema(const ForeignMeaning& meaning, const Use& use) {
  RunTimeOutputs<double> outputs;
  outputs.find(meaning.schema);
  outputs.visit(use);
}

/// Places of the file's outputs in the schema's order.
std::vector<std::size_t> output_order(const ForeignMeaning& meaning) {
  std::vector<std::size_t> of_file;
  with_schema(meaning, [&](auto schema) {
    for (const char* name : OutputMap<decltype(schema)>::names) of_file.push_back(place_of(meaning.outputs, name));
  });
  return of_file;
}

/// Throws InputError where float has no such number.
template <class Scalar>
Scalar narrowed(double number, const ForeignNetwork& network) {
  if (std::is_same_v<Scalar, float> && std::abs(number) > double(std::numeric_limits<float>::max())) {
    throw InputError(network.source, 0, 0, "numbers that float holds (--double holds more)", number_text(number));
  }
  return static_cast<Scalar>(number);
}

/// The layers between the library's standardised features and its outputs: the first is shown what the network was
/// trained on, the last makes the outputs in the schema's order.
std::vector<ForeignLayer> layers_of(const ForeignNetwork& network, const ForeignMeaning& meaning,
                                    const std::vector<std::size_t>& of_file, const std::vector<Line>& to_network,
                                    const std::vector<std::size_t>& outputs_of_file) {
  std::vector<ForeignLayer> layers = network.layers;
  ForeignLayer& first = layers.front();
  const Numbers weights = first.weights;
  for (std::size_t row = 0; row < first.outputs(); ++row) {
    for (std::size_t own = 0; own < network.inputs; ++own) {
      const double weight = weights[row * network.inputs + of_file[own]];
      first.weights[row * network.inputs + own] = weight * to_network[own].scale;
      first.bias[row] += weight * to_network[own].shift;
    }
  }
  ForeignLayer& last = layers.back();
  const ForeignLayer made = last;
  for (std::size_t own = 0; own < network.outputs; ++own) {
    const std::size_t place = outputs_of_file[own], width = made.inputs();
    for (std::size_t k = 0; k < width; ++k) {
      last.weights[own * width + k] = made.weights[place * width + k] * meaning.output_scale[place];
    }
    last.bias[own] = made.bias[place] * meaning.output_scale[place] + meaning.output_mean[place];
  }
  return layers;
}

/// The names of the layers, in a block's description ("Inputs") or as a header's type ("InputSize").
template <class Scalar>
std::string network_text(const char* inputs_word, std::size_t inputs, const std::vector<ForeignLayer>& layers) {
  std::string text =
      "pinnquad::Network<" + type_name<Scalar>() + ", pinnquad::" + inputs_word + "<" + std::to_string(inputs) + ">";
  for (const ForeignLayer& layer : layers) {
    const std::string name = layer.activation.empty() ? "pinnquad::Dense" : counted_layer(layer.activation);
    text +=
        ", " + (name.empty() ? activation_layer(layer.activation) : name + "<" + std::to_string(layer.outputs()) + ">");
  }
  return text + ">";
}

/// The source's commands for a row, of its answer.
class SourceCommands {
 public:
  explicit SourceCommands(const ForeignMeaning& meaning) : meaning_(meaning), of_file_(output_order(meaning)) {
    schema_.find(meaning.schema);
    schema_.prepare(meaning.airframe.value);
  }

  Commands<double> operator()(const Numbers& answer, const Numbers& features) const {
    Numbers outputs;
    for (const std::size_t place : of_file_) {
      outputs.push_back(answer[place] * meaning_.output_scale[place] + meaning_.output_mean[place]);
    }
    Commands<double> u{};
    schema_.commands(features.data(), outputs.data(), u.data());
    return u;
  }

 private:
  const ForeignMeaning& meaning_;
  std::vector<std::size_t> of_file_;
  RunTimeOutputs<double> schema_;
};

constexpr std::size_t golden_rows = 8, compared_rows = 1000;

}  // namespace

template <class Scalar>
AskedRows asked_rows(const ForeignMeaning& meaning) {
  AskedRows rows;
  std::mt19937_64 engine(1);
  const std::vector<std::size_t> of_file = feature_order(meaning, "").of_file;
  for (std::size_t i = 0; i < golden_rows + compared_rows; ++i) {
    Numbers& own = rows.features.emplace_back();
    Numbers& shown = rows.of_network.emplace_back(of_file.size());
    for (const std::size_t place : of_file) {
      const ForeignFeature& feature = meaning.features[place];
      const double lower = feature.lower / feature.unit_factor, upper = feature.upper / feature.unit_factor;
      const double drawn = i == 0 ? (lower + upper) / 2 : uniform(engine, lower, upper);
      const auto value = std::clamp(static_cast<Scalar>(drawn), static_cast<Scalar>(lower), static_cast<Scalar>(upper));
      own.push_back(static_cast<double>(value));
      shown[place] = (feature.unit_factor * own.back() - feature.mean) / feature.scale;
    }
  }
  return rows;
}

template <class Scalar>
pinnquad::detail::WrittenModel<Scalar> converted_model(const ForeignNetwork& network, const ForeignMeaning& meaning,
                                                       const AskedRows& rows, const std::string& name) {
  const FeatureOrder order = feature_order(meaning, name);
  pinnquad::detail::WrittenModel<Scalar> model;
  std::vector<Line> to_network;
  std::vector<std::string> columns;
  for (const std::size_t place : order.of_file) {
    const ForeignFeature& feature = meaning.features[place];
    const FeatureScaler<Scalar> scaler = scaler_of<Scalar>(feature);
    model.input_mean.push_back(scaler.mean);
    model.input_deviation.push_back(scaler.deviation);
    model.envelope_lower.push_back(static_cast<Scalar>(feature.lower / feature.unit_factor));
    model.envelope_upper.push_back(static_cast<Scalar>(feature.upper / feature.unit_factor));
    to_network.push_back(scaler.to_network);
    pinnquad::detail::append_texts(model.feature_texts, std::array{feature.name}, std::array{feature.unit});
    if (!feature.is_column) continue;
    model.column_names.push_back(feature.name);
    model.column_units.push_back(feature.unit);
  }
  const std::vector<ForeignLayer> layers =
      layers_of(network, meaning, order.of_file, to_network, output_order(meaning));
  for (const ForeignLayer& layer : layers) {
    for (const Numbers* numbers : {&layer.weights, &layer.bias}) {
      for (const double number : *numbers) model.parameters.push_back(narrowed<Scalar>(number, network));
    }
  }
  model.output_mean.assign(network.outputs, Scalar(0));
  model.output_deviation.assign(network.outputs, Scalar(1));
  const SourceCommands source(meaning);
  for (std::size_t row = 0; row < golden_rows; ++row) {
    const Numbers& x = rows.features[row];
    auto& golden = model.golden_features.emplace_back();
    for (const double value : x) golden.push_back(static_cast<Scalar>(value));
    const Commands<double> u = source(network.answers[row], x);
    auto& commands = model.golden_commands.emplace_back();
    for (std::size_t i = 0; i < u.size(); ++i) commands[i] = narrowed<Scalar>(u[i], network);
  }

  model.name = name;
  model.answer = network_text<Scalar>("Inputs", network.inputs, layers);
  model.network_type = network_text<Scalar>("InputSize", network.inputs, layers);
  model.features_type = order.type;
  model.own_types = order.own_types;
  with_schema(meaning, [&](auto schema) {
    using Map = OutputMap<decltype(schema)>;
    model.outputs_type = type_name<decltype(schema)>();
    model.output_texts = {pinnquad::detail::description_text<decltype(schema)>()};
    pinnquad::detail::append_texts(model.output_texts, Map::names, Map::units);
    pinnquad::detail::take_airframe<decltype(schema)>(model, meaning.airframe.name, meaning.airframe.value,
                                                      airframe_in<Scalar>(meaning.airframe.value));
  });
  model.facts.command_meaning = meaning.command_meaning.value_or(command_meaning_of(meaning.airframe.value));
  model.facts.sample_period_s = meaning.sample_period_s;
  model.training_data = network.source;
  model.loss = "not known: converted";
  RunTimeNetwork read;
  if (!read.parse(model.answer)) {
    throw std::invalid_argument(network.source + ": expected a network of at most " +
                                std::to_string(RunTimeNetwork::Part::most_layers) + " layers, each of at most " +
                                std::to_string(RunTimeNetwork::widest_layer) + " neurons, found " + model.answer);
  }
  pinnquad::detail::require_numbers(model);
  return model;
}

template AskedRows asked_rows<float>(const ForeignMeaning&);
template AskedRows asked_rows<double>(const ForeignMeaning&);
template pinnquad::detail::WrittenModel<float> converted_model(const ForeignNetwork&, const ForeignMeaning&,
                                                               const AskedRows&, const std::string&);
template pinnquad::detail::WrittenModel<double> converted_model(const ForeignNetwork&, const ForeignMeaning&,
                                                                const AskedRows&, const std::string&);

double largest_difference(const BlockModel& model, const ForeignNetwork& network, const ForeignMeaning& meaning,
                          const AskedRows& rows) {
  Commands<double> most{}, scale{1, 1, 1, 1};
  const SourceCommands source(meaning);
  for (std::size_t row = 0; row < rows.features.size(); ++row) {
    const Commands<double> own = model.commands(rows.features[row]),
                           said = source(network.answers[row], rows.features[row]);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const double difference = std::abs(own[i] - said[i]);
      if (!(difference <= most[i])) most[i] = difference;  // NaN stays
      scale[i] = std::max(scale[i], std::abs(said[i]));
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < most.size(); ++i) {
    if (!(most[i] / scale[i] <= largest)) largest = most[i] / scale[i];
  }
  return largest;
}

}  // namespace programs
