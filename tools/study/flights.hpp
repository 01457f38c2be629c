// SPDX-License-Identifier: MIT
// The study's flights, flown in memory: a name and a seed give the same rows on every machine; their pictures.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "study/columns.hpp"

namespace study {

/// Flights of the study.
using Airframe = pinnquad::PaperQuadrotor;

/// Flies `fly NAME --seed SEED`. Throws std::invalid_argument, one line, if the flight ends early.
pinnquad::Flight flown(const programs::StudyFlight& id);

/// Flies d1, d2 and d3 of one seed again, forces taken apart, and draws `folder`/flights/{d1,d2,d3}/*.svg as
/// `fly NAME --pictures` does. Where gnuplot is missing or failed, one line on stderr says so, and the
/// report leaves them out.
void draw_flights(const std::string& folder, std::uint64_t seed);

/// All flights of a study.
using Flights = std::map<programs::StudyFlight, pinnquad::Flight>;

}  // namespace study
