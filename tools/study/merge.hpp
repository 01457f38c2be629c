// SPDX-License-Identifier: MIT
// Joins the folders of a study's shards into one, as if a single machine had run it.
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "study/campaign.hpp"

namespace study {

namespace detail {

/// The trainings of a study and their epochs, from its settings: models in order, flights, seeds.
inline std::vector<std::pair<RowId, int>> expected_rows(const nlohmann::json& configuration) {
  std::vector<std::pair<RowId, int>> rows;
  const auto epochs = configuration.at("epochs").get<int>();
  const auto first_flight = configuration.at("flight_seed").get<std::uint64_t>();
  const auto first = configuration.at("first_seed").get<std::uint64_t>();
  for (const nlohmann::json& model : configuration.at("models")) {
    const auto flights = model.at("flights").get<std::uint64_t>();
    const bool trained = model.at("trained").get<bool>();
    const auto seeds = trained ? configuration.at("seeds").get<std::uint64_t>() : 1;
    for (std::uint64_t flight = 0; flight < flights; ++flight) {
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        rows.push_back({{model.at("id"), model.at("flight"), first_flight + flight, trained ? first + seed : 0},
                        trained ? epochs : 0});
      }
    }
  }
  return rows;
}

/// A shard's folder as read.
struct Part {
  std::string path;
  nlohmann::json configuration;
  StoredRows stored;
  std::map<RowId, int> own;  ///< the trainings of its study and their epochs
  double share = 1;          ///< of its rows, what the folder to write did not hold already
};

inline Part read_part(const std::string& path) {
  Part part;
  part.path = path;
  part.configuration = read_configuration(path + "/study.json");
  try {
    for (const auto& [id, epochs] : expected_rows(part.configuration)) part.own[id] = epochs;
  } catch (const nlohmann::json::exception&) {
    throw pinnquad::InputError(path + "/study.json", 0, 0, "the settings of a study", "something else");
  }
  part.stored = read_rows(path + "/rows.csv", part.configuration.value("columns", rows_header()));
  if (part.stored.broken > 0) {
    programs::complain("merge", path + "/rows.csv: " + std::to_string(part.stored.broken) + " not whole; left out");
  }
  return part;
}

/// A row of each training in `part` into `rows`. Throws std::invalid_argument: rows of another study, or figures that
/// are not those of a part before.
inline void add_rows(const Part& part, std::map<RowId, std::string>& rows) {
  require_own_rows(part.path + "/rows.csv", part.stored, part.own, part.configuration.value("weights", "") == "best");
  for (const auto& [id, row] : part.stored.rows) {
    const auto [known, is_new] = rows.emplace(id, row);
    if (!is_new && without_time(known->second) != without_time(row)) {
      throw std::invalid_argument(part.path + " has other figures than a part before for " + to_string(id));
    }
  }
}

/// Contents of the folder to write. Throws InputError: rows without settings.
inline std::optional<Part> held_before(const StudyFolder& folder) {
  std::error_code error;
  if (std::filesystem::exists(folder.configuration(), error)) return read_part(folder.path());
  if (std::filesystem::exists(folder.rows(), error))
    throw pinnquad::InputError(folder.configuration(), 0, 0, "the settings of the rows beside it", "none");
  return {};
}

/// How much of a part's rows `before` does not have.
inline double new_share(const Part& part, const Part& before) {
  if (part.stored.rows.empty()) return 0;
  const auto is_new = [&before](const auto& row) { return before.stored.rows.count(row.first) == 0; };
  const auto count = std::count_if(part.stored.rows.begin(), part.stored.rows.end(), is_new);
  return static_cast<double>(count) / static_cast<double>(part.stored.rows.size());
}

/// One study.json for all parts: times added up as far as the parts' rows are new, processors named.
inline nlohmann::json joined_configuration(const std::vector<Part>& parts) {
  nlohmann::json joined = parts.front().configuration;
  std::set<std::string> processors;
  double wall_s = 0;
  std::string started = joined.value("started", ""), finished;
  int threads = 0, folders = 0;
  for (const Part& part : parts) {
    const nlohmann::json& c = part.configuration;
    std::istringstream cpu(c.value("cpu", "unknown"));  // of a merged folder: several
    for (std::string name; std::getline(cpu >> std::ws, name, ';');) processors.insert(name);
    wall_s += part.share * c.value("wall_s", 0.0);
    if (part.share > 0) threads += c.value("threads", 0);
    if (part.share > 0) folders += c.value("parts", 1);
    started = std::min(started, c.value("started", started));
    if (c.contains("finished") && c["finished"].is_string())
      finished = std::max(finished, c["finished"].get<std::string>());
  }
  std::string names;
  for (const std::string& name : processors) names += (names.empty() ? "" : "; ") + name;
  joined["cpu"] = names;
  joined["wall_s"] = wall_s;
  joined["threads"] = threads;
  joined["started"] = started;
  joined["finished"] = finished;
  joined["shard"] = "1/1";
  joined["parts"] = folders;
  return joined;
}

}  // namespace detail

