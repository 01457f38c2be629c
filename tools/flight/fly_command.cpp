// SPDX-License-Identifier: MIT
// Flies a simulated quadrotor on one of the paper's flights and writes the recorded flight as CSV.
//   pinnquad fly d1 --out flight.csv --seed 1
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/command.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/in_words.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/options.hpp"
#include "command_line/progress_line.hpp"
#include "flight/battery_options.hpp"
#include "flight/choice.hpp"
#include "flight/pictures.hpp"
#include "flight/statistics.hpp"
#include "flight/trace.hpp"
#include "page/watch_page.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/simulation/recorded_sticks.hpp"
#include "pinnquad/simulation/recorder.hpp"

namespace {

using namespace pinnquad;

struct FlyOptions {
  std::string flight = AgileFlight::name;
  std::string out;
  std::uint64_t seed = 1;
  std::optional<std::size_t> samples;
  std::optional<double> interval_ms;
  std::string airframe = PaperQuadrotor::name;
  std::optional<double> max_speed_m_s;
  std::string ground_effect;  ///< empty: the flight's own
  double gyro_noise_rad_s = 0;
  double latency_ms = 0;
  double jitter_ms = 0;
  std::string sticks;
  std::string record_sticks;
  double stick_interval_ms = 0;
  std::size_t statistics = 0;
  std::string pictures;
  std::string watch;
  programs::BatteryOptions battery;
  bool list_airframes = false;
};

/// No output takes the place of the sticks or of another output.
void require_separate_files(const FlyOptions& options) {
  programs::FileRoles roles;
  roles.reads("--sticks", options.sticks);
  if (programs::is_airframe_file(options.airframe)) roles.reads("--airframe", options.airframe);
  roles.writes("--out", options.out);
  roles.writes("--record-sticks", options.record_sticks);
  roles.writes("--watch", options.watch);
  if (options.pictures.empty()) return;
  roles.writes("--pictures", options.pictures);
  for (const char* name : programs::flight_picture_names) roles.writes("--pictures", options.pictures + "/" + name);
}

/// An output must be writable before minutes are spent on what goes there.
void require_writable(const std::string& path) {
  if (!path.empty()) AtomicFile probe(path);
}

/// The folder for pictures, made if its own folder is there.
void make_folder(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return;
  std::filesystem::create_directory(path, error);
  if (error) throw OutputError(path, error.message());
}

/// A flight with all choices made.
class ChosenFlight {
 public:
  ChosenFlight(const FlyOptions& options, const programs::NamedFlight& flight, const programs::NamedAirframe& airframe,
               GroundEffectModel ground_effect)
      : options_(options),
        flight_(flight),
        name_(airframe.name),
        ground_effect_(ground_effect),
        battery_(programs::battery_of(options.battery)),
        vehicle_(flight.vehicle(airframe.value, ground_effect, battery_)),
        without_(flight.vehicle(airframe.value, GroundEffectModel::none, battery_)),
        airframe_(airframe.value),
        plan_(flight.plan) {
    if (options.interval_ms) {
      plan_.controls_per_sample = static_cast<int>(std::lround(1e-3 * *options.interval_ms / plan_.control_period_s()));
    }
    if (!options.sticks.empty()) {
      sticks_ = RecordedSticks(read_sticks_csv(options.sticks));
      constexpr double rounding = 1e-6;
      plan_.samples = static_cast<std::size_t>(std::ceil(sticks_->duration_s() / plan_.sample_period_s() - rounding));
      if (plan_.samples == 0) plan_.samples = 1;
    }
    if (options.samples) plan_.samples = *options.samples;
    constexpr std::size_t fewest_drawn = 20;  // three blocks and a line in each
    if (!options.pictures.empty() && plan_.samples < fewest_drawn) {
      throw std::invalid_argument("--pictures needs " + std::to_string(fewest_drawn) + " rows or more");
    }
    require_thrust();
  }

