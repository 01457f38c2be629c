// SPDX-License-Identifier: MIT
// The study's flights, flown; and drawn, forces taken apart (Figs. 2, 4 (d), 5 and 6), for the report to embed.
#include "study/flights.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "command_line/folders.hpp"
#include "command_line/progress_line.hpp"
#include "flight/choice.hpp"
#include "flight/pictures.hpp"
#include "flight/trace.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"

pinnquad::Flight study::flown(const programs::StudyFlight& id) {
  const programs::NamedFlight& flight = programs::flight_named(id.name);
  const auto vehicle = flight.vehicle(pinnquad::airframe_value<Airframe, double>(), flight.ground_effect, {});
  pinnquad::RecordedFlight recorded = pinnquad::fly(vehicle, flight.pilot(vehicle, id.seed, {}), flight.plan);
  if (recorded.report.end != pinnquad::FlightEnd::completed) {
    throw std::invalid_argument("flight " + id.name + " of seed " + std::to_string(id.seed) + " ended after " +
                                std::to_string(recorded.report.rows) + " rows: choose another --flight-seed");
  }
  return std::move(recorded.flight);
}

void study::draw_flights(const std::string& folder, std::uint64_t seed) {
  using namespace pinnquad;
  const pinnquad::Airframe<double> airframe = airframe_value<study::Airframe, double>();
  programs::ProgressLine progress("drawing the flights");
  double done = 0;
  for (const programs::NamedFlight& flight : programs::flights()) {
    if (flight.name == std::string(HarderFlight::name)) continue;  // none of the paper's
    const SwitchedQuadrotor vehicle = flight.vehicle(airframe, flight.ground_effect, {});
    const SwitchedQuadrotor without = flight.vehicle(airframe, GroundEffectModel::none, {});
    std::vector<programs::TraceRow> trace;
    const RecordedFlight recorded = fly(vehicle, flight.pilot(vehicle, seed, {}), flight.plan, [&](const auto& flies) {
      trace.push_back(programs::trace_row(vehicle, without, flies.vehicle()));
    });
    const std::string into = folder + "/flights/" + flight.name;
    programs::make_folders(into);
    programs::draw_flight(into, recorded.flight, trace, airframe, flight.ground_effect,
                          flight.name == std::string(WindyFlight::name));
    progress.update(++done / 3);
  }
}
