// SPDX-License-Identifier: MIT
// The drawings of a report on logged flights: errors flight by flight, errors over speed, battery and height, and
// commands about a moment.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "flight/loop_figures.hpp"
#include "page/chart.hpp"
#include "training/held_out_dynamics.hpp"
#include "training/kind_verdict.hpp"
#include "training/worst_moments.hpp"

namespace programs {

/// Kinds that a drawing shows in colour, an index of JudgedKinds::kinds each.
inline constexpr std::size_t most_shown_kinds = 3;
inline constexpr const char* colour_of_shown[most_shown_kinds] = {colour::blue, colour::orange, colour::green};

/// A path from above, with the model and without it, and how far off both were.
inline Chart path_chart(const FlownTraces& flown) {
  const FlownTrace &with = flown.model, &without = flown.without;
  Panel path;
  path.title = "Path from above";
  path.x.name = "east, m";
  path.y.name = "north, m";
  path.height = 0;
  path.series = {{"planned", Shape::line, colour::muted, with.planned_east_m, with.planned_north_m, 4, 0.45},
                 {"without the model", Shape::line, colour::orange, without.east_m, without.north_m},
                 {"with the model", Shape::line, colour::blue, with.east_m, with.north_m}};
  const auto ends = [&path](std::vector<double> Series::*of) {
    std::pair<double, double> range{1e9, -1e9};
    for (const Series& series : path.series) {
      for (const double value : series.*of) range = {std::min(range.first, value), std::max(range.second, value)};
    }
    return range;
  };
  const auto [west, east] = ends(&Series::x);
  const auto [south, north] = ends(&Series::y);
  const double half = 0.55 * std::max({east - west, north - south, 0.1});  // one scale on both axes
  path.x.least = (west + east) / 2 - half, path.x.most = (west + east) / 2 + half;
  path.y.least = (south + north) / 2 - half, path.y.most = (south + north) / 2 + half;
  Panel error;
  error.title = "Distance from the path";
  error.x.name = "time, s";
  error.y = {"cm", 0};
  error.height = 300;
  const auto in_cm = [](std::vector<double> values) {
    for (double& value : values) value *= 100;
    return values;
  };
  error.series = {{"without the model", Shape::line, colour::orange, without.time_s, in_cm(without.error_m)},
                  {"with the model", Shape::line, colour::blue, with.time_s, in_cm(with.error_m)}};
  return {"The path flown with the model and without it",
          "Planned path and both flown paths from above, and the distance from the path over time.",
          {path, error},
          2};
}

/// Root mean square error of every kind on each held-out flight: a mark each, those shown in colour.
inline Chart flights_chart(const JudgedKinds& judged, const std::vector<std::size_t>& shown) {
  Panel panel;
  panel.y.rows = judged.flights;
  const auto marks = [&](std::size_t k, Series series) {
    const std::vector<double> errors = error_of_flights(judged.kinds[k]);
    for (std::size_t flight = 0; flight < errors.size(); ++flight) {
      series.add(1e3 * errors[flight], static_cast<double>(flight));
    }
    panel.series.push_back(series);
  };
  for (std::size_t k = 0; k < judged.kinds.size(); ++k) {
    const bool coloured = std::find(shown.begin(), shown.end(), k) != shown.end();
    if (judged.kinds[k].applicable() && !coloured)
      marks(k, {"others", Shape::strokes, colour::muted, {}, {}, 1.2, 0.7});
  }
  double most = 0;
  for (std::size_t i = shown.size(); i-- > 0;) {
    marks(shown[i], {judged.kinds[shown[i]].kind.title, Shape::strokes, colour_of_shown[i], {}, {}, 4});
    for (const double error : panel.series.back().x) {
      if (std::isfinite(error)) most = std::max(most, error);
    }
  }
  panel.x = {"root mean square error of the commands, 10⁻³", 0, 1.25 * most + 1e-9};
  return {"Error on each held-out flight",
          "Root mean square error of the commands by model and held-out flight, mean over the seeds; the table has the "
          "figures.",
          {panel}};
}

/// An error of each row that counts, by shown kind, over a quantity of that row.
struct ErrorsOver {
  std::string quantity, unit;
  std::vector<double> value;
  std::vector<std::vector<double>> error;   ///< [shown kind][row]: mean over the motors, predicted - flown
  std::vector<std::vector<double>> square;  ///< the same of the squares
};

/// Root mean square (solid) and mean (dashed) of the error in tenths of the rows, from low to high.
inline Panel errors_over_panel(const JudgedKinds& judged, const std::vector<std::size_t>& shown,
                               const ErrorsOver& over) {
  constexpr std::size_t parts = 10;
  std::vector<std::size_t> order(over.value.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return over.value[a] < over.value[b]; });
  Panel panel;
  panel.x.name = over.quantity + ", " + over.unit;
  panel.y.name = "error, 10⁻³";
  panel.height = 190;
  for (std::size_t kind = 0; kind < over.error.size(); ++kind) {
    Series root{judged.kinds[shown[kind]].kind.title, Shape::line, colour_of_shown[kind]}, mean = root;
    mean.name += ", mean";
    mean.dashed = true;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t begin = part * order.size() / parts, end = (part + 1) * order.size() / parts;
      if (begin == end) continue;
      double value = 0, error = 0, square = 0;
      for (std::size_t i = begin; i < end; ++i) {
        value += over.value[order[i]];
        error += over.error[kind][order[i]];
        square += over.square[kind][order[i]];
      }
      const auto count = static_cast<double>(end - begin);
      root.add(value / count, 1e3 * std::sqrt(square / count));
      mean.add(value / count, 1e3 * error / count);
    }
    panel.series.insert(panel.series.end(), {root, mean});
  }
  return panel;
}

