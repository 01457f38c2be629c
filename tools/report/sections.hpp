// SPDX-License-Identifier: MIT
// The sections of a study's report, each a function from the study to HTML.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/evaluation/summary.hpp"
#include "report/claims.hpp"
#include "report/comparisons.hpp"
#include "report/html.hpp"
#include "report/settings.hpp"

namespace programs {

using JudgedClaims = std::vector<std::pair<Claim, Judged>>;

inline JudgedClaims judge_claims(const Study& study) {
  JudgedClaims list;
  for (Claim& claim : paper_claims()) {
    Judged judged = claim.judge(study);
    list.emplace_back(std::move(claim), std::move(judged));
  }
  return list;
}

inline std::size_t count_verdicts(const JudgedClaims& claims, Verdict verdict) {
  std::size_t count = 0;
  for (const auto& [claim, judged] : claims) count += judged.verdict == verdict ? 1 : 0;
  return count;
}

/// What a whole study would have and this one has not, one line each.
inline std::vector<std::string> missing_lines(const Study& study, const StudySettings& settings) {
  std::vector<std::string> lines;
  std::string absent_models;
  for (int model = 1; model <= study_models; ++model) {
    if (settings.plans(model)) continue;
    absent_models += (absent_models.empty() ? "" : ", ") + std::to_string(model);
  }
  if (!absent_models.empty()) lines.push_back("not part of this study: models " + absent_models);
  if (study.cut_rows > 0) lines.push_back("rows.csv ends with a row that is cut off: left out");
  const std::size_t wanted = std::max(settings.seeds, study.expected.size());
  for (int model = 1; model <= study_models; ++model) {
    if (!settings.plans(model)) continue;
    const std::string name = "model " + std::to_string(model);
    const std::vector<const StudyRow*> trainings = study.trainings(model);
    if (trainings.empty()) {
      lines.push_back(name + ": no rows");
      continue;
    }
    if (model == 1) continue;  // it is not trained
    std::set<std::uint64_t> seeds;
    std::size_t undefined = 0;
    for (const StudyRow* row : trainings) {
      seeds.insert(row->seed);
      undefined += std::isfinite(row->figure("mae")) ? 0 : 1;
    }
    std::string absent;
    for (const std::uint64_t seed : study.expected) {
      if (seeds.count(seed) == 0) absent += (absent.empty() ? ", without seed " : ", ") + std::to_string(seed);
    }
    if (seeds.size() < wanted) {
      lines.push_back(name + ": " + std::to_string(seeds.size()) + " of " + std::to_string(wanted) + " seeds" + absent);
    }
    if (undefined > 0) {
      lines.push_back(name + ": " + std::to_string(undefined) + " trainings without a finite error, left out");
    }
  }
  return lines;
}

inline std::string badge(Verdict verdict) {
  static constexpr std::array<const char*, 4> kinds = {"reproduced", "part", "not", "open"};
  return "<span class=\"badge " + std::string(kinds[static_cast<std::size_t>(verdict)]) + "\">" +
         verdict_name(verdict) + "</span>";
}

/// Every claim with its verdict, one line each.
inline std::string claims_overview(const JudgedClaims& claims) {
  std::string body;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const auto& [claim, judged] = claims[i];
    const bool closes = i + 1 == claims.size() || claims[i + 1].first.discussion != claim.discussion;
    body += html::row({{"<a href=\"#claim-" + claim.id + "\">" + claim.id + "</a>", "key"},
                       {html_text(claim.statement), ""},
                       {badge(judged.verdict), "key"}},
                      closes ? "group" : "");
  }
  return html::table(html::row({{"", ""}, {"claim", ""}, {"verdict", ""}}, "", true), body, "overview");
}

