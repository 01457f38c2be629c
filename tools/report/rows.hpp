// SPDX-License-Identifier: MIT
// The rows of a study (rows.csv: one training per row) as a report reads them, and the choice of those it judges.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "pinnquad/io/csv_table.hpp"
#include "report/columns.hpp"
#include "report/settings.hpp"
#include "training/judgement.hpp"

namespace programs {

/// One training, judged on its test block. A figure that is not finite (a training that diverged, a share of nothing)
/// is NaN: it is shown and left out of means and comparisons.
struct StudyRow {
  int model = 0;
  StudyFlight flight;
  std::uint64_t seed = 0;
  std::uint64_t epochs = 0;
  std::string weights;  ///< "final" or "best" (on validation data)
  std::map<std::string, double> figures;

  double figure(const std::string& name) const { return figures.at(name); }
};

namespace detail {

/// The range of figures of a kind, by how their columns' names begin; those that are not named can be anything.
struct FigureRange {
  const char* begin;
  double least, most;
  const char* words;
};
inline constexpr double no_limit = std::numeric_limits<double>::infinity();
inline constexpr std::array<FigureRange, 10> figure_ranges = {
    {{"mae", 0, no_limit, "an error of 0 or more"},
     {"rmse", 0, no_limit, "an error of 0 or more"},
     {"validation_mae", 0, no_limit, "an error of 0 or more"},
     {"r2", -no_limit, 1, "at most 1"},
     {"angle_difference", 0, 180, "degrees from 0 to 180"},
     {"raw_angle_difference", 0, 180, "degrees from 0 to 180"},
     {"correlation", -1, 1, "a value from -1 to 1"},
     {"target_correlation", -1, 1, "a value from -1 to 1"},
     {"sign_violation_share", 0, 1, "a share from 0 to 1"},
     {"training_s", 0, no_limit, "0 seconds or more"}}};

/// The cells of one line of rows.csv, each with its place for the message.
struct RowCells {
  const std::string& path;
  std::size_t line;
  const std::vector<std::string>& columns;
  const std::vector<std::size_t>& fields;
  const std::vector<std::string_view>& cells;

  std::string_view text(std::size_t column) const { return cells[fields[column]]; }

  [[noreturn]] void refuse(std::size_t column, const std::string& expected) const {
    throw pinnquad::InputError(path, line, fields[column] + 1, expected + " in column " + columns[column],
                               pinnquad::quoted_cell(text(column)));
  }

  std::uint64_t count(std::size_t column, std::uint64_t least, std::uint64_t most, const char* expected) const {
    std::uint64_t value = 0;
    const std::string_view cell = text(column);
    const std::from_chars_result result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    const bool whole = result.ec == std::errc() && result.ptr == cell.data() + cell.size();
    if (!whole || value < least || value > most) refuse(column, expected);
    return value;
  }

