// SPDX-License-Identifier: MIT
// How a claim is judged from a study's rows: the rules that claims share, and those of single claims. The two suspect
// entries of Table 3 (docs/paper.md, deviation 19) have no part in a verdict.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"
#include "report/comparisons.hpp"

namespace programs {

enum class Verdict { reproduced, in_part, not_reproduced, undecided, not_judged };

inline const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::reproduced: return "reproduced";
    case Verdict::in_part: return "in part";
    case Verdict::not_reproduced: return "not reproduced";
    case Verdict::undecided: return "undecided";
    case Verdict::not_judged: break;
  }
  return "not judged";
}

/// A line of figures behind a verdict; what does not apply is empty.
struct Evidence {
  std::string what;
  std::string from;    ///< the first figure compared, with unit
  std::string to;      ///< the second
  std::string change;  ///< between them
  std::string wins;    ///< seeds in which the second is lower
  std::string p_value;
  std::string paper;  ///< the change in the paper's Table 3
  std::string says;
};

/// Below six seeds no exact p-value can fall below 0.05, and a mean is of too few trainings for a yes or a no.
constexpr std::size_t fewest_seeds = 6;

struct Judged {
  Verdict verdict = Verdict::not_judged;
  std::vector<Evidence> evidence;
  std::size_t seeds = pinnquad::most_pairs;  ///< the fewest that any of its figures has

  void rests_on(std::size_t count) { seeds = std::min(seeds, count); }
};

