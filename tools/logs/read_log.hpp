// SPDX-License-Identifier: MIT
// A log whatever its file is: ULog, a folder that ulog2csv wrote, a Crazyflie's uSD card's, a CSV table.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "command_line/progress_line.hpp"
#include "logs/csv_log.hpp"
#include "logs/flight_log.hpp"
#include "logs/log_selection.hpp"
#include "logs/ulog.hpp"
#include "logs/ulog2csv_folder.hpp"
#include "logs/usd_log.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

enum class LogKind { ulog, ulog2csv_folder, usd, csv };

namespace detail {

/// Throws InputError that says how to restore what was compressed.
inline void refuse_compressed(const std::string& path, std::string_view begin) {
  struct Compression {
    std::string_view magic;
    const char* name;
    const char* restored_by;
  };
  constexpr std::array<Compression, 4> compressions{{{{"\xfd"
                                                       "7zXZ\0",
                                                       6},
                                                      "xz",
                                                      "xz -d"},
                                                     {{"\x1f\x8b", 2}, "gzip", "gzip -d"},
                                                     {{"\x28\xb5\x2f\xfd", 4}, "zstd", "zstd -d"},
                                                     {{"PK\x03\x04", 4}, "zip", "unzip"}}};
  for (const Compression& compression : compressions) {
    if (begin.substr(0, compression.magic.size()) != compression.magic) continue;
    throw pinnquad::InputError(
        path, 0, 0, "a log as it was written",
        std::string("one compressed by ") + compression.name + " (restore it with " + compression.restored_by + ")");
  }
}

}  // namespace detail

/// By its first bytes, or by being a folder. Throws pinnquad::InputError for what is none of them.
inline LogKind kind_of_log(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return LogKind::ulog2csv_folder;
  std::array<char, 4096> block{};
  pinnquad::detail::TextFile file(path);
  const std::string_view begin(block.data(), file.read(block.data(), block.size()));
  if (begin.substr(0, ulog::magic.size()) == ulog::magic) return LogKind::ulog;
  if (usd::begins(begin)) return LogKind::usd;
  detail::refuse_compressed(path, begin);
  if (std::filesystem::path(path).extension() == ".ulg" || begin.find('\0') != std::string_view::npos) {
    throw pinnquad::InputError(path, 0, 0,
                               "a ULog file, a CSV table, a Crazyflie's log, or a folder that ulog2csv wrote",
                               begin.empty() ? "an empty file" : "neither by its first bytes");
  }
  return LogKind::csv;
}

/// With progress on stderr unless the selection takes it. Throws pinnquad::InputError, one line, for what cannot be
/// read at all; what is lost of the rest is in `warnings`.
inline FlightLog read_log(const std::string& path, const LogSelection& selection = {}) {
  const LogKind kind = kind_of_log(path);
  ProgressLine progress("reading " + pinnquad::printable(std::filesystem::path(path).filename().string()));
  LogSelection shown = selection;
  if (!shown.on_progress) shown.on_progress = [&progress](double share) { progress.update(share); };
  switch (kind) {
    case LogKind::ulog: return read_ulog(path, shown);
    case LogKind::ulog2csv_folder: return read_ulog2csv_folder(path, shown);
    case LogKind::usd: return read_usd_log(path);
    case LogKind::csv: break;
  }
  return read_csv_log(path, shown);
}

}  // namespace programs
