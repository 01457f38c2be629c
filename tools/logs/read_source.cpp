// SPDX-License-Identifier: MIT

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "logs/log_parts.hpp"
#include "logs/standing_columns.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/logs/dataset_folder.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {
std::vector<ColumnName> shared_columns(const std::vector<std::string>& paths) {
  std::vector<ColumnName> shared = extra_columns_in(paths.front());
  for (const std::string& path : paths) {
    const std::vector<ColumnName> own = extra_columns_in(path);
    const auto lacks = [&own](const ColumnName& column) {
      return std::none_of(own.begin(), own.end(), [&column](const ColumnName& other) {
        return other.name == column.name && other.unit == column.unit;
      });
    };
    shared.erase(std::remove_if(shared.begin(), shared.end(), lacks), shared.end());
  }
  return shared;
}

namespace {

/// Body rates and commands tell a flight from others, whatever its clock begins with.
std::array<double, 3 + rotor_count> signature(const Sample& sample) {
  const Vector3<double>& w = sample.body_rates_rad_s;
  const auto& u = sample.commands;
  return {w[0], w[1], w[2], u[0], u[1], u[2], u[3]};
}

/// The row from which on `rows` of them turn the vehicle most.
std::size_t liveliest_row(const Flight& flight, std::size_t rows) {
  double sum = 0, most = -1;
  std::size_t best = 0;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    sum += flight[row].body_rates_rad_s.squaredNorm();
    if (row >= rows) sum -= flight[row - rows].body_rates_rad_s.squaredNorm();
    if (row + 1 < rows || !(sum > most)) continue;
    most = sum;
    best = row + 1 - rows;
  }
  return best;
}

/// True where the liveliest rows of `part` stand in `whole` too, but for rounding: two flights of one vehicle on one
/// path differ by more, by their noise alone.
bool holds(const Flight& whole, const Flight& part) {
  constexpr std::size_t rows = 100;
  constexpr double alike = 1e-4;  // of a column's variance
  if (part.size() < rows || whole.size() < rows) return false;
  const std::size_t first = liveliest_row(part, rows);
  std::array<double, 3 + rotor_count> sum{}, squares{}, weight{};
  for (std::size_t row = first; row < first + rows; ++row) {
    const auto values = signature(part[row]);
    for (std::size_t k = 0; k < values.size(); ++k) {
      sum[k] += values[k];
      squares[k] += values[k] * values[k];
    }
  }
  double columns = 0;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    const double left = squares[k] - sum[k] * sum[k] / static_cast<double>(rows);
    if (!(left > 1e-9 * squares[k])) continue;  // stands still: rounding is no motion
    weight[k] = 1 / left;
    columns += 1;
  }
  for (std::size_t at = 0; at + rows <= whole.size() && columns > 0; ++at) {
    double apart = 0;
    for (std::size_t row = 0; row < rows && apart < alike * columns; ++row) {
      const auto theirs = signature(whole[at + row]), ours = signature(part[first + row]);
      for (std::size_t k = 0; k < weight.size(); ++k) {
        apart += weight[k] * (theirs[k] - ours[k]) * (theirs[k] - ours[k]);
      }
    }
    if (apart < alike * columns) return true;
  }
  return false;
}

}  // namespace

void require_different_flights(const Dataset& dataset, const std::vector<std::string>& places) {
  const auto place = [&](std::size_t i) { return printable(places.empty() ? dataset[i].name : places[i]); };
  std::vector<std::uint64_t> hashes;
  for (std::size_t i = 0; i < dataset.size() && dataset.size() > 1; ++i) {
    hashes.push_back(content_hash(dataset[i]));
    for (std::size_t k = 0; k < i; ++k) {
      const bool same = hashes[k] == hashes[i];
      if (!same && !holds(dataset[k], dataset[i]) && !holds(dataset[i], dataset[k])) continue;
      throw std::invalid_argument(place(k) + " and " + place(i) +
                                  " hold the same flight: it would be judged on rows that it was trained on");
    }
  }
}

