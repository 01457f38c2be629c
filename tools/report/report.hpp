// SPDX-License-Identifier: MIT
// The report of a study: DIR/report.html, report.json, table3.csv, comparisons.csv and claims.csv, from DIR/rows.csv,
// study.json and series/. Everything it says of the study is computed from the rows.
#pragma once

#include <string>

namespace programs {

/// Writes all files of the report from DIR/rows.csv, DIR/study.json and DIR/series/, and says where it is. None is
/// written where it throws: InputError, OutputError, one line each; Interrupted.
void report_study(const std::string& folder);

}  // namespace programs
