// SPDX-License-Identifier: MIT
#include "convert/features_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "command_line/listed.hpp"
#include "logs/toml_table.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/run_time_activation.hpp"
#include "pinnquad/exported/run_time_features.hpp"
#include "pinnquad/exported/run_time_outputs.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {
namespace {

using namespace pinnquad;
using logs::TomlTable;

constexpr const char* key_of_file = "a key of a features file (docs/convert.md)";

/// Units that a file may say in place of the library's.
struct OtherUnit {
  const char* said;
  const char* own;
  double factor;  ///< a number in it is the library's times this
};
constexpr double degrees = 57.295779513082321;
constexpr std::array<OtherUnit, 4> other_units = {{{"deg", "rad", degrees},
                                                   {"deg/s", "rad/s", degrees},
                                                   {"deg/s^2", "rad/s^2", degrees},
                                                   {"g", "m/s^2", 1 / standard_gravity_m_s2<double>}}};

/// The unit of a feature of the library; empty for any other name.
std::string own_unit(const std::string& name) {
  using Named = NamedFeaturesWithAltitude;
  for (std::size_t i = 0; i < Named::names.size(); ++i) {
    if (name == Named::names[i]) return Named::units[i];
  }
  return {};
}

ForeignFeature feature_of(const std::string& path, const toml::table& table) {
  TomlTable keys(path, table, "a key of a feature: name, unit, lower, upper, mean, scale");
  ForeignFeature feature{};
  feature.name = keys.line("name");
  const toml::node& name = keys.required("name", "");
  if (feature.name.find('[') != std::string::npos) {
    keys.refuse(name, "a feature of the present instant", "\"" + feature.name + "\", of another instant of a window");
  }
  feature.unit = keys.line("unit");
  feature.unit_factor = 1;
  const std::string own = own_unit(feature.name);
  feature.is_column = own.empty();
  if (!own.empty() && feature.unit != own) {
    const toml::node& unit = keys.required("unit", "");
    const auto* other = std::find_if(other_units.begin(), other_units.end(),
                                     [&](const OtherUnit& one) { return one.own == own && one.said == feature.unit; });
    if (other == other_units.end()) {
      std::string expected = "the unit of " + feature.name + ", " + own;
      for (const OtherUnit& one : other_units) {
        if (one.own == own) expected += std::string(" or ") + one.said;
      }
      keys.refuse(unit, expected, logs::described(unit));
    }
    feature.unit = own;
    feature.unit_factor = other->factor;
  }
  feature.lower = keys.number("lower", logs::of_either_sign);
  feature.upper = keys.number("upper", logs::of_either_sign);
  if (!(static_cast<float>(feature.lower) < static_cast<float>(feature.upper))) {
    const toml::node& node = keys.required("upper", "a number");
    keys.refuse(node, "a value above `lower`, " + number_text(feature.lower), logs::described(node));
  }
  feature.is_standardised = keys.optional("mean") != nullptr || keys.optional("scale") != nullptr;
  feature.mean = keys.number("mean", logs::of_either_sign, 0);
  feature.scale = keys.number("scale", {1e-9, logs::largest_number, "a value from 1e-9 to 1e9"}, 1);
  if (feature.is_standardised) {
    const double centre = feature.mean, reach = pinnquad::detail::furthest_deviations * feature.scale;
    if (!(centre - feature.lower <= reach && feature.upper - centre <= reach)) {
      keys.refuse(*keys.optional(keys.optional("scale") ? "scale" : "mean"),
                  "a mean and a scale by which the envelope lies within 131072 of 0", "others");
    }
  }
  keys.require_no_more();
  return feature;
}

/// A list of texts. Throws for anything else.
std::vector<std::string> texts_of(const TomlTable& table, const toml::node& node, const std::string& expected) {
  const toml::array* list = node.as_array();
  if (!list || list->empty()) table.refuse(node, expected, logs::described(node));
  std::vector<std::string> texts;
  for (const toml::node& one : *list) texts.push_back(table.as_text(one, expected));
  return texts;
}

/// One number per output.
void take_numbers(TomlTable& table, const char* key, std::size_t count, const logs::NumberRange& range,
                  Numbers& numbers) {
  const toml::node* node = table.optional(key);
  if (!node) return;
  const toml::array* list = node->as_array();
  if (!list || list->size() != count) {
    table.refuse(*node, "an array of " + std::to_string(count) + " numbers, one per output", logs::described(*node));
  }
  for (std::size_t i = 0; i < count; ++i) numbers[i] = table.as_number((*list)[i], range);
}

/// Finds the schema that has these outputs, in whatever order.
template <class... Schema>
bool find_schema(const std::vector<std::string>& names, std::string& description, const std::tuple<Schema...>*) {
  const auto take = [&](auto schema) {
    using Map = OutputMap<decltype(schema)>;
    using Base = typename pinnquad::detail::BaseOf<decltype(schema)>::type;
    if (!std::is_same_v<Base, pinnquad::detail::NoBase>) return false;
    std::vector<std::string> own(Map::names.begin(), Map::names.end()), given = names;
    std::sort(own.begin(), own.end());
    std::sort(given.begin(), given.end());
    if (own != given) return false;
    description = pinnquad::detail::description_text<decltype(schema)>();
    return true;
  };
  return (take(Schema{}) || ...);
}

void take_outputs(const std::string& path, TomlTable& root, ForeignMeaning& meaning) {
  constexpr const char* table_expected = "a table [output]";
  meaning.outputs = {"u1", "u2", "u3", "u4"};
  meaning.output_mean.assign(4, 0);
  meaning.output_scale.assign(4, 1);
  meaning.schema = pinnquad::detail::description_text<CommandOutputs>();
  const toml::node* node = root.optional("output");
  if (!node) return;
  if (!node->is_table()) root.refuse(*node, table_expected, logs::described(*node));
  TomlTable table(path, *node->as_table(), "a key of [output]: names, mean, scale");
  if (const toml::node* names = table.optional("names")) {
    const std::string expected =
        "the motor commands [\"u1\", \"u2\", \"u3\", \"u4\"] in the network's order, or the names of another output "
        "schema";
    meaning.outputs = texts_of(table, *names, expected);
    if (!find_schema(meaning.outputs, meaning.schema, static_cast<const RunTimeOutputs<double>::Schemas*>(nullptr))) {
      table.refuse(*names, expected, "[" + listed(meaning.outputs, [](const std::string& name) {
                                       return "\"" + printable(name) + "\"";
                                     }) + "]");
    }
    meaning.output_mean.assign(meaning.outputs.size(), 0);
    meaning.output_scale.assign(meaning.outputs.size(), 1);
  }
  take_numbers(table, "mean", meaning.outputs.size(), logs::of_either_sign, meaning.output_mean);
  take_numbers(table, "scale", meaning.outputs.size(), logs::above_zero, meaning.output_scale);
  table.require_no_more();
}

void take_activations(TomlTable& root, ForeignMeaning& meaning) {
  // those that networks.py makes of the library's, and nothing at all
  std::vector<std::string> words = {"sigmoid", "relu6", "hardtanh", "identity"};
  for (const auto& one : pinnquad::detail::run_time_activations<float>)
    words.push_back(activation_word(one.description));
  const std::string expected =
      "one of " + listed(words, [](const std::string& word) { return "\"" + word + "\""; }) + ", or a list of them";
  const toml::node* node = root.optional("activations");
  if (!node) return;
  const auto take = [&](const toml::node& one) {
    meaning.activations.push_back(root.as_text(one, expected));
    if (std::find(words.begin(), words.end(), meaning.activations.back()) == words.end()) {
      root.refuse(one, expected, logs::described(one));
    }
  };
  if (const toml::array* list = node->as_array()) {
    for (const toml::node& one : *list) take(one);
  } else {
    take(*node);
    meaning.one_activation = true;
  }
}

void take_airframe(const std::string& path, TomlTable& root, ForeignMeaning& meaning) {
  const std::string expected = "a table [airframe] with `name` or `file`";
  const toml::node& node = root.required("airframe", expected);
  if (!node.is_table()) root.refuse(node, expected, logs::described(node));
  TomlTable table(path, *node.as_table(), "a key of [airframe]: name, file");
  const toml::node *name = table.optional("name"), *file = table.optional("file");
  table.require_no_more();
  if ((name == nullptr) == (file == nullptr)) table.refuse(node, "`name` or `file`", name ? "both" : "none of them");
  if (file) {
    const std::filesystem::path of_file = table.line("file");
    meaning.airframe = logs::read_airframe_file((std::filesystem::path(path).parent_path() / of_file).string());
    return;
  }
  const std::string known = table.line("name");
  if (logs::is_airframe_file(known)) table.refuse(*name, "the name of an airframe, or `file`", logs::described(*name));
  try {
    meaning.airframe = logs::chosen_airframe(known);
  } catch (const std::invalid_argument& error) {
    table.refuse(*name, "an airframe that is known", error.what());
  }
}

ForeignMeaning meaning_of(const toml::table& content, const std::string& path) {
  TomlTable root(path, content, key_of_file);
  ForeignMeaning meaning;
  meaning.path = path;
  const std::string expected = "a table [[feature]] for each number that the network reads, in its order";
  const toml::node& features = root.required("feature", expected);
  const toml::array* list = features.as_array();
  if (!list || list->empty() || !list->is_homogeneous<toml::table>()) {
    root.refuse(features, expected, logs::described(features));
  }
  if (list->size() > std::size_t(RunTimeFeatures::most_features)) {
    root.refuse(features, "at most " + std::to_string(RunTimeFeatures::most_features) + " features",
                std::to_string(list->size()));
  }
  std::size_t columns = 0;
  for (const toml::node& one : *list) {
    const ForeignFeature feature = feature_of(path, *one.as_table());
    for (const ForeignFeature& other : meaning.features) {
      if (other.name == feature.name) {
        logs::refuse_toml(path, one.source(), "each feature once", "\"" + feature.name + "\" again");
      }
    }
    columns += feature.is_column ? 1 : 0;
    if (columns > std::size_t(RunTimeFeatures::most_columns)) {
      logs::refuse_toml(path, one.source(), "at most " + std::to_string(RunTimeFeatures::most_columns) + " columns",
                        "\"" + feature.name + "\" beyond them");
    }
    meaning.features.push_back(feature);
  }
  take_outputs(path, root, meaning);
  take_activations(root, meaning);
  if (const toml::node* layers = root.optional("layers")) {
    meaning.layers = texts_of(root, *layers, "the names of the layers in their order, [\"fc1\", \"fc2\"]");
  }
  if (root.optional("commands_are")) {
    std::vector<const char*> words;
    for (std::size_t i = 0; i < command_meaning_count; ++i) words.push_back(to_string(static_cast<CommandMeaning>(i)));
    meaning.command_meaning = root.choice("commands_are", words, CommandMeaning{});
  }
  meaning.sample_period_s =
      root.number("sample_period_s", {0, longest_clock_s, "a value from 0 to 4"}, meaning.sample_period_s);
  take_airframe(path, root, meaning);
  root.require_no_more();
  return meaning;
}

}  // namespace

std::string activation_word(std::string_view layer) {
  std::string word;
  for (const char letter : layer.substr(layer.rfind(':') + 1)) {
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    if (is_capital && !word.empty()) word += '_';
    word += static_cast<char>(is_capital ? letter - 'A' + 'a' : letter);
  }
  return word;
}

std::string activation_layer(const std::string& word) {
  for (const auto& one : pinnquad::detail::run_time_activations<float>) {
    if (activation_word(one.description) == word) return std::string(one.description);
  }
  return {};
}

std::string counted_layer(const std::string& word) {
  if (word == "layer_norm") return "pinnquad::LayerNorm";
  return word == "rms_norm" ? "pinnquad::RmsNorm" : word == "glu" ? "pinnquad::Glu" : "";
}

ForeignMeaning read_features_file(const std::string& path) {
  return meaning_of(logs::read_toml_file(path, "a features file"), path);
}

ForeignMeaning parse_features(const std::string& text, const std::string& path) {
  return meaning_of(logs::parse_toml(text, path), path);
}

}  // namespace programs
