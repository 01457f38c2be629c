// SPDX-License-Identifier: MIT
// Flies a simulated quadrotor under a random pilot and writes the recorded flight as CSV.
//   fly --out flight.csv --seed 1
#include <CLI/CLI.hpp>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <string>

#include "airframes.hpp"
#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/simulation/flight.hpp"
#include "progress_line.hpp"

namespace {

constexpr int exit_flight_failed = 1;
constexpr int exit_bad_input = 2;
constexpr double degrees = 57.295779513082323;

struct Options {
  std::string out;
  std::uint64_t seed = 1;
  std::size_t samples = pinnquad::FlightPlan{}.samples;
  std::string airframe = pinnquad::PaperQuadrotor::name;
  double max_speed_m_s = pinnquad::PilotStyle{}.max_speed_m_s;
};

void list_airframes() {
  programs::each_airframe([](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    constexpr pinnquad::Airframe<double> airframe = pinnquad::airframe_value<Vehicle, double>();
    std::printf("%-16s %.3f kg, rotors up to %.0f rpm, thrust-to-weight %.3f\n", Vehicle::name, airframe.mass_kg,
                60 * airframe.max_rotor_speed_rev_s, airframe.thrust_to_weight());
  });
}

/// The folder of the output must exist before minutes are spent on what goes there.
void require_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    throw pinnquad::OutputError(path, "its folder does not exist");
  }
}

void print_summary(const Options& options, const pinnquad::Airframe<double>& airframe,
                   const pinnquad::PilotStyle& style, const pinnquad::FlightReport& report, double period_s) {
  std::printf("airframe    %s: %.3f kg, rotor speed limit %.0f rpm, thrust-to-weight %.3f\n", options.airframe.c_str(),
              airframe.mass_kg, 60 * airframe.max_rotor_speed_rev_s, airframe.thrust_to_weight());
  std::printf("flight      seed %llu, %zu rows at %.3g s, %.1f s\n", static_cast<unsigned long long>(options.seed),
              report.rows, period_s, static_cast<double>(report.rows) * period_s);
  std::printf("speed       up to %.2f m/s; tilt up to %.1f deg\n", report.max_speed_m_s, degrees * report.max_tilt_rad);
  std::printf("altitude    %.1f to %.1f m above ground\n", report.min_altitude_m, report.max_altitude_m);
  std::printf("saturation  a rotor at its limit in %.2f %% of the rows\n", 100 * report.saturated_share);
  if (style.max_climb_m_s < style.max_speed_m_s) {
    std::printf("note        this airframe's thrust allows the pilot %.1f m/s of climb at most\n", style.max_climb_m_s);
  }
}

template <class Vehicle>
int fly_and_write(const Options& options) {
  using namespace pinnquad;
  const Quadrotor<double, StandardAtmosphere, QuadraticDrag> quadrotor(airframe_value<Vehicle, double>(),
                                                                       paper_site<double>(), {}, {});
  FlightPlan plan;
  plan.samples = options.samples;
  const PilotStyle style = pilot_style(quadrotor, plan.start_m, options.max_speed_m_s);
  const RandomPilot<std::mt19937_64> pilot(std::mt19937_64(options.seed), style, quadrotor.site().ground_z_m);
  programs::ProgressLine progress("flying");
  const RecordedFlight recorded = fly(quadrotor, pilot, plan, [&progress](const FlightRow& row) {
    progress.update(static_cast<double>(row.rows_done) / static_cast<double>(row.rows));
  });
  progress.clear();

  const FlightReport& report = recorded.report;
  if (report.end != FlightEnd::completed) {
    const Vector3<double>& p = report.last.body.position_m;
    std::fprintf(stderr, "fly: the flight ended at %.3f s, north %.2f m, east %.2f m, %.2f m above ground: %s\n",
                 report.last.time_s, p[0], p[1], quadrotor.site().ground_z_m - p[2],
                 report.end == FlightEnd::ground ? "it came down to the ground" : to_string(report.status));
    return exit_flight_failed;
  }
  write_flight_csv(options.out, recorded.flight);
  print_summary(options, quadrotor.airframe(), style, report, plan.sample_period_s());
  return 0;
}

}  // namespace

int main(int argument_count, char** arguments) {
  Options options;
  bool list = false;
  CLI::App app{"Flies a simulated quadrotor under a random pilot, up to 8 m/s with drag, and records it as CSV.",
               "fly"};
  app.add_option("--out", options.out, "CSV file to write")->type_name("FILE.csv");
  app.add_option("--seed", options.seed, "seed of the pilot; the same seed gives the same flight")
      ->capture_default_str();
  app.add_option("--samples", options.samples, "rows to record, one every 0.05 s")
      ->capture_default_str()
      ->check(CLI::Range(std::size_t{1}, std::size_t{10000000}));
  app.add_option("--airframe", options.airframe, "one of: " + programs::airframe_names())->capture_default_str();
  app.add_option("--max-speed", options.max_speed_m_s, "fastest velocity the pilot asks for, m/s")
      ->capture_default_str()
      ->check(CLI::Range(0.5, 8.0));
  app.add_flag("--list-airframes", list, "print the airframes and stop");
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::fprintf(stderr, "fly: %s\n", error.what());
    return exit_bad_input;
  }
  if (list) {
    list_airframes();
    return 0;
  }
  if (options.out.empty()) {
    std::fprintf(stderr, "fly: --out FILE.csv is needed (see --help)\n");
    return exit_bad_input;
  }
  try {
    require_folder(options.out);
    int code = exit_bad_input;
    const bool known = programs::with_airframe(
        options.airframe, [&](auto tag) { code = fly_and_write<typename decltype(tag)::type>(options); });
    if (!known) {
      std::fprintf(stderr, "fly: no airframe named '%s'; known: %s\n", options.airframe.c_str(),
                   programs::airframe_names().c_str());
    }
    return code;
  } catch (const std::exception& error) {  // InputError, OutputError: one line
    std::fprintf(stderr, "fly: %s\n", error.what());
    return exit_bad_input;
  }
}
