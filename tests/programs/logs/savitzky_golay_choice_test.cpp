// SPDX-License-Identifier: MIT
#include "logs/savitzky_golay.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pinnquad/core/random.hpp"

using pinnquad::IndexRange;
using pinnquad::logs::choose_savitzky_golay;
using pinnquad::logs::savitzky_golay;
using pinnquad::logs::SavitzkyGolay;

namespace {

constexpr double tau = 6.283185307179586;

struct Wave {
  std::vector<double> measured, derivative;
};
Wave wave(double frequency_Hz, double noise, double period_s, std::uint64_t seed, int derivative) {
  std::mt19937_64 engine(seed);
  Wave result;
  for (int row = 0; row < 4000; ++row) {
    const double phase = tau * frequency_Hz * row * period_s, w = tau * frequency_Hz;
    result.measured.push_back(std::sin(phase) + noise * pinnquad::standard_normal(engine));
    result.derivative.push_back(derivative == 0   ? std::sin(phase)
                                : derivative == 1 ? w * std::cos(phase)
                                                  : -w * w * std::sin(phase));
  }
  return result;
}
double error_inside(const Wave& wave, double period_s, const SavitzkyGolay& filter, int derivative) {
  const auto got = savitzky_golay(wave.measured, period_s, filter, derivative);
  double squares = 0;
  for (std::size_t row = 100; row < got.size() - 100; ++row) squares += std::pow(got[row] - wave.derivative[row], 2);
  return std::sqrt(squares / static_cast<double>(got.size() - 200));
}

}  // namespace

/// The stated factors of the best filter that brute force finds: values and first derivatives, second derivatives.
constexpr double factor_of_best = 1.15, factor_of_best_second = 1.5;

TEST_CASE("noisy waves: within a factor of the best order and window, its noise and error foretold") {
  for (const double period_s : {0.004, 0.02}) {
    for (const double noise : {0.01, 0.3}) {
      for (const double frequency_Hz : {2.0, 5.0}) {
        for (const int derivative : {0, 1, 2}) {
          CAPTURE(period_s);
          CAPTURE(noise);
          CAPTURE(frequency_Hz);
          CAPTURE(derivative);
          const Wave one = wave(frequency_Hz, noise, period_s, 7, derivative);
          const auto choice = choose_savitzky_golay(one.measured, {{0, one.measured.size()}}, period_s, derivative);
          CHECK(std::abs(choice.noise / noise - 1) < 0.06);
          CHECK(choice.bandwidth_Hz > frequency_Hz);
          const double got = error_inside(one, period_s, choice.filter, derivative);
          CHECK(choice.expected_error / got > 0.6);
          CHECK(choice.expected_error / got < 1.7);
          double best = std::numeric_limits<double>::infinity();
          for (const int order : {2, 4}) {
            for (int half = order / 2; half <= 100; half += 1 + half / 6) {
              best = std::min(best, error_inside(one, period_s, {order, half}, derivative));
            }
          }
          CHECK(got <= (derivative == 2 ? factor_of_best_second : factor_of_best) * best);
        }
      }
    }
  }
}

TEST_CASE("without noise the narrowest window of the highest order is right, of noise alone the widest") {
  const Wave clean = wave(2, 0, 0.02, 1, 1);
  const auto exact = choose_savitzky_golay(clean.measured, {{0, clean.measured.size()}}, 0.02, 1);
  CHECK(exact.filter.order == 4);
  CHECK(exact.filter.half_window == 2);
  CHECK(exact.noise < 1e-3);
  std::mt19937_64 engine(3);
  std::vector<double> noise(4000);
  for (double& value : noise) value = pinnquad::standard_normal(engine);
  const auto all = choose_savitzky_golay(noise, {{0, noise.size()}}, 0.02, 1);
  CHECK(all.filter.half_window >= 20);
  CHECK(all.noise == doctest::Approx(1).epsilon(0.05));
}

/// A gyro behind its filter: noise is flat up to 30 Hz, then sinks; differences of neighbours see little of it.
TEST_CASE("noise behind a low-pass is not taken for signal") {
  const double period_s = 0.004, cutoff_Hz = 30;
  std::mt19937_64 engine(11);
  const double share = 1 - std::exp(-tau * cutoff_Hz * period_s);
  Wave one = wave(2, 0, period_s, 1, 1);
  std::array<double, 3> stage{};
  for (double& value : one.measured) {
    double through = 0.1 * pinnquad::standard_normal(engine);
    for (double& s : stage) through = s += share * (through - s);
    value += through;
  }
  const auto choice = choose_savitzky_golay(one.measured, {{0, one.measured.size()}}, period_s, 1);
  CHECK(choice.bandwidth_Hz < 8);
  double best = std::numeric_limits<double>::infinity();
  for (const int order : {2, 4}) {
    for (int half = order / 2; half <= 100; ++half)
      best = std::min(best, error_inside(one, period_s, {order, half}, 1));
  }
  CHECK(error_inside(one, period_s, choice.filter, 1) <= factor_of_best * best);
}

TEST_CASE("the power of a spectrum is the variance, wave and noise where they are") {
  const Wave one = wave(5, 0.3, 0.02, 5, 0);
  const auto spectrum = pinnquad::logs::power_spectrum(one.measured, {{0, one.measured.size()}}, 0.02, 256);
  double sum = 0, near_wave = 0;
  for (std::size_t bin = 0; bin < spectrum.power.size(); ++bin) {
    sum += spectrum.power[bin];
    if (std::abs(spectrum.frequency_Hz(bin) - 5) < 1) near_wave += spectrum.power[bin];
  }
  CHECK(sum == doctest::Approx(0.5 + 0.09).epsilon(0.03));
  CHECK(near_wave == doctest::Approx(0.5 + 0.09 * 2 / 25).epsilon(0.03));
  CHECK(spectrum.frequency_Hz(spectrum.power.size() - 1) == doctest::Approx(25));
}

TEST_CASE("a jump between two segments is no signal, and too few rows have the default") {
  Wave one = wave(2, 0.03, 0.02, 9, 1);
  const auto whole = choose_savitzky_golay(one.measured, {{0, 2000}, {2000, 4000}}, 0.02, 1);
  for (std::size_t row = 2000; row < 4000; ++row) one.measured[row] += 1000;
  const auto parted = choose_savitzky_golay(one.measured, {{0, 2000}, {2000, 4000}}, 0.02, 1);
  CHECK(parted.filter.half_window == whole.filter.half_window);
  CHECK(parted.noise == doctest::Approx(whole.noise));
  const auto few = choose_savitzky_golay(one.measured, {{0, 20}}, 0.02, 1);
  CHECK(few.filter.order == 2);
  CHECK(few.filter.half_window == 2);
}