namespace detail {

inline std::string format(const char* pattern, double value) {
  if (!std::isfinite(value)) return "-";  // a change of nothing
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

inline std::string pair_text(const ModelPair& pair) {
  return std::to_string(pair.candidate) + " against " + std::to_string(pair.baseline);
}

/// A mean in the unit shown, with the decimals of Table 3.
inline std::string measure_text(std::size_t measure, double value) {
  const Measure& m = table3_measures[measure];
  return format("%.3f", m.scale * value) + (measure == 0 ? "e-3" : " deg");
}

inline std::string signed_percent(double share) { return format("%+.1f %%", 100 * share); }

inline std::string cell_name(const ModelPair& pair, std::size_t measure) {
  return pair_text(pair) + ", " + table3_measures[measure].label;
}

inline Evidence evidence(const Comparison& c) {
  Evidence e;
  e.what = cell_name(c.pair, c.measure);
  e.from = measure_text(c.measure, c.result.baseline_mean);
  e.to = measure_text(c.measure, c.result.candidate_mean);
  e.change = signed_percent(c.result.relative_difference);
  e.wins = std::to_string(c.result.wins) + "/" + std::to_string(c.result.pairs);
  e.p_value = format("%.2g", c.result.p_value);
  if (const std::optional<double> paper = paper_change(c.pair, c.measure)) e.paper = signed_percent(*paper);
  e.says = outcome_name(outcome(c.result));
  return e;
}

inline constexpr const char* suspect_words = "suspect in the paper: not counted";

/// A line that only says something.
inline Evidence remark(const std::string& what, const std::string& says) {
  return {what, "", "", "", "", "", "", says};
}

/// A cell of a claim: a pair of models on one measure.
struct Cell {
  ModelPair pair;
  std::size_t measure;
};

constexpr const char* cells_rule =
    "reproduced: better (lower mean, p < 0.05) in every comparison. In part: better in one at least and worse (p < "
    "0.05) in no more, or lower in every mean. Else not reproduced";

/// The common rule, `cells_rule`.
inline Judged judge_cells(const Study& study, const std::vector<Cell>& cells) {
  Judged judged;
  std::size_t better = 0, worse = 0, lower = 0, counted = 0;
  bool missing = false;
  for (const Cell& cell : cells) {
    const std::optional<Comparison> c = compare(study, cell.pair, cell.measure);
    judged.evidence.push_back(c ? evidence(*c) : remark(cell_name(cell.pair, cell.measure), "no seed has both models"));
    if (suspect_entry(cell.pair.candidate, cell.measure) || suspect_entry(cell.pair.baseline, cell.measure)) {
      judged.evidence.back().says = suspect_words;
      continue;
    }
    if (!c) {
      missing = true;
      continue;
    }
    ++counted;
    judged.rests_on(c->result.pairs);
    const Outcome o = outcome(c->result);
    better += o == Outcome::better ? 1 : 0;
    worse += o == Outcome::worse ? 1 : 0;
    lower += o == Outcome::better || o == Outcome::leans_better ? 1 : 0;
  }
  if (missing || counted == 0) return judged;
  judged.verdict = better == counted                                       ? Verdict::reproduced
                   : (better > 0 && worse <= better) || (lower == counted) ? Verdict::in_part
                                                                           : Verdict::not_reproduced;
  return judged;
}

inline Judged judge_errors(const Study& study, const std::vector<ModelPair>& pairs) {
  std::vector<Cell> cells;
  for (const ModelPair& pair : pairs) cells.push_back({pair, 0});
  return judge_cells(study, cells);
}

inline Judged judge_angles(const Study& study, const std::vector<ModelPair>& pairs) {
  std::vector<Cell> cells;
  for (const ModelPair& pair : pairs) {
    for (std::size_t measure = 1; measure < table3_measures.size(); ++measure) cells.push_back({pair, measure});
  }
  return judge_cells(study, cells);
}

/// Mean of a figure over the seeds, or nothing; the verdict rests on it.
inline std::optional<double> mean(const Study& study, int model, std::size_t measure, Judged& judged) {
  const std::vector<double> values = study.values(model, table3_measures[measure].column);
  if (values.empty()) return std::nullopt;
  if (model > 1) judged.rests_on(values.size());  // the linearized model is not trained
  return pinnquad::summarize(values).mean;
}

/// Counts conditions on means: all of them reproduce a claim, some in part; without a mean there is no verdict.
struct Tally {
  Judged judged;
  std::size_t held = 0, counted = 0;
  bool missing = false;

  void lacks(int model) {
    judged.evidence.push_back(remark("model " + std::to_string(model), "missing"));
    missing = true;
  }
  void count(bool holds, Evidence line) {
    line.says = holds ? "holds" : "does not hold";
    judged.evidence.push_back(std::move(line));
    held += holds ? 1 : 0;
    ++counted;
  }
  Judged result() {
    if (!missing && counted > 0) {
      judged.verdict = held == counted ? Verdict::reproduced : held > 0 ? Verdict::in_part : Verdict::not_reproduced;
    }
    return judged;
  }
};

/// Discussion 1: the networks' errors beside the linearized model's.
inline Judged judge_magnitude(const Study& study) {
  constexpr double magnitude = 10;
  Tally tally;
  bool all_lower = true;
  const std::optional<double> linearized = mean(study, 1, 0, tally.judged);
  if (!linearized) tally.lacks(1);
  for (const int model : {2, 3, 4}) {
    const std::optional<double> network = mean(study, model, 0, tally.judged);
    if (!network) tally.lacks(model);
    if (!network || !linearized) continue;
    all_lower = all_lower && *network < *linearized;
    tally.count(*linearized >= magnitude * *network,
                {"1 against " + std::to_string(model) + ", mean absolute error", measure_text(0, *network),
                 measure_text(0, *linearized), format("%.1f times", *linearized / *network), "", "",
                 format("%.1f times", paper_entry(1, 0).mean / paper_entry(model, 0).mean), ""});
  }
  Judged judged = tally.result();
  if (judged.verdict == Verdict::not_reproduced && all_lower) judged.verdict = Verdict::in_part;
  return judged;
}

inline Judged judge_linearized_angles(const Study& study) {
  Tally tally;
  if (!study.has(1)) tally.lacks(1);
  for (const int model : {2, 3, 4}) {
    for (std::size_t measure = 1; measure < table3_measures.size(); ++measure) {
      const std::optional<double> one = mean(study, 1, measure, tally.judged),
                                  network = mean(study, model, measure, tally.judged);
      if (!network && measure == 1) tally.lacks(model);
      if (!one || !network) continue;
      Evidence line{"1 against " + std::to_string(model) + ", " + table3_measures[measure].label,
                    measure_text(measure, *network),
                    measure_text(measure, *one),
                    signed_percent(*one / *network - 1),
                    "",
                    "",
                    "",
                    suspect_words};
      if (suspect_entry(model, measure)) {
        tally.judged.evidence.push_back(std::move(line));
        continue;
      }
      line.paper = signed_percent(paper_entry(1, measure).mean / paper_entry(model, measure).mean - 1);
      tally.count(*one < *network, std::move(line));
    }
  }
  return tally.result();
}

inline Judged judge_best_model(const Study& study) {
  std::vector<Cell> cells;
  for (int model = 2; model <= 5; ++model) cells.push_back({{model, 6}, 0});
  Judged judged = judge_cells(study, cells);
  if (judged.verdict == Verdict::not_judged) return judged;
  bool lowest = true;
  for (int model = 2; model <= 5; ++model) lowest = lowest && mean(study, 6, 0, judged) < mean(study, model, 0, judged);
  if (judged.verdict != Verdict::reproduced) judged.verdict = lowest ? Verdict::in_part : Verdict::not_reproduced;
  return judged;
}

inline Judged judge_competitive(const Study& study) {
  constexpr double close = 0.10;
  Tally tally;
  const std::optional<double> vanilla = mean(study, 5, 0, tally.judged), informed = mean(study, 6, 0, tally.judged);
  if (!vanilla) tally.lacks(5);
  if (!informed) tally.lacks(6);
  if (!vanilla || !informed) return tally.judged;
  const double excess = *vanilla / *informed - 1;
  tally.count(excess <= close, {"5 against 6, mean absolute error", measure_text(0, *informed),
                                measure_text(0, *vanilla), signed_percent(excess), "", "",
                                signed_percent(paper_entry(5, 0).mean / paper_entry(6, 0).mean - 1), ""});
  return tally.result();
}

inline Judged judge_larger_gain(const Study& study) {
  Tally tally;
  const std::optional<Comparison> full = compare(study, {5, 6}, 0);
  if (!full) tally.lacks(study.has(5) ? 6 : 5);
  for (const ModelPair& pair : {ModelPair{7, 8}, ModelPair{9, 10}}) {
    const std::optional<Comparison> reduced = compare(study, pair, 0);
    if (!reduced) tally.lacks(study.has(pair.baseline) ? pair.candidate : pair.baseline);
    if (!reduced || !full) continue;
    tally.judged.rests_on(std::min(reduced->result.pairs, full->result.pairs));
    const double gain = reduced->result.relative_difference, full_gain = full->result.relative_difference;
    tally.count(gain < full_gain && gain < 0,
                {pair_text(pair) + "; on the full set 6 against 5", signed_percent(full_gain), signed_percent(gain),
                 format("%+.1f points", 100 * (gain - full_gain)), "", "",
                 format("%+.1f points", 100 * (*paper_change(pair, 0) - *paper_change({5, 6}, 0))), ""});
  }
  return tally.result();
}

inline Judged judge_degradation(const Study& study) {
  Tally tally;
  for (const ModelPair& pair : {ModelPair{5, 7}, ModelPair{5, 9}, ModelPair{6, 8}, ModelPair{6, 10}}) {
    const std::optional<double> full = mean(study, pair.baseline, 0, tally.judged),
                                reduced = mean(study, pair.candidate, 0, tally.judged);
    if (!full || !reduced) tally.lacks(full ? pair.candidate : pair.baseline);
    if (!full || !reduced) continue;
    tally.count(*reduced > *full,
                {pair_text(pair) + ", mean absolute error", measure_text(0, *full), measure_text(0, *reduced),
                 signed_percent(*reduced / *full - 1), "", "",
                 signed_percent(paper_entry(pair.candidate, 0).mean / paper_entry(pair.baseline, 0).mean - 1), ""});
  }
  return tally.result();
}

}  // namespace detail
}  // namespace programs
