// SPDX-License-Identifier: MIT
// A model on flights that were held out, as a control engineer looks at it: frequency response from the predicted to
// the flown commands, what the noise lets any model explain, a stretch of time, what its guard declines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "training/judged_kinds.hpp"
#include "training/spectra.hpp"

namespace programs {

/// Held-out rows of a parting that follow each other without a gap and all count.
struct HeldOutStretch {
  const pinnquad::Flight* flight = nullptr;
  std::size_t fold = 0;
  std::size_t row = 0;       ///< of the flight
  std::size_t held_out = 0;  ///< the same, of the parting's held-out rows
  std::size_t size = 0;
};

inline std::vector<HeldOutStretch> held_out_stretches(const std::vector<Fold>& folds,
                                                      const std::vector<std::vector<bool>>& counts, double period_s) {
  std::vector<HeldOutStretch> all;
  for (std::size_t fold = 0; fold < folds.size(); ++fold) {
    std::size_t at = 0;
    for (const pinnquad::FlightRows& piece : folds[fold].split.test.pieces()) {
      HeldOutStretch now{piece.flight, fold, 0, 0, 0};
      const auto end = [&all, &now] {
        if (now.size > 0) all.push_back(now);
        now.size = 0;
      };
      for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row, ++at) {
        const pinnquad::Flight& flight = *piece.flight;
        if (now.size > 0 && flight[row].time_s - flight[row - 1].time_s > 1.5 * period_s) end();
        if (!counts[fold][at]) {
          end();
          continue;
        }
        if (now.size == 0) now = {&flight, fold, row, at, 0};
        ++now.size;
      }
      end();
    }
  }
  return all;
}

/// R^2 that a perfect model would have. Taken from the residuals' highest quarter of frequencies: noise of commands and
/// inputs that goes on as strong below them (white) is what no model of these rows tells. Of the models judged the
/// quietest counts, motor by motor.
struct NoiseCeiling {
  static constexpr double from_share = 0.75;  ///< of half the sampling rate
  static constexpr double most_slope = 1.5;   ///< between the halves of that quarter: more is no white noise

  MotorFigures r2 = {pinnquad::not_a_number, pinnquad::not_a_number, pinnquad::not_a_number, pinnquad::not_a_number};
  MotorFigures density{};                                 ///< of the noise, 1/Hz
  std::array<std::size_t, pinnquad::rotor_count> kind{};  ///< whose residual it is
  bool white = true;
};

struct HeldOutDynamics {
  std::size_t kind = 0;  ///< of the judged kinds
  std::uint64_t seed = 0;
  GuardCounts guard;
  std::string why_not;  ///< there are no spectra; empty: there are
  double period_s = 0, segment_s = 0;
  std::size_t segments = 0;
  std::array<std::vector<SpectralBand>, 4> sums;    ///< input: predicted, output: flown
  std::array<FollowedRange, 4> followed;            ///< of these
  std::array<std::vector<SpectralBand>, 4> motors;  ///< input: flown - predicted, output: flown
  NoiseCeiling ceiling;
  HeldOutStretch typical;  ///< no longer than a few seconds: of all such the one with the middle error

  bool has_spectra() const { return why_not.empty(); }
};

namespace detail {

/// Predictions of a fit, parting by parting; null where there is none of that seed.
inline std::vector<const Predictions*> predictions_of_seed(const FitPlan& plan, const Fits& fits, std::size_t kind,
                                                           std::uint64_t seed) {
  std::vector<const Predictions*> result(plan.folds.size(), nullptr);
  for (const FinishedFit& fit : fits.finished) {
    if (fit.kind == kind && fit.seed == seed) result[fit.fold] = &fit.held_out;
  }
  return result;
}

/// The longest segments, a power of two of rows and at most 8 s, of which there are enough to average; 0 if none are.
inline std::size_t segment_length(const std::vector<HeldOutStretch>& stretches, double period_s) {
  constexpr double longest_s = 8;
  constexpr std::size_t shortest = 32, enough = 24, fewest = 4;
  std::size_t length = shortest, chosen = 0;
  for (; static_cast<double>(length) * period_s <= longest_s || length == shortest; length *= 2) {
    std::size_t segments = 0;
    for (const HeldOutStretch& stretch : stretches) segments += WelchSpectra::segments_in(stretch.size, length);
    if (segments >= (length == shortest ? fewest : enough)) chosen = length;
  }
  return chosen;
}

/// `of(sample, predicted)` gives input and output of a row.
template <class Of>
WelchSpectra spectra_of(const std::vector<HeldOutStretch>& stretches,
                        const std::vector<const Predictions*>& predictions, std::size_t length, double period_s,
                        const Of& of) {
  WelchSpectra spectra(length, period_s);
  for (const HeldOutStretch& stretch : stretches) {
    std::vector<double> input, output;
    for (std::size_t i = 0; i < stretch.size; ++i) {
      const auto [x, y] =
          of((*stretch.flight)[stretch.row + i].commands, (*predictions[stretch.fold])[stretch.held_out + i]);
      input.push_back(x);
      output.push_back(y);
    }
    spectra.add(input, output);
  }
  return spectra;
}

inline WelchSpectra motor_spectra(const std::vector<HeldOutStretch>& stretches,
                                  const std::vector<const Predictions*>& predictions, std::size_t length,
                                  double period_s, std::size_t motor) {
  return spectra_of(stretches, predictions, length, period_s, [motor](const auto& flown, const auto& predicted) {
    return std::pair{flown[motor] - predicted[motor], flown[motor]};
  });
}

/// 1 - noise / variance of a motor's flown commands over the rows that count, mean over the partings as R^2 is.
inline double r2_under_noise(const std::vector<Fold>& folds, const std::vector<std::vector<bool>>& counts,
                             std::size_t motor, double noise) {
  double sum = 0;
  for (std::size_t fold = 0; fold < folds.size(); ++fold) {
    const pinnquad::RowSet& rows = folds[fold].split.test;
    std::vector<double> values;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (counts[fold][row]) values.push_back(rows[row].commands[motor]);
    }
    const double squares = squares_about(values, pinnquad::detail::mean_of(values));
    sum += explained(noise * static_cast<double>(values.size()), squares);
  }
  return sum / static_cast<double>(folds.size());
}

