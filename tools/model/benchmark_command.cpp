// SPDX-License-Identifier: MIT
// The row of a data set in a table: what train made of it, and what other methods predict of the same rows.
//   pinnquad benchmark my_set --predictions mine.csv --name "my method"
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/command.hpp"
#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "logs/json_file.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_table.hpp"

namespace {

using nlohmann::json;
using pinnquad::InputError;
using Commands = std::array<double, 4>;

const std::vector<std::string> predicted_columns = {"t", "u1", "u2", "u3", "u4"};
constexpr std::array<const char*, 10> kinds = {
    "structured_causal", "structured", "ridge_causal", "ridge",         "linear",
    "physics_informed",  "physics",    "vanilla",      "last_commands", "constant"};

struct BenchmarkOptions {
  std::vector<std::string> folders;
  std::string predictions, name = "other";
};

/// A folder with dataset/ of import, model/ of train and, once another method was scored, others.json.
struct Set {
  std::string folder, name;
  json report, others;

  std::string report_path() const { return folder + "/model/report.json"; }
  std::string others_path() const { return folder + "/others.json"; }
  std::vector<std::string> held_out() const { return report.at("held_out").get<std::vector<std::string>>(); }
};

Set read_set(const std::string& folder) {
  Set set;
  set.folder = folder;
  set.name = std::filesystem::absolute(folder + "/.").lexically_normal().parent_path().filename().string();
  set.report = pinnquad::logs::read_json_file(set.report_path());
  set.others =
      std::filesystem::exists(set.others_path()) ? pinnquad::logs::read_json_file(set.others_path()) : json::object();
  return set;
}

/// By time in microseconds.
std::map<std::int64_t, Commands> read_commands(const std::string& path) {
  std::map<std::int64_t, Commands> rows;
  pinnquad::detail::for_each_csv_row(path, predicted_columns, 1,
                                     [&](const std::vector<double>& values, std::size_t line, const auto& /*fields*/) {
                                       if (!(std::abs(values[0]) < 9e12))
                                         throw InputError(path, line, 1, "seconds", "more");
                                       const Commands u = {values[1], values[2], values[3], values[4]};
                                       if (!rows.emplace(std::llround(values[0] * 1e6), u).second) {
                                         throw InputError(path, line, 1, "a time of its own", "that of another row");
                                       }
                                     });
  return rows;
}

/// The file of each flight in a dataset, by the flight's name.
std::map<std::string, std::string> flight_files(const std::string& dataset) {
  std::map<std::string, std::string> files;
  const json read = pinnquad::logs::read_json_file(dataset + "/dataset.json");
  for (const json& flight : read.at("flights")) {
    files[flight.at("name").get<std::string>()] = dataset + "/" + flight.at("file").get<std::string>();
  }
  return files;
}

/// Judges predictions of all rows held out: R^2 of each command and their mean, as train has it.
json score(const Set& set, const std::string& predictions) {
  const std::vector<std::string> held_out = set.held_out();
  const std::map<std::string, std::string> files = flight_files(set.folder + "/dataset");
  const bool by_flight = std::filesystem::is_directory(predictions);
  if (!by_flight && held_out.size() > 1) {
    throw InputError(predictions, 0, 0,
                     "a folder with NAME.csv for each flight held out, " + programs::listed(held_out), "a file");
  }
  std::vector<Commands> truth, said;
  for (const std::string& flight : held_out) {
    const auto file = files.find(flight);
    if (file == files.end()) throw InputError(set.folder + "/dataset", 0, 0, "the flight " + flight, "none");
    const std::string path = by_flight ? predictions + "/" + flight + ".csv" : predictions;
    const std::map<std::int64_t, Commands> given = read_commands(path), flown = read_commands(file->second);
    const std::size_t before = truth.size();
    double first_missing_s = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [at_us, u] : flown) {
      const auto one = given.find(at_us);
      if (one == given.end()) {
        if (std::isnan(first_missing_s)) first_missing_s = static_cast<double>(at_us) * 1e-6;
        continue;
      }
      truth.push_back(u);
      said.push_back(one->second);
    }
    const std::size_t missing = flown.size() - (truth.size() - before);
    if (missing > 0) {
      throw InputError(
          path, 0, 0, "a prediction for each of the " + std::to_string(flown.size()) + " rows of " + file->second,
          "none for " + std::to_string(missing) + ", the first at t = " + pinnquad::number_text(first_missing_s));
    }
  }
  const auto errors = pinnquad::prediction_errors(said, truth);
  json found;
  double mean_square = 0;
  for (std::size_t motor = 0; motor < 4; ++motor) {
    found["r2_" + predicted_columns[motor + 1]] = errors.per_motor[motor].r_squared;
    mean_square += std::pow(errors.per_motor[motor].root_mean_square, 2) / 4;
  }
  found["r2"] = errors.mean.r_squared;
  found["rmse"] = std::sqrt(mean_square);
  found["rows"] = truth.size();
  return found;
}

std::string three_digits(const json& number) {
  if (!number.is_number()) return "";
  return programs::in_words("%.3f", number.get<double>());
}

