// SPDX-License-Identifier: MIT
// Flights for the tests of this room: rows that are all different, with bits that are hard to print.
#pragma once

#include <pinnquad/core/random.hpp>
#include <pinnquad/data/dataset.hpp>

#include <cmath>
#include <cstddef>
#include <random>

namespace pinnquad_test {

/// `rows` samples 0.05 s apart; the other values spread over 60 decades, with both signs.
inline pinnquad::Flight random_flight(std::size_t rows, unsigned seed) {
  std::mt19937_64 engine(seed);
  pinnquad::Flight flight;
  for (std::size_t i = 0; i < rows; ++i) {
    pinnquad::Sample::Values values{};
    for (double& value : values) {
      value = pinnquad::standard_normal(engine) * std::pow(10.0, pinnquad::uniform(engine, -30, 30));
    }
    values[0] = 0.05 * static_cast<double>(i);
    flight.push_back(pinnquad::to_sample(values));
  }
  return flight;
}

}  // namespace pinnquad_test
