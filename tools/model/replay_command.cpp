// SPDX-License-Identifier: MIT
// Runs a model over a log, row by row, with the checks and guards that fly; or, where the log has what a flight stack's
// core received, the core itself, and compares what it answers with what was logged.
//   pinnquad replay flight.csv --model my_model/model.hpp
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/folders.hpp"
#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "model/flight_model.hpp"
#include "model/given_model.hpp"
#include "model/learnt_vehicle.hpp"
#include "model/replay_core.hpp"
#include "model/replay_input.hpp"
#include "model/replay_summary.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_table.hpp"

namespace {

using namespace pinnquad;
using programs::Replayed;
using programs::ReplayInput;

struct ReplayOptions {
  std::string log;
  std::vector<std::string> models;
  std::string guard = "flight_stack";
  std::vector<std::string> settings;
  double tolerance = 1e-5;
  std::string out;
  std::string learnt;
  bool json = false;
};

programs::ReplayGuard guard_of(const ReplayOptions& options) {
  return options.guard == "training" ? programs::ReplayGuard::training : programs::ReplayGuard::flight_stack;
}

/// NAME=VALUE of --set. Throws std::invalid_argument: no such setting, no number.
void apply_setting(const std::string& text, pinnquad::autopilot::CoreSettings& settings) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  bool found = false;
  std::string known;
  programs::each_core_number(settings, [&](const std::string& of, const char* unit, auto& number) {
    if (of == "timestamp") return;
    programs::add_to_list(known, of);
    if (name != of) return;
    found = true;
    using Number = std::decay_t<decltype(number)>;
    double value = 0;
    const bool is_number = equals != std::string::npos &&
                           programs::parse_decimal(text.substr(equals + 1), 0.0, 1e9, value) &&
                           (std::is_floating_point_v<Number> || std::floor(value) >= value);
    if (!is_number) {
      throw std::invalid_argument(
          "--set: expected " + name + "=NUMBER" + (std::is_floating_point_v<Number> ? "" : ", a whole one,") +
          (std::string(unit) == "1" ? "" : std::string(" in ") + unit) + ", found '" + text + "'");
    }
    number = static_cast<Number>(value);
  });
  if (!found) throw std::invalid_argument("--set: no setting named '" + name + "'; known: " + known);
}

Replayed replay_flights(const ReplayOptions& options, const ReplayInput& input, const std::vector<BlockModel>& models) {
  if (models.size() > 1) {
    throw std::invalid_argument(
        "--model: a log of flights takes one model; several are for a log of a core, which names them");
  }
  if (!options.learnt.empty()) {
    throw std::invalid_argument("--learnt: a flight stack's core learns, and the log has none of its records");
  }
  if (!options.settings.empty()) {
    throw std::invalid_argument(
        "--set: these are settings of a flight stack's core, and the log has none of its records");
  }
  Replayed replayed;
  replayed.notes = input.notes;
  std::size_t rows = 0;
  for (const Flight& flight : input.flights) {
    replayed.flights.push_back(flight.name);
    rows += flight.size();
  }
  programs::ProgressLine progress("replaying " + std::to_string(rows) + " rows");
  replayed.rows.reserve(rows);
  const auto model = programs::flight_model(models.front(), guard_of(options));
  for (std::size_t i = 0; i < input.flights.size(); ++i) {
    model->run(input.flights[i], i, replayed.rows,
               [&] { progress.update(static_cast<double>(replayed.rows.size()) / static_cast<double>(rows)); });
  }
  return replayed;
}

/// The model that flew in each tick, by checksum; one model alone stands for whatever flew.
class FlownModels {
 public:
  explicit FlownModels(const std::vector<BlockModel>& models) {
    for (const BlockModel& model : models) checksums_.push_back(model.checksum());
  }

