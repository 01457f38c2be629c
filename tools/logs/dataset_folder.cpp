// SPDX-License-Identifier: MIT
#include "pinnquad/logs/dataset_folder.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "logs/json_file.hpp"
#include "logs/whole_folder.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/io/atomic_file.hpp"

namespace pinnquad::logs {
namespace {

constexpr int dataset_format = 1;

/// A flight's name as that of a file: letters, digits, '-', '_' and '.', and none that another flight has.
std::string flight_file(const std::string& name, std::set<std::string>& taken) {
  constexpr std::size_t most_letters = 100;
  std::string stem;
  for (const char c : name.substr(0, most_letters)) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
    stem += plain ? c : '_';
  }
  if (stem.empty() || stem.front() == '.') stem.insert(0, "flight");
  std::string file = stem + ".csv";
  for (int copy = 2; !taken.insert(file).second; ++copy) file = stem + "_" + std::to_string(copy) + ".csv";
  return file;
}

/// The names of all files in a folder that hold a dataset and nothing else; empty if it is none.
std::set<std::string> dataset_files(const std::string& folder) {
  try {
    const nlohmann::json json = read_json_file((std::filesystem::path(folder) / dataset_file_name).string());
    if (!json.is_object() || json.value("format", 0) != dataset_format) return {};
    std::set<std::string> files = {dataset_file_name};
    for (const nlohmann::json& flight : json.at("flights")) files.insert(flight.at("file").get<std::string>());
    return files;
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

void require_dataset_place(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) throw OutputError(path, "it is there already, and is no folder");
  const std::set<std::string> ours = dataset_files(path);
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error)) {
    const std::string name = entry.path().filename().string();
    if (ours.count(name) > 0 && entry.is_regular_file(error)) continue;
    throw OutputError(path,
                      "the folder is there already and holds " + quoted_cell(name) + ", which is no part of a dataset");
  }
  if (error) throw OutputError(path, error.message());
}

std::vector<std::string> flight_files(const ImportedDataset& dataset) {
  std::set<std::string> taken;
  std::vector<std::string> files;
  for (const Flight& flight : dataset.flights.flights()) files.push_back(flight_file(flight.name, taken));
  return files;
}

std::string dataset_json(const ImportedDataset& dataset) {
  const std::vector<std::string> files = flight_files(dataset);
  nlohmann::json json = {
      {"format", dataset_format},
      {"sample_period_s", dataset.sample_period_s},
      {"lag_removed_s", dataset.lag_removed_s},
      {"absent", dataset.absent},
      {"airframe", printable(dataset.airframe)},
      {"mapping", printable(dataset.mapping)},
      {"thrust_curve",
       {{"k", dataset.curve.k}, {"fitted", dataset.curve.fitted}, {"told", printable(dataset.curve.told)}}},
      {"rows", dataset.flights.rows()},
      {"flights", nlohmann::json::array()},
      {"steps", nlohmann::json::array()},
      {"notes", nlohmann::json::array()},
      {"warnings", nlohmann::json::array()}};
  for (std::size_t i = 0; i < dataset.flights.size(); ++i) {
    const Flight& flight = dataset.flights[i];
    json["flights"].push_back({{"name", printable(flight.name)},
                               {"file", files[i]},
                               {"trajectory", printable(flight.trajectory)},
                               {"weight", flight.weight},
                               {"rows", flight.size()},
                               {"source", i < dataset.sources.size() ? printable(dataset.sources[i]) : ""}});
  }
  for (const ImportStep& step : dataset.steps) {
    json["steps"].push_back({{"step", printable(step.name)},
                             {"rows_before", step.rows_before},
                             {"rows_after", step.rows_after},
                             {"told", printable(step.told)}});
  }
  for (const std::string& note : dataset.notes) json["notes"].push_back(printable(note));
  for (const std::string& warning : dataset.warnings) json["warnings"].push_back(printable(warning));
  return json.dump(1);
}

void write_dataset_folder(const std::string& path, const ImportedDataset& dataset,
                          const std::function<void(double)>& go_on) {
  require_dataset_place(path);
  WholeFolder folder(path);
  const std::vector<std::string> files = flight_files(dataset);
  const double all = static_cast<double>(std::max<std::size_t>(dataset.flights.rows(), 1));
  std::size_t written = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    write_flight_csv((folder.path() / files[i]).string(), dataset.flights[i], [&](std::size_t rows) {
      constexpr std::size_t look = 1000;
      if (go_on && rows % look == 0) go_on(static_cast<double>(written + rows) / all);
    });
    written += dataset.flights[i].size();
  }
  AtomicFile file((folder.path() / dataset_file_name).string());
  file.stream() << dataset_json(dataset) << '\n';
  file.commit();
  if (go_on) go_on(1.0);
  folder.commit();
}