inline std::string claims_section(const JudgedClaims& claims) {
  std::string text;
  int discussion = 0;
  static constexpr std::array<const char*, 5> titles = {"the linearized model as baseline",
                                                        "physics-informed loss and cyclical annealing", "batch norm",
                                                        "the reduced data set", "ground effect and periodic wind"};
  for (const auto& [claim, judged] : claims) {
    if (claim.discussion != discussion) {
      discussion = claim.discussion;
      text += html::tag(
          "h3", "Discussion " + std::to_string(discussion) + ": " + titles[static_cast<std::size_t>(discussion - 1)]);
    }
    std::string body;
    for (const Evidence& e : judged.evidence) {
      body += html::row({{html_text(e.what), ""},
                         {html::quantity(e.from), "n"},
                         {html::quantity(e.to), "n"},
                         {html::quantity(e.change), "n"},
                         {html_text(e.wins), "n"},
                         {e.p_value.empty() ? "" : html::p_value(std::stod(e.p_value)), "n"},
                         {html::quantity(e.paper), "n paper"},
                         {html_text(e.says), e.says == "better" || e.says == "holds"          ? "good"
                                             : e.says == "worse" || e.says == "does not hold" ? "bad"
                                                                                              : "mild"}});
    }
    text += "<div class=\"claim\" id=\"claim-" + claim.id + "\"><div class=\"id\">" + claim.id +
            "</div><div class=\"statement\">" + html_text(claim.statement) + "</div><div>" + badge(judged.verdict) +
            "</div><div class=\"rest\"><div class=\"rule\">" + html_text(claim.rule) + ".</div>" +
            html::table(html::row({{"compared", ""},
                                   {"baseline", "n"},
                                   {"candidate", "n"},
                                   {"change", "n"},
                                   {"lower in", "n"},
                                   {"p", "n"},
                                   {"paper", "n"},
                                   {"says", ""}},
                                  "", true),
                        body) +
            "</div></div>\n";
  }
  return text;
}

/// Table 2 with what was run of it.
inline std::string table2_section(const Study& study, const StudySettings& settings) {
  std::string body;
  for (const PaperModel& model : table2) {
    const std::vector<const StudyRow*> trainings = study.trainings(model.id);
    std::set<std::uint64_t> epochs;
    for (const StudyRow* row : trainings) epochs.insert(row->epochs);
    std::string epochs_text;
    for (const std::uint64_t count : epochs) epochs_text += (epochs_text.empty() ? "" : ", ") + std::to_string(count);
    const bool network = model.id > 1;
    const char* term = model.term == PhysicsTerm::none ? "&ndash;" : loss_words(model.id);
    body += html::row({{std::to_string(model.id), "n"},
                       {model.network, ""},
                       {network ? (model.batch_norm ? "with" : "without") : "&ndash;", ""},
                       {term, ""},
                       {model.data, ""},
                       {settings.splits.count(model.id) > 0 ? settings.splits.at(model.id) : model.split, "n"},
                       {study.has(model.id) ? html_text(study.first.at(model.id).name) + ", seed " +
                                                  std::to_string(study.first.at(model.id).seed)
                                            : "not run",
                        ""},
                       {network ? std::to_string(trainings.size()) : (study.has(1) ? "&ndash;" : "0"), "n"},
                       {network ? epochs_text : "&ndash;", "n"},
                       {network && !trainings.empty() ? trainings.front()->weights : "&ndash;", ""}},
                      model.id == 1 || model.id == 4 || (model.id > 4 && model.id % 2 == 0) ? "group" : "");
  }
  return html::table(
      html::row({{"model", "n"},
                 {"network", ""},
                 {"batch norm", ""},
                 {"physics term", ""},
                 {"data of Table 2", ""},
                 {settings.splits.empty() ? "train / valid. / test, %" : "train / valid. / test, rows", "n"},
                 {"flight", ""},
                 {"seeds", "n"},
                 {"epochs", "n"},
                 {"weights", ""}},
                "", true),
      body);
}

