// SPDX-License-Identifier: MIT
// Pairs of models compared seed by seed: on the flight of Table 2, on each further flight, and over the flights.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/evaluation/paired_test.hpp"
#include "report/paper.hpp"
#include "report/rows.hpp"

namespace programs {

constexpr double significance = 0.05;

/// Verdict of a comparison, by rule: `better` and `worse` need p < 0.05, the `lower` mean alone is a lean.
enum class Outcome { better, leans_better, leans_worse, worse };

inline Outcome outcome(const pinnquad::PairedComparison& result) {
  const bool sure = result.p_value < significance;
  if (result.mean_difference < 0) return sure && result.rank_biserial > 0 ? Outcome::better : Outcome::leans_better;
  return sure && result.rank_biserial < 0 ? Outcome::worse : Outcome::leans_worse;
}

inline const char* outcome_name(Outcome value) {
  switch (value) {
    case Outcome::better: return "better";
    case Outcome::leans_better: return "lower, unsure";
    case Outcome::leans_worse: return "not lower, unsure";
    case Outcome::worse: break;
  }
  return "worse";
}

/// The same figure of two models on the same flight, from the seeds that both have.
struct PairedSeeds {
  std::vector<std::uint64_t> seeds;
  std::vector<double> candidate;
  std::vector<double> baseline;
  std::size_t undefined = 0;  ///< seeds left out because a figure is not finite
};

inline PairedSeeds paired_seeds(const Study& study, const ModelPair& pair, const StudyFlight& flight,
                                const std::string& weights, const std::string& figure) {
  PairedSeeds result;
  if (study.weights_of(pair.candidate, flight, weights) != study.weights_of(pair.baseline, flight, weights)) {
    return result;
  }
  for (const StudyRow* a : study.trainings(pair.candidate, flight, weights)) {
    for (const StudyRow* b : study.trainings(pair.baseline, flight, weights)) {
      if (a->seed != b->seed) continue;
      const double of_candidate = a->figure(figure);
      const double of_baseline = b->figure(figure);
      if (!std::isfinite(of_candidate) || !std::isfinite(of_baseline)) {
        ++result.undefined;
        continue;
      }
      result.seeds.push_back(a->seed);
      result.candidate.push_back(of_candidate);
      result.baseline.push_back(of_baseline);
    }
  }
  return result;
}

/// One line of comparisons.csv.
struct Comparison {
  ModelPair pair{};
  StudyFlight flight;
  std::size_t measure = 0;
  PairedSeeds paired;
  pinnquad::PairedComparison result;

  /// Relative change of each seed against the baseline's mean.
  std::vector<double> relative_changes() const {
    std::vector<double> changes;
    for (std::size_t i = 0; i < paired.seeds.size(); ++i) {
      changes.push_back((paired.candidate[i] - paired.baseline[i]) / std::abs(result.baseline_mean));
    }
    return changes;
  }
};

/// Relative change of the paper's means; no value where an entry is suspect.
inline std::optional<double> paper_change(const ModelPair& pair, std::size_t measure) {
  if (suspect_entry(pair.baseline, measure) || suspect_entry(pair.candidate, measure)) return std::nullopt;
  return paper_entry(pair.candidate, measure).mean / paper_entry(pair.baseline, measure).mean - 1;
}

/// Nothing if no seed has both models.
inline std::optional<Comparison> compare(const Study& study, const ModelPair& pair, const StudyFlight& flight,
                                         std::size_t measure, const std::string& weights) {
  Comparison comparison;
  comparison.pair = pair;
  comparison.flight = flight;
  comparison.measure = measure;
  comparison.paired = paired_seeds(study, pair, flight, weights, table3_measures[measure].column);
  if (comparison.paired.seeds.empty() || comparison.paired.seeds.size() > pinnquad::most_pairs) return std::nullopt;
  comparison.result = pinnquad::compare_paired(comparison.paired.candidate, comparison.paired.baseline);
  return comparison;
}

/// On the flight of Table 2. Nothing if a model is missing or both were trained on different flights.
inline std::optional<Comparison> compare(const Study& study, const ModelPair& pair, std::size_t measure) {
  if (!study.has(pair.candidate) || !study.has(pair.baseline)) return std::nullopt;
  const StudyFlight& flight = study.first.at(pair.baseline);
  if (!(flight == study.first.at(pair.candidate))) return std::nullopt;
  return compare(study, pair, flight, measure, study.weights);
}

/// Called when a piece of the work is done: with hundreds of seeds the exact test takes seconds.
using Step = std::function<void()>;

/// Every pair and measure that the rows allow, in the order of `compared_pairs`; a step for each.
inline std::vector<Comparison> all_comparisons(const Study& study, const Step& step) {
  std::vector<Comparison> list;
  for (const ModelPair& pair : compared_pairs) {
    for (std::size_t measure = 0; measure < table3_measures.size(); ++measure) {
      if (std::optional<Comparison> comparison = compare(study, pair, measure)) list.push_back(std::move(*comparison));
      step();
    }
  }
  return list;
}

/// One pair and measure over further flights. Trainings of one flight share its rows, so that they are no independent
/// witnesses of what another flight would give: across flights, a flight's mean over its seeds is one pair.
struct FlightsComparison {
  ModelPair pair{};
  std::size_t measure = 0;
  std::vector<Comparison> flights;
  pinnquad::PairedComparison of_means;  ///< each flight's mean, divided by its baseline's
};

inline std::optional<FlightsComparison> compare_flights(const Study& study, const ModelPair& pair,
                                                        std::size_t measure) {
  FlightsComparison all;
  all.pair = pair;
  all.measure = measure;
  std::vector<double> candidate_means, baseline_means;
  for (const StudyFlight& flight : study.further_flights(pair.baseline)) {
    std::optional<Comparison> one = compare(study, pair, flight, measure, study.weights);
    if (!one || !(one->result.baseline_mean > 0)) continue;
    candidate_means.push_back(one->result.candidate_mean / one->result.baseline_mean);
    baseline_means.push_back(1);
    all.flights.push_back(std::move(*one));
  }
  if (all.flights.empty() || all.flights.size() > pinnquad::most_pairs) return std::nullopt;
  all.of_means = pinnquad::compare_paired(candidate_means, baseline_means);
  return all;
}

/// The main comparison and its parts, where further flights were run: error and angles of 4 against 2, then errors. A
/// step for each.
inline std::vector<FlightsComparison> main_comparisons(const Study& study, const Step& step) {
  std::vector<FlightsComparison> list;
  const auto add = [&](const ModelPair& pair, std::size_t measure) {
    if (std::optional<FlightsComparison> all = compare_flights(study, pair, measure)) list.push_back(std::move(*all));
    step();
  };
  for (std::size_t measure = 0; measure < table3_measures.size(); ++measure) add({2, 4}, measure);
  for (const ModelPair& pair : compared_pairs) {
    if (pair.baseline != 2 || pair.candidate != 4) add(pair, 0);
  }
  return list;
}

}  // namespace programs
