// SPDX-License-Identifier: MIT
// A recorded flight as a CSV file: header `t,vdot_bx,...,u4` (`sample_field_names`), one sample per line, SI units.
// Extra columns stand behind them as `battery_voltage [V]`: name and unit.
// A flight that is written reads back to the same bits; a file that cannot be read is refused in one line.
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

/// Fewest rows that `read_flight_csv` takes by default: the 60/20/20 split then leaves two rows in every block.
inline constexpr std::size_t minimum_flight_rows = 10;

namespace detail {

/// The columns of a file: those of every flight, then extra ones.
template <class Columns>
std::vector<std::string> flight_columns(const Columns& extra) {
  std::vector<std::string> columns(sample_field_names.begin(), sample_field_names.end());
  for (const ColumnName& column : extra) columns.push_back(column.name + " [" + column.unit + "]");
  return columns;
}

}  // namespace detail

/// Reads a flight, and the extra columns asked for. Columns are found by name, in any order; others are ignored. Units
/// and frames: see `Sample`. An extra column is found by its name with its unit.
/// Throws InputError (all of `read_csv`, time that does not increase from row to row, a column u5, and extra columns of
/// one name or of a name that every flight has), its text one line:
///   flight.csv:17:5: expected a finite number in column wdot_x, found "abc"
Flight read_flight_csv(const std::string& path, std::size_t minimum_rows = minimum_flight_rows,
                       const std::vector<ColumnName>& extra = {});

/// The extra columns of a file, in its order: those whose heads read `name [unit]`. Throws InputError.
std::vector<ColumnName> extra_columns_in(const std::string& path);

/// Writes a flight with its extra columns; the file appears whole or not at all. `read_flight_csv` gives the same bits
/// back. `after_row(rows_written)` is called after each row; if it throws, there is no file.
/// Throws OutputError if the file cannot be written, or if the flight could not be read back: a value that is not
/// finite, time that does not increase.
template <class Observer>
void write_flight_csv(const std::string& path, const Flight& flight, const Observer& after_row) {
  const std::vector<std::string> columns = detail::flight_columns(flight.columns());
  detail::CsvWriter writer(path, columns);
  std::vector<double> values(columns.size());
  for (std::size_t i = 0; i < flight.size(); ++i) {
    const Sample::Values sample = to_values(flight[i]);
    std::copy(sample.begin(), sample.end(), values.begin());
    for (std::size_t k = 0; k < flight.columns().size(); ++k) {
      values[sample.size() + k] = flight.columns()[k].values[i];
    }
    for (std::size_t field = 0; field < values.size(); ++field) {
      if (!is_finite(values[field])) {
        throw OutputError(path, "sample " + std::to_string(i) + " has no finite " + columns[field]);
      }
    }
    if (i > 0 && !(flight[i].time_s > flight[i - 1].time_s)) {
      throw OutputError(path, "time does not increase at sample " + std::to_string(i));
    }
    writer.row(values.data(), values.size());
    after_row(i + 1);
  }
  writer.commit();
}
/// The same, of which nobody watches the rows.
void write_flight_csv(const std::string& path, const Flight& flight);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/csv.hpp"
#endif