/// Table 3: ours, mean and deviation over the seeds, and the paper's.
inline std::string table3_section(const Study& study) {
  static constexpr std::array<std::array<int, 2>, 6> groups = {{{1, 4}, {5, 6}, {7, 8}, {9, 10}, {11, 12}, {13, 14}}};
  std::vector<html::Cell> top = {{"", ""}, {"", ""}}, head = {{"model", "n"}, {"", ""}};
  for (const Measure& measure : table3_measures) {
    top.push_back({std::string(measure.label) + (measure.scale > 1 ? ", 10<sup>&minus;3</sup>" : ", &#176;"), "c", 4});
    for (const char* whose : {"ours", "paper"}) {
      head.push_back({whose, "n"});
      head.push_back({"&plusmn;", "n dev"});
    }
  }
  std::string body;
  for (const std::array<int, 2>& group : groups) {
    for (int model = group[0]; model <= group[1]; ++model) {
      std::vector<html::Cell> cells = {
          {std::to_string(model), "n"},
          {model == 1 ? "linearized" : std::string(loss_words(model)) + (paper_model(model).batch_norm ? ", BN" : ""),
           "key"}};
      for (std::size_t m = 0; m < table3_measures.size(); ++m) {
        const auto of = [&](int id) { return pinnquad::summarize(study.values(id, table3_measures[m].column)); };
        const pinnquad::Summary ours = of(model);
        bool best = ours.count > 0;
        for (int other = group[0]; other <= group[1]; ++other) best = best && !(of(other).mean < ours.mean);
        const double scale = table3_measures[m].scale;
        cells.push_back({html::number(scale * ours.mean, 3), best ? "n best" : "n"});
        cells.push_back({ours.count > 1 ? html::number(scale * ours.deviation, 3) : "", "n dev"});
        const PaperEntry& paper = paper_entry(model, m);
        cells.push_back({html::number(scale * paper.mean, 3) + (suspect_entry(model, m) ? "&#8224;" : ""), "n paper"});
        cells.push_back({paper.deviation > 0 ? html::number(scale * paper.deviation, 3) : "", "n dev"});
      }
      body += html::row(cells, model == group[1] ? "group" : "");
    }
  }
  return html::table(html::row(top, "", true) + html::row(head, "", true), body);
}

