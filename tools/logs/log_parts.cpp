// SPDX-License-Identifier: MIT
#include "logs/log_parts.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "logs/blackbox.hpp"
#include "logs/bound_log.hpp"
#include "logs/nearest_names.hpp"
#include "logs/ulog2csv_folder.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/io/text_file.hpp"

namespace pinnquad::logs {
namespace {

/// A pattern has one pair of brackets, and at most this many stars: each may stand for any letters, as few as will do.
constexpr std::size_t most_stars = 6;

/// True where the whole name fits; `begin` and `end` are what the brackets hold.
bool fits(std::string_view pattern, std::string_view name, std::size_t at, std::size_t& begin, std::size_t& end) {
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '(') {
      begin = at;
    } else if (pattern[i] == ')') {
      end = at;
    } else if (pattern[i] == '*') {
      for (std::size_t next = at; next <= name.size(); ++next) {
        if (fits(pattern.substr(i + 1), name, next, begin, end)) return true;
      }
      return false;
    } else if (at >= name.size() || name[at++] != pattern[i]) {
      return false;
    }
  }
  return at == name.size();
}

/// The part of a name within the brackets of the pattern; the name itself where it does not fit, or is longer than any
/// name.
std::string part_of_name(std::string_view pattern, const std::string& name) {
  constexpr std::size_t longest = 120;
  std::size_t begin = 0, end = 0;
  if (name.size() > longest || !is_name_pattern(pattern) || !fits(pattern, name, 0, begin, end)) return name;
  return end > begin ? name.substr(begin, end - begin) : name;
}

const LogText& labels_of(const LogTopic& topic, const NamedColumn& wanted, const Mapping& mapping) {
  if (const LogText* text = topic.text(wanted.name)) return *text;
  std::vector<std::string> known;
  for (const LogText& text : topic.texts) known.push_back(text.name);
  for (const LogColumn& column : topic.columns) known.push_back(column.name);
  throw InputError(mapping.file, wanted.place.line, wanted.place.column,
                   "a column of " + topic_words(topic.name, topic.instance) + " in " + topic.file,
                   "`" + printable(wanted.name) + "`, which it has not; " + nearest_names(wanted.name, known));
}

/// The topic's rows dealt to a topic each, column by column, which is let go then: the table is never there twice.
std::vector<LogTopic> dealt(LogTopic topic, const std::vector<std::vector<std::size_t>>& rows) {
  std::vector<LogTopic> parts(rows.size());
  const auto deal = [&](auto& values, const auto& to) {
    auto all = std::move(values);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto& part = to(parts[i]);
      if (rows.size() == 1) {  // every row is its
        part = std::move(all);
        return;
      }
      part.reserve(rows[i].size());
      for (const std::size_t row : rows[i]) part.push_back(std::move(all[row]));
    }
  };
  for (LogTopic& part : parts) {
    part.name = topic.name;
    part.instance = topic.instance;
    part.file = topic.file;
    part.places_are_lines = topic.places_are_lines;
  }
  deal(
      topic.time_s, [](LogTopic & part) -> auto& { return part.time_s; });
  deal(
      topic.place, [](LogTopic & part) -> auto& { return part.place; });
  for (LogColumn& column : topic.columns) {
    for (LogTopic& part : parts) part.columns.push_back({column.name, {}, column.unit});
    deal(
        column.values, [](LogTopic & part) -> auto& { return part.columns.back().values; });
  }
  for (LogText& text : topic.texts) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto first =
          std::find_if(rows[i].begin(), rows[i].end(), [&](std::size_t row) { return row >= text.first_text; });
      const auto index = static_cast<std::size_t>(first - rows[i].begin());
      parts[i].texts.push_back({text.name, {}, first == rows[i].end() ? 0 : index});
    }
    deal(
        text.values, [](LogTopic & part) -> auto& { return part.texts.back().values; });
  }
  return parts;
}

}  // namespace

bool is_name_pattern(std::string_view pattern) {
  const std::size_t open = pattern.find('('), close = pattern.find(')');
  return open != pattern.npos && close != pattern.npos && open < close && pattern.find('(', open + 1) == pattern.npos &&
         pattern.find(')', close + 1) == pattern.npos &&
         static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), '*')) <= most_stars;
}

bool stands_beside_log(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));  // of a FAT card: .GPS.CSV
  const auto ends = [&name](std::string_view end) {
    return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  return ends(".gps.csv") || ends(".gps.gpx") || ends(".headers.csv") || ends(".event");
}

namespace {

/// A file, or the flights of a blackbox log of several, numbered as blackbox_decode does.
void add_file(const std::string& path, std::vector<LogPlace>& places) {
  const std::string name = printable(std::filesystem::path(path).stem().string());
  const bool is_blackbox = kind_of_log(path) == LogKind::blackbox;
  const std::size_t flights = is_blackbox ? blackbox_flights(file_text(path)).size() : 1;
  for (std::size_t flight = 0; flight < flights; ++flight) {
    const std::string number = (flight < 9 ? ".0" : ".") + std::to_string(flight + 1);
    places.push_back({path, "", flights > 1 ? name + number : name, flight});
  }
}

}  // namespace

