// SPDX-License-Identifier: MIT
// The study's flights, flown in memory: a name and a seed give the same rows on every machine.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "flight/choice.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "report/columns.hpp"

namespace study {

/// Flights of the study.
using Airframe = pinnquad::PaperQuadrotor;

/// Flies `fly NAME --seed SEED`. Throws std::runtime_error, one line, if the flight ends early.
inline pinnquad::Flight flown(const programs::StudyFlight& id) {
  pinnquad::RecordedFlight recorded;
  programs::with_flight(id.name, [&](auto tag) {
    using PaperFlight = typename decltype(tag)::type;
    recorded = pinnquad::fly<PaperFlight>(pinnquad::airframe_value<Airframe, double>(), std::mt19937_64(id.seed));
  });
  if (recorded.report.end != pinnquad::FlightEnd::completed) {
    throw std::runtime_error("flight " + id.name + " of seed " + std::to_string(id.seed) + " ended after " +
                             std::to_string(recorded.report.rows) + " rows: choose another --flight-seed");
  }
  return std::move(recorded.flight);
}

/// All flights of a study.
using Flights = std::map<programs::StudyFlight, pinnquad::Flight>;

}  // namespace study
