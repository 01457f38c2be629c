// SPDX-License-Identifier: MIT
// The report of a study: DIR/report.html, table3.csv, comparisons.csv and claims.csv, from DIR/rows.csv, study.json and
// series/. Everything it says of the study is computed from the rows.
#include "report/report.hpp"

#include <cstdio>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/data/atomic_file.hpp"
#include "report/csv.hpp"
#include "report/input.hpp"
#include "report/page.hpp"

namespace programs {

void write_study_report(const std::string& folder) {
  const detail::ReportInput input = detail::read_report_input(folder);
  const std::vector<Comparison> comparisons = all_comparisons(input.study);
  const std::vector<FlightsComparison> flights = detail::main_comparisons(input.study);
  const JudgedClaims claims = judge_claims(input.study);
  const std::vector<std::pair<std::string, std::string>> files = {
      {"report.html", detail::report_page(input, comparisons, flights, claims)},
      {"table3.csv", detail::table3_csv(input.study)},
      {"comparisons.csv", detail::comparisons_csv(comparisons, flights)},
      {"claims.csv", detail::claims_csv(claims)}};
  std::vector<std::unique_ptr<pinnquad::AtomicFile>> open;  // all are whole before one is put in its place
  for (const auto& [name, text] : files) {
    open.push_back(std::make_unique<pinnquad::AtomicFile>(folder + "/" + name));
    open.back()->stream() << text;
    open.back()->close();
  }
  for (const auto& file : open) file->commit();
}

void report_study(const std::string& folder) {
  write_study_report(folder);
  std::printf("report      %s/report.html\n", folder.c_str());
}

}  // namespace programs