namespace detail {

inline html::Cell outcome_cell(const pinnquad::PairedComparison& result) {
  const Outcome o = outcome(result);
  return {outcome_name(o), o == Outcome::better ? "good" : o == Outcome::worse ? "bad" : "mild"};
}

/// Change, wins, p, effect size and what they say: the right half of every table of comparisons.
inline std::vector<html::Cell> result_cells(const pinnquad::PairedComparison& result) {
  return {{html::number(100 * result.relative_difference, 1, true), "n"},
          {std::to_string(result.wins) + " of " + std::to_string(result.pairs), "n"},
          {html::p_value(result.p_value), "n"},
          {html::number(result.rank_biserial, 2, true), "n"},
          outcome_cell(result)};
}

inline std::vector<html::Cell> result_head() {
  return {{"change, %", "n"}, {"lower in", "n"}, {"p", "n"}, {"effect size", "n"}, {"says", ""}};
}

inline std::vector<html::Cell> joined(std::vector<html::Cell> first, const std::vector<html::Cell>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace detail

/// A measure with its unit, as HTML.
inline std::string measure_name(std::size_t measure) {
  const Measure& m = table3_measures[measure];
  return std::string(m.label) + (m.scale > 1 ? ", 10<sup>&minus;3</sup>" : ", &#176;");
}

inline std::string comparisons_section(const std::vector<Comparison>& comparisons) {
  std::string body;
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    const Comparison& c = comparisons[i];
    const bool opens = i == 0 || comparisons[i - 1].pair.baseline != c.pair.baseline ||
                       comparisons[i - 1].pair.candidate != c.pair.candidate;
    const bool closes = i + 1 == comparisons.size() || comparisons[i + 1].pair.baseline != c.pair.baseline ||
                        comparisons[i + 1].pair.candidate != c.pair.candidate;
    const double scale = table3_measures[c.measure].scale;
    const std::optional<double> paper = paper_change(c.pair, c.measure);
    body += html::row(
        detail::joined({{opens ? detail::pair_text(c.pair) : "", "key"},
                        {measure_name(c.measure), "key"},
                        {html::number(scale * c.result.baseline_mean, 3), "n"},
                        {html::number(scale * c.result.candidate_mean, 3), "n"}},
                       detail::joined(detail::result_cells(c.result),
                                      {{paper ? html::number(100 * *paper, 1, true) : "suspect&#8224;", "n paper"}})),
        closes ? "group" : "");
  }
  return html::table(html::row(detail::joined({{"models", ""}, {"measure", ""}, {"baseline", "n"}, {"candidate", "n"}},
                                              detail::joined(detail::result_head(), {{"paper, %", "n"}})),
                               "", true),
                     body);
}

/// Per flight, over all trainings, and over the flights' means.
inline std::string flights_table(const std::vector<FlightsComparison>& all, const Study& study) {
  std::string body;
  for (const FlightsComparison& f : all) {
    bool opens = true;
    const auto line = [&](const std::string& flight, const pinnquad::PairedComparison& result, bool absolute,
                          const std::string& kind) {
      const double scale = table3_measures[f.measure].scale;
      body += html::row(detail::joined({{opens ? detail::pair_text(f.pair) : "", "key"},
                                        {opens ? measure_name(f.measure) : "", "key"},
                                        {flight, "key"},
                                        {absolute ? html::number(scale * result.baseline_mean, 3) : "", "n"},
                                        {absolute ? html::number(scale * result.candidate_mean, 3) : "", "n"}},
                                       detail::result_cells(result)),
                        kind);
      opens = false;
    };
    if (const std::optional<Comparison> first = compare(study, f.pair, f.measure)) {
      line(html_text(first->flight.name) + ", seed " + std::to_string(first->flight.seed) + " (Table 2&rsquo;s)",
           first->result, true, "");
    }
    for (const Comparison& c : f.flights) {
      line(html_text(c.flight.name) + ", seed " + std::to_string(c.flight.seed), c.result, true, "");
    }
    if (f.trainings) line("all trainings on further flights", *f.trainings, false, "");
    line("means of the further flights", f.of_means, false, "group");
  }
  return html::table(
      html::row(detail::joined({{"models", ""}, {"measure", ""}, {"flight", ""}, {"baseline", "n"}, {"candidate", "n"}},
                               detail::result_head()),
                "", true),
      body);
}

/// Seconds of a training by model, and physics-informed over vanilla beside the paper's.
inline std::string cost_section(const Study& study) {
  std::string body;
  for (const ModelPair& pair : compared_pairs) {
    const bool against_vanilla = paper_model(pair.baseline).term == PhysicsTerm::none;
    const pinnquad::Summary vanilla = pinnquad::summarize(study.values(pair.baseline, "training_s"));
    const pinnquad::Summary informed = pinnquad::summarize(study.values(pair.candidate, "training_s"));
    if (!against_vanilla || vanilla.count == 0 || informed.count == 0) continue;
    const auto seconds = [](const pinnquad::Summary& s) { return html::number(s.mean, 2); };
    const auto deviation = [](const pinnquad::Summary& s) { return s.count > 1 ? html::number(s.deviation, 2) : ""; };
    body += html::row({{detail::pair_text(pair), "key"},
                       {seconds(vanilla), "n"},
                       {deviation(vanilla), "n dev"},
                       {seconds(informed), "n"},
                       {deviation(informed), "n dev"},
                       {html::number(informed.mean / vanilla.mean, 3), "n"}});
  }
  if (body.empty()) return "<p>No pair of networks was trained.</p>\n";
  body += html::row({{"4 against 2, the paper (another machine)", "key"},
                     {html::number(paper_vanilla_s, 0), "n paper"},
                     {"", "n dev"},
                     {html::number(paper_physics_informed_s, 0), "n paper"},
                     {"", "n dev"},
                     {html::number(paper_physics_informed_s / paper_vanilla_s, 3), "n paper"}});
  return html::table(html::row({{"models", ""},
                                {"vanilla, s", "n"},
                                {"&plusmn;", "n dev"},
                                {"physics-informed, s", "n"},
                                {"&plusmn;", "n dev"},
                                {"ratio", "n"}},
                               "", true),
                     body, "plain");
}

}  // namespace programs
