// SPDX-License-Identifier: MIT
// The drawings of a report on logged flights: errors flight by flight, errors over speed, battery and height, and
// commands about a moment.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "command_line/listed.hpp"
#include "pictures/drawing.hpp"
#include "pictures/numbers.hpp"
#include "training/log_moments.hpp"
#include "training/log_verdict.hpp"

namespace programs {

/// Kinds that a drawing shows in colour, an index of LogJudgement::kinds each.
inline constexpr std::size_t most_shown_kinds = 3;
inline constexpr const char* stroke_of_shown[most_shown_kinds] = {"first", "second", "third"};

namespace detail {

/// Names of the shown kinds in their colours, from `x` on.
inline std::string legend(double x, double y, const LogJudgement& judged, const std::vector<std::size_t>& shown) {
  constexpr double stroke = 22, letter = 6.6, gap = 26;
  std::string text;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::string title = judged.kinds[shown[i]].kind.title;
    text += drawing::line(x, y - 4, x + stroke, y - 4, stroke_of_shown[i]) +
            drawing::label(x + stroke + 6, y, title, "start");
    x += stroke + 6 + letter * static_cast<double>(title.size()) + gap;
  }
  return text;
}

}  // namespace detail

/// Root mean square error of every kind on each held-out flight: a mark each, those shown in colour.
inline std::string flights_drawing(const LogJudgement& judged, const std::vector<std::size_t>& shown) {
  constexpr double row = 26, left = 250, right = 1030, top = 44;
  double most = 0;
  for (const std::size_t k : shown) {
    for (const double error : error_of_flights(judged.kinds[k])) {
      if (std::isfinite(error)) most = std::max(most, 1e3 * error);
    }
  }
  const double bottom = top + row * static_cast<double>(judged.flights.size());
  const drawing::Axis x{0, most * 1.25 + 1e-9, left, right};
  std::string text = drawing::horizontal_axis(x, top, bottom, 8, "root mean square error of the commands, 1e-3");
  for (std::size_t flight = 0; flight < judged.flights.size(); ++flight) {
    const double y = top + row * (static_cast<double>(flight) + 0.5);
    constexpr std::size_t most_letters = 34;
    std::string name = judged.flights[flight];
    if (name.size() > most_letters) name = name.substr(0, most_letters - 1) + "…";
    text += drawing::label(left - 10, y + 4, name, "end") + drawing::line(left, y, right, y, "grid");
    const auto mark = [&](std::size_t k, const std::string& kind, double half) {
      const double error = 1e3 * error_of_flights(judged.kinds[k])[flight];
      if (std::isfinite(error) && error <= x.most) {
        text += drawing::line(x(error), y - half, x(error), y + half, kind);
      }
    };
    for (std::size_t k = 0; k < judged.kinds.size(); ++k) {
      const bool coloured = std::find(shown.begin(), shown.end(), k) != shown.end();
      if (judged.kinds[k].applicable() && !coloured) mark(k, "axis", 5);
    }
    for (std::size_t i = shown.size(); i-- > 0;) mark(shown[i], std::string(stroke_of_shown[i]) + " mark", 9);
  }
  text += detail::legend(left, top - 20, judged, shown);
  return drawing::svg(1060, bottom + 44, text, "Error on each held-out flight",
                      "Root mean square error of the commands by model and held-out flight, mean over the seeds; the "
                      "table has the figures.");
}

/// An error of each row that counts, by shown kind, over a quantity of that row.
struct ErrorsOver {
  std::string quantity, unit;
  std::vector<double> value;
  std::vector<std::vector<double>> error;   ///< [shown kind][row]: mean over the motors, predicted - flown
  std::vector<std::vector<double>> square;  ///< the same of the squares
};

/// Of a tenth of the rows: means, and the root mean square.
struct ErrorsOfPart {
  double value = 0, mean = 0, root = 0;
};

