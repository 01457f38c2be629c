// SPDX-License-Identifier: MIT
// Training sets for the tests of training: a known map, and flights that obey the linearised dynamics.
#pragma once

#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad::test {

/// Normal features, and outputs y = tanh(A x) / 2 with a fixed A: smooth, bounded, all features count.
template <class Scalar>
TrainingData<Scalar, 16, 4> known_map(int rows, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  TrainingData<Scalar, 16, 4> data;
  for (int row = 0; row < rows; ++row) {
    double x[16];
    for (double& v : x) {
      v = standard_normal(engine);
      data.features.push_back(static_cast<Scalar>(v));
    }
    for (int k = 0; k < 4; ++k) {
      double sum = 0.0;
      for (int i = 0; i < 16; ++i) sum += std::cos(1.7 * (i + 1) * (k + 1)) * x[i] / 4.0;
      data.outputs.push_back(static_cast<Scalar>(std::tanh(sum) / 2.0));
    }
  }
  return data;
}

/// The same with a linear map.
template <class Scalar>
TrainingData<Scalar, 16, 4> linear_map(int rows, std::uint64_t seed) {
  auto data = known_map<Scalar>(rows, seed);
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
    for (std::size_t k = 0; k < 4; ++k) {
      double sum = 0.1 * static_cast<double>(k);
      for (std::size_t i = 0; i < 16; ++i) {
        const auto weight = std::cos(1.7 * static_cast<double>((i + 1) * (k + 1)));
        sum += weight * static_cast<double>(data.features[row * 16 + i]) / 4.0;
      }
      data.outputs[row * 4 + k] = static_cast<Scalar>(sum);
    }
  }
  return data;
}

/// Rows of all fields at random within flight ranges; nothing is related to anything.
inline Flight random_flight_rows(std::size_t rows, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  Flight flight(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    Sample& s = flight[i];
    s.time_s = 0.05 * static_cast<double>(i);
    for (int k = 0; k < 3; ++k) {
      s.linear_acceleration_m_s2[k] = uniform(engine, -5, 9);
      s.angular_acceleration_rad_s2[k] = uniform(engine, -20, 25);
      s.velocity_m_s[k] = uniform(engine, -8, 8);
      s.body_rates_rad_s[k] = uniform(engine, -2, 3);
    }
    s.roll_rad = uniform(engine, -0.6, 0.5);
    s.pitch_rad = uniform(engine, -0.5, 0.6);
    s.yaw_rad = uniform(engine, -3.1, 3.1);
    for (double& u : s.commands) u = uniform(engine, 0.2, 0.9);
  }
  return flight;
}

}  // namespace pinnquad::test
