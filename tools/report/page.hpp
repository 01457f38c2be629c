// SPDX-License-Identifier: MIT
// The page of a study's report: its sections in the order of a reader's questions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/figures.hpp"
#include "report/input.hpp"
#include "report/sections.hpp"
#include "report/style.hpp"

namespace programs {
namespace detail {

/// The main comparison and its parts, where further flights were run: error and angles of 4 against 2, then errors.
inline std::vector<FlightsComparison> main_comparisons(const Study& study) {
  std::vector<FlightsComparison> list;
  const auto add = [&](const ModelPair& pair, std::size_t measure) {
    if (std::optional<FlightsComparison> all = compare_flights(study, pair, measure)) list.push_back(std::move(*all));
  };
  for (std::size_t measure = 0; measure < table3_measures.size(); ++measure) add({2, 4}, measure);
  for (const ModelPair& pair : compared_pairs) {
    if (pair.baseline != 2 || pair.candidate != 4) add(pair, 0);
  }
  return list;
}

inline std::string section(const std::string& id, const std::string& title, const std::string& content) {
  return "<section id=\"" + id + "\"><h2>" + title + "</h2>\n" + content + "</section>\n";
}

inline std::string paragraph(const std::string& text) { return "<p>" + text + "</p>\n"; }
inline std::string note(const std::string& text) { return "<p class=\"note\">" + text + "</p>\n"; }

inline std::string tile(const std::string& figure, const std::string& words) {
  return "<div><b>" + figure + "</b><span>" + words + "</span></div>";
}

inline std::string summary(const std::vector<Comparison>& comparisons, const std::vector<FlightsComparison>& flights,
                           const JudgedClaims& claims) {
  std::string text = "<div class=\"tally\">";
  text += tile(std::to_string(count_verdicts(claims, Verdict::reproduced)) + " of " + std::to_string(claims.size()),
               "claims reproduced");
  text += tile(std::to_string(count_verdicts(claims, Verdict::in_part)), "in part");
  text += tile(std::to_string(count_verdicts(claims, Verdict::not_reproduced)), "not reproduced");
  if (const std::size_t open = count_verdicts(claims, Verdict::not_judged)) {
    text += tile(std::to_string(open), "not judged: rows are missing");
  }
  text += "</div>\n";
  if (!comparisons.empty() && comparisons.front().pair.candidate == 4 && comparisons.front().pair.baseline == 2) {
    const Comparison& main = comparisons.front();
    text +=
        paragraph("The main comparison, annealed physics-informed loss against vanilla (model 4 against 2, flight " +
                  html_text(main.flight.name) + "): the mean absolute error changes by <b>" +
                  html::number(100 * main.result.relative_difference, 1, true) + "&#160;%</b>, lower in " +
                  std::to_string(main.result.wins) + " of " + std::to_string(main.result.pairs) +
                  " seeds, p = " + html::p_value(main.result.p_value) + ". The paper&rsquo;s means change by " +
                  html::number(100 * *paper_change(main.pair, 0), 1, true) + "&#160;%.");
  }
  for (const FlightsComparison& f : flights) {
    if (f.pair.baseline != 2 || f.pair.candidate != 4 || f.measure != 0) continue;
    text += paragraph("On " + std::to_string(f.flights.size()) + " further flight" +
                      (f.flights.size() == 1 ? "" : "s") + " the same comparison gives " +
                      html::number(100 * f.of_means.relative_difference, 1, true) + "&#160;% on average, lower on " +
                      std::to_string(f.of_means.wins) + " of " + std::to_string(f.of_means.pairs) + ".");
  }
  return text;
}

inline std::string missing_box(const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text = "<div class=\"gap\"><p><b>This study is not the whole of Table 2.</b></p>";
  for (const std::string& line : lines) text += "<p>" + html_text(line) + "</p>";
  return text + "</div>\n";
}

/// The same pairs under the weights that the report does not use, where rows.csv has them.
inline std::string other_weights(const Study& study) {
  const std::string other = study.weights == "final" ? "best" : "final";
  std::string body;
  for (const ModelPair& pair : compared_pairs) {
    if (!study.has(pair.baseline)) continue;
    const StudyFlight& flight = study.first.at(pair.baseline);
    if (study.weights_of(pair.baseline, flight, other) == study.weights_of(pair.baseline, flight, study.weights))
      continue;
    if (const std::optional<Comparison> c = compare(study, pair, flight, 0, other)) {
      body += html::row(joined({{pair_text(pair), "key"},
                                {html::number(1e3 * c->result.baseline_mean, 3), "n"},
                                {html::number(1e3 * c->result.candidate_mean, 3), "n"}},
                               result_cells(c->result)));
    }
  }
  if (body.empty()) return "";
  return html::tag("h3",
                   "The same with the " + std::string(other == "best" ? "best-validation" : "final") + " weights") +
         html::table(
             html::row(joined({{"models", ""}, {"baseline", "n"}, {"candidate", "n"}}, result_head()), "", true), body,
             "plain");
}

inline std::string figures_section(const ReportInput& input) {
  const Study& study = input.study;
  std::uint64_t epochs = 0;
  for (const StudyRow& row : study.rows) epochs = std::max(epochs, row.epochs);
  constexpr std::uint64_t paper_epochs = 300;
  if (epochs == 0) epochs = paper_epochs;
  std::vector<int> models;
  std::vector<StudySeries> series;
  for (const auto& [model, one] : input.series) {
    models.push_back(model);
    series.push_back(one);
  }
  std::string text, left_out;
  if (models.empty()) {
    left_out = "Fig. 2 over some seconds and Fig. 8 (no series/model2.csv, series/model4.csv)";
  } else {
    text +=
        html::figure(correlation_figure(series.front()),
                     "<b>Fig. 2.</b> Angular acceleration (broad) and signed sum of the flown commands (thin) at the "
                     "start of the test block, each in its spread; PCC: Pearson correlation.");
  }
  const pinnquad::CyclicalAnnealing& annealing = input.settings.annealing;
  text += html::figure(schedule_figure(annealing, static_cast<int>(epochs)),
                       "<b>Fig. 3.</b> Cyclical annealing, Eq. (6): M = " + std::to_string(annealing.cycles) +
                           ", R = " + html::number(annealing.hold, 2) +
                           ", &#955;<sub>max</sub> = " + html::number(annealing.maximum, 3) +
                           ", T = " + std::to_string(epochs) + " (the paper: 5, 0.5, 0.1, 300).");
  text +=
      html::figure(errors_figure(study, {2, 3, 4, 5, 6, 7, 8, 9, 10}),
                   "<b>Fig. 7.</b> Test error on D1. Red: without batch norm; green: with; yellow and orange: reduced "
                   "sets with batch norm. Bars: mean over the seeds; whiskers: standard deviation; pale: vanilla. "
                   "Diamonds: the paper&rsquo;s Table 3. Its flights were never released: the order can be compared, "
                   "the length cannot.");
  if (!models.empty()) {
    text += html::figure(
        ellipses_figure(models, series),
        "<b>Fig. 8.</b> Signed command sum over angular acceleration on the test block, one seed, both axes in units "
        "of "
        "the target&rsquo;s spread. Dots and blue: target; plus signs and orange: prediction; ellipses at 3 &sigma;, "
        "dashed their major axes. The angle between those axes is &Delta;m of Table 3.");
  }
  text +=
      html::figure(errors_figure(study, {11, 12}) + errors_figure(study, {13, 14}),
                   "<b>Fig. 9.</b> Test error on D2 with ground effect (upper) and on D3 with periodic wind (lower), "
                   "drawn as Fig. 7.");
  text += flight_pictures(input.folder, left_out);
  if (!left_out.empty()) text += note("Left out, because the folder does not hold what they show: " + left_out + ".");
  return text;
}

inline std::string report_page(const ReportInput& input, const std::vector<Comparison>& comparisons,
                               const std::vector<FlightsComparison>& flights, const JudgedClaims& claims) {
  const Study& study = input.study;
  const std::size_t seeds = study.expected.size();
  std::size_t tests = comparisons.size();
  for (const FlightsComparison& f : flights) tests += f.flights.size() + 2;
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
      "<meta name=\"color-scheme\" content=\"light dark\"/>"
      "<title>Physics-informed quadrotor dynamics: the paper&rsquo;s study, run again</title>\n<style>";
  page += html::style();
  page +=
      "</style></head>\n<body><main>\n<h1>Physics-informed quadrotor dynamics: the paper&rsquo;s study, run "
      "again</h1>\n";
  page +=
      "<p class=\"lead\">The models of Table 2 of Gu, Primatesta and Rizzo, <i>Physics-informed Neural Network for "
      "Quadrotor Dynamical Modeling</i> (Robotics and Autonomous Systems 171, 2024), trained and judged by pinnquad on "
      "flights of its own. Every figure, verdict and p-value on this page is computed from " +
      std::to_string(study.rows.size()) + " rows of rows.csv" +
      (seeds > 0 ? ", up to " + std::to_string(seeds) + " seed" + (seeds == 1 ? "" : "s") + " per network" : "") +
      ".</p>\n";
  page += summary(comparisons, flights, claims);
  page += missing_box(missing_lines(study, input.settings));
  page +=
      "<nav><a href=\"#claims\">Claims</a><a href=\"#table3\">Table 3</a><a href=\"#pairs\">Pairs</a>"
      "<a href=\"#flights\">Further flights</a><a href=\"#figures\">Figures</a><a href=\"#cost\">Training cost</a>"
      "<a href=\"#table2\">Table 2</a><a href=\"#settings\">Settings</a></nav>\n";
  constexpr int few_seeds = 6;
  page += section(
      "claims", "The paper&rsquo;s claims",
      paragraph(
          "What Discussions 1 to 5 claim, in our words, each with the rule that decides and the figures it decides "
          "on. A comparison is paired over seeds; &ldquo;better&rdquo; needs a lower mean and p &lt; 0.05. &ldquo;In "
          "part&rdquo; may rest on lower means "
          "alone, which chance can make: the lines below then say &ldquo;unsure&rdquo;.") +
          (seeds < few_seeds
               ? note("With fewer than six seeds no p-value can fall below 0.05: &ldquo;in part&rdquo; is "
                      "then the most that a paired claim can reach.")
               : "") +
          claims_overview(claims) + claims_section(claims));
  page +=
      section("table3", "Table 3",
              table3_section(study) +
                  note("&plusmn;: standard deviation over the seeds. Bold: lowest mean of its group. The paper&rsquo;s "
                       "columns are copied from its Table 3; neither its flights nor its training code were "
                       "released, so orderings and relative changes can be compared, absolute values cannot. "
                       "&#8224; suspect: a leading digit may have been lost (the neighbours are 23 to 28); no claim is "
                       "judged by these two entries. Angles: between the major axes of the ellipses of target and "
                       "prediction, axes in units of the target&rsquo;s spread."));
  page += section(
      "pairs", "Pairs, seed by seed",
      html::figure(
          changes_figure(comparisons),
          "Each dot is a seed: its change of the mean absolute error against the baseline&rsquo;s mean. Left of "
          "the line: the candidate is better. Stroke: mean; diamond: the paper&rsquo;s means.") +
          comparisons_section(comparisons) +
          note("p: exact two-sided Wilcoxon signed-rank test. Effect size: matched-pairs rank biserial, +1 if the "
               "candidate is lower for every seed, &minus;1 if for none. p-values are not corrected for the " +
               std::to_string(tests) +
               " comparisons of this page: of those without any effect one in twenty still falls below 0.05.") +
          other_weights(study));
  const std::string limits = paragraph(
      "<b>Seeds vary the training, not the data:</b> a seed sets initial weights and batch order on one flight, so "
      "its p-value speaks of training noise only. Whether a result holds for another flight only other flights "
      "can tell.");
  page += section(
      "flights", "Further flights",
      limits +
          (flights.empty()
               ? paragraph("This study has no further flights: nothing on this page says what another flight would "
                           "give.")
               : flights_table(flights, study) +
                     note("&ldquo;All trainings&rdquo; divides each training by its flight&rsquo;s baseline mean and "
                          "takes all of them as independent, which those of one flight are not; it is left out above " +
                          std::to_string(pinnquad::most_pairs) +
                          " trainings. &ldquo;Means&rdquo; "
                          "has one pair per flight; with n flights its p is never below 2<sup>1&minus;n</sup>. The "
                          "flight of Table 2 is in neither.")));
  page += section("figures", "Figures", figures_section(input));
  page += section(
      "cost", "Training cost",
      paragraph(
          "Seconds of one training, mean and deviation over the seeds, and physics-informed over vanilla (Sec. 5.4).") +
          cost_section(study) +
          note("The paper&rsquo;s times are of another machine: PyTorch with CUDA on a laptop (Ryzen 7 5800H, RTX "
               "3060), 300 "
               "epochs of about 9,000 rows. The ratio can be compared, the seconds cannot. Trainings that ran side by "
               "side on the cores of one machine slow each other down alike."));
  page += section(
      "table2", "Table 2 as run",
      table2_section(study, input.settings) +
          note("Weights: those after the last epoch (final) or those of the lowest validation error (best). The "
               "reduced sets are judged by their final weights where there are any: models 9 and 10 leave no rows to "
               "validate with." +
               (input.settings.all.contains("patience")
                    ? " Early stopping: patience " + json_text(input.settings.all["patience"]) + " epochs."
                    : std::string(" Early stopping: none named in study.json."))));
  page += section("settings", "Settings", settings_section(input.settings));
  return page + "</main></body></html>\n";
}

}  // namespace detail
}  // namespace programs