/// One panel: root mean square (solid) and mean (dashed) of the error in tenths of the rows, from low to high.
inline std::string errors_over_panel(const ErrorsOver& over, double x0, double width, double top, double height) {
  constexpr std::size_t parts = 10;
  std::vector<std::size_t> order(over.value.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return over.value[a] < over.value[b]; });
  std::vector<std::vector<ErrorsOfPart>> lines(over.error.size());
  double least = 0, most = 1e-9;
  for (std::size_t kind = 0; kind < over.error.size(); ++kind) {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t begin = part * order.size() / parts, end = (part + 1) * order.size() / parts;
      if (begin == end) continue;
      ErrorsOfPart p;
      for (std::size_t i = begin; i < end; ++i) {
        p.value += over.value[order[i]];
        p.mean += 1e3 * over.error[kind][order[i]];
        p.root += 1e6 * over.square[kind][order[i]];
      }
      const auto count = static_cast<double>(end - begin);
      p = {p.value / count, p.mean / count, std::sqrt(p.root / count)};
      least = std::min(least, p.mean);
      most = std::max({most, p.root, p.mean});
      lines[kind].push_back(p);
    }
  }
  const double low = over.value[order.front()], high = over.value[order.back()];
  const drawing::Axis x{low, high > low ? high : low + 1, x0, x0 + width},
      y{least * 1.1, most * 1.1, top + height, top};
  std::string text = drawing::horizontal_axis(x, top, top + height, 4, over.quantity + ", " + over.unit) +
                     drawing::vertical_axis(y, x0, x0 + width, 5, "");
  for (std::size_t kind = 0; kind < lines.size(); ++kind) {
    drawing::Trace root, mean;
    for (const ErrorsOfPart& p : lines[kind]) {
      root.to(x(p.value), y(p.root));
      mean.to(x(p.value), y(p.mean));
    }
    text += drawing::path(root.d(), stroke_of_shown[kind]) +
            drawing::path(mean.d(), std::string(stroke_of_shown[kind]) + " dash");
  }
  return text;
}

/// Panels side by side; empty for none.
inline std::string errors_over_drawing(const LogJudgement& judged, const std::vector<std::size_t>& shown,
                                       const std::vector<ErrorsOver>& panels) {
  if (panels.empty()) return {};
  constexpr double left = 56, right = 1040, gap = 56, top = 48, height = 220;
  const auto count = static_cast<double>(panels.size());
  const double width = std::min(460.0, (right - left - gap * (count - 1)) / count);
  std::string text = detail::legend(left, top - 24, judged, shown);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    text += errors_over_panel(panels[i], left + static_cast<double>(i) * (width + gap), width, top, height);
  }
  return drawing::svg(
      1060, top + height + 44, text, "Error over speed, battery and height",
      "Root mean square and mean of the command error, 1e-3, in tenths of the held-out rows, by model.");
}

/// The flown and the predicted commands of a motor, two seconds before and after a moment.
inline std::string moment_drawing(const LogMoment& moment, const pinnquad::FlightRows& piece,
                                  const LogJudgement& judged, const std::vector<std::size_t>& shown,
                                  const std::vector<const Predictions*>& predictions) {
  constexpr double left = 56, right = 1040, top = 14, height = 120, reach_s = 2;
  const pinnquad::Flight& flight = *moment.flight;
  const double at_s = flight[moment.row].time_s;
  std::size_t begin = moment.row, end = moment.row + 1;
  while (begin > piece.rows.begin && flight[begin - 1].time_s >= at_s - reach_s) --begin;
  while (end < piece.rows.end && flight[end].time_s <= at_s + reach_s) ++end;
  const auto held_out = [&](std::size_t row) { return moment.held_out + row - moment.row; };
  double least = 1, most = 0;
  const auto widen = [&](double u) {
    if (!std::isfinite(u)) return;
    least = std::min(least, u);
    most = std::max(most, u);
  };
  for (std::size_t row = begin; row < end; ++row) {
    widen(flight[row].commands[moment.motor]);
    for (const Predictions* of : predictions) widen((*of)[held_out(row)][moment.motor]);
  }
  const double margin = 0.08 * (most - least) + 1e-6;
  const drawing::Axis x{at_s - reach_s, at_s + reach_s, left, right},
      y{least - margin, most + margin, top + height, top};
  drawing::Trace flown;
  for (std::size_t row = begin; row < end; ++row) {
    if (row > begin && flight[row].time_s - flight[row - 1].time_s > 0.1) flown.to(std::nan(""), 0);
    flown.to(x(flight[row].time_s), y(flight[row].commands[moment.motor]));
  }
  std::string text = drawing::horizontal_axis(x, top, top + height, 8, "time, s") +
                     drawing::vertical_axis(y, left, right, 4, "") +
                     drawing::line(x(at_s), top, x(at_s), top + height, "axis") + drawing::path(flown.d(), "flown");
  for (std::size_t i = predictions.size(); i-- > 0;) {
    drawing::Trace said;
    for (std::size_t row = begin; row < end; ++row) {
      const double u = (*predictions[i])[held_out(row)][moment.motor];
      said.to(x(flight[row].time_s), std::isfinite(u) ? y(u) : u);
    }
    text += drawing::path(said.d(), stroke_of_shown[i]);
  }
  const std::string names = listed(shown, [&judged](std::size_t k) { return judged.kinds[k].kind.title; });
  return drawing::svg(1060, top + height + 42, text,
                      "Command of motor u" + std::to_string(moment.motor + 1) + " about the moment",
                      "As flown, and as predicted by " + names + ".");
}

}  // namespace programs