  int run() {
    if (options_.statistics > 0) return run_statistics();
    StickRecording sticks;
    std::vector<programs::TraceRow> trace;
    programs::AnyPilot pilot = pilot_of(options_.seed);
    if (!options_.record_sticks.empty()) pilot = written_down(pilot, sticks, options_.stick_interval_ms / 1000);
    programs::WatchPage watch(title(), airframe_, paper_site<double>().ground_z_m);
    programs::ProgressLine progress("flying");
    const RecordedFlight recorded = flown(options_.seed, pilot, [&](const auto& flies) {
      const Flight& rows = flies.recording();
      progress.update(static_cast<double>(rows.size()) / static_cast<double>(plan_.samples));
      if (!options_.pictures.empty()) trace.push_back(programs::trace_row(vehicle_, without_, flies.vehicle()));
      if (!options_.watch.empty()) watch.add(flies.vehicle(), rows.back().commands);
    });
    progress.clear();
    if (recorded.report.end != FlightEnd::completed) {
      programs::complain("fly", why_it_ended(recorded.report));
      return programs::exit_failed;
    }
    write_flight(recorded.flight);
    if (!options_.record_sticks.empty()) write_sticks_csv(options_.record_sticks, sticks);
    if (!options_.watch.empty()) watch.write(options_.watch);
    print_summary(recorded);
    if (!options_.pictures.empty()) {
      programs::draw_flight(options_.pictures, recorded.flight, trace, airframe_, ground_effect_,
                            flight_.name == std::string(WindyFlight::name));
    }
    return 0;
  }

 private:
  /// The flight as CSV, if it is asked for: the first output, so that after Ctrl-C nothing was written.
  void write_flight(const Flight& flight) const {
    if (options_.out.empty()) return;
    programs::ProgressLine progress("writing " + printable(options_.out));
    const auto rows = static_cast<double>(flight.size());
    write_flight_csv(options_.out, flight,
                     [&](std::size_t written) { progress.update(static_cast<double>(written) / rows); });
  }

  /// An airframe that the controller can't hold up here is refused before it flies.
  void require_thrust() const {
    const Status status = vehicle_.status();
    if (status == Status::out_of_range && ground_effect_ == GroundEffectModel::conyers) {
      throw std::invalid_argument(name_ + " cannot fly " + flight_.name +
                                  " so: the ground effect conyers has no fit for a frame and propellers of this size; "
                                  "--ground-effect cheeseman-bennett has");
    }
    const double hover = hover_command(vehicle_, plan_.start_m);
    constexpr double most = 0.97;  // of its thrust: flight_limits
    if (hover < most) return;
    if (!is_finite(hover)) {
      throw std::invalid_argument(name_ + " cannot fly " + flight_.name + ": no commands hold it in hover there");
    }
    throw std::invalid_argument(
        name_ +
        programs::in_words(" cannot fly %s: its hover takes %.0f %% of its thrust, %.0f %% is what the controller uses",
                           flight_.name, 100 * hover, 100 * most));
  }

  programs::AnyPilot pilot_of(std::uint64_t seed) const {
    if (sticks_) return *sticks_;
    return flight_.pilot(vehicle_, seed, options_.max_speed_m_s);
  }

  /// "paper_quadrotor, d1, seed 1"
  std::string title() const {
    const std::string flown = sticks_ ? "sticks " + options_.sticks : "seed " + std::to_string(options_.seed);
    return name_ + ", " + flight_.name + ", " + flown;
  }

  bool exact() const { return options_.gyro_noise_rad_s == 0 && options_.latency_ms == 0 && options_.jitter_ms == 0; }

  /// `observer` sees each row; Ctrl-C ends the flight by an exception.
  template <class Observer>
  RecordedFlight flown(std::uint64_t seed, const programs::AnyPilot& pilot, const Observer& observer) const {
    const auto watched = [&observer](const auto& simulator) {
      programs::stop_if_interrupted();
      observer(simulator);
    };
    if (exact()) return fly(vehicle_, pilot, plan_, watched);
    RecorderErrors errors;
    errors.gyro_noise_rad_s = options_.gyro_noise_rad_s;
    errors.command_latency_s = options_.latency_ms / 1000;
    errors.command_jitter_s = options_.jitter_ms / 1000;
    constexpr std::uint64_t another = 0x9e3779b97f4a7c15u;  // not the pilot's numbers again
    return fly(vehicle_, pilot, plan_, watched,
               NoisyRecorder<std::mt19937_64>(std::mt19937_64(seed ^ another), errors));
  }

  std::string why_it_ended(const FlightReport& report) const {
    const Vector3<double>& p = report.last.body.position_m;
    return programs::in_words(
        "the flight ended at %.3f s, north %.2f m, east %.2f m, %.2f m above ground: %s", report.last.time_s, p[0],
        p[1], paper_site<double>().ground_z_m - p[2],
        report.end == FlightEnd::ground ? "it came down to the ground" : to_string(report.status));
  }

