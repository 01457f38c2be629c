// SPDX-License-Identifier: MIT
// The tables of a study's report as CSV: numbers with all their digits.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/io/csv_table.hpp"
#include "report/claims.hpp"
#include "report/comparisons.hpp"

namespace programs {
namespace detail {

inline std::string table3_csv(const Study& study) {
  using pinnquad::number_text;
  std::string text = pinnquad::csv_line(
      {"model", "measure", "seeds", "mean", "deviation", "paper_mean", "paper_deviation", "paper_entry_suspect"});
  for (const PaperModel& model : table2) {
    for (std::size_t m = 0; m < table3_measures.size(); ++m) {
      const pinnquad::Summary ours = pinnquad::summarize(study.values(model.id, table3_measures[m].column));
      const PaperEntry& paper = paper_entry(model.id, m);
      text += pinnquad::csv_line({std::to_string(model.id), table3_measures[m].column, std::to_string(ours.count),
                                  number_text(ours.mean), number_text(ours.deviation), number_text(paper.mean),
                                  number_text(model.id == 1 ? pinnquad::not_a_number : paper.deviation),
                                  suspect_entry(model.id, m) ? "1" : "0"});
    }
  }
  return text;
}

inline std::string comparisons_csv(const std::vector<Comparison>& comparisons,
                                   const std::vector<FlightsComparison>& flights) {
  using pinnquad::number_text;
  std::string text = pinnquad::csv_line({"baseline", "candidate", "measure", "flight", "flight_seed", "pairs", "wins",
                                         "ties", "losses", "baseline_mean", "candidate_mean", "relative_difference",
                                         "p_value", "rank_biserial", "outcome", "paper_relative_difference"});
  const auto line = [&](const ModelPair& pair, std::size_t measure, const std::string& flight, const std::string& seed,
                        const pinnquad::PairedComparison& r) {
    const std::optional<double> paper = paper_change(pair, measure);
    text += pinnquad::csv_line(
        {std::to_string(pair.baseline), std::to_string(pair.candidate), table3_measures[measure].column, flight, seed,
         std::to_string(r.pairs), std::to_string(r.wins), std::to_string(r.ties), std::to_string(r.losses),
         number_text(r.baseline_mean), number_text(r.candidate_mean), number_text(r.relative_difference),
         number_text(r.p_value), number_text(r.rank_biserial), outcome_name(outcome(r)),
         number_text(paper.value_or(pinnquad::not_a_number))});
  };
  for (const Comparison& c : comparisons) {
    line(c.pair, c.measure, c.flight.name, std::to_string(c.flight.seed), c.result);
  }
  for (const FlightsComparison& f : flights) {
    for (const Comparison& c : f.flights) {
      line(c.pair, c.measure, c.flight.name, std::to_string(c.flight.seed), c.result);
    }
    line(f.pair, f.measure, "further flights, means", "", f.of_means);
  }
  return text;
}

inline std::string claims_csv(const JudgedClaims& claims) {
  std::string text = pinnquad::csv_line({"id", "discussion", "verdict", "statement", "rule", "figures"});
  for (const auto& [claim, judged] : claims) {
    std::string figures;
    for (const Evidence& e : judged.evidence) {
      figures += (figures.empty() ? "" : "; ") + e.what;
      const ClaimColumns& columns = claim.columns;
      if (!e.from.empty()) {
        figures += std::string(": ") + columns.from + " " + e.from + ", " + columns.to + " " + e.to + ", " +
                   columns.change + " " + e.change;
      }
      if (!e.wins.empty()) figures += ", lower in " + e.wins + ", p = " + e.p_value;
      if (!e.paper.empty()) figures += ", the paper " + e.paper;
      figures += ": " + e.says;
    }
    text += pinnquad::csv_line({claim.id, std::to_string(claim.discussion), verdict_name(judged.verdict),
                                claim.statement, claim.rule, figures});
  }
  return text;
}

}  // namespace detail
}  // namespace programs
