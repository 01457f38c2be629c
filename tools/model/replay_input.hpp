// SPDX-License-Identifier: MIT
// The log of `replay`: a recorded flight, a folder of imported flights, or what a flight stack's core logged (a ULog
// file, a folder that ulog2csv wrote, a Crazyflie's log from its uSD card, a CSV table).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "command_line/in_words.hpp"
#include "command_line/progress_line.hpp"
#include "model/core_log.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/logs/dataset_folder.hpp"
#include "pinnquad/logs/read_log.hpp"

namespace programs {

namespace logs = pinnquad::logs;

/// Either flights or ticks of a core.
struct ReplayInput {
  std::vector<pinnquad::Flight> flights;
  std::vector<pinnquad::autopilot::CoreRecord> ticks;
  pinnquad::autopilot::CoreSettings settings;  ///< of the core; as made where the log does not say
  bool has_settings = false;
  std::vector<std::string> notes;

  bool of_core() const noexcept { return flights.empty(); }
};

namespace detail {

/// A flight whose numbers may be NaN: why a model refuses a row is what the user asks. Throws InputError, one line: a
/// column of every flight that is missing or holds text, time that is no number or does not increase.
inline pinnquad::Flight read_flight_with_gaps(const std::string& path) {
  logs::LogSelection selection;
  ProgressLine progress("reading " + pinnquad::printable(std::filesystem::path(path).filename().string()));
  selection.on_progress = [&progress](double share) { progress.update(share); };
  const logs::LogTopic topic = logs::read_csv_topic(path, selection);
  std::vector<const logs::LogColumn*> columns;
  for (const std::string_view name : pinnquad::sample_field_names) {
    columns.push_back(topic.column(name));
    if (columns.back() != nullptr) continue;
    if (const logs::LogText* text = topic.text(name)) {
      throw pinnquad::InputError(path, static_cast<std::size_t>(topic.place[text->first_text]), 0,
                                 "a number in column " + std::string(name),
                                 pinnquad::quoted_cell(text->values[text->first_text]));
    }
    throw pinnquad::InputError(path, 1, 0, "a column named " + std::string(name),
                               "none of that name: is it a raw log? (pinnquad import makes a dataset of it)");
  }
  pinnquad::Flight flight;
  const std::size_t rows = topic.place.size();
  if (rows == 0) throw pinnquad::InputError(path, 2, 0, "a row of data", "none");
  flight.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    pinnquad::Sample::Values values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = columns[i]->values[row];
    if (!std::isfinite(values[0]) || (row > 0 && !(values[0] > flight.back().time_s))) {
      throw pinnquad::InputError(path, static_cast<std::size_t>(topic.place[row]), 0,
                                 row > 0
                                     ? "a time above " + pinnquad::number_text(flight.back().time_s) + " in column t"
                                     : "a time in column t",
                                 in_words("%.9g", values[0]));
    }
    flight.push_back(pinnquad::to_sample(values));
  }
  for (const logs::LogColumn& column : topic.columns) {
    const std::size_t unit = column.name.rfind(" [");
    if (unit == std::string::npos || unit == 0 || column.name.back() != ']') continue;
    flight.add_column(
        {{column.name.substr(0, unit), column.name.substr(unit + 2, column.name.size() - unit - 3)}, column.values});
  }
  flight.name = pinnquad::printable(std::filesystem::path(path).filename().string());
  return flight;
}

inline ReplayInput read_dataset(const std::string& path) {
  JobLine progress;
  const logs::ImportedDataset dataset = logs::read_dataset_folder(
      path, [&progress](const std::string& job, double share) { progress.update(job, share); });
  ReplayInput input;
  input.flights.assign(dataset.flights.flights().begin(), dataset.flights.flights().end());
  for (const std::string& quantity : dataset.absent) {
    input.notes.push_back(quantity + " is not in these logs: it is 0 here, and a model that asks for it is told so");
  }
  return input;
}

/// The settings that held when the core began.
inline void take_settings(const logs::LogTopic& topic, ReplayInput& input) {
  const std::vector<pinnquad::autopilot::CoreSettings> all = core_records<pinnquad::autopilot::CoreSettings>(topic);
  if (all.empty()) return;
  input.settings = all.front();
  for (const pinnquad::autopilot::CoreSettings& settings : all) {
    if (settings.timestamp <= input.ticks.front().timestamp) input.settings = settings;
  }
  input.has_settings = true;
}

inline ReplayInput read_core_topics(const std::string& path, logs::FlightLog& log) {
  for (logs::LogTopic& topic : log.topics) {
    if (topic.name != pinnquad::autopilot::CoreRecord::topic) continue;
    refuse_earlier_core(topic);
    add_core_columns(topic, pinnquad::autopilot::CoreRecord::added);
  }
  const logs::LogTopic* ticks = log.topic(pinnquad::autopilot::CoreRecord::topic);
  if (ticks == nullptr || ticks->size() == 0) {
    throw pinnquad::InputError(path, 0, 0,
                               std::string("a topic ") + pinnquad::autopilot::CoreRecord::topic +
                                   ", which a core logs, or a " + "dataset (pinnquad import makes one of a log)",
                               "neither");
  }
  ReplayInput input;
  input.ticks = core_records<pinnquad::autopilot::CoreRecord>(*ticks);
  if (const logs::LogTopic* settings = log.topic(pinnquad::autopilot::CoreSettings::topic))
    take_settings(*settings, input);
  for (const std::string& warning : log.warnings) input.notes.push_back(warning);
  if (log.dropouts > 0) input.notes.push_back(in_words("the logger dropped out %zu times", log.dropouts));
  return input;
}

/// A core's ticks as one table; its settings are those of the table beside it, NAME_pinnquad_settings_0.csv.
inline ReplayInput read_core_table(const std::string& path) {
  const logs::LogSelection selection = [] {
    logs::LogSelection clock;
    clock.clock_column = logs::ulog2csv::clock_column;
    clock.clock_ticks_per_s = logs::ulog2csv::ticks_per_s;
    return clock;
  }();
  logs::FlightLog log;
  log.topics.push_back(logs::read_csv_topic(path, selection));
  log.topics.back().name = pinnquad::autopilot::CoreRecord::topic;
  std::string beside = path;
  const std::string name = pinnquad::autopilot::CoreRecord::topic;
  const std::size_t at = beside.rfind(name);
  std::error_code ignored;
  if (at != std::string::npos) {
    beside.replace(at, name.size(), pinnquad::autopilot::CoreSettings::topic);
    if (std::filesystem::is_regular_file(beside, ignored)) {
      log.topics.push_back(logs::read_csv_topic(beside, selection));
      log.topics.back().name = pinnquad::autopilot::CoreSettings::topic;
    }
  }
  return read_core_topics(path, log);
}

}  // namespace detail

