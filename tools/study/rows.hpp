// SPDX-License-Identifier: MIT
// rows.csv of a study: one line per finished training, written whole and on the disk before the training counts as
// done.
#pragma once

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "study/columns.hpp"
#include "study/contender.hpp"

namespace study {

/// Key of a training.
struct RowId {
  std::string model;
  std::string flight;
  std::uint64_t flight_seed = 0;
  std::uint64_t seed = 0;

  bool operator<(const RowId& other) const {
    return std::tie(model, flight, flight_seed, seed) <
           std::tie(other.model, other.flight, other.flight_seed, other.seed);
  }
};

/// "model 4, flight d1 of seed 1, seed 7"
inline std::string to_string(const RowId& id) {
  return "model " + id.model + ", flight " + id.flight + " of seed " + std::to_string(id.flight_seed) + ", seed " +
         std::to_string(id.seed);
}

/// Weights judged: those after the last epoch, or those of the least validation error.
inline const char* weights_name(bool best) { return best ? "best" : "final"; }

/// The first line of rows.csv, without a line end.
inline std::string rows_header() {
  std::string header;
  for (const std::string& column : programs::study_columns()) header += (header.empty() ? "" : ",") + column;
  return header;
}

/// The line of a finished training, without a line end.
inline std::string table_row(const RowId& id, int epochs, const Outcome& outcome) {
  using pinnquad::number_text;
  std::string text = id.model + "," + id.flight + "," + std::to_string(id.flight_seed) + "," + std::to_string(id.seed) +
                     "," + std::to_string(epochs) + "," + weights_name(outcome.best_weights);
  for (const programs::Figure& figure : programs::figures()) text += "," + number_text(figure.of(outcome.test));
  return text + "," + number_text(outcome.validation_mae) + "," + number_text(outcome.training_s);
}

/// A training in a study's rows.csv: its first six columns are those of study_columns(), its last the time.
struct RowFormat {
  std::string header = rows_header();
  std::string (*text)(const RowId&, int epochs, const Outcome&) = table_row;
};

/// The same line without its last column, the time: what is equal for the same training on the same build.
inline std::string without_time(const std::string& row) { return row.substr(0, row.rfind(',')); }

namespace detail {

constexpr std::size_t epochs_field = 4, weights_field = 5;

inline bool parse_seed(std::string_view text, std::uint64_t& value) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

/// Reads the training that a line holds. False if the line is not whole.
inline bool parse_row(const std::string& line, std::size_t columns, RowId& id) {
  std::vector<std::string_view> fields;
  pinnquad::split_fields(line, fields);
  constexpr std::size_t first_number = 6;
  if (fields.size() != columns || fields[0].empty() ||
      (fields[weights_field] != weights_name(false) && fields[weights_field] != weights_name(true)))
    return false;
  for (std::size_t i = first_number; i < fields.size(); ++i) {
    double value = 0;
    const auto read = std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), value);
    if (read.ec != std::errc() || read.ptr != fields[i].data() + fields[i].size()) return false;
  }
  id.model = fields[0];
  id.flight = fields[1];
  return parse_seed(fields[2], id.flight_seed) && parse_seed(fields[3], id.seed);
}

}  // namespace detail

/// Rows by training. A row that is not whole is left out and counted: its training has to be run again.
struct StoredRows {
  std::map<RowId, std::string> rows;
  std::size_t broken = 0;
};

/// Reads a rows.csv; an absent or empty file has no rows. Throws InputError: not readable, another
/// header, two rows of one training with different figures.
inline StoredRows read_rows(const std::string& path, const std::string& header = rows_header()) {
  StoredRows stored;
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) return stored;
  const std::string text = pinnquad::file_text(path);
  const auto columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  std::size_t begin = 0, line_number = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end == std::string::npos ? end : end - begin);
    const bool ended = end != std::string::npos;
    begin = ended ? end + 1 : text.size();
    ++line_number;
    if (line_number == 1) {
      if (line == header) continue;
      if (!ended && header.compare(0, line.size(), line) == 0) return stored;  // the very first write was cut short
      throw pinnquad::InputError(path, 1, 0, "the columns of this version's rows.csv", "others");
    }
    RowId id;
    if (ended && detail::parse_row(line, columns, id)) {
      const auto [kept, is_new] = stored.rows.emplace(id, line);
      if (!is_new && without_time(kept->second) != without_time(line)) {
        throw pinnquad::InputError(path, line_number, 0, "one row of " + to_string(id),
                                   "a second one with other figures");
      }
    } else {
      ++stored.broken;
    }
  }
  return stored;
}

/// Throws std::invalid_argument, one line, for a row of a training that is not in `own` (trainings and their epochs),
/// that had other epochs, or whose weights were chosen where `best_weights` does not allow it.
inline void require_own_rows(const std::string& path, const StoredRows& stored, const std::map<RowId, int>& own,
                             bool best_weights) {
  for (const auto& [id, line] : stored.rows) {
    std::vector<std::string_view> fields;
    pinnquad::split_fields(line, fields);
    const std::string epochs(fields[detail::epochs_field]), weights(fields[detail::weights_field]);
    const auto training = own.find(id);
    std::string differs;
    if (training == own.end()) {
      differs = "there is no such training here";
    } else if (epochs != std::to_string(training->second)) {
      differs = "epochs is " + epochs + " there and " + std::to_string(training->second) + " here";
    } else if (weights != weights_name(false) && !best_weights) {
      differs = "weights is " + weights + " there and " + weights_name(false) + " here";
    } else {
      continue;
    }
    throw std::invalid_argument(path + ": a row of another study: " + to_string(id) + ": " + differs);
  }
}

/// Replaces a rows.csv by these lines; the file appears whole or not at all.
inline void write_rows(const std::string& path, const std::vector<std::string>& lines,
                       const std::string& header = rows_header()) {
  std::string text = header + '\n';
  for (const std::string& line : lines) text += line + '\n';
  pinnquad::AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

/// Appends rows to a rows.csv that ends with a whole line. One writer at a time.
class RowAppender {
 public:
  explicit RowAppender(const std::string& path)
      : path_(path), file_(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC)) {
    if (file_ < 0) throw pinnquad::OutputError(path, pinnquad::system_reason(errno, "it does not open"));
  }
  RowAppender(const RowAppender&) = delete;
  RowAppender& operator=(const RowAppender&) = delete;
  ~RowAppender() { ::close(file_); }

  /// The row is on the disk when this returns. Throws OutputError and takes back what was written of it.
  void append(const std::string& row) {
    const std::string line = row + '\n';
    const off_t before = ::lseek(file_, 0, SEEK_END);
    std::size_t written = 0;
    errno = 0;
    while (written < line.size()) {  // one write, but for a disk that fills up: the next one tells the reason
      const ssize_t count = ::write(file_, line.data() + written, line.size() - written);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      written += static_cast<std::size_t>(count);
    }
    if (written == line.size() && ::fsync(file_) == 0) return;
    const int reason = errno;
    // if this fails too, the next start finds the cut row and runs its training again
    const bool taken_back = before >= 0 && ::ftruncate(file_, before) == 0;
    throw pinnquad::OutputError(
        path_, pinnquad::system_reason(reason, "writing failed") + (taken_back ? "" : "; its last row may be cut"));
  }

 private:
  std::string path_;
  int file_;
};

}  // namespace study
