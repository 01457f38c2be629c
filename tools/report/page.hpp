// SPDX-License-Identifier: MIT
// The page of a study's report: all that it shows as one JSON value, and the template of the page filled with it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "page/page.hpp"
#include "report/figures.hpp"
#include "report/gaps.hpp"
#include "report/input.hpp"
#include "report/tables.hpp"

namespace programs {
namespace detail {

/// The main comparison in a sentence's figures: on Table 2's flight and on further ones; false where there is none.
inline nlohmann::json main_comparison(const std::vector<Comparison>& comparisons,
                                      const std::vector<FlightsComparison>& flights) {
  const auto is_main = [](const auto& c) { return c.pair.baseline == 2 && c.pair.candidate == 4 && c.measure == 0; };
  const auto main = std::find_if(comparisons.begin(), comparisons.end(), is_main);
  if (main == comparisons.end()) return false;
  nlohmann::json sentence = comparison_row(main->result, table3_measures[0].scale);
  sentence["flight"] = main->flight.name;
  sentence["paper"] = shown::number(100 * *paper_change(main->pair, 0), 1, true);
  const auto further = std::find_if(flights.begin(), flights.end(), is_main);
  sentence["further"] = further == flights.end() ? nlohmann::json(false) : comparison_row(further->of_means, 0);
  return sentence;
}

/// Figures of the captions; what is left out of the section, by name.
inline nlohmann::json figures_words(const ReportInput& input, std::uint64_t epochs) {
  const pinnquad::CyclicalAnnealing& annealing = input.settings.annealing;
  std::vector<std::string> left_out;
  if (input.series.empty()) {
    left_out.emplace_back("Fig. 2 over some seconds and Fig. 8 (no series/model2.csv, series/model4.csv)");
  }
  nlohmann::json flights = flight_pictures(input.folder, left_out);
  const std::string names = listed(left_out);
  return {{"cycles", annealing.cycles},
          {"hold", shown::number(annealing.hold, 2)},
          {"lambda_max", shown::number(annealing.maximum, 3)},
          {"epochs", epochs},
          {"flights", flights},
          {"left_out", left_out.empty() ? nlohmann::json(false) : nlohmann::json(names)}};
}

/// The drawings of the page as SVG; those that need what the folder does not hold are false.
inline nlohmann::json drawings(const ReportInput& input, const std::vector<Comparison>& comparisons,
                               std::uint64_t epochs) {
  const Study& study = input.study;
  std::vector<EllipsesOf> ellipses;
  for (const auto& [model, series] : input.series) ellipses.push_back({"M" + std::to_string(model), series.axes});
  const auto svg = [](const Chart& chart) {
    return chart.panels.empty() ? nlohmann::json(false) : nlohmann::json(inline_svg(chart));
  };
  return {{"changes", svg(changes_chart(comparisons))},
          {"correlation", svg(ellipses.empty() ? Chart{} : series_chart(input.series.front().second))},
          {"ellipses", svg(ellipses_chart(ellipses))},
          {"schedule", svg(schedule_chart(input.settings.annealing, static_cast<int>(epochs)))},
          {"errors_d1", svg(study_errors_chart(study, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, "Test error on D1"))},
          {"errors_d2", svg(study_errors_chart(study, {11, 12}, "Test error on D2, with ground effect"))},
          {"errors_d3", svg(study_errors_chart(study, {13, 14}, "Test error on D3, with periodic wind"))}};
}

}  // namespace detail

/// The page as report.json: figures are text in the signs of the page; table3.csv, comparisons.csv and claims.csv
/// have all their digits.
inline nlohmann::json report_figures(const detail::ReportInput& input, const std::vector<Comparison>& comparisons,
                                     const std::vector<FlightsComparison>& flights, const JudgedClaims& claims) {
  const Study& study = input.study;
  std::uint64_t epochs = 0;
  for (const StudyRow& row : study.rows) epochs = std::max(epochs, row.epochs);
  if (epochs == 0) epochs = paper_epochs;
  std::size_t tests = comparisons.size();
  for (const FlightsComparison& f : flights) tests += f.flights.size() + 1;
  const auto count = [&claims](Verdict verdict) { return count_verdicts(claims, verdict); };
  const std::string smaller = listed(smaller_than_default(study, input.settings));
  const nlohmann::json patience = input.settings.all.value("patience", nlohmann::json());
  return {{"rows", study.rows.size()},
          {"seeds", study.expected.size()},
          {"smaller", smaller.empty() ? nlohmann::json(false) : nlohmann::json(smaller)},
          {"missing", missing_lines(study, input.settings)},
          {"claim_count", claims.size()},
          {"reproduced", count(Verdict::reproduced)},
          {"in_part", count(Verdict::in_part)},
          {"not_reproduced", count(Verdict::not_reproduced)},
          {"undecided", count(Verdict::undecided)},
          {"any_undecided", count(Verdict::undecided) > 0},
          {"not_judged", count(Verdict::not_judged)},
          {"any_not_judged", count(Verdict::not_judged) > 0},
          {"main", detail::main_comparison(comparisons, flights)},
          {"discussions", claims_table(claims)},
          {"table3", table3_rows(study)},
          {"pairs", comparison_rows(comparisons)},
          {"tests", tests},
          {"other_weights", other_weights_rows(study)},
          {"other_weights_are", study.weights == "final" ? "best-validation" : "final"},
          {"further_flights", flight_rows(flights, study)},
          {"figures", detail::figures_words(input, epochs)},
          {"cost", cost_rows(study)},
          {"paper_vanilla_s", shown::number(paper_vanilla_s, 0)},
          {"paper_informed_s", shown::number(paper_physics_informed_s, 0)},
          {"paper_cost_ratio", shown::number(paper_physics_informed_s / paper_vanilla_s, 3)},
          {"table2", table2_rows(study, input.settings)},
          {"split_unit", input.settings.splits.empty() ? "%" : "rows"},
          {"patience", patience.is_null() ? nlohmann::json(false) : nlohmann::json(detail::json_text(patience))},
          {"settings", settings_tables(input.settings)}};
}

/// The page: the template filled with the figures and the drawings.
inline std::string report_page(const detail::ReportInput& input, const std::vector<Comparison>& comparisons,
                               nlohmann::json figures) {
  figures["drawings"] = detail::drawings(input, comparisons, figures["figures"]["epochs"].get<std::uint64_t>());
  figures["title"] = "Physics-informed quadrotor dynamics: the paper’s study, run again";
  return text_page(report_template, figures);
}

}  // namespace programs
