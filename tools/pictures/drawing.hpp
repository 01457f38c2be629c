// SPDX-License-Identifier: MIT
// SVG drawings that stand in an HTML page and take its colours: lines, text, axes with ticks, traces.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "pictures/html_text.hpp"
#include "pictures/numbers.hpp"

namespace programs {
namespace drawing {

/// A coordinate: a tenth of a unit is finer than the eye.
inline std::string at(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// `title` names it in a word or two, `description` says what it shows to who does not see it.
inline std::string svg(double width, double height, const std::string& content, const std::string& title,
                       const std::string& description) {
  return "<svg viewBox=\"0 0 " + at(width) + " " + at(height) + "\" role=\"img\">\n<title>" + html_text(title) +
         "</title>\n<desc>" + html_text(description) + "</desc>\n" + content + "</svg>\n";
}

inline std::string line(double x1, double y1, double x2, double y2, const std::string& kind) {
  return "<line x1=\"" + at(x1) + "\" y1=\"" + at(y1) + "\" x2=\"" + at(x2) + "\" y2=\"" + at(y2) + "\" class=\"" +
         kind + "\"/>\n";
}

inline std::string rectangle(double x, double y, double width, double height, const std::string& kind) {
  return "<rect x=\"" + at(x) + "\" y=\"" + at(y) + "\" width=\"" + at(width) + "\" height=\"" + at(height) +
         "\" class=\"" + kind + "\"/>\n";
}

inline std::string path(const std::string& d, const std::string& kind) {
  return d.empty() ? "" : "<path d=\"" + d + "\" class=\"" + kind + "\"/>\n";
}

/// Text in a drawing; `kind` holds the anchor: "start", "middle" or "end" among its words.
inline std::string label(double x, double y, const std::string& content, const std::string& kind) {
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" class=\"" + kind + "\">" + html_text(content) + "</text>\n";
}

/// A linear axis from values to coordinates, with ticks at 1, 2 or 5 times a power of ten.
struct Axis {
  double least = 0, most = 1;  ///< values at the ends
  double from = 0, to = 1;     ///< their coordinates

  double operator()(double value) const { return from + (value - least) / (most - least) * (to - from); }

  double step(int wanted) const {
    const double raw = (most - least) / wanted;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (raw <= factor * power * 1.0000001) return factor * power;
    }
    return 10 * power;
  }

  std::vector<double> ticks(int wanted) const {
    const double by = step(wanted);
    std::vector<double> list;
    for (double k = std::ceil(least / by - 1e-9); k * by <= most + 1e-9 * by; k += 1) list.push_back(k * by + 0.0);
    return list;
  }

  /// A tick's text: as many decimals as its step needs.
  std::string text(double value, int wanted) const {
    const double by = step(wanted);
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(by) - 1e-9)));
    return shown::number(std::abs(value) < by / 2 ? 0 : value, decimals);
  }
};

/// Grid, ticks and frame of a panel with a horizontal axis below; the vertical one is left out where it names things.
inline std::string horizontal_axis(const Axis& x, double top, double bottom, int wanted, const std::string& name,
                                   bool numbered = true) {
  std::string text;
  for (const double tick : x.ticks(wanted)) {
    text += line(x(tick), top, x(tick), bottom, "grid");
    if (numbered) text += label(x(tick), bottom + 16, x.text(tick, wanted), "tick middle");
  }
  return name.empty() ? text : text + label((x.from + x.to) / 2, bottom + 34, name, "name middle");
}

inline std::string vertical_axis(const Axis& y, double left, double right, int wanted, const std::string& name) {
  std::string text;
  for (const double tick : y.ticks(wanted)) {
    text += line(left, y(tick), right, y(tick), "grid");
    text += label(left - 7, y(tick) + 4, y.text(tick, wanted), "tick end");
  }
  const double middle = (y.from + y.to) / 2;
  if (name.empty()) return text;
  return text + "<text class=\"name middle\" transform=\"translate(" + at(left - 44) + " " + at(middle) +
         ") rotate(-90)\">" + html_text(name) + "</text>\n";
}

/// A polyline through the points, as the d of a path.
class Trace {
 public:
  void to(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) {
      open_ = false;
      return;
    }
    d_ += (open_ ? "L" : "M") + at(x) + " " + at(y);
    open_ = true;
  }
  /// A dot (round caps make it one) or a plus sign.
  void dot(double x, double y) { d_ += "M" + at(x) + " " + at(y) + "h0"; }
  void plus(double x, double y) { d_ += "M" + at(x - 2) + " " + at(y) + "h4m-2 -2v4"; }
  const std::string& d() const { return d_; }

 private:
  std::string d_;
  bool open_ = false;
};

}  // namespace drawing
}  // namespace programs
