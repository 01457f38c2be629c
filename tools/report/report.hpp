// SPDX-License-Identifier: MIT
// The report of a study: DIR/report.html, table3.csv, comparisons.csv and claims.csv, from DIR/rows.csv, study.json and
// series/. Everything it says of the study is computed from the rows.
#pragma once

#include <string>

namespace programs {

/// Writes DIR/report.html, DIR/table3.csv, DIR/comparisons.csv and DIR/claims.csv from DIR/rows.csv, DIR/study.json and
/// DIR/series/; all of them or, where input is refused or one can't be written, none. Throws InputError, OutputError: one line each.
void write_study_report(const std::string& folder);

/// The same, and says where it is.
void report_study(const std::string& folder);

}  // namespace programs
