// SPDX-License-Identifier: MIT
// The fits in closed form, of 15,000 rows of a flight with noise: the structured model's base, and its slopes by
// smoothed rows, which must be the one that made the rows, to a tenth: least squares of the rows finds a seventh less.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/training/structured/slopes_under_noise.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

constexpr double rolling_slope = 0.001;  // command per rad/s^2, of each rotor, with its sign
using Setting = Context<InverseFeatures, PaperQuadrotor, AxisCommandOutputs>;

/// 150 s at 100 Hz: sines about every axis, commands affine in the motion, noise on both.
Flight noisy_flight(std::size_t rows = 15000) {
  std::mt19937_64 engine(5);
  const auto signs = motor_torque_signs(airframe_value<PaperQuadrotor, double>());
  Flight flight(rows);
  flight.name = "noisy";
  for (std::size_t row = 0; row < rows; ++row) {
    Sample& s = flight[row];
    s.time_s = 0.01 * static_cast<double>(row);
    const double t = s.time_s;
    double turning[3];
    for (int k = 0; k < 3; ++k) {
      const double fast = 7.3 + 1.7 * k, slow = 4.1 + 0.9 * k;
      s.velocity_m_s[k] = 2 * std::sin(t * (1 + 0.3 * k));
      s.body_rates_rad_s[k] =
          -3 / fast * std::cos(fast * t) - 2 / slow * std::cos(slow * t) + 0.01 * standard_normal(engine);
      s.linear_acceleration_m_s2[k] = std::cos(t + k) + 0.1 * standard_normal(engine);
      turning[k] = 3 * std::sin(fast * t) + 2 * std::sin(slow * t);
      s.angular_acceleration_rad_s2[k] = turning[k] + standard_normal(engine);
    }
    s.roll_rad = 0.2 * std::sin(t);
    s.pitch_rad = 0.2 * std::cos(t);
    s.yaw_rad = std::sin(0.1 * t);
    for (std::size_t i = 0; i < 4; ++i) {
      s.commands[i] = 0.5 + signs[i][0] * rolling_slope * turning[0] - 0.01 * s.linear_acceleration_m_s2[2] +
                      0.002 * standard_normal(engine);
    }
  }
  return flight;
}

}  // namespace

int main(int argc, char** argv) {
  static const Flight flight = noisy_flight();
  static const RowSet rows(flight, {0, flight.size()});
  static const Setting context = make_context<Setting>(rows);
  static const FitContext value = fit_context(context);
  static const AffineMap base = fit_monotone_base(context, rows);
  AffineMap map = base;
  const MeasuredSlopes found = measure_slopes(value, rows, {}, map);
  require_close("Fit/slopes", 4 * rolling_slope, found.of[1].slope, 0.4 * rolling_slope);
  benchmark::RegisterBenchmark("Fit/closed_form", [](benchmark::State& state) {
    for (auto _ : state) {
      AffineMap fitted = fit_monotone_base(context, rows);
      benchmark::DoNotOptimize(fitted.weights.data());
    }
  })->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("Fit/slopes", [](benchmark::State& state) {
    for (auto _ : state) {
      AffineMap fitted = base;
      MeasuredSlopes slopes = measure_slopes(value, rows, {}, fitted);
      benchmark::DoNotOptimize(&slopes);
    }
  })->Unit(benchmark::kMillisecond);
  return run_benchmarks(argc, argv);
}