  /// Throws std::invalid_argument for one that is not among several.
  std::optional<std::size_t> of(const pinnquad::autopilot::CoreRecord& tick, Replayed& replayed) {
    if (tick.model == 0) return {};
    const auto found = std::find(checksums_.begin(), checksums_.end(), tick.model);
    if (found != checksums_.end()) return static_cast<std::size_t>(found - checksums_.begin());
    const std::string flew = programs::in_words("a model of checksum %08x flew from %.3f s", tick.model,
                                                1e-6 * static_cast<double>(tick.timestamp));
    if (checksums_.size() > 1) throw std::invalid_argument("--model: " + flew + ", and none of these is it");
    if (std::find(strangers_.begin(), strangers_.end(), tick.model) == strangers_.end()) {
      strangers_.push_back(tick.model);
      replayed.notes.push_back(flew + ", not the one given, " + programs::in_words("%08x", checksums_.front()) +
                               ": what follows may differ for that");
    }
    return 0;
  }

 private:
  std::vector<std::uint32_t> checksums_, strangers_;
};

/// The limits that the core had are those of the block. Throws std::invalid_argument where it has none; others are
/// noted.
void compare_trust(const BlockModel& model, const pinnquad::autopilot::CoreSettings& logged, Replayed& replayed) {
  if (!(logged.distance_limit > 0)) return;
  const unsigned char* trust = model.with([](const auto& own) { return own.records().trust; });
  if (trust == nullptr) {
    throw std::invalid_argument("--model: the core that flew had limits of distance and command residual, and " +
                                model.path() + " has none");
  }
  double limits[5];
  std::memcpy(limits, trust, sizeof limits);
  const auto same = [](double own, float flown) {
    return static_cast<float>(own) >= flown && static_cast<float>(own) <= flown;
  };
  if (!same(limits[0], logged.distance_limit) || !same(limits[2], logged.innovation_limit)) {
    replayed.notes.push_back("the block's limits of trust are not those that flew: what follows may differ for that");
  }
}

/// The vehicle that a core learnt, for --learnt: noted tick by tick, written where all of it is known.
class Learnt {
 public:
  explicit Learnt(const Airframe<float>& start) : vehicle_(start) {}

  void note(const pinnquad::autopilot::CoreRecord& tick, const OnboardInverse<float>* learner) {
    if (tick.learning == 0) return;
    const double time_s = 1e-6 * static_cast<double>(tick.timestamp);
    if (!(from_s_ >= 0)) from_s_ = time_s;
    if (learner == nullptr) {
      if (!(unknown_s_ >= 0)) unknown_s_ = time_s;
      return;
    }
    vehicle_.note(time_s - from_s_, *learner);
  }
  /// Throws std::invalid_argument where the log does not have all that was learnt from.
  /// Returns why there is no model among the files; empty where there is one.
  std::string write(const std::string& folder, const std::string& name, const std::string& flight,
                    const OnboardInverse<float>* learner) const {
    if (!(from_s_ >= 0)) throw std::invalid_argument("--learnt: in no tick of this log a vehicle is learnt");
    if (unknown_s_ >= 0 || learner == nullptr) {
      throw std::invalid_argument(programs::in_words(
          "--learnt: at %.3f s the learner had seen flight that is not in this log: only a log of all "
          "ticks of its flights tells what was learnt",
          unknown_s_ >= 0 ? unknown_s_ : from_s_));
    }
    programs::make_folders(folder);
    return vehicle_.write(folder, name, flight, *learner);
  }

 private:
  programs::LearntVehicle<float> vehicle_;
  double from_s_ = -1, unknown_s_ = -1;
};