/// Throws InputError, one line, for what is none of them.
inline ReplayInput read_replay_input(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::is_directory(path, ignored) && fs::exists(fs::path(path) / logs::dataset_file_name, ignored)) {
    return detail::read_dataset(path);
  }
  if (logs::kind_of_log(path) == logs::LogKind::csv) {
    const std::vector<std::string> head = pinnquad::detail::csv_header(path);
    const auto has = [&head](const char* name) { return std::find(head.begin(), head.end(), name) != head.end(); };
    if (has("timestamp") && has("body_rates_us")) return detail::read_core_table(path);
    ReplayInput input;
    input.flights.push_back(detail::read_flight_with_gaps(path));
    return input;
  }
  logs::LogSelection selection;
  selection.topics = {pinnquad::autopilot::CoreRecord::topic, pinnquad::autopilot::CoreSettings::topic};
  ProgressLine progress("reading " + pinnquad::printable(fs::path(path).filename().string()));
  selection.on_progress = [&progress](double share) { progress.update(share); };
  logs::FlightLog log = logs::read_log(path, selection);
  if (logs::kind_of_log(path) == logs::LogKind::usd) {
    for (logs::LogTopic& topic : log.topics) {
      if (topic.name == pinnquad::autopilot::CoreRecord::topic)
        complete_core_topic<pinnquad::autopilot::CoreRecord>(topic);
      if (topic.name == pinnquad::autopilot::CoreSettings::topic)
        complete_core_topic<pinnquad::autopilot::CoreSettings>(topic);
    }
  }
  return detail::read_core_topics(path, log);
}

}  // namespace programs