/// "4.86; 13.7, -, 1.43": thrust of a rotor over mass, m/s^2; what roll, pitch and yaw answer with, rad/s^2; - is not
/// determined.
std::string vehicle_text(const json& vehicle) {
  std::string text;
  for (const char* key :
       {"thrust_m_s2", "roll_effectiveness_rad_s2", "pitch_effectiveness_rad_s2", "yaw_effectiveness_rad_s2"}) {
    const json numbers = vehicle.is_object() ? vehicle.value("numbers", json::object()) : json::object();
    const json number = numbers.value(key, json::object());
    const bool told = number.value("excitation", "not determined") != "not determined";
    text += text.empty() ? "" : text.find(';') == std::string::npos ? "; " : ", ";
    text += told ? programs::in_words("%.3g", number.at("value").get<double>()) : "-";
  }
  return text;
}

/// Markdown: a row for each set, R^2 of each kind and method on what is held out, the exported kind in bold.
void print_table(const std::vector<Set>& sets) {
  std::set<std::string> others;
  for (const Set& set : sets) {
    for (const auto& [name, found] : set.others.items()) others.insert(name);
  }
  std::string head = "| set | flights, rows | held out | lag, ms | vehicle |";
  for (const char* kind : kinds) head += std::string(" ") + kind + " |";
  for (const std::string& name : others) head += " " + name + " |";
  std::string line = "|";
  for (std::size_t i = 0; i < 5 + kinds.size() + others.size(); ++i) line += "---|";
  std::printf("%s\n%s\n", pinnquad::printable(head).c_str(), line.c_str());
  for (const Set& set : sets) {
    const json& settings = set.report.at("settings");
    const json lag = settings.value("lag_removed_s", json());
    const std::vector<std::string> held_out = set.held_out();
    std::string text =
        "| " + set.name + " | " + std::to_string(settings.at("flights").size()) + ", " +
        std::to_string(settings.at("rows").get<std::size_t>()) + " | " +
        (held_out.size() < 3 ? programs::listed(held_out) : std::to_string(held_out.size()) + " flights") + " | " +
        (lag.is_number() ? std::to_string(std::lround(1000 * lag.get<double>())) : "given") + " | " +
        vehicle_text(set.report.value("vehicle", json())) + " |";
    std::map<std::string, std::vector<double>> scores;  // of a kind, by seed
    for (const json& result : set.report.at("results")) {
      if (result.at("r2").is_number()) scores[result.at("model").get<std::string>()].push_back(result.at("r2"));
    }
    for (const char* kind : kinds) {
      const std::vector<double>& seeds = scores[kind];
      double mean = 0;
      for (const double r2 : seeds) mean += r2 / static_cast<double>(seeds.size());
      const std::string mark = set.report.value("exported_model", json()) == kind ? "**" : "";
      text += seeds.empty() ? " |" : " " + mark + three_digits(mean) + mark + " |";
    }
    for (const std::string& name : others) {
      const json found = set.others.value(name, json::object());
      text += " " + three_digits(found.value("r2", json())) + " |";
    }
    std::printf("%s\n", pinnquad::printable(text).c_str());
  }
}

int benchmark(const BenchmarkOptions& options) {
  if (!options.predictions.empty() && options.folders.size() > 1) {
    throw std::invalid_argument("--predictions are of one set, found " + std::to_string(options.folders.size()));
  }
  std::vector<Set> sets;
  std::string path;
  try {
    for (const std::string& folder : options.folders) {
      sets.push_back(read_set(folder));
      path = sets.back().report_path();
      if (options.predictions.empty()) continue;
      sets[0].others[options.name] = score(sets[0], options.predictions);
    }
    print_table(sets);
  } catch (const json::exception&) {
    throw InputError(path, 0, 0, "what pinnquad train writes of flights that it holds out", "other JSON");
  }
  if (!options.predictions.empty()) {
    pinnquad::AtomicFile file(sets[0].others_path());
    file.stream() << sets[0].others.dump(1, ' ', false, json::error_handler_t::replace) << "\n";
    file.commit();
  }
  return 0;
}

}  // namespace

namespace programs {

Command benchmark_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "benchmark", "Prints a row of results per data set, with those of your own method beside them");
  const auto options = std::make_shared<BenchmarkOptions>();
  add_paths(*line, "folders", options->folders, "DIR", "folders with dataset/ (from import) and model/ (from train)")
      ->required();
  add_path(
      *line, "--predictions", options->predictions, "FILE.csv|FOLDER",
      "another method's: t,u1,u2,u3,u4 for each row of dataset/NAME.csv, NAME being held out; of several flights a "
      "folder of NAME.csv");
  line->add_option("--name", options->name, "of that method")->type_name("TEXT")->capture_default_str();
  line->footer(
      "Examples:\n"
      "  pinnquad import logs --out mine/dataset\n"
      "  pinnquad train mine/dataset --hold-out flight7 --out mine/model\n"
      "  pinnquad benchmark mine --predictions mine.csv --name \"my method\"\n"
      "A table in Markdown: R^2, the mean of the four commands', on the flights held out; of the vehicle thrust of a "
      "rotor\n"
      "over mass (m/s^2), what roll, pitch and yaw answer with (rad/s^2). DIR/others.json keeps the methods. Public "
      "sets:\n"
      "docs/data_sets.md.\n"
      "Exit codes: 0; 2 bad input or a file that can't be read or written.");
  return {line, [options] { return benchmark(*options); }};
}

}  // namespace programs
