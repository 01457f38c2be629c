// SPDX-License-Identifier: MIT
// The report of a study: DIR/report.html, report.json, table3.csv, comparisons.csv and claims.csv, from DIR/rows.csv,
// study.json and series/. Everything it says of the study is computed from the rows.
#pragma once

#include <string>

namespace programs {

/// Writes all files of the report from DIR/rows.csv, DIR/study.json and DIR/series/, or none: where input is refused,
/// one can't be written, or Ctrl-C came before all were ready (false). Throws InputError, OutputError: one line each.
bool write_study_report(const std::string& folder);

/// The same, and says where it is. Exit code: 0 or that of an interrupt.
int report_study(const std::string& folder);

}  // namespace programs
