// SPDX-License-Identifier: MIT
#include "logs/offered_mapping.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "logs/blackbox.hpp"
#include "logs/blackbox_header.hpp"
#include "logs/csv_head.hpp"
#include "logs/log_columns.hpp"
#include "logs/log_parts.hpp"
#include "logs/mapping.hpp"
#include "logs/mapping_texts.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"
#include "pinnquad/logs/flight_log.hpp"
#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {
namespace {

constexpr std::size_t head_bytes = std::size_t{1} << 18;  ///< what a ULog's definitions, a blackbox's head fit into

std::string begin_of(const std::string& path) {
  std::string begin(head_bytes, '\0');
  detail::TextFile file(path);
  begin.resize(file.read(begin.data(), begin.size()));
  return begin;
}

std::optional<OfferedMapping> of_blackbox(const std::string& path) {
  const std::string begin = begin_of(path);
  const std::vector<std::size_t> flights = blackbox_flights(begin);
  if (flights.empty()) return std::nullopt;
  const blackbox::Header header = blackbox::read_header(begin, flights.front(), path);
  const auto firmware = header.texts.find("Firmware revision");
  const std::string words = firmware == header.texts.end() ? "" : printable(firmware->second.substr(0, 40));
  return OfferedMapping{header.is_inav() ? "inav" : "betaflight",
                        "a blackbox log" + (words.empty() ? words : " of " + words)};
}

/// True where the table's columns make every quantity of a mapping that a log may not lack.
bool fits(const Mapping& mapping, const LogTopic& table) {
  if (mapping.time_column.name.empty() || column_named(table, mapping.time_column.name) == nullptr) return false;
  for (const QuantityFacts& facts : quantities) {
    bool asked = false, found = false;
    for (const Source& source : mapping.sources) {
      if (source.quantity != facts.quantity || source.optional) continue;
      asked = true;
      found = found || (source.topic.empty() && !columns_in(table, source.columns, mapping.file, false).empty());
    }
    if (asked && !found) return false;
  }
  return true;
}

std::optional<OfferedMapping> of_table(const std::string& path) {
  const CsvHead head = csv_head(path);
  LogTopic table;
  for (const std::string& name : head.names) table.columns.push_back({name, {}});
  std::optional<OfferedMapping> offered;
  for (const MappingText& ready : mapping_texts) {
    if (!fits(parse_mapping(ready.toml, std::string(ready.name) + ".toml"), table)) continue;
    if (offered) return std::nullopt;  // two: the columns do not tell
    offered = OfferedMapping{ready.name, "a table with the columns that it names"};
  }
  return offered;
}

std::optional<OfferedMapping> of_folder(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<std::string> logs, tables;
  std::error_code error, ignored;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    const std::string file = entry->path().string();
    if (!entry->is_regular_file(ignored) || stands_beside_log(file)) continue;
    if (entry->path().extension() == ".csv") tables.push_back(file);
    if (is_vehicles_log(file)) logs.push_back(file);
  }
  for (std::vector<std::string>* files : {&logs, &tables}) {
    std::sort(files->begin(), files->end());
    std::optional<OfferedMapping> offered;
    for (const std::string& file : *files) {
      const std::optional<OfferedMapping> own = offered_mapping(file);
      if (!own || (offered && offered->name != own->name)) break;
      offered = own;
      if (file == files->back()) return offered;
    }
    if (files == &logs && !logs.empty()) return std::nullopt;
  }
  const LogSelection all;
  if (!tables.empty() && !logs_at(path, all, false).empty()) return OfferedMapping{"px4", "a folder of PX4's ulog2csv"};
  return std::nullopt;
}

}  // namespace

std::optional<OfferedMapping> offered_mapping(const std::string& path) {
  switch (kind_of_log(path)) {
    case LogKind::ulog: {
      const std::string begin = begin_of(path);
      const bool is_px4 = begin.find("vehicle_attitude:") != std::string::npos ||
                          begin.find("vehicle_angular_velocity:") != std::string::npos;
      if (is_px4) return OfferedMapping{"px4", "a ULog file with PX4's topics"};
      return std::nullopt;
    }
    case LogKind::blackbox: return of_blackbox(path);
    case LogKind::dataflash: return OfferedMapping{"ardupilot", "a DataFlash log"};
    case LogKind::usd: return OfferedMapping{"crazyflie", "a Crazyflie's uSD log"};
    case LogKind::ulog2csv_folder: return of_folder(path);
    case LogKind::csv: break;
  }
  return of_table(path);
}

}  // namespace pinnquad::logs