  /// A figure: NaN where it is not finite, else within what its kind can be.
  double number(std::size_t column) const {
    const std::string_view cell = text(column);
    for (const std::string_view undefined : {"nan", "-nan", "inf", "-inf"}) {
      if (cell == undefined) return pinnquad::not_a_number;
    }
    double value = 0;
    if (!pinnquad::parse_number(cell, value)) refuse(column, "a number");
    constexpr double spare = 1e-9;  // of a quotient's rounding
    for (const FigureRange& range : figure_ranges) {
      if (columns[column].rfind(range.begin, 0) != 0) continue;
      if (!(value >= range.least - spare && value <= range.most + spare)) refuse(column, range.words);
      break;
    }
    return value;
  }
};

/// Of commands that are not finite neither error is; of others both are.
inline void require_whole_errors(const RowCells& at, const StudyRow& row) {
  for (std::size_t column = 0; column < at.columns.size(); ++column) {
    const std::string& name = at.columns[column];
    if (name.rfind("mae", 0) != 0) continue;
    const std::string other = "rmse" + name.substr(3);
    const bool finite = std::isfinite(row.figure(name)), other_is = std::isfinite(row.figure(other));
    if (finite == other_is) continue;
    const auto wrong = finite ? std::find(at.columns.begin(), at.columns.end(), other) - at.columns.begin()
                              : static_cast<std::ptrdiff_t>(column);
    at.refuse(static_cast<std::size_t>(wrong), "a finite error beside a finite " + (finite ? name : other));
  }
}

}  // namespace detail

/// Reads rows.csv; columns by name, in any order, others ignored. Throws InputError with file, line and column: no
/// readable file, a missing column, a row of other length, a cell that is not what its column holds, a training twice
/// or one that the study has not.
/// A last line without an end (a run was killed while it wrote) is left out and counted in `cut_rows` if it is not
/// whole.
inline std::vector<StudyRow> read_study_rows(const std::string& path, const StudySettings& settings,
                                             std::size_t& cut_rows) {
  cut_rows = 0;
  constexpr std::uint64_t most = ~std::uint64_t{0}, most_epochs = 1000000;
  const std::string text = pinnquad::file_text(path);
  const std::vector<std::string> columns = study_columns();
  std::string_view rest = text;
  std::vector<std::string_view> cells;
  std::vector<std::size_t> fields;
  std::vector<StudyRow> rows;
  std::map<std::tuple<int, StudyFlight, std::uint64_t, std::string>, std::size_t> lines;
  std::size_t width = 0;
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    const bool ended = end != std::string_view::npos;
    rest = ended ? rest.substr(end + 1) : std::string_view();
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() && rest.empty()) break;
    pinnquad::split_fields(line, cells);
    if (line_number == 1) {
      fields = pinnquad::locate_columns(path, cells, columns);
      width = cells.size();
      continue;
    }
    if (cells.size() != width && !ended) {
      ++cut_rows;
      break;
    }
    if (cells.size() != width) {
      throw pinnquad::InputError(path, line_number, std::min(cells.size(), width) + 1,
                                 std::to_string(width) + " fields as in the header", std::to_string(cells.size()));
    }
    const detail::RowCells at{path, line_number, columns, fields, cells};
    StudyRow row;
    row.model = static_cast<int>(at.count(0, 1, study_models, "a model of Table 2, 1 to 14,"));
    if (!settings.plans(row.model)) at.refuse(0, "a model of study.json");
    row.flight.name = std::string(at.text(1));
    if (row.flight.name.empty()) at.refuse(1, "a flight's name");
    row.flight.seed = at.count(2, 0, most, "a seed");
    if (!settings.plans(row.flight)) at.refuse(2, "the seed of a flight " + row.flight.name + " of study.json");
    row.seed = at.count(3, 0, most, "a seed");
    row.epochs = at.count(4, 0, most_epochs, "a number of epochs");
    const bool trained = row.model > 1;
    if (settings.epochs > 0 && row.epochs != settings.epochs && (trained || row.epochs > 0)) {
      at.refuse(4, "the epochs of study.json, " + std::to_string(settings.epochs) + ",");
    }
    row.weights = std::string(at.text(5));
    if (row.weights != "final" && row.weights != "best") at.refuse(5, "final or best");
    for (std::size_t column = 6; column < columns.size(); ++column) row.figures[columns[column]] = at.number(column);
    detail::require_whole_errors(at, row);
    const auto [first, fresh] = lines.try_emplace({row.model, row.flight, row.seed, row.weights}, line_number);
    if (!fresh) {
      throw pinnquad::InputError(path, line_number, 0, "one row per training",
                                 "a second one (the first is line " + std::to_string(first->second) + ")");
    }
    rows.push_back(std::move(row));
  }
  if (width == 0) throw pinnquad::InputError(path, 1, 0, "a header that names the columns", "an empty file");
  if (rows.empty()) throw pinnquad::InputError(path, 1, 0, "at least one finished training", "only the header");
  return rows;
}