  int run_statistics() {
    const auto one = [this](std::uint64_t seed, std::atomic<std::size_t>& rows_done) {
      const RecordedFlight recorded =
          flown(seed, pilot_of(seed), [&rows_done](const auto&) { rows_done.fetch_add(1); });
      return programs::FlightFigures{seed, recorded.report, programs::axis_correlations(recorded.flight, airframe_)};
    };
    const std::vector<programs::FlightFigures> figures =
        programs::fly_seeds(flight_.name, options_.seed, options_.statistics, plan_.samples, one);
    programs::stop_if_interrupted();
    if (!options_.out.empty()) programs::write_flight_table(options_.out, figures);
    programs::print_flight_table(figures);
    for (const programs::FlightFigures& f : figures) {
      if (f.report.end == FlightEnd::completed) continue;
      programs::complain("fly", "seed " + std::to_string(f.seed) + ": " + why_it_ended(f.report));
      return programs::exit_failed;
    }
    return 0;
  }

  void print_summary(const RecordedFlight& recorded) const {
    const FlightReport& report = recorded.report;
    std::printf("airframe    %s: %.3f kg, rotor speed limit %.0f rpm, thrust-to-weight %.3f\n", name_.c_str(),
                airframe_.mass_kg, 60 * airframe_.max_rotor_speed_rev_s, airframe_.thrust_to_weight());
    std::printf("flight      %s, ground effect %s, ", flight_.name, programs::name_of(ground_effect_));
    if (sticks_) {
      std::printf("sticks %s", options_.sticks.c_str());
    } else {
      std::printf("seed %llu", static_cast<unsigned long long>(options_.seed));
    }
    std::printf(", %zu rows at %.3g s, %.1f s\n", report.rows, plan_.sample_period_s(),
                static_cast<double>(report.rows) * plan_.sample_period_s());
    std::printf("speed       up to %.2f m/s; tilt up to %.1f deg\n", report.max_speed_m_s,
                pinnquad::degrees_per_radian * report.max_tilt_rad);
    std::printf("altitude    %.*f to %.*f m above ground\n", report.max_altitude_m < 5 ? 2 : 1, report.min_altitude_m,
                report.max_altitude_m < 5 ? 2 : 1, report.max_altitude_m);
    std::printf("saturation  a rotor at its limit in %.2f %% of the rows\n", 100 * report.saturated_share);
    if (battery_) {
      const std::vector<double>& volts = recorded.flight.columns().back().values;
      std::printf("battery     %s, %.2f to %.2f V\n", options_.battery.pack.c_str(), volts.front(), volts.back());
    }
    if (options_.ground_effect.empty() && ground_effect_ != flight_.ground_effect) {
      std::printf("note        the flight's own ground effect, %s, has no fit for a frame and propellers so large\n",
                  programs::name_of(flight_.ground_effect));
    }
    const std::array<double, 3> pcc = programs::axis_correlations(recorded.flight, airframe_);
    std::printf("correlation of angular acceleration and command sum: roll %.3f, pitch %.3f, yaw %.3f\n", pcc[0],
                pcc[1], pcc[2]);
    if (sticks_) return;
    const double climb_m_s = pilot_style(vehicle_, plan_.start_m).max_climb_m_s;
    if (climb_m_s < PilotStyle{}.max_climb_m_s) {
      std::printf("note        this airframe's thrust allows the pilot %.1f m/s of climb at most\n", climb_m_s);
    }
  }

