// SPDX-License-Identifier: MIT
// The tables of a study's report as JSON for its template: figures as text, as the page shows them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "page/text.hpp"
#include "pinnquad/evaluation/summary.hpp"
#include "report/claims.hpp"
#include "report/comparisons.hpp"
#include "report/settings.hpp"

namespace programs {

/// The class that colours a verdict in the page.
inline const char* verdict_kind(Verdict verdict) {
  static constexpr std::array<const char*, 5> kinds = {"reproduced", "part", "not", "undecided", "open"};
  return kinds[static_cast<std::size_t>(verdict)];
}

/// The class that colours what a line of figures says.
inline const char* saying_kind(const std::string& says) {
  if (says == "better" || says == "holds") return "good";
  return says == "worse" || says == "does not hold" ? "bad" : "mild";
}

/// Claims with their verdicts and figures, by discussion of the paper.
inline nlohmann::json claims_table(const JudgedClaims& claims) {
  static constexpr std::array<const char*, 5> titles = {"the linearized model as baseline",
                                                        "physics-informed loss and cyclical annealing", "batch norm",
                                                        "the reduced data set", "ground effect and periodic wind"};
  nlohmann::json discussions = nlohmann::json::array();
  for (const auto& [claim, judged] : claims) {
    if (discussions.empty() || discussions.back()["number"] != claim.discussion) {
      discussions.push_back({{"number", claim.discussion},
                             {"title", titles[static_cast<std::size_t>(claim.discussion - 1)]},
                             {"claims", nlohmann::json::array()}});
    }
    nlohmann::json lines = nlohmann::json::array();
    bool paired = false;
    for (const Evidence& e : judged.evidence) {
      paired = paired || !e.wins.empty();
      lines.push_back({{"what", e.what},
                       {"from", shown::quantity(e.from)},
                       {"to", shown::quantity(e.to)},
                       {"change", shown::quantity(e.change)},
                       {"wins", e.wins},
                       {"p", e.p_value.empty() ? "" : shown::p_value(std::stod(e.p_value))},
                       {"paper", shown::quantity(e.paper)},
                       {"says", e.says},
                       {"kind", saying_kind(e.says)}});
    }
    discussions.back()["claims"].push_back({{"id", claim.id},
                                            {"statement", claim.statement},
                                            {"rule", claim.rule},
                                            {"verdict", verdict_name(judged.verdict)},
                                            {"verdict_kind", verdict_kind(judged.verdict)},
                                            {"column_from", claim.columns.from},
                                            {"column_to", claim.columns.to},
                                            {"column_change", claim.columns.change},
                                            {"paired", paired},
                                            {"lines", lines}});
  }
  return discussions;
}

/// Table 2 with what was run of it.
inline nlohmann::json table2_rows(const Study& study, const StudySettings& settings) {
  nlohmann::json rows = nlohmann::json::array();
  for (const PaperModel& model : table2) {
    const std::vector<const StudyRow*> trainings = study.trainings(model.id);
    std::set<std::uint64_t> epochs;
    for (const StudyRow* row : trainings) epochs.insert(row->epochs);
    const std::string epochs_text = listed(epochs, [](std::uint64_t count) { return std::to_string(count); });
    const bool network = model.id > 1, run = study.has(model.id);
    const auto of_network = [network](const std::string& text) { return network ? text : std::string("–"); };
    std::string flight = "not run";
    if (run) flight = study.first.at(model.id).name + ", seed " + std::to_string(study.first.at(model.id).seed);
    const auto split = settings.splits.find(model.id);
    rows.push_back({{"model", model.id},
                    {"network", structure_words(model.structure)},
                    {"batch_norm", of_network(model.batch_norm ? "with" : "without")},
                    {"term", model.term == PhysicsTerm::none ? "–" : loss_words(model.id)},
                    {"data", data_words(model.data)},
                    {"split", split != settings.splits.end() ? split->second : std::string(split_words(model))},
                    {"flight", flight},
                    {"seeds", network || !run ? std::to_string(trainings.size()) : "–"},
                    {"epochs", of_network(epochs_text)},
                    {"weights", network && !trainings.empty() ? trainings.front()->weights : "–"},
                    {"closes", model.id == 1 || model.id == 4 || (model.id > 4 && model.id % 2 == 0)}});
  }
  return rows;
}

/// Table 3: ours, mean and deviation over the seeds, and the paper's.
inline nlohmann::json table3_rows(const Study& study) {
  static constexpr std::array<std::array<int, 2>, 6> groups = {{{1, 4}, {5, 6}, {7, 8}, {9, 10}, {11, 12}, {13, 14}}};
  nlohmann::json rows = nlohmann::json::array();
  for (const std::array<int, 2>& group : groups) {
    for (int model = group[0]; model <= group[1]; ++model) {
      nlohmann::json measures = nlohmann::json::array();
      for (std::size_t m = 0; m < table3_measures.size(); ++m) {
        const auto of = [&](int id) { return pinnquad::summarize(study.values(id, table3_measures[m].column)); };
        const pinnquad::Summary ours = of(model);
        bool best = ours.count > 0;
        for (int other = group[0]; other <= group[1]; ++other) best = best && !(of(other).mean < ours.mean);
        const double scale = table3_measures[m].scale;
        const PaperEntry& paper = paper_entry(model, m);
        measures.push_back({{"mean", shown::number(scale * ours.mean, 3)},
                            {"deviation", ours.count > 1 ? shown::number(scale * ours.deviation, 3) : ""},
                            {"best", best},
                            {"paper", shown::number(scale * paper.mean, 3)},
                            {"suspect", suspect_entry(model, m)},
                            {"paper_deviation", paper.deviation > 0 ? shown::number(scale * paper.deviation, 3) : ""}});
      }
      rows.push_back(
          {{"model", model}, {"name", model_words(model)}, {"measures", measures}, {"closes", model == group[1]}});
    }
  }
  return rows;
}

/// A measure with its unit.
inline std::string measure_name(std::size_t measure) {
  const Measure& m = table3_measures[measure];
  return std::string(m.label) + (m.scale > 1 ? ", 10⁻³" : ", °");
}

/// Change, wins, p, effect size and what they say: the right half of every table of comparisons. Means are shown where
/// they have a unit: `scale` is 0 for those that were divided by their flight's.
inline nlohmann::json comparison_row(const pinnquad::PairedComparison& result, double scale) {
  const std::string says = outcome_name(outcome(result));
  return {{"baseline", scale > 0 ? shown::number(scale * result.baseline_mean, 3) : ""},
          {"candidate", scale > 0 ? shown::number(scale * result.candidate_mean, 3) : ""},
          {"change", shown::number(100 * result.relative_difference, 1, true)},
          {"wins", result.wins},
          {"of", result.pairs},
          {"p", shown::p_value(result.p_value)},
          {"effect", shown::number(result.rank_biserial, 2, true)},
          {"says", says},
          {"kind", saying_kind(says)}};
}

/// Each pair on each figure.
inline nlohmann::json comparison_rows(const std::vector<Comparison>& comparisons) {
  nlohmann::json rows = nlohmann::json::array();
  const auto same_pair = [&](std::size_t a, std::size_t b) {
    return a < comparisons.size() && b < comparisons.size() &&
           comparisons[a].pair.baseline == comparisons[b].pair.baseline &&
           comparisons[a].pair.candidate == comparisons[b].pair.candidate;
  };
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const Comparison& c = comparisons[i];
    const std::optional<double> paper = paper_change(c.pair, c.measure);
    nlohmann::json row = comparison_row(c.result, table3_measures[c.measure].scale);
    row["pair"] = detail::pair_text(c.pair);
    row["opens"] = !same_pair(i, i - 1);
    row["closes"] = !same_pair(i, i + 1);
    row["measure"] = measure_name(c.measure);
    row["paper"] = paper ? shown::number(100 * *paper, 1, true) : "suspect†";
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Per flight, and over the flights' means.
inline nlohmann::json flight_rows(const std::vector<FlightsComparison>& all, const Study& study) {
  nlohmann::json rows = nlohmann::json::array();
  for (const FlightsComparison& f : all) {
    bool opens = true;
    const double scale = table3_measures[f.measure].scale;
    const auto add = [&](const std::string& flight, nlohmann::json row, bool closes) {
      row["pair"] = detail::pair_text(f.pair);
      row["measure"] = measure_name(f.measure);
      row["flight"] = flight;
      row["opens"] = opens;
      row["closes"] = closes;
      rows.push_back(std::move(row));
      opens = false;
    };
    const auto name = [](const StudyFlight& flight) { return flight.name + ", seed " + std::to_string(flight.seed); };
    if (const std::optional<Comparison> first = compare(study, f.pair, f.measure)) {
      add(name(first->flight) + " (Table 2’s)", comparison_row(first->result, scale), false);
    }
    for (const Comparison& c : f.flights) add(name(c.flight), comparison_row(c.result, scale), false);
    add("means of the further flights", comparison_row(f.of_means, 0), true);
  }
  return rows;
}

/// The same pairs under the weights that the report does not use, where rows.csv has them.
inline nlohmann::json other_weights_rows(const Study& study) {
  const std::string other = study.weights == "final" ? "best" : "final";
  nlohmann::json rows = nlohmann::json::array();
  for (const ModelPair& pair : compared_pairs) {
    if (!study.has(pair.baseline)) continue;
    const StudyFlight& flight = study.first.at(pair.baseline);
    if (study.weights_of(pair.baseline, flight, other) == study.weights_of(pair.baseline, flight, study.weights))
      continue;
    if (const std::optional<Comparison> c = compare(study, pair, flight, 0, other)) {
      rows.push_back(comparison_row(c->result, table3_measures[0].scale));
      rows.back()["pair"] = detail::pair_text(pair);
    }
  }
  return rows;
}

/// Seconds of a training by model, and physics-informed over vanilla.
inline nlohmann::json cost_rows(const Study& study) {
  nlohmann::json rows = nlohmann::json::array();
  for (const ModelPair& pair : compared_pairs) {
    const bool against_vanilla = paper_model(pair.baseline).term == PhysicsTerm::none;
    const pinnquad::Summary vanilla = pinnquad::summarize(study.values(pair.baseline, "training_s"));
    const pinnquad::Summary informed = pinnquad::summarize(study.values(pair.candidate, "training_s"));
    if (!against_vanilla || vanilla.count == 0 || informed.count == 0) continue;
    const auto deviation = [](const pinnquad::Summary& s) { return s.count > 1 ? shown::number(s.deviation, 2) : ""; };
    rows.push_back({{"pair", detail::pair_text(pair)},
                    {"vanilla", shown::number(vanilla.mean, 2)},
                    {"vanilla_deviation", deviation(vanilla)},
                    {"informed", shown::number(informed.mean, 2)},
                    {"informed_deviation", deviation(informed)},
                    {"ratio", shown::number(informed.mean / vanilla.mean, 3)}});
  }
  return rows;
}

}  // namespace programs