/// Panels side by side; none for none.
inline Chart errors_over_chart(const JudgedKinds& judged, const std::vector<std::size_t>& shown,
                               const std::vector<ErrorsOver>& quantities) {
  Chart chart{"Error over speed, battery and height",
              "Root mean square and mean of the command error, 10⁻³, in tenths of the held-out rows, by model.",
              {},
              std::max(1, static_cast<int>(quantities.size()))};
  for (const ErrorsOver& over : quantities) chart.panels.push_back(errors_over_panel(judged, shown, over));
  return chart;
}

/// The flown and the predicted commands of a motor, two seconds before and after a moment.
inline Chart moment_chart(const WorstMoment& moment, const pinnquad::FlightRows& piece, const JudgedKinds& judged,
                          const std::vector<std::size_t>& shown, const std::vector<const Predictions*>& predictions) {
  constexpr double reach_s = 2;
  const pinnquad::Flight& flight = *moment.flight;
  const double at_s = flight[moment.row].time_s;
  std::size_t begin = moment.row, end = moment.row + 1;
  while (begin > piece.rows.begin && flight[begin - 1].time_s >= at_s - reach_s) --begin;
  while (end < piece.rows.end && flight[end].time_s <= at_s + reach_s) ++end;
  Panel panel;
  panel.x = {"time, s", at_s - reach_s, at_s + reach_s};
  panel.y.name = "command u" + std::to_string(moment.motor + 1);
  panel.series = {{"flown", Shape::line, colour::muted, {}, {}, 3.4, 0.55}};
  for (std::size_t i = 0; i < predictions.size(); ++i) {
    panel.series.push_back({judged.kinds[shown[i]].kind.title, Shape::line, colour_of_shown[i]});
  }
  for (std::size_t row = begin; row < end; ++row) {
    const bool gap = row > begin && flight[row].time_s - flight[row - 1].time_s > 0.1;
    for (std::size_t i = 0; i < panel.series.size(); ++i) {
      Series& series = panel.series[i];
      if (gap && i == 0) {
        series.add_gap();
      }
      series.add(flight[row].time_s, i == 0 ? flight[row].commands[moment.motor]
                                            : (*predictions[i - 1])[moment.held_out + row - moment.row][moment.motor]);
    }
  }
  return {"Command of motor u" + std::to_string(moment.motor + 1) + " about the moment",
          "As flown, and as predicted by " +
              listed(shown, [&judged](std::size_t k) { return judged.kinds[k].kind.title; }) + ".",
          {panel}};
}

/// Signed sums of a stretch, flown and predicted.
inline Chart stretch_chart(const HeldOutStretch& stretch, const std::string& model, const Predictions& predictions,
                           const std::array<MotorFigures, 4>& signs) {
  Chart chart{"Signed sums of the commands over time, flown and predicted",
              "Thrust, roll, pitch and yaw sums of a stretch of a held-out flight, as flown and as predicted by " +
                  model + "."};
  for (std::size_t sum = 0; sum < signs.size(); ++sum) {
    Panel panel;
    panel.title = sum_names[sum];
    panel.height = 95;
    panel.x.name = "time, s";
    Series flown{"flown", Shape::line, colour::muted, {}, {}, 3, 0.55},
        predicted{model, Shape::line, colour_of_shown[0]};
    for (std::size_t i = 0; i < stretch.size; ++i) {
      const pinnquad::Sample& sample = (*stretch.flight)[stretch.row + i];
      flown.add(sample.time_s, pinnquad::signed_sum(signs[sum], sample.commands));
      predicted.add(sample.time_s, pinnquad::signed_sum(signs[sum], predictions[stretch.held_out + i]));
    }
    panel.series = {flown, predicted};
    chart.panels.push_back(panel);
  }
  return chart;
}

namespace detail {

inline Series level_line(double from, double to, double level, const char* colour = colour::muted) {
  Series line{"", Shape::line, colour, {from, to}, {level, level}, 1};
  line.dashed = true;
  return line;
}

inline double decibels(double power) { return 10 * std::log10(std::max(power, 1e-30)); }

}  // namespace detail