inline HeldOutStretch typical_stretch(const std::vector<HeldOutStretch>& stretches,
                                      const std::vector<const Predictions*>& predictions, double period_s) {
  constexpr double shown_s = 10;
  const auto longest = static_cast<std::size_t>(std::max(2.0, shown_s / period_s));
  std::vector<std::pair<double, HeldOutStretch>> parts;
  for (const bool whole : {true, false}) {
    for (const HeldOutStretch& stretch : stretches) {
      for (std::size_t first = 0; first < stretch.size; first += longest) {
        HeldOutStretch part = stretch;
        part.row += first;
        part.held_out += first;
        part.size = std::min(longest, stretch.size - first);
        if (whole && part.size < longest) continue;
        double squares = 0;
        for (std::size_t i = 0; i < part.size; ++i) {
          for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
            const double error =
                (*predictions[part.fold])[part.held_out + i][motor] - (*part.flight)[part.row + i].commands[motor];
            squares += error * error / static_cast<double>(part.size);
          }
        }
        parts.push_back({squares, part});
      }
    }
    if (!parts.empty()) break;
  }
  const auto middle = parts.begin() + static_cast<std::ptrdiff_t>(parts.size() / 2);
  std::nth_element(parts.begin(), middle, parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return middle->second;
}

}  // namespace detail

/// The ceiling by all judged models that may be exported, their first seeds.
inline NoiseCeiling noise_ceiling(const FitPlan& plan, const Fits& fits, const JudgedKinds& judged,
                                  const std::vector<HeldOutStretch>& stretches, std::size_t length, double period_s) {
  const double half_rate_hz = 0.5 / period_s, from_hz = NoiseCeiling::from_share * half_rate_hz;
  const double middle_hz = 0.5 * (from_hz + half_rate_hz);
  NoiseCeiling ceiling;
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    double least = HUGE_VAL, slope = 1;
    for (std::size_t k = 0; k < judged.kinds.size(); ++k) {
      const JudgedKind& kind = judged.kinds[k];
      if (!kind.applicable() || !kind.kind.exportable) continue;
      const auto predictions = detail::predictions_of_seed(plan, fits, k, kind.seeds.front());
      const WelchSpectra spectra = detail::motor_spectra(stretches, predictions, length, period_s, motor);
      const double density = spectra.band(from_hz, half_rate_hz).input;
      if (!(density < least)) continue;
      least = density;
      slope = spectra.band(from_hz, middle_hz).input / spectra.band(middle_hz, half_rate_hz).input;
      ceiling.kind[motor] = k;
    }
    ceiling.density[motor] = least;
    ceiling.r2[motor] = detail::r2_under_noise(plan.folds, judged.counts, motor, least * half_rate_hz);
    if (!(slope < NoiseCeiling::most_slope && slope > 1 / NoiseCeiling::most_slope)) ceiling.white = false;
  }
  return ceiling;
}

/// Over all partings.
inline GuardCounts guard_of_seed(const Fits& fits, std::size_t kind, std::uint64_t seed) {
  GuardCounts guard;
  for (const FinishedFit& fit : fits.finished) {
    if (fit.kind == kind && fit.seed == seed) guard += fit.guard;
  }
  return guard;
}

