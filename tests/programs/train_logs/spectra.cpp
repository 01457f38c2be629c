// SPDX-License-Identifier: MIT
// Spectra and responses of signals whose truth is known in closed form.
#include "training/spectra.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <random>
#include <vector>

namespace {

using programs::FollowedRange;
using programs::SpectralBand;
using programs::WelchSpectra;

constexpr double period_s = 0.01, pi = 3.14159265358979323846;
constexpr std::size_t samples = 60000, length = 512;

std::vector<double> white(std::uint64_t seed, double deviation, std::size_t count = samples) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(0, deviation);
  std::vector<double> values(count);
  for (double& value : values) value = normal(engine);
  return values;
}

/// y[n] = a y[n - 1] + (1 - a) x[n]: a first-order lag, sampled.
std::vector<double> lagged(const std::vector<double>& x, double a) {
  std::vector<double> y(x.size());
  double state = 0;
  for (std::size_t i = 0; i < x.size(); ++i) y[i] = state = a * state + (1 - a) * x[i];
  return y;
}

std::complex<double> response_of_lag(double a, double frequency_hz) {
  return (1 - a) / (1.0 - a * std::exp(std::complex<double>(0, -2 * pi * frequency_hz * period_s)));
}

WelchSpectra spectra_of(const std::vector<double>& input, const std::vector<double>& output) {
  WelchSpectra spectra(length, period_s);
  spectra.add(input, output);
  return spectra;
}

}  // namespace

TEST_CASE("gain and phase of a first-order lag are its own, within the errors that are stated") {
  constexpr double a = 0.8;
  const std::vector<double> input = white(1, 0.3);
  std::vector<double> output = lagged(input, a);
  const std::vector<double> noise = white(2, 0.02);
  for (std::size_t i = 0; i < output.size(); ++i) output[i] += noise[i];
  const auto bands = spectra_of(input, output).bands();
  REQUIRE(bands.size() > 30);
  double squares = 0;
  for (const SpectralBand& band : bands) {
    const std::complex<double> truth = response_of_lag(a, band.frequency_hz);
    CAPTURE(band.frequency_hz);
    const double gain_off = band.gain() / std::abs(truth) - 1;
    CHECK(std::abs(gain_off) < 4 * band.relative_error() + 0.005);
    CHECK(std::abs(band.phase_rad() - std::arg(truth)) < 4 * band.relative_error() + 0.01);
    const double power = std::norm(truth) * 0.3 * 0.3;
    CHECK(band.coherence() == doctest::Approx(power / (power + 0.02 * 0.02)).epsilon(0.04));
    squares += gain_off * gain_off / (band.relative_error() * band.relative_error());
  }
  const double deviations = std::sqrt(squares / static_cast<double>(bands.size()));
  CHECK(deviations > 0.6);  // neither far too small nor far too large
  CHECK(deviations < 1.6);
}

TEST_CASE("white noise of a known variance has that density at all frequencies") {
  const std::vector<double> noise = white(3, 0.05), other = white(4, 0.2);
  const WelchSpectra spectra = spectra_of(noise, other);
  CHECK(spectra.segments() == WelchSpectra::segments_in(samples, length));
  const double density = 2 * period_s;  // one-sided, of unit variance
  for (const SpectralBand& band : spectra.bands(1)) {
    CAPTURE(band.frequency_hz);
    CHECK(band.input == doctest::Approx(0.05 * 0.05 * density).epsilon(0.1));
    CHECK(band.output == doctest::Approx(0.2 * 0.2 * density).epsilon(0.1));
  }
  const SpectralBand all = spectra.band(0, 1 / period_s);
  CHECK(all.input * 0.5 / period_s == doctest::Approx(0.05 * 0.05).epsilon(0.02));
  CHECK(all.difference() * 0.5 / period_s == doctest::Approx(0.05 * 0.05 + 0.2 * 0.2).epsilon(0.02));
  std::size_t above_chance = 0, count = 0;
  for (const SpectralBand& band : spectra.bands()) {
    ++count;
    above_chance += band.coherence() > band.chance_coherence() ? std::size_t{1} : std::size_t{0};
  }
  CHECK(above_chance < count / 6);  // one in twenty is meant
}

TEST_CASE("a delay is found, with the range in which the output follows") {
  constexpr std::size_t late = 3;
  constexpr double a = 0.9;
  const std::vector<double> input = lagged(white(5, 1), a);
  std::vector<double> output(samples, 0.0);
  const std::vector<double> noise = white(6, 0.1);
  for (std::size_t i = late; i < samples; ++i) output[i] = 0.7 * input[i - late] + noise[i];
  const FollowedRange followed = programs::followed_range(spectra_of(input, output).bands());
  CHECK(followed.gain == doctest::Approx(0.7).epsilon(0.01));
  CHECK(followed.delay_s == doctest::Approx(late * period_s).epsilon(0.01));
  CHECK(followed.delay_error_s < 0.01 * late * period_s);
  // coherence of 0.6: the signal's power is 1.5 times that of the noise
  double border_hz = 0;
  for (double f = 0.1; f < 0.5 / period_s; f += 0.01) {
    if (0.49 * std::norm(response_of_lag(a, f)) > 1.5 * 0.01) border_hz = f;
  }
  CHECK(followed.from_hz < 1);
  CHECK(followed.to_hz == doctest::Approx(border_hz).epsilon(0.2));
  const FollowedRange none = programs::followed_range(spectra_of(input, noise).bands());
  CHECK(none.to_hz == 0);
}