bool is_vehicles_log(const std::string& path) {
  try {
    const LogKind kind = kind_of_log(path);
    return kind != LogKind::csv && kind != LogKind::ulog2csv_folder;
  } catch (const InputError&) {
    return false;
  }
}

std::vector<LogPlace> logs_at(const std::string& path, const LogSelection& selection, bool tables_have_clock) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path shown = path;
  if (!shown.has_filename()) shown = shown.parent_path();
  std::vector<LogPlace> places;
  if (!fs::is_directory(path, error)) {
    add_file(path, places);
    return places;
  }
  std::vector<std::string> files, tables;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    const std::string file = entry->path().string();
    std::error_code ignored;
    if (!entry->is_regular_file(ignored)) continue;
    if (entry->path().extension() == ".ulg" || is_vehicles_log(file)) files.push_back(file);
    if (entry->path().extension() == ".csv") tables.push_back(entry->path().string());
  }
  if (error) throw InputError(path, 0, 0, "a readable folder", "none (" + error.message() + ")");
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) add_file(file, places);
  if (!places.empty()) return places;
  std::sort(tables.begin(), tables.end());
  if (tables_have_clock) {
    for (const std::string& file : tables) {
      places.push_back({file, "", printable(fs::path(file).stem().string()), 0});
    }
    if (!places.empty()) return places;
  }
  for (const std::string& log : ulog2csv_logs(path, selection)) {
    places.push_back({path, log, printable(log), 0});
  }
  if (places.empty()) {
    throw InputError(path, 0, 0, "a folder of logs, or one that ulog2csv wrote", "neither");
  }
  return places;
}

void tell_apart(std::vector<LogPlace>& places) {
  std::map<std::string, std::vector<LogPlace*>> by_name;
  for (LogPlace& place : places) by_name[place.name].push_back(&place);
  for (const auto& [name, alike] : by_name) {
    std::vector<std::filesystem::path> folders;
    for (const LogPlace* place : alike) {
      folders.push_back(std::filesystem::absolute(place->path).lexically_normal().parent_path());
    }
    bool told = alike.size() == 1;
    while (!told && folders.front().has_relative_path()) {
      std::set<std::string> different;
      for (const auto& folder : folders) different.insert(folder.filename().string());
      told = different.size() == alike.size();
      for (std::size_t i = 0; i < alike.size(); ++i) {
        if (told) alike[i]->name = printable(folders[i].filename().string()) + "_" + name;
        folders[i] = folders[i].parent_path();
      }
    }
  }
}

std::vector<LogPart> parts_of(FlightLog log, const std::string& name, const Mapping& mapping) {
  std::vector<LogPart> parts;
  const auto trajectory_of = [&mapping](const LogPart& part) {
    if (!mapping.trajectory_column.name.empty() && !part.log.topics.empty()) {
      const LogText& labels = labels_of(part.log.topics[0], mapping.trajectory_column, mapping);
      if (!labels.values.empty()) return printable(labels.values[0]);
    }
    return mapping.trajectory.empty() ? part.name : part_of_name(mapping.trajectory, part.name);
  };
  if (mapping.flight_column.name.empty() || log.topics.empty()) {
    parts.push_back({std::move(log), name, ""});
  } else {
    const LogTopic& topic = log.topics[0];
    const LogText& labels = labels_of(topic, mapping.flight_column, mapping);
    std::map<std::string, std::size_t> known;
    std::vector<std::vector<std::size_t>> rows;
    std::vector<std::string> names;
    for (std::size_t row = 0; row < labels.values.size(); ++row) {
      const auto [entry, is_new] = known.emplace(labels.values[row], rows.size());
      if (is_new) {
        constexpr std::size_t most_flights = 10000;
        if (rows.size() == most_flights) {
          throw InputError(mapping.file, mapping.flight_column.place.line, mapping.flight_column.place.column,
                           "a column with a label for each flight", "more than 10000 labels");
        }
        rows.emplace_back();
        names.push_back(labels.values[row].empty() ? name : printable(labels.values[row]));
      }
      rows[entry->second].push_back(row);
    }
    std::vector<LogTopic> topics = dealt(std::move(log.topics[0]), rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      LogPart part;
      part.name = names[i];
      part.log.source = log.source;
      part.log.parameters = log.parameters;
      part.log.topics.push_back(std::move(topics[i]));
      parts.push_back(std::move(part));
    }
  }
  for (LogPart& part : parts) part.trajectory = trajectory_of(part);
  return parts;
}

std::string free_name(const Dataset& dataset, const std::string& name, int part) {
  const auto numbered = [&name](int number) { return number > 1 ? name + " (" + std::to_string(number) + ")" : name; };
  const auto& flights = dataset.flights();
  while (
      std::any_of(flights.begin(), flights.end(), [&](const Flight& other) { return other.name == numbered(part); })) {
    ++part;
  }
  return numbered(part);
}

}  // namespace pinnquad::logs