Replayed replay_core(const ReplayOptions& options, const ReplayInput& input, const std::vector<BlockModel>& models) {
  Replayed replayed;
  replayed.of_core = true;
  replayed.notes = input.notes;
  replayed.flights = {printable(std::filesystem::path(options.log).filename().string())};
  programs::CoreReplayOptions of_core{input.settings, options.tolerance};
  const Airframe<float> airframe = programs::flying_airframe(models.front());
  if (!input.has_settings) {
    using Core = programs::FlightStackController;
    of_core.settings = Core(Core::Vehicle(airframe)).settings();
    replayed.notes.push_back("the log has no topic pinnquad_settings: a core's own limits and gains are taken");
  }
  for (const std::string& setting : options.settings) apply_setting(setting, of_core.settings);
  compare_trust(models.front(), of_core.settings, replayed);
  for (const BlockModel& model : models) {
    if (model.airframe_name() == models.front().airframe_name()) continue;
    throw std::invalid_argument("--model: " + models.front().path() + " is for " + models.front().airframe_name() +
                                ", " + model.path() + " for " + model.airframe_name());
  }
  const std::unique_ptr<programs::CoreReplay> core = programs::core_replay(models, airframe, of_core);
  FlownModels flown(models);
  std::optional<Learnt> learnt;
  if (!options.learnt.empty()) learnt.emplace(airframe);
  programs::ProgressLine progress("replaying " + std::to_string(input.ticks.size()) + " ticks");
  replayed.rows.reserve(input.ticks.size());
  for (const pinnquad::autopilot::CoreRecord& tick : input.ticks) {
    replayed.rows.push_back(core->run(tick, flown.of(tick, replayed), replayed));
    if (learnt) learnt->note(tick, core->learner());
    progress.update(static_cast<double>(replayed.rows.size()) / static_cast<double>(input.ticks.size()));
  }
  if (learnt) {
    const auto differs = [](const programs::ReplayedRow& row) { return !row.differs.empty(); };
    if (std::any_of(replayed.rows.begin(), replayed.rows.end(), differs)) {
      replayed.notes.push_back("--learnt: nothing is written, as the core answers otherwise than was logged");
    } else {
      const std::string none =
          learnt->write(options.learnt, models.front().airframe_name(), replayed.flights.front(), core->learner());
      if (!none.empty()) replayed.notes.push_back("--learnt: no learnt.block is written: " + none);
    }
  }
  return replayed;
}

void print_head(const ReplayOptions& options, const Replayed& replayed, const std::vector<BlockModel>& models) {
  std::printf("%-11s %s\n", "log", printable(options.log).c_str());
  for (const BlockModel& model : models) {
    std::printf("%-11s %s (checksum %08x), for %s\n", "model", printable(model.path()).c_str(), model.checksum(),
                model.airframe_name().c_str());
  }
  std::printf("%-11s %s\n", "run by",
              replayed.of_core ? "the flight stacks' controller, tick by tick, and compared with what it logged"
              : options.guard == "training"
                  ? "InverseDynamics behind TrainingGuard: refuses, has no fallback"
                  : "InverseDynamics behind the flight stacks' guard: falls back to the analytic inverse");
}

/// Row by row as CSV; commands that were not there are empty cells.
void write_table(const std::string& path, const Replayed& replayed) {
  constexpr std::size_t rows_per_report = 1000;
  programs::ProgressLine progress("writing " + printable(path));
  AtomicFile file(path);
  std::vector<std::string> head = {"flight", replayed.of_core ? "tick" : "row", "t", "answered_by", "status", "cause"};
  if (replayed.of_core) head.push_back("reaction");
  for (const char* name : {"u1", "u2", "u3", "u4", "logged_u1", "logged_u2", "logged_u3", "logged_u4", "worst_feature",
                           "excess", "state", "reason"}) {
    head.emplace_back(name);
  }
  if (replayed.of_core) head.push_back("differs");
  file.stream() << csv_line(head);
  for (std::size_t i = 0; i < replayed.rows.size(); ++i) {
    const programs::ReplayedRow& row = replayed.rows[i];
    std::vector<std::string> cells = {replayed.flights[row.flight], std::to_string(row.row), number_text(row.time_s),
                                      to_string(row.answerer),      to_string(row.status),   to_string(row.cause)};
    if (replayed.of_core) cells.push_back(row.reaction);
    for (const programs::FourCommands* commands : {&row.commands, &row.logged}) {
      for (const double u : *commands) cells.push_back(std::isnan(u) ? "" : number_text(u));
    }
    cells.insert(cells.end(), {row.feature, number_text(row.excess), row.state, row.reason});
    if (replayed.of_core) cells.push_back(row.differs);
    file.stream() << csv_line(cells);
    if (i % rows_per_report == 0) progress.update(static_cast<double>(i) / static_cast<double>(replayed.rows.size()));
  }
  file.commit();
}