  const FlyOptions& options_;
  const programs::NamedFlight& flight_;
  std::string name_;  ///< the airframe's
  GroundEffectModel ground_effect_;
  std::optional<Battery> battery_;
  SwitchedQuadrotor vehicle_, without_;  ///< and the same without ground effect
  Airframe<double> airframe_;
  FlightPlan plan_;
  std::optional<RecordedSticks> sticks_;
};

/// Options that contradict each other; empty if none do.
std::string contradiction(const FlyOptions& o) {
  const bool single_output = !o.record_sticks.empty() || !o.pictures.empty() || !o.watch.empty();
  if (o.out.empty() && !single_output && o.statistics == 0)
    return "--out FILE.csv is needed: pinnquad fly d1 --out d1.csv";
  if (o.statistics > 0 && !o.sticks.empty()) return "--statistics flies seeds, --sticks a recording: one of them";
  if (o.statistics > 0 && single_output) return "--statistics goes with none of --record-sticks, --pictures, --watch";
  if (!o.sticks.empty() && o.max_speed_m_s) return "--max-speed is the random pilot's, --sticks has no use for it";
  return {};
}

/// Flies what the options ask for: the exit code.
int fly_chosen(const FlyOptions& options) {
  const std::string fault = contradiction(options);
  if (!fault.empty()) throw std::invalid_argument(fault);
  require_separate_files(options);
  GroundEffectModel ground_effect = GroundEffectModel::none;
  if (!options.ground_effect.empty()) ground_effect = programs::ground_effect_named(options.ground_effect);
  const programs::NamedAirframe airframe = programs::chosen_airframe(options.airframe);
  const programs::NamedFlight& flight = programs::flight_named(options.flight);
  if (options.ground_effect.empty()) ground_effect = flight.ground_effect_of(airframe.value);
  ChosenFlight chosen(options, flight, airframe, ground_effect);
  for (const std::string& file : {options.out, options.record_sticks, options.watch}) require_writable(file);
  if (!options.watch.empty()) programs::WatchPage::require_available(options.watch);
  if (!options.pictures.empty()) make_folder(options.pictures);
  return chosen.run();
}

void add_options(CLI::App& app, FlyOptions& options) {
  using programs::add_number;
  using programs::add_path;
  std::string flights = "the flight";
  for (const programs::NamedFlight& flight : programs::flights()) {
    flights += std::string("\n") + flight.name + ": " + flight.summary;
  }
  app.footer(
      "Examples:\n"
      "  pinnquad fly d1 --seed 1 --out d1.csv\n"
      "  pinnquad fly d2 --ground-effect cheeseman-bennett --out d2.csv --pictures pictures\n"
      "Exit codes: 0; 1 the flight ended early; 2 bad input or a file that can't be read or written;\n"
      "130 interrupted: nothing was written.");
  app.add_option("flight", options.flight, flights)->type_name("d1|d2|d3|harder")->capture_default_str();
  add_path(app, "--out", options.out, "FILE.csv", "the flight, or with --statistics the table");
  add_number(app, "--seed", options.seed, std::uint64_t{0}, programs::most_seed,
             "seed of pilot and recorder noise; the same seed gives the same flight")
      ->type_name("N");
  add_number(app, "--samples", options.samples, std::size_t{1}, std::size_t{10000000},
             "rows to record (default: that of the flight or of --sticks)");
  add_number(app, "--interval", options.interval_ms, 2.0, 1000.0,
             "ms from row to row, rounded to control ticks of 2 ms (default: 50)");
  app.add_option("--airframe", options.airframe, "what flies: see airframe list")
      ->type_name("NAME|FILE.toml")
      ->capture_default_str();
  add_number(app, "--max-speed", options.max_speed_m_s, 0.5, 8.0, "fastest the pilot flies, m/s (default: 8, d2 4)");
  app.add_option("--ground-effect", options.ground_effect,
                 "none, cheeseman-bennett or conyers (default: the flight's own)")
      ->type_name("MODEL");
  programs::add_battery(app, options.battery);
  add_number(app, "--gyro-noise", options.gyro_noise_rad_s, 0.0, 10.0,
             "gyro noise added to the recording, standard deviation, rad/s");
  add_number(app, "--latency", options.latency_ms, 0.0, 1000.0, "delay of the recorded commands, ms");
  add_number(app, "--jitter", options.jitter_ms, 0.0, 1000.0,
             "additional random delay of each row's commands, at most, ms");
  add_path(app, "--sticks", options.sticks, "FILE.csv",
           "fly this stick recording instead of the random pilot (docs/flights.md)");
  add_path(app, "--record-sticks", options.record_sticks, "FILE.csv", "write the pilot's set points to this file");
  add_number(app, "--stick-interval", options.stick_interval_ms, 0.0, 1000.0,
             "least ms between its rows; 0: each tick, which repeats the flight");
  add_number(app, "--statistics", options.statistics, std::size_t{1}, std::size_t{100000},
             "fly this many seeds from --seed on; print speed, height, tilt")
      ->default_str("");
  add_path(app, "--pictures", options.pictures, "DIR", "draw trajectory, correlation, ground effect and wind as SVG");
  add_path(app, "--watch", options.watch, "FILE.html", "page to watch the flight in 3D in a browser (docs/watch.md)");
  app.add_flag("--list-airframes", options.list_airframes, "print the airframes and where their values are from");
}

int run(const FlyOptions& options) {
  if (options.list_airframes) {
    programs::list_airframes();
    return 0;
  }
  return fly_chosen(options);
}

}  // namespace

namespace programs {

Command fly_command(CLI::App& program) {
  CLI::App* line = program.add_subcommand(
      "fly", "Flies a simulated quadrotor on one of the paper's three flights and records it as CSV");
  const auto options = std::make_shared<FlyOptions>();
  add_options(*line, *options);
  return {line, [options] { return run(*options); }};
}

}  // namespace programs
