// SPDX-License-Identifier: MIT
#include "logs/ulog2csv_folder.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "logs/csv_log.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {
namespace {

/// A file of the folder: `rest` is <log>_<topic>, which may both have underscores.
struct File {
  std::string path;
  std::string name;
  std::string rest;
  int instance = 0;
};

/// A file's name split on its last underscore; false for a name of another kind.
bool split_name(const std::filesystem::path& path, File& file) {
  constexpr std::size_t most_digits = 3;
  const std::string stem = path.stem().string();
  const std::size_t underscore = stem.rfind('_');
  if (path.extension() != ".csv" || underscore == std::string::npos || underscore == 0) return false;
  const std::string digits = stem.substr(underscore + 1);
  if (digits.empty() || digits.size() > most_digits || digits.find_first_not_of("0123456789") != std::string::npos) {
    return false;
  }
  file = {path.string(), path.filename().string(), stem.substr(0, underscore), std::stoi(digits)};
  return true;
}

/// Files named as ulog2csv names them, in the order of their names. Throws InputError where the folder cannot be read.
std::vector<File> files_of(const std::string& folder) {
  std::vector<File> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    File file;
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && split_name(entry->path(), file)) files.push_back(std::move(file));
  }
  if (error) throw InputError(folder, 0, 0, "a readable folder", "none (" + error.message() + ")");
  std::sort(files.begin(), files.end(), [](const File& a, const File& b) { return a.name < b.name; });
  return files;
}

/// The logs whose files these are, by the topics that nearly every log has: only they tell where <log> ends.
std::set<std::string> logs_of(const std::vector<File>& files, const LogSelection& selection) {
  std::vector<std::string> topics = {"actuator_controls_0", "actuator_motors",          "actuator_outputs",
                                     "battery_status",      "sensor_combined",          "vehicle_acceleration",
                                     "vehicle_attitude",    "vehicle_angular_velocity", "vehicle_land_detected",
                                     "vehicle_status",      "vehicle_local_position",   "vehicle_thrust_setpoint"};
  topics.insert(topics.end(), selection.topics.begin(), selection.topics.end());
  std::set<std::string> logs;
  for (const File& file : files) {
    std::size_t longest = 0;
    for (const std::string& topic : topics) {
      const std::string ending = "_" + topic;
      const bool ends = file.rest.size() > ending.size() &&
                        file.rest.compare(file.rest.size() - ending.size(), ending.size(), ending) == 0;
      if (ends) longest = std::max(longest, topic.size());
    }
    if (longest > 0) logs.insert(file.rest.substr(0, file.rest.size() - longest - 1));
  }
  return logs;
}

/// The log whose files are read. Throws InputError: there is none, or more than one and nobody chose.
std::string choose_log(const std::string& folder, const std::vector<File>& files, const LogSelection& selection) {
  if (!selection.prefix.empty()) {
    std::string prefix = selection.prefix;
    if (prefix.back() == '_') prefix.pop_back();
    const auto begins = [&](const File& file) { return file.rest.rfind(prefix + "_", 0) == 0; };
    if (std::any_of(files.begin(), files.end(), begins)) return prefix;
    throw InputError(folder, 0, 0, "files of ulog2csv that begin with " + prefix + "_", "none");
  }
  const std::set<std::string> logs = logs_of(files, selection);
  if (logs.size() == 1) return *logs.begin();
  constexpr std::size_t most_named = 5;
  std::string found = "none";
  if (!logs.empty()) {
    found = std::to_string(logs.size()) + ":";
    std::size_t named = 0;
    for (const std::string& log : logs) {
      if (++named > most_named) break;
      found += " " + printable(log);
    }
    if (named > most_named) found += " ...";
  }
  throw InputError(folder, 0, 0,
                   logs.empty() ? "files that ulog2csv wrote, such as <log>_vehicle_attitude_0.csv"
                                : "files of one log (choose one by its prefix)",
                   found);
}

}  // namespace

std::set<std::string> ulog2csv_logs(const std::string& folder, const LogSelection& selection) {
  return logs_of(files_of(folder), selection);
}

FlightLog read_ulog2csv_folder(const std::string& folder, const LogSelection& selection) {
  FlightLog log;
  log.source = folder;
  const std::vector<File> files = files_of(folder);
  const std::string begin = choose_log(folder, files, selection) + "_";
  LogSelection table = selection;
  table.clock_column = ulog2csv::clock_column;
  table.clock_ticks_per_s = ulog2csv::ticks_per_s;
  double done = 0;
  table.on_progress = [&](double share) { selection.report((done + share) / static_cast<double>(files.size())); };
  for (const File& file : files) {
    ++done;
    if (file.rest.rfind(begin, 0) != 0) {
      if (selection.prefix.empty()) {
        log.warnings.push_back(printable(file.path) + ": not of the log " + printable(begin) + "*: left out");
      }
      continue;
    }
    const std::string name = file.rest.substr(begin.size());
    if (!selection.wants(name)) continue;
    LogTopic topic = read_csv_topic(file.path, table);
    topic.name = name;
    topic.instance = file.instance;
    if (topic.size() > 0) log.topics.push_back(std::move(topic));
  }
  return log;
}

}  // namespace pinnquad::logs
