// SPDX-License-Identifier: MIT
// Charts as values: panels with axes and series. A page draws them with Chart.js (charts/main.js); a file is an SVG.
// The bytes depend on the values alone.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace programs {

/// Names of page/palette.css, light and dark. A colour may also be "#rrggbb", which is the same in both.
namespace colour {
inline constexpr const char *text = "text", *muted = "muted", *grid = "line", *ground = "background",
                            *blue = "series-1", *orange = "series-2", *green = "series-3", *amber = "series-4",
                            *red = "series-5", *violet = "series-6";
}  // namespace colour

/// A series is a line through its points, or a mark on each; pluses and strokes in pages alone.
enum class Shape { line, dots, pluses, squares, strokes };

/// Points over each other. In a panel whose y axis names rows, the y of a point is its row's number.
struct Series {
  std::string name;  ///< in the legend; not there where empty
  Shape shape = Shape::line;
  std::string colour = colour::blue;
  std::vector<double> x{}, y{};  ///< a NaN breaks a line
  double width = 1.6;            ///< of strokes
  double opacity = 1;
  bool dashed = false;
  bool right = false;  ///< y counts on the panel's right axis

  void add(double at_x, double at_y) {
    x.push_back(at_x);
    y.push_back(at_y);
  }
  /// Breaks a line.
  void add_gap() { add(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()); }
};

/// An end that is NaN lies where the series end. What lies outside is not drawn.
struct Axis {
  std::string name{};  ///< quantity and unit: "speed, m/s"
  double least = std::numeric_limits<double>::quiet_NaN();
  double most = std::numeric_limits<double>::quiet_NaN();
  bool logarithmic = false;         ///< in pages alone
  std::vector<std::string> rows{};  ///< names instead of numbers, from the top; in pages alone
  bool hidden = false;              ///< in SVG files alone, as bands, labels, right axes and shares
  bool numbered = true;
};

/// A shaded range of x, named along the upper edge.
struct Band {
  std::string name, colour;
  double from = 0, to = 0;
};

/// Text in a panel, at a place of its axes; `anchor` as in SVG.
struct Label {
  std::string text, anchor;
  double x = 0, y = 0;
};

/// `note` stands beside the title, at the right.
struct Panel {
  std::string title{}, note{};
  Axis x{}, y{}, right{};
  std::vector<Series> series{};
  double height = 130;  ///< of its plot; 0: as wide, in pages alone. Rows have a height of their own
  double share = 1;     ///< of the width of its line of panels
  std::vector<Band> bands{};
  std::vector<Label> labels{};
};

/// `description` says what it shows to who does not see it. Panels stand in columns where these are wide enough.
struct Chart {
  std::string title, description;
  std::vector<Panel> panels{};
  int columns = 1;
};

/// A part of a page: a table of least, mean and largest, in whose place charts/main.js draws the chart. Nothing without
/// panels.
std::string inline_chart(const Chart& chart);

/// A file of its own, with title, ground and style; whole or not at all. Throws OutputError.
void write_svg(const std::string& path, const Chart& chart);

}  // namespace programs