ImportedDataset read_dataset_folder(const std::string& path, const OnProgress& on_progress) {
  namespace fs = std::filesystem;
  const std::string about = (fs::path(path) / dataset_file_name).string();
  const nlohmann::json json = read_json_file(about);
  const auto refuse = [&about](const std::string& expected, const std::string& found) {
    throw InputError(about, 0, 0, expected, found);
  };
  if (!json.is_object() || !json.value("format", nlohmann::json()).is_number_integer() ||
      json["format"] != dataset_format)
    refuse("a dataset of format " + std::to_string(dataset_format), "something else");
  const auto text = [&](const nlohmann::json& from, const char* key) {
    const nlohmann::json value = from.is_object() ? from.value(key, nlohmann::json()) : nlohmann::json();
    if (!value.is_string()) refuse("a text \"" + std::string(key) + "\"", value.type_name());
    return value.get<std::string>();
  };
  const auto number = [&](const nlohmann::json& from, const char* key, double least) {
    const nlohmann::json value = from.is_object() ? from.value(key, nlohmann::json()) : nlohmann::json();
    const double read = value.is_number() ? value.get<double>() : std::nan("");
    if (!(read >= least && read <= 1e12)) {
      refuse("a number \"" + std::string(key) + "\", " + number_text(least) + " or more",
             value.is_number() ? number_text(read) : value.type_name());
    }
    return read;
  };
  const auto list = [&](const char* key) {
    const nlohmann::json value = json.value(key, nlohmann::json::array());
    if (!value.is_array()) refuse("a list \"" + std::string(key) + "\"", value.type_name());
    return value;
  };
  ImportedDataset dataset;
  dataset.sample_period_s = number(json, "sample_period_s", 0);
  dataset.lag_removed_s = number(json, "lag_removed_s", -4);
  if (json.contains("airframe")) dataset.airframe = text(json, "airframe");
  if (json.contains("mapping")) dataset.mapping = text(json, "mapping");
  if (json.contains("thrust_curve")) {
    const nlohmann::json& curve = json["thrust_curve"];
    dataset.curve = {number(curve, "k", 0), curve.value("fitted", nlohmann::json()) == nlohmann::json(true),
                     text(curve, "told")};
    if (dataset.curve.k > 1) refuse("a thrust curve `k` from 0 to 1", number_text(dataset.curve.k));
  }
  const nlohmann::json flights = list("flights");
  for (const nlohmann::json& entry : flights) {
    if (on_progress)
      on_progress("reading flights", static_cast<double>(dataset.sources.size()) / static_cast<double>(flights.size()));
    const std::string file = text(entry, "file");
    if (fs::path(file).filename() != fs::path(file) || file.empty() || file.front() == '.' ||
        file.find('\0') != std::string::npos) {
      refuse("the name of a file in this folder", quoted_cell(file));
    }
    const std::string place = (fs::path(path) / file).string();
    Flight flight = read_flight_csv(place, minimum_flight_rows, extra_columns_in(place));
    const double rows = number(entry, "rows", 0);
    if (!(std::abs(rows - static_cast<double>(flight.size())) < 0.5)) {
      throw InputError(place, 0, 0, number_text(rows) + " rows, as " + dataset_file_name + " says",
                       std::to_string(flight.size()));
    }
    flight.name = text(entry, "name");
    flight.trajectory = text(entry, "trajectory");
    if (entry.contains("weight")) flight.weight = number(entry, "weight", 0);
    try {
      dataset.flights.add(std::move(flight));
    } catch (const std::invalid_argument& refused) {
      refuse("flights that make a dataset", refused.what());
    }
    dataset.sources.push_back(text(entry, "source"));
  }
  if (dataset.flights.size() == 0) refuse("a flight", "none");
  for (const nlohmann::json& step : list("steps")) {
    dataset.steps.push_back({text(step, "step"), static_cast<std::size_t>(number(step, "rows_before", 0)),
                             static_cast<std::size_t>(number(step, "rows_after", 0)), text(step, "told")});
  }
  const auto texts = [&](const char* key, std::vector<std::string>& to) {
    for (const nlohmann::json& each : list(key)) {
      if (!each.is_string()) refuse("texts in the list \"" + std::string(key) + "\"", each.type_name());
      to.push_back(each.get<std::string>());
    }
  };
  texts("absent", dataset.absent);
  texts("notes", dataset.notes);
  texts("warnings", dataset.warnings);
  return dataset;
}

}  // namespace pinnquad::logs