/// The rows of a study with the choices that make a report: the flight each model is judged on first, and which
/// weights.
struct Study {
  std::vector<StudyRow> rows;
  std::size_t cut_rows = 0;
  std::vector<StudyFlight> flights;     ///< in the order of study.json, then of the rows
  std::string weights = "final";        ///< judged where a model has them
  std::map<int, StudyFlight> first;     ///< model -> its first flight
  std::vector<std::uint64_t> expected;  ///< seeds that every network should have: all that any has

  bool has(int model) const { return first.count(model) > 0; }

  /// Final weights for the reduced sets (docs/paper.md, deviation 16: two of them leave no validation data), the
  /// study's choice elsewhere.
  std::string weights_of(int model, const StudyFlight& flight, const std::string& choice) const {
    const std::string wanted = model >= 7 && model <= 10 ? "final" : choice;
    const std::string other = wanted == "final" ? "best" : "final";
    const auto any = [&](const std::string& kind) {
      return std::any_of(rows.begin(), rows.end(), [&](const StudyRow& row) {
        return row.model == model && row.flight == flight && row.weights == kind;
      });
    };
    return any(wanted) || !any(other) ? wanted : other;
  }

  /// The trainings of a model on a flight, by seed.
  std::vector<const StudyRow*> trainings(int model, const StudyFlight& flight, const std::string& choice) const {
    const std::string kind = weights_of(model, flight, choice);
    std::vector<const StudyRow*> found;
    for (const StudyRow& row : rows) {
      if (row.model == model && row.flight == flight && row.weights == kind) found.push_back(&row);
    }
    std::sort(found.begin(), found.end(), [](const StudyRow* a, const StudyRow* b) { return a->seed < b->seed; });
    return found;
  }
  std::vector<const StudyRow*> trainings(int model) const {
    return has(model) ? trainings(model, first.at(model), weights) : std::vector<const StudyRow*>{};
  }

  /// One figure of a model over its seeds on its first flight; only what is finite.
  std::vector<double> values(int model, const std::string& figure) const {
    std::vector<double> found;
    for (const StudyRow* row : trainings(model)) {
      if (std::isfinite(row->figure(figure))) found.push_back(row->figure(figure));
    }
    return found;
  }

  /// Flights other than a model's first that it was trained on.
  std::vector<StudyFlight> further_flights(int model) const {
    std::vector<StudyFlight> found;
    for (const StudyFlight& flight : flights) {
      if (has(model) && !(flight == first.at(model)) && !trainings(model, flight, weights).empty()) {
        found.push_back(flight);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }
};

/// Sorts rows into a study. `listed` are the flights of study.json, in its order: the first that a model has rows for
/// is its first; without a list the order of the rows decides.
inline Study make_study(std::vector<StudyRow> rows, const std::vector<StudyFlight>& listed,
                        const std::string& weights) {
  Study study;
  study.rows = std::move(rows);
  study.weights = weights;
  const auto add = [&](const StudyFlight& flight) {
    if (std::find(study.flights.begin(), study.flights.end(), flight) == study.flights.end()) {
      study.flights.push_back(flight);
    }
  };
  for (const StudyFlight& flight : listed) add(flight);
  for (const StudyRow& row : study.rows) add(row.flight);
  for (const StudyFlight& flight : study.flights) {
    for (const StudyRow& row : study.rows) {
      if (row.flight == flight) study.first.try_emplace(row.model, flight);
    }
  }
  for (const StudyRow& row : study.rows) {
    if (row.model > 1 && row.flight == study.first.at(row.model)) study.expected.push_back(row.seed);
  }
  std::sort(study.expected.begin(), study.expected.end());
  study.expected.erase(std::unique(study.expected.begin(), study.expected.end()), study.expected.end());
  return study;
}

}  // namespace programs