Dataset read_flights(const std::vector<std::string>& paths, std::size_t minimum_rows,
                     const std::vector<ColumnName>& extra, const OnProgress& on_progress) {
  const bool one = paths.size() == 1;
  const auto bytes_of = [](const std::string& path) {  // of what is no file, or a pipe: none
    std::error_code ignored;
    const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
    return ignored ? 0.0 : static_cast<double>(bytes);
  };
  double all_bytes = 0, bytes_read = 0;
  for (const std::string& path : paths) all_bytes += bytes_of(path);
  Dataset dataset;
  for (const std::string& path : paths) {
    if (on_progress) on_progress("reading flights", all_bytes > 0 ? bytes_read / all_bytes : 0);
    bytes_read += bytes_of(path);
    Flight flight = read_flight_csv(path, one ? minimum_rows : minimum_flight_rows, extra);
    require_plausible(path, flight);
    const bool moves = std::any_of(flight.begin(), flight.end(),
                                   [](const Sample& sample) { return sample.velocity_m_s.squaredNorm() > 0; });
    const HasQuantities has{moves, moves, false};  // trainings and identifications ask for commands that change
    if (const auto found = find_standing_column(flight, has))
      throw InputError(path, 0, 0, found->expected, found->found);
    flight.name = free_name(dataset, printable(std::filesystem::path(path).filename().string()));
    dataset.add(std::move(flight));
  }
  require_different_flights(dataset, paths);
  if (dataset.rows() < minimum_rows) {
    throw std::invalid_argument("expected at least " + std::to_string(minimum_rows) + " rows in " +
                                std::to_string(dataset.size()) + " flights, found " + std::to_string(dataset.rows()));
  }
  return dataset;
}

SourceKind kind_of_source(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::path(path) / dataset_file_name, ignored)) return SourceKind::dataset;
  if (!std::filesystem::exists(path, ignored)) return SourceKind::flights;  // its reader says so
  if (kind_of_log(path) != LogKind::csv) return SourceKind::logs;
  const std::vector<std::string> cells = detail::csv_header(path);
  if (cells.empty()) return SourceKind::flights;  // empty, as its reader says
  std::size_t of_a_flight = 0;
  for (const std::string& cell : cells) {
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
      end = cell.find_first_of(";\t", begin);  // wrong in a flight, and its reader says so
      const std::string head = cell.substr(begin, end == std::string::npos ? end : end - begin);
      if (std::find(sample_field_names.begin(), sample_field_names.end(), head) != sample_field_names.end())
        ++of_a_flight;
    }
  }
  return 2 * of_a_flight > sample_field_names.size() ? SourceKind::flights : SourceKind::logs;
}

SourceKind kind_of_sources(const std::vector<std::string>& paths, const std::string& mapping) {
  if (paths.empty()) throw std::invalid_argument("expected FLIGHTS: flights, a dataset, or logs");
  const auto first = std::find_if_not(paths.begin(), paths.end(), stands_beside_log);
  const SourceKind kind = kind_of_source(first == paths.end() ? paths.front() : *first);
  if (!mapping.empty()) {
    if (kind != SourceKind::dataset) return SourceKind::logs;
    throw InputError(paths.front(), 0, 0, "logs, whose columns --mapping names", "a dataset, which needs none");
  }
  for (const std::string& path : paths) {
    if (kind == SourceKind::logs && stands_beside_log(path)) continue;  // it is skipped
    if (kind_of_source(path) == kind && (kind != SourceKind::dataset || paths.size() == 1)) continue;
    throw std::invalid_argument("expected flights, one dataset, or logs, found " + printable(paths.front()) + " and " +
                                printable(path) + ": import them into one dataset first");
  }
  return kind;
}

ImportedDataset read_source(const std::vector<std::string>& paths, const LogSettings& settings) {
  const SourceKind kind = kind_of_sources(paths, settings.mapping);
  if (kind == SourceKind::logs) return read_dataset(paths, settings);
  if (kind == SourceKind::dataset) return read_dataset_folder(paths.front(), settings.on_progress);
  ImportedDataset dataset;
  dataset.flights = read_flights(paths, minimum_flight_rows, shared_columns(paths), settings.on_progress);
  dataset.sources = paths;
  dataset.sample_period_s = sample_period_s(all_rows(dataset.flights.flights()));
  return dataset;
}

}  // namespace pinnquad::logs
