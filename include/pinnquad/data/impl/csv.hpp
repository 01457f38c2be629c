// SPDX-License-Identifier: MIT
// Bodies of csv.hpp.
#pragma once

#include "pinnquad/data/csv.hpp"

namespace pinnquad {

PINNQUAD_BODY Flight read_flight_csv(const std::string& path, std::size_t minimum_rows,
                                     const std::vector<ColumnName>& extra) {
  Flight flight;
  for (const std::string& head : detail::csv_header(path)) {
    if (head == "u5") throw InputError(path, 1, 0, "the commands of four motors, u1 to u4", "a column u5");
  }
  try {
    for (const ColumnName& column : extra) flight.add_column({column, {}});
  } catch (const std::invalid_argument& refused) {
    throw InputError(path, 1, 0, "extra columns that differ in name", refused.what());
  }
  detail::for_each_csv_row(
      path, detail::flight_columns(extra), minimum_rows,
      [&](const std::vector<double>& values, std::size_t line, const std::vector<std::size_t>& fields) {
        if (!flight.empty() && !(values[0] > flight.back().time_s)) {
          throw InputError(path, line, fields[0] + 1,
                           "a time above " + number_text(flight.back().time_s) + " in column t",
                           number_text(values[0]));
        }
        // room for all rows at once: growing would hold the flight twice
        if (flight.empty()) flight.reserve(detail::most_records(path, fields.size()));
        Sample::Values row;
        std::copy_n(values.begin(), row.size(), row.begin());
        flight.push_back(to_sample(row), values.data() + row.size(), extra.size());
      });
  return flight;
}

PINNQUAD_BODY std::vector<ColumnName> extra_columns_in(const std::string& path) {
  std::vector<ColumnName> columns;
  for (const std::string& head : detail::csv_header(path)) {
    const std::size_t unit = head.rfind(" [");
    if (unit == std::string::npos || unit == 0 || head.back() != ']') continue;
    columns.push_back({head.substr(0, unit), head.substr(unit + 2, head.size() - unit - 3)});
  }
  return columns;
}

PINNQUAD_BODY void write_flight_csv(const std::string& path, const Flight& flight) {
  write_flight_csv(path, flight, [](std::size_t) {});
}

}  // namespace pinnquad