int replay(const ReplayOptions& options) {
  programs::FileRoles roles;
  roles.reads("LOG", options.log);
  for (const std::string& model : options.models) roles.reads("--model", model);
  roles.writes("--out", options.out);
  roles.writes("--learnt", options.learnt);
  std::vector<BlockModel> models;
  for (const std::string& path : options.models) models.push_back(programs::read_model(path));
  const ReplayInput input = programs::read_replay_input(options.log);
  const Replayed replayed =
      input.of_core() ? replay_core(options, input, models) : replay_flights(options, input, models);
  const programs::ReplaySummary summary = programs::summary_of(replayed);
  if (!options.out.empty()) write_table(options.out, replayed);
  if (options.json) {
    nlohmann::json json = programs::as_json(replayed, summary);
    json["log"] = options.log;
    json["run_by"] = input.of_core() ? "core" : options.guard;
    for (const BlockModel& model : models) {
      json["models"].push_back({{"path", model.path()},
                                {"checksum", programs::in_words("%08x", model.checksum())},
                                {"airframe", model.airframe_name()}});
    }
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
  } else {
    print_head(options, replayed, models);
    programs::print_summary(replayed, summary);
  }
  if (summary.differing > 0) return programs::exit_failed;
  if (input.of_core() && replayed.compared == 0) {
    programs::complain("replay", options.log + ": nothing compared: every tick stands behind a gap");
    return programs::exit_failed;
  }
  if (input.of_core() || programs::detail::count_of(summary.answerers, "model") > 0) return 0;
  programs::complain("replay", models.front().path() + ": answers no row of this log");
  return programs::exit_failed;
}

}  // namespace

namespace programs {

Command replay_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "replay",
      "Runs a model, or a flight stack's core, over a log: who answered, what, and why not (a flight as a page in "
      "3D: fly --watch)");
  const auto options = std::make_shared<ReplayOptions>();
  add_path(*line, "log", options->log, "LOG",
           "a recorded flight (FILE.csv), a folder that pinnquad import wrote, or what a flight stack's core logged: a "
           "ULog file, a folder that ulog2csv wrote, NAME_pinnquad_record_0.csv")
      ->required();
  add_paths(
      *line, "--model", options->models, "MODEL",
      "a model block, as pinnquad train writes it (model.block), or the header beside it; of a core's log all that "
      "flew")
      ->required();
  line->add_option("--guard", options->guard,
                   "what stands between model and motors where the log is a flight: flight_stack, as "
                   "the autopilot, which falls back to the analytic inverse; training, which refuses")
      ->capture_default_str()
      ->check(CLI::IsMember({"flight_stack", "training"}));
  line->add_option("--set", options->settings,
                   "change a setting of the core, to see what it would have done: --set tilt_1_s=7")
      ->type_name("NAME=VALUE");
  add_number(*line, "--tolerance", options->tolerance, 0.0, 1.0,
             "largest difference of a command from the core's log that counts as the same");
  add_path(*line, "--out", options->out, "FILE.csv", "every row: status, who answered, commands, the reason in words");
  add_path(*line, "--learnt", options->learnt, "FOLDER",
           "the vehicle that a core learnt in this flight: its model (learnt.block, learnt.hpp), airframe.toml, "
           "learnt.json, slopes.csv, slopes.svg");
  line->add_flag("--json", options->json, "the summary as JSON");
  line->footer(
      "Examples:\n"
      "  pinnquad replay flight.csv --model my_model/model.hpp\n"
      "  pinnquad replay flight.csv --model my_model/model.block --out rows.csv\n"
      "  pinnquad replay flight.ulg --model model.block        the core, tick by tick\n"
      "  pinnquad replay flight.ulg --model model.block --set attitude_us=30000\n"
      "  pinnquad replay flight.ulg --model model.block --learnt my_vehicle\n"
      "Exit codes: 0; 1 the core answers otherwise than was logged, nothing of its log can be compared, or the model\n"
      "answers no row; 2 bad input or a file that can't be read or written; 130 interrupted.\n"
      "docs/replay_log.md says what a core logs. A flight as a page in 3D: pinnquad fly --watch.");
  return {line, [options] { return replay(*options); }};
}

}  // namespace programs
