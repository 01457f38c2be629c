// SPDX-License-Identifier: MIT
// study.json: all that decides a study's rows, so that rows of two studies are never mixed; and how long it took.
#pragma once

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/build_facts.hpp"
#include "logs/json_file.hpp"
#include "pinnquad/deploy/header_writer.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/version.hpp"
#include "study/contender.hpp"
#include "study/rows.hpp"

namespace study {

/// Entries of study.json that decide no row.
inline const std::set<std::string>& run_facts() {
  static const std::set<std::string> names = {"cpu",       "threads",           "wall_s", "started", "finished",
                                              "trainings", "trainings_finished"};
  return names;
}

/// The settings that decide the rows. `kind` is "table 2", "ablation" or "beyond".
struct Plan {
  std::string kind;
  std::vector<Contender> contenders;
  int seeds = 20;
  int epochs = 300;
  std::uint64_t flight_seed = first_flight_seed;
  int flights = 4;            ///< of the main comparison
  bool best_weights = false;  ///< judged are the weights of the least validation error, where a data set validates
  int patience = 0;           ///< epochs without a lesser validation error after which a training ends; 0: none does
  RowFormat format;
  std::function<pinnquad::Flight(const programs::StudyFlight&)> fly = flown;  ///< or read, made noisy, made heavier
  nlohmann::json facts = nlohmann::json::object();  ///< entries of study.json in place of, and beside, the usual
};

/// The flights that a contender asks for under one seed.
inline std::vector<programs::StudyFlight> flights_of(const Contender& contender, std::uint64_t seed) {
  if (contender.flights) return contender.flights(seed);
  return {{contender.flight, seed}};
}

/// Seeds of a contender's flights: one, or as many as the main comparison has.
inline std::vector<std::uint64_t> flight_seeds(const Plan& plan, const Contender& contender) {
  std::vector<std::uint64_t> seeds;
  const int count = contender.more_flights ? plan.flights : 1;
  for (int i = 0; i < count; ++i) seeds.push_back(plan.flight_seed + static_cast<std::uint64_t>(i));
  return seeds;
}

inline nlohmann::json configuration(const Plan& plan, const Flights& flights) {
  nlohmann::json models = nlohmann::json::array(), flown = nlohmann::json::array();
  for (const Contender& contender : plan.contenders) {
    models.push_back(contender.description);
    models.back()["trained"] = contender.trained;
    models.back()["flights"] = flight_seeds(plan, contender).size();
  }
  for (const auto& [id, rows] : flights) {
    flown.push_back({{"name", id.name},
                     {"seed", id.seed},
                     {"rows", rows.size()},
                     {"content_hash", pinnquad::hexadecimal(pinnquad::content_hash(rows))}});
  }
  nlohmann::json result = {{"kind", plan.kind},
                           {"version", PINNQUAD_VERSION},
                           {"epochs", plan.epochs},
                           {"seeds", plan.seeds},
                           {"first_seed", first_seed},
                           {"flight_seed", plan.flight_seed},
                           {"flights_of_main_comparison", plan.flights},
                           {"airframe", Airframe::name},
                           {"network", "10 x 25 ReLU"},
                           {"weights", weights_name(plan.best_weights)},
                           {"patience", plan.patience},
                           {"recipe", recipe_description()},
                           {"models", models},
                           {"flights", flown},
                           {"compiler", programs::compiler_name()},
                           {"flags", programs::compiler_flags()},
                           {"instruction_set", programs::instruction_set()}};
  result.update(plan.facts);
  return result;
}

/// Where two configurations differ, in words: "epochs is 300 there and 100 here"; empty if they don't. Facts of the run
/// do not count.
inline std::string difference(const nlohmann::json& there, const nlohmann::json& here) {
  const auto deciding = [&](nlohmann::json configuration) {
    for (const std::string& name : run_facts()) configuration.erase(name);
    return configuration;
  };
  const nlohmann::json a = deciding(there), b = deciding(here);
  std::set<std::string> unordered;
  for (const auto* configuration : {&a, &b}) {
    for (const auto& entry : configuration->items()) unordered.insert(entry.key());
  }
  std::vector<std::string> names(unordered.begin(), unordered.end());
  // the flights follow from the rest: whatever else differs says more
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name != "flights"; });
  const auto told = [](const nlohmann::json& configuration, const nlohmann::json::json_pointer& at) {
    return configuration.contains(at) ? configuration.at(at).dump() : std::string("absent");
  };
  for (const std::string& name : names) {
    const nlohmann::json::json_pointer entry = nlohmann::json::json_pointer() / name;
    const nlohmann::json in_a = a.contains(name) ? a.at(name) : nlohmann::json(),
                         in_b = b.contains(name) ? b.at(name) : nlohmann::json();
    if (in_a == in_b) continue;
    if (!in_a.is_structured() || !in_b.is_structured())
      return name + " is " + told(a, entry) + " there and " + told(b, entry) + " here";
    if (in_a.size() != in_b.size()) {
      return name + " has " + std::to_string(in_a.size()) + " entries there and " + std::to_string(in_b.size()) +
             " here";
    }
    const nlohmann::json flat = nlohmann::json::diff(in_a, in_b);  // not empty: they differ
    const auto at = entry / nlohmann::json::json_pointer(flat.front().at("path").get<std::string>());
    return at.to_string().substr(1) + " is " + told(a, at) + " there and " + told(b, at) + " here";
  }
  return {};
}

/// Reads DIR/study.json. Throws InputError if it is not one.
inline nlohmann::json read_configuration(const std::string& path) {
  const nlohmann::json read = pinnquad::logs::read_json_file(path);
  const auto facts_are_usual = [&read] {
    const auto fact = [&read](const char* name, const nlohmann::json& otherwise) {
      return read.value(name, otherwise);
    };
    return fact("wall_s", 0.0).is_number() && fact("threads", 1).is_number() && fact("started", "").is_string();
  };
  if (!read.is_object() || !facts_are_usual())
    throw pinnquad::InputError(path, 0, 0, "the settings of a study as JSON", "something else");
  return read;
}

inline void write_configuration(const std::string& path, const nlohmann::json& configuration) {
  pinnquad::AtomicFile file(path);
  file.stream() << configuration.dump(2) << '\n';
  file.commit();
}

}  // namespace study
