// SPDX-License-Identifier: MIT
// Pictures of the study's flights, Figs. 2, 4 (d), 5 and 6, drawn into its folder for the report to embed.
#pragma once

#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "command_line/folders.hpp"
#include "command_line/progress_line.hpp"
#include "flight/pictures.hpp"
#include "flight/trace.hpp"
#include "study/flights.hpp"

namespace study {

/// Flies d1, d2 and d3 of one seed again, forces taken apart, and draws `folder`/flights/{d1,d2,d3}/*.svg as
/// `fly NAME --pictures` does. False, after one line on stderr, where gnuplot is missing or failed; the report then
/// leaves them out.
inline bool draw_flights(const std::string& folder, std::uint64_t seed) {
  using namespace pinnquad;
  const pinnquad::Airframe<double> airframe = airframe_value<study::Airframe, double>();
  bool drawn = true;
  programs::ProgressLine progress("drawing the flights");
  double done = 0;
  programs::each_flight([&](auto tag) {
    using PaperFlight = typename decltype(tag)::type;
    if (!drawn) return;
    const auto vehicle = flight_vehicle<PaperFlight>(airframe, PaperFlight::ground_effect);
    const auto without = flight_vehicle<PaperFlight>(airframe, GroundEffectModel::none);
    std::vector<programs::TraceRow> trace;
    const RecordedFlight recorded =
        fly(vehicle, PaperFlight::pilot(vehicle, std::mt19937_64(seed)), PaperFlight::plan(),
            [&](const auto& flies) { trace.push_back(programs::trace_row(vehicle, without, flies.vehicle())); });
    const std::string into = folder + "/flights/" + PaperFlight::name;
    programs::make_folders(into);
    drawn = programs::draw_flight(into, recorded.flight, trace, airframe, PaperFlight::ground_effect,
                                  std::is_same_v<PaperFlight, WindyFlight>);
    progress.update(++done / 3);
  });
  return drawn;
}

}  // namespace study