/// Joins the parts `paths` with what `out` holds already; `out` itself may be among them. Exit code: 0, 1 if trainings
/// are missing. Throws InputError, OutputError; Interrupted, which leaves `out` as it was; std::invalid_argument for
/// parts of different studies and for two different rows of one training.
inline int merge(const std::vector<std::string>& paths, const std::string& out) {
  std::vector<detail::Part> parts;
  std::map<RowId, std::string> rows;
  programs::FileRoles roles;
  for (const std::string& path : paths) {
    std::error_code error;
    if (std::filesystem::equivalent(path, out, error)) continue;
    for (const char* name : {"/study.json", "/rows.csv"}) roles.reads("merge", path + name);
    parts.push_back(detail::read_part(path));
    const std::string differs = difference(parts.front().configuration, parts.back().configuration, {"shard"});
    if (!differs.empty()) {
      throw std::invalid_argument(path + " is of another study than " + parts.front().path + ": " + differs);
    }
    detail::add_rows(parts.back(), rows);
  }
  if (parts.empty()) throw std::invalid_argument(out + " is the folder to write; there is nothing to join");
  std::error_code error;
  std::set<std::string> series;
  for (const detail::Part& part : parts) {
    for (const auto& entry : std::filesystem::directory_iterator(part.path + "/series", error)) {
      if (entry.path().extension() != ".csv") continue;
      roles.reads("merge", entry.path().string());
      series.insert(entry.path().filename().string());
    }
  }
  for (const char* name : {"/study.json", "/rows.csv"}) roles.writes("--out", out + name);
  for (const std::string& name : series) roles.writes("--out", out + "/series/" + name);
  nlohmann::json joined = detail::joined_configuration(parts);
  const std::size_t named = parts.size();
  std::size_t held = 0;
  const StudyFolder folder(out);
  if (std::optional<detail::Part> before = detail::held_before(folder)) {
    const std::string differs = difference(before->configuration, joined);
    if (!differs.empty()) {
      throw std::invalid_argument(folder.configuration() + ": of another study: " + differs + "; give another --out");
    }
    detail::add_rows(*before, rows);
    held = before->stored.rows.size();
    for (detail::Part& part : parts) part.share = detail::new_share(part, *before);
    parts.push_back(*std::move(before));
    joined = detail::joined_configuration(parts);
  }
  const std::vector<std::pair<RowId, int>> expected = detail::expected_rows(joined);
  std::vector<std::string> lines;
  const RowId* missing = nullptr;
  for (const auto& [id, epochs] : expected) {
    const auto row = rows.find(id);
    if (row != rows.end()) {
      lines.push_back(row->second);
    } else if (missing == nullptr) {
      missing = &id;
    }
  }
  programs::stop_if_interrupted();
  for (std::size_t i = 0; i < named; ++i) {
    for (const auto& entry : std::filesystem::directory_iterator(parts[i].path + "/series", error)) {
      if (entry.path().extension() != ".csv") continue;
      pinnquad::AtomicFile copy(out + "/series/" + entry.path().filename().string());
      copy.stream() << pinnquad::file_text(entry.path().string());
      copy.commit();
    }
  }
  joined["trainings"] = expected.size();
  joined["trainings_finished"] = lines.size();
  if (missing != nullptr) joined["finished"] = nlohmann::json();
  write_configuration(folder.configuration(), joined);
  write_rows(folder.rows(), lines, joined.value("columns", rows_header()));
  std::printf("%zu of %zu trainings from %zu folders are in %s, %zu of them from before\n", lines.size(),
              expected.size(), named, folder.rows().c_str(), held);
  if (missing == nullptr) return 0;
  programs::complain("merge", std::to_string(expected.size() - lines.size()) + " trainings are missing, the first is " +
                                  to_string(*missing));
  return programs::exit_failed;
}

}  // namespace study