/// The least of some bounds that holds a value.
inline double bound_for(double value, std::initializer_list<double> bounds) {
  for (const double bound : bounds) {
    if (value <= bound) return bound;
  }
  return *(bounds.end() - 1);
}

/// Gain, phase and coherence of the flown sums by the predicted ones, over the frequency; where the coherence is low
/// they are faint, and where it is no more than chance they are left out.
inline Chart response_chart(const HeldOutDynamics& dynamics) {
  constexpr std::array<const char*, 4> colours = {colour::violet, colour::blue, colour::orange, colour::green};
  constexpr double faint = 0.3;
  const auto decibels = [](const SpectralBand& band) { return 20 * std::log10(band.gain()); };
  const auto degrees = [](const SpectralBand& band) { return pinnquad::degrees_per_radian * band.phase_rad(); };
  const std::vector<SpectralBand>& any = dynamics.sums[0];
  const double from = any.front().frequency_hz, to = any.back().frequency_hz;
  double most_db = 0, most_deg = 0;
  for (const std::vector<SpectralBand>& bands : dynamics.sums) {
    for (const SpectralBand& band : bands) {
      if (band.coherence() < FollowedRange::least_coherence) continue;
      most_db = std::max(most_db, std::abs(decibels(band)));
      most_deg = std::max(most_deg, std::abs(degrees(band)));
    }
  }
  const double bound_db = bound_for(most_db, {6, 12, 24}), bound_deg = bound_for(most_deg, {45, 90, 180});
  std::array<Panel, 3> panels;
  for (Panel& panel : panels) {
    panel.x = {"frequency, Hz", from, to, true};
    panel.height = 150;
  }
  panels[0].y = {"gain, dB", -bound_db, bound_db};
  panels[1].y = {"phase, °", -bound_deg, bound_deg};
  panels[2].y = {"coherence", 0, 1};
  panels[0].series = {detail::level_line(from, to, 0)};
  panels[1].series = {detail::level_line(from, to, 0)};
  panels[2].series = {detail::level_line(from, to, FollowedRange::least_coherence)};
  for (std::size_t sum = 0; sum < sum_names.size(); ++sum) {
    for (std::size_t figure = 0; figure < panels.size(); ++figure) {
      double before = pinnquad::not_a_number;
      Series clear{sum_names[sum], Shape::line, colours[sum]}, weak = clear;
      weak.opacity = faint;
      for (const SpectralBand& band : dynamics.sums[sum]) {
        const double coherence = band.coherence();
        const double value = figure == 0 ? decibels(band) : figure == 1 ? degrees(band) : coherence;
        if (figure == 1 && std::abs(value - before) > 180) {  // once round: no line across
          for (Series* line : {&weak, &clear}) {
            line->add(band.frequency_hz, pinnquad::not_a_number);
          }
        }
        before = value;
        weak.add(band.frequency_hz, coherence > band.chance_coherence() ? value : pinnquad::not_a_number);
        clear.add(band.frequency_hz,
                  figure == 2 || coherence >= FollowedRange::least_coherence ? value : pinnquad::not_a_number);
      }
      if (figure < 2) panels[figure].series.push_back(weak);
      panels[figure].series.push_back(clear);
    }
  }
  return {"Frequency response from predicted to flown command sums",
          "Gain, phase and coherence of thrust, roll, pitch and yaw sums over the frequency; 0 dB, 0 degrees and a "
          "coherence of 1 are a perfect model.",
          {panels.begin(), panels.end()}};
}

/// Power of each motor's commands and of the model's residual over the frequency, and the level taken for noise.
inline Chart residual_chart(const HeldOutDynamics& dynamics, const std::string& model) {
  Chart chart{"Spectra of commands and residuals",
              "Power density of each motor's flown commands, of the residual of " + model +
                  ", and the level that is taken for noise.",
              {},
              2};
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    const std::vector<SpectralBand>& bands = dynamics.motors[motor];
    Panel panel;
    panel.title = "u" + std::to_string(motor + 1);
    panel.x = {"frequency, Hz", bands.front().frequency_hz, bands.back().frequency_hz, true};
    panel.y.name = "dB of 1/Hz";
    Series flown{"flown", Shape::line, colour::muted, {}, {}, 3, 0.55},
        residual{"residual, flown − predicted", Shape::line, colour_of_shown[0]};
    for (const SpectralBand& band : bands) {
      flown.add(band.frequency_hz, detail::decibels(band.output));
      residual.add(band.frequency_hz, detail::decibels(band.input));
    }
    double lowest = HUGE_VAL;
    for (const Series* series : {&flown, &residual}) {
      lowest = std::min(lowest, *std::min_element(series->y.begin(), series->y.end()));
    }
    panel.y.least = lowest - 6;  // a level far below is not drawn
    Series noise = detail::level_line(panel.x.least, panel.x.most, detail::decibels(dynamics.ceiling.density[motor]),
                                      colour::orange);
    noise.name = "taken for noise";
    panel.series = {flown, residual, noise};
    chart.panels.push_back(panel);
  }
  return chart;
}

}  // namespace programs
