// SPDX-License-Identifier: MIT
#include "pinnquad/logs/read_log.hpp"

#include <array>
#include <filesystem>
#include <system_error>

#include "logs/blackbox.hpp"
#include "logs/csv_log.hpp"
#include "logs/dataflash.hpp"
#include "logs/foreign_files.hpp"
#include "logs/ulog.hpp"
#include "logs/ulog2csv_folder.hpp"
#include "logs/ulog_types.hpp"
#include "logs/usd_log.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad::logs {
LogKind kind_of_log(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return LogKind::ulog2csv_folder;
  std::array<char, 4096> block{};
  detail::TextFile file(path);
  const std::string_view begin(block.data(), file.read(block.data(), block.size()));
  if (begin.substr(0, ulog::magic.size()) == ulog::magic) return LogKind::ulog;
  if (is_usd_log(begin)) return LogKind::usd;
  if (is_dataflash_log(begin)) return LogKind::dataflash;
  if (is_blackbox_log(begin)) return LogKind::blackbox;
  refuse_foreign(path, begin);
  if (std::filesystem::path(path).extension() == ".ulg" || begin.find('\0') != std::string_view::npos) {
    throw InputError(path, 0, 0,
                     "a ULog file, a blackbox log, a DataFlash log, a CSV table, a Crazyflie's log, or a folder that "
                     "ulog2csv wrote",
                     begin.empty() ? "an empty file" : "neither by its first bytes");
  }
  return LogKind::csv;
}

FlightLog read_log(const std::string& path, const LogSelection& selection) {
  switch (kind_of_log(path)) {
    case LogKind::ulog: return read_ulog(path, selection);
    case LogKind::ulog2csv_folder: return read_ulog2csv_folder(path, selection);
    case LogKind::usd: return read_usd_log(path);
    case LogKind::blackbox: return parse_blackbox(file_text(path), path, selection);
    case LogKind::dataflash: return parse_dataflash(file_text(path), path, selection);
    case LogKind::csv: break;
  }
  return read_csv_log(path, selection);
}

}  // namespace pinnquad::logs
