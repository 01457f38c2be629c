// SPDX-License-Identifier: MIT
// The study's flights, flown; and drawn, forces taken apart (Figs. 2, 4 (d), 5 and 6), for the report to embed.
#include "study/flights.hpp"

#include <random>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "command_line/folders.hpp"
#include "command_line/progress_line.hpp"
#include "flight/choice.hpp"
#include "flight/pictures.hpp"
#include "flight/trace.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"

pinnquad::Flight study::flown(const programs::StudyFlight& id) {
  pinnquad::RecordedFlight recorded;
  programs::with_flight(id.name, [&](auto tag) {
    using PaperFlight = typename decltype(tag)::type;
    recorded = pinnquad::fly<PaperFlight>(pinnquad::airframe_value<Airframe, double>(), std::mt19937_64(id.seed));
  });
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
  programs::each_flight([&](auto tag) {
    using PaperFlight = typename decltype(tag)::type;
    if constexpr (std::is_same_v<PaperFlight, HarderFlight>) return;  // none of the paper's
    const auto vehicle = flight_vehicle<PaperFlight>(airframe, PaperFlight::ground_effect);
    const auto without = flight_vehicle<PaperFlight>(airframe, GroundEffectModel::none);
    std::vector<programs::TraceRow> trace;
    const RecordedFlight recorded =
        fly(vehicle, PaperFlight::pilot(vehicle, std::mt19937_64(seed)), PaperFlight::plan(),
            [&](const auto& flies) { trace.push_back(programs::trace_row(vehicle, without, flies.vehicle())); });
    const std::string into = folder + "/flights/" + PaperFlight::name;
    programs::make_folders(into);
    programs::draw_flight(into, recorded.flight, trace, airframe, PaperFlight::ground_effect,
                          std::is_same_v<PaperFlight, WindyFlight>);
    progress.update(++done / 3);
  });
}
