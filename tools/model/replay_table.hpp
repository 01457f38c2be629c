// SPDX-License-Identifier: MIT
// A replay row by row as CSV. Commands that were not there are empty cells.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "model/replayed_row.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {

/// `go_on(share)` is called now and then; what it throws leaves no file. Throws OutputError.
template <class GoOn>
void write_replay_table(const std::string& path, const Replayed& replayed, const GoOn& go_on) {
  constexpr std::size_t rows_per_report = 1000;
  pinnquad::AtomicFile file(path);
  std::vector<std::string> head = {"flight", replayed.of_core ? "tick" : "row", "t", "answered_by", "status", "cause"};
  if (replayed.of_core) head.push_back("reaction");
  for (const char* name : {"u1", "u2", "u3", "u4", "logged_u1", "logged_u2", "logged_u3", "logged_u4", "worst_feature",
                           "excess", "state", "reason"}) {
    head.emplace_back(name);
  }
  if (replayed.of_core) head.push_back("differs");
  file.stream() << pinnquad::csv_line(head);
  for (std::size_t i = 0; i < replayed.rows.size(); ++i) {
    const ReplayedRow& row = replayed.rows[i];
    std::vector<std::string> cells = {replayed.flights[row.flight],      std::to_string(row.row),
                                      pinnquad::number_text(row.time_s), to_string(row.answerer),
                                      pinnquad::to_string(row.status),   pinnquad::to_string(row.cause)};
    if (replayed.of_core) cells.push_back(row.reaction);
    for (const FourCommands* commands : {&row.commands, &row.logged}) {
      for (const double u : *commands) cells.push_back(std::isnan(u) ? "" : pinnquad::number_text(u));
    }
    cells.insert(cells.end(), {row.feature, pinnquad::number_text(row.excess), row.state, row.reason});
    if (replayed.of_core) cells.push_back(row.differs);
    file.stream() << pinnquad::csv_line(cells);
    if (i % rows_per_report == 0) go_on(static_cast<double>(i) / static_cast<double>(replayed.rows.size()));
  }
  file.commit();
}

}  // namespace programs
