// SPDX-License-Identifier: MIT
// Flights of the library's own simulator as a dataset of logs: the truth is known.
#pragma once

#include <random>
#include <string>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace pinnquad_test {

inline pinnquad::Flight simulated_flight(const std::string& name, std::uint64_t seed, std::size_t samples,
                                         const std::string& trajectory = "") {
  using namespace pinnquad;
  const auto airframe = airframe_value<PaperQuadrotor, double>();
  const auto vehicle = flight_vehicle<AgileFlight>(airframe);
  FlightPlan plan = AgileFlight::plan();
  plan.samples = samples;
  Flight flight = fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(seed)), plan).flight;
  flight.name = name;
  flight.trajectory = trajectory;
  return flight;
}

inline pinnquad::Dataset simulated_dataset(int flights, std::size_t samples) {
  pinnquad::Dataset dataset;
  for (int i = 1; i <= flights; ++i) {
    dataset.add(simulated_flight("flight" + std::to_string(i), static_cast<std::uint64_t>(i), samples));
  }
  return dataset;
}

}  // namespace pinnquad_test
