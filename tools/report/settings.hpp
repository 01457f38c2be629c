// SPDX-License-Identifier: MIT
// study.json: how a study was made. A report shows what stands in it and needs none of it but that it is JSON.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "logs/json_file.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "report/columns.hpp"

namespace programs {

/// Keys that a report reads, all optional: `flights` (list of {name, seed}: the first of each name is Table 2's),
/// `flight_seed` (that of Table 2's flights), `seeds` (how many, or which), `models` (numbers, or objects with `id` and
/// rows of the split), `weights` ("final" or "best": which are judged), `epochs` (of every network), `recipe`
/// (lambda_max, cycles, hold), `kind`.
struct StudySettings {
  nlohmann::json all;
  std::vector<StudyFlight> flights;
  std::string weights = "final";
  std::size_t seeds = 0;              ///< each network should have; 0 if not said
  std::uint64_t epochs = 0;           ///< of every network's training; 0 if not said
  std::vector<int> models;            ///< that should be there; empty if not said: all
  std::map<int, std::string> splits;  ///< rows to train, validate, test
  pinnquad::CyclicalAnnealing annealing;

  bool plans(int model) const {
    return models.empty() || std::find(models.begin(), models.end(), model) != models.end();
  }
  bool plans(const StudyFlight& flight) const {
    return flights.empty() || std::find(flights.begin(), flights.end(), flight) != flights.end();
  }
};

namespace detail {

/// A model of the plan: its number, or an object with `id` and perhaps the rows of its split.
inline void read_planned_model(const nlohmann::json& model, StudySettings& settings) {
  const nlohmann::json id = model.is_object() ? model.value("id", nlohmann::json()) : model;
  int number = id.is_number_integer() ? id.get<int>() : 0;
  if (id.is_string()) {
    const auto text = id.get<std::string>();
    std::from_chars(text.data(), text.data() + text.size(), number);
  }
  if (number < 1 || number > study_models) return;
  settings.models.push_back(number);
  if (!model.is_object()) return;
  std::string split;
  for (const char* key : {"train_rows", "validation_rows", "test_rows"}) {
    if (!model.contains(key) || !model[key].is_number_unsigned()) return;
    const auto rows = model[key].get<std::uint64_t>();
    split += (split.empty() ? "" : " / ") + (rows > 0 ? std::to_string(rows) : "–");
  }
  settings.splits[number] = split;
}

}  // namespace detail

/// Throws InputError with line and column where the file is no JSON object; where it is that of another kind of study.
inline StudySettings read_study_settings(const std::string& path) {
  StudySettings settings;
  settings.all = pinnquad::logs::read_json_file(path);
  if (!settings.all.is_object()) throw pinnquad::InputError(path, 1, 1, "a JSON object", settings.all.type_name());
  const auto find = [&](const char* key) { return settings.all.value(key, nlohmann::json()); };
  if (find("kind").is_string() && find("kind") != "table 2") {
    throw pinnquad::InputError(path, 0, 0, "a study of Table 2",
                               "one of kind " + pinnquad::quoted_cell(find("kind").get<std::string>()));
  }
  for (const nlohmann::json& flight : find("flights")) {
    if (!flight.is_object() || !flight.contains("name") || !flight["name"].is_string()) continue;
    if (!flight.contains("seed") || !flight["seed"].is_number_unsigned()) continue;
    settings.flights.push_back({flight["name"].get<std::string>(), flight["seed"].get<std::uint64_t>()});
  }
  if (find("weights") == "best") settings.weights = "best";
  const nlohmann::json seeds = find("seeds");
  if (seeds.is_array()) settings.seeds = seeds.size();
  if (seeds.is_number_unsigned()) settings.seeds = seeds.get<std::size_t>();
  if (find("epochs").is_number_unsigned()) settings.epochs = find("epochs").get<std::uint64_t>();
  for (const nlohmann::json& model : find("models")) detail::read_planned_model(model, settings);
  if (find("flight_seed").is_number_unsigned()) {
    const auto seed = find("flight_seed").get<std::uint64_t>();
    std::stable_partition(settings.flights.begin(), settings.flights.end(),
                          [seed](const StudyFlight& flight) { return flight.seed == seed; });
  }
  const nlohmann::json recipe = find("recipe");
  if (recipe.is_object()) {
    const auto number = [&](const char* key, double least, double most, double otherwise) {
      const double value = recipe.contains(key) && recipe[key].is_number() ? recipe[key].get<double>() : otherwise;
      return value >= least && value <= most ? value : otherwise;
    };
    pinnquad::CyclicalAnnealing& annealing = settings.annealing;
    annealing.maximum = number("lambda_max", 1e-9, 1e9, annealing.maximum);
    annealing.cycles = static_cast<int>(number("cycles", 1, 1e6, annealing.cycles));
    annealing.hold = number("hold", 0, 1, annealing.hold);
  }
  return settings;
}

namespace detail {

inline std::string json_text(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "–";
  const bool flat = value.is_array() &&
                    std::all_of(value.begin(), value.end(), [](const nlohmann::json& v) { return v.is_primitive(); });
  if (!flat) return value.dump();
  return listed(value, [](const nlohmann::json& item) { return json_text(item); });
}

inline std::string key_text(std::string key) {
  std::replace(key.begin(), key.end(), '_', ' ');
  return key;
}

/// A list of objects as a table with the keys of all of them.
inline nlohmann::json objects_table(const std::string& name, const nlohmann::json& list) {
  std::vector<std::string> keys;
  for (const nlohmann::json& object : list) {
    for (const auto& item : object.items()) {
      if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) keys.push_back(item.key());
    }
  }
  // what names an object stands first
  std::stable_partition(keys.begin(), keys.end(), [](const std::string& key) { return key == "seed"; });
  std::stable_partition(keys.begin(), keys.end(),
                        [](const std::string& key) { return key == "name" || key == "model"; });
  nlohmann::json head = nlohmann::json::array(), rows = nlohmann::json::array();
  for (const std::string& key : keys) {
    const bool number = std::all_of(list.begin(), list.end(), [&](const nlohmann::json& object) {
      return !object.contains(key) || object[key].is_number();
    });
    head.push_back({{"text", key_text(key)}, {"number", number}});
  }
  for (const nlohmann::json& object : list) {
    nlohmann::json cells = nlohmann::json::array();
    for (std::size_t i = 0; i < keys.size(); ++i) {
      cells.push_back(
          {{"text", object.contains(keys[i]) ? json_text(object[keys[i]]) : ""}, {"number", head[i]["number"]}});
    }
    rows.push_back({{"cells", cells}});
  }
  return {{"name", key_text(name)}, {"head", head}, {"rows", rows}};
}

inline bool lists_objects(const nlohmann::json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const nlohmann::json& v) { return v.is_object(); });
}

/// Names and values of an object, nested ones in lines of their own.
inline void add_values(const nlohmann::json& object, const std::string& prefix, nlohmann::json& values) {
  for (const auto& item : object.items()) {
    const std::string name = prefix + key_text(item.key());
    if (item.value().is_object()) {
      add_values(item.value(), name + " › ", values);
    } else if (!lists_objects(item.value())) {
      values.push_back({{"name", name}, {"value", json_text(item.value())}});
    }
  }
}

}  // namespace detail

/// Everything in study.json: lists of objects as tables, the rest as names and values.
inline nlohmann::json settings_tables(const StudySettings& settings) {
  nlohmann::json values = nlohmann::json::array(), lists = nlohmann::json::array();
  detail::add_values(settings.all, "", values);
  for (const auto& item : settings.all.items()) {
    if (detail::lists_objects(item.value())) lists.push_back(detail::objects_table(item.key(), item.value()));
  }
  return {{"values", values}, {"lists", lists}};
}

}  // namespace programs
