// SPDX-License-Identifier: MIT
// The report of a study: DIR/report.html, report.json, table3.csv, comparisons.csv and claims.csv, from DIR/rows.csv,
// study.json and series/. Everything it says of the study is computed from the rows.
#include "report/report.hpp"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/progress_line.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "report/csv.hpp"
#include "report/input.hpp"
#include "report/page.hpp"

namespace programs {

void report_study(const std::string& folder) {
  const detail::ReportInput input = detail::read_report_input(folder);
  const std::size_t steps =
      (compared_pairs.size() + 1) * table3_measures.size() + compared_pairs.size() - 1 + paper_claims().size();
  std::size_t done = 0;
  ProgressLine progress("report");
  const auto step = [&] { progress.update(static_cast<double>(++done) / static_cast<double>(steps)); };
  const std::vector<Comparison> comparisons = all_comparisons(input.study, step);
  const std::vector<FlightsComparison> flights = main_comparisons(input.study, step);
  const JudgedClaims claims = judge_claims(input.study, step);
  progress.clear();
  const nlohmann::json figures = report_figures(input, comparisons, flights, claims);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"report.html", report_page(input, comparisons, figures)},
      {"report.json", figures.dump(2) + "\n"},
      {"table3.csv", detail::table3_csv(input.study)},
      {"comparisons.csv", detail::comparisons_csv(comparisons, flights)},
      {"claims.csv", detail::claims_csv(claims)}};
  std::vector<std::unique_ptr<pinnquad::AtomicFile>> open;  // all are whole before one is put in its place
  for (const auto& [name, text] : files) {
    open.push_back(std::make_unique<pinnquad::AtomicFile>(folder + "/" + name));
    open.back()->stream() << text;
    open.back()->close();
  }
  stop_if_interrupted();
  for (const auto& file : open) file->commit();
  std::printf("report      %s/report.html\n", folder.c_str());
}

}  // namespace programs