/// Of a judged kind, by the fits of one of its seeds.
inline HeldOutDynamics held_out_dynamics(const FitPlan& plan, const Fits& fits, const JudgedKinds& judged,
                                         std::size_t kind, std::uint64_t seed) {
  HeldOutDynamics result;
  result.kind = kind;
  result.seed = seed;
  result.guard = guard_of_seed(fits, kind, seed);
  pinnquad::RowSet all;
  for (const Fold& fold : plan.folds) {
    for (const pinnquad::FlightRows& piece : fold.split.test.pieces()) all.add(*piece.flight, piece.rows);
  }
  result.period_s = pinnquad::sample_period_s(all);
  if (!(result.period_s > 0)) {
    result.why_not = "the held-out flights have no one time from row to row";
    return result;
  }
  const auto stretches = held_out_stretches(plan.folds, judged.counts, result.period_s);
  const auto predictions = detail::predictions_of_seed(plan, fits, kind, seed);
  result.typical = detail::typical_stretch(stretches, predictions, result.period_s);
  const std::size_t length = detail::segment_length(stretches, result.period_s);
  if (length == 0) {
    result.why_not = "the held-out rows have too few stretches of 32 rows without a gap";
    return result;
  }
  result.segment_s = static_cast<double>(length) * result.period_s;
  const auto all_signs = sum_signs(plan.airframe.value);
  for (std::size_t sum = 0; sum < sum_names.size(); ++sum) {
    const MotorFigures& signs = all_signs[sum];
    const WelchSpectra spectra = detail::spectra_of(
        stretches, predictions, length, result.period_s, [&signs](const auto& flown, const auto& predicted) {
          return std::pair{pinnquad::signed_sum(signs, predicted), pinnquad::signed_sum(signs, flown)};
        });
    result.segments = spectra.segments();
    result.sums[sum] = spectra.bands();
    result.followed[sum] = followed_range(result.sums[sum]);
    result.motors[sum] = detail::motor_spectra(stretches, predictions, length, result.period_s, sum).bands();
  }
  result.ceiling = noise_ceiling(plan, fits, judged, stretches, length, result.period_s);
  return result;
}

/// Of report.json: `guard`.
inline nlohmann::json guard_json(const GuardCounts& guard, const std::string& model) {
  const auto share = [&guard](std::uint64_t count) { return guard.share_of(count); };
  nlohmann::json features = nlohmann::json::object();
  for (const auto& [feature, count] : guard.furthest) features[feature] = share(count);
  return {{"model", model},
          {"rows", guard.rows},
          {"answered_share", guard.answered_share()},
          {"refused",
           {{"warming_up", share(guard.warming_up)},
            {"outside_envelope", share(guard.outside_envelope)},
            {"output_not_finite", share(guard.output_not_finite)}}},
          {"furthest_outside", std::move(features)},
          {"beyond_limits_share", share(guard.beyond_limits)}};
}

/// Of report.json: `response`.
inline nlohmann::json response_json(const HeldOutDynamics& dynamics, const std::string& model) {
  if (!dynamics.has_spectra()) return {{"model", model}, {"why_not", dynamics.why_not}};
  nlohmann::json sums;
  for (std::size_t sum = 0; sum < sum_names.size(); ++sum) {
    nlohmann::json& of = sums[sum_names[sum]];
    const FollowedRange& followed = dynamics.followed[sum];
    of = {{"coherent_hz", nullptr}};
    if (followed.to_hz > 0) {
      of = {{"coherent_hz", {followed.from_hz, followed.to_hz}},
            {"gain", followed.gain},
            {"gain_standard_error", followed.gain_error},
            {"delay_s", followed.delay_s},
            {"delay_standard_error_s", followed.delay_error_s}};
    }
    for (const SpectralBand& band : dynamics.sums[sum]) {
      nlohmann::json& bands = of["bands"];
      bands["frequency_hz"].push_back(band.frequency_hz);
      bands["gain"].push_back(band.gain());
      bands["phase_deg"].push_back(pinnquad::degrees_per_radian * band.phase_rad());
      bands["coherence"].push_back(band.coherence());
      bands["relative_standard_error"].push_back(band.relative_error());
      bands["flown_per_hz"].push_back(band.output);
      bands["residual_per_hz"].push_back(band.difference());
    }
  }
  return {{"model", model},
          {"why_not", nullptr},
          {"sample_period_s", dynamics.period_s},
          {"segment_s", dynamics.segment_s},
          {"segments", dynamics.segments},
          {"sums", std::move(sums)}};
}

/// Of report.json: `noise_ceiling`.
inline nlohmann::json ceiling_json(const HeldOutDynamics& dynamics, const JudgedKinds& judged) {
  if (!dynamics.has_spectra()) return {{"r2", nullptr}, {"why_not", dynamics.why_not}};
  const NoiseCeiling& ceiling = dynamics.ceiling;
  nlohmann::json motors;
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    motors["u" + std::to_string(motor + 1)] = {{"r2", ceiling.r2[motor]},
                                               {"noise_per_hz", ceiling.density[motor]},
                                               {"noise", std::sqrt(ceiling.density[motor] * 0.5 / dynamics.period_s)},
                                               {"model", judged.kinds[ceiling.kind[motor]].kind.key}};
  }
  return {{"r2", mean_over_motors(ceiling.r2)},
          {"why_not", nullptr},
          {"from_hz", NoiseCeiling::from_share * 0.5 / dynamics.period_s},
          {"white", ceiling.white},
          {"per_motor", std::move(motors)}};
}

}  // namespace programs
