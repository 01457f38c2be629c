// SPDX-License-Identifier: MIT
#include "page/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "page/page.hpp"
#include "page/text.hpp"
#include "pinnquad/io/atomic_file.hpp"

namespace programs {

// what charts/main.js reads
NLOHMANN_JSON_SERIALIZE_ENUM(Shape, {{Shape::line, "line"},
                                     {Shape::dots, "dots"},
                                     {Shape::pluses, "pluses"},
                                     {Shape::squares, "squares"},
                                     {Shape::strokes, "strokes"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Series, name, shape, colour, x, y, width, opacity, dashed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Axis, name, least, most, logarithmic, rows)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Panel, title, note, x, y, height, series)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Chart, description, columns, panels)

namespace {

constexpr double wide = 640, letter = 6.9, line_height = 17;

/// A coordinate: a tenth of a unit is finer than the eye.
std::string at(double value) {
  const long tenths = std::lround(10 * value);
  const std::string whole = (tenths < 0 ? "-" : "") + std::to_string(std::labs(tenths) / 10);
  return tenths % 10 == 0 ? whole : whole + "." + std::to_string(std::labs(tenths) % 10);
}

double text_width(const std::string& text) {
  return letter *
         static_cast<double>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

/// A colour of the palette, and its light value for readers of SVG that know no variables.
std::string ink(const std::string& colour) {
  if (colour[0] == '#') return " color=\"" + colour + "\"";
  const std::string palette = page_file("palette.css"), name = "--" + colour + ": ";
  const std::size_t place = palette.find(name);
  if (place == std::string::npos) throw std::logic_error("page/palette.css has no colour " + colour);
  const std::size_t begin = place + name.size();
  return " style=\"color:var(--" + colour + ")\" color=\"" + palette.substr(begin, palette.find(';', begin) - begin) +
         "\"";
}

std::string stroke(const std::string& d, const std::string& colour, double width, const std::string& more = "") {
  if (d.empty()) return "";
  return "<path" + ink(colour) + " fill=\"none\" stroke=\"currentColor\" stroke-width=\"" + at(width) + "\"" + more +
         " d=\"" + d + "\"/>\n";
}

std::string text(double x, double y, const std::string& content, const std::string& colour, const std::string& anchor,
                 const std::string& more = "") {
  return "<text" + ink(colour) + " fill=\"currentColor\" x=\"" + at(x) + "\" y=\"" + at(y) + "\" text-anchor=\"" +
         anchor + "\"" + more + ">" + html_text(content) + "</text>\n";
}

std::string rectangle(double x, double y, double width, double height, const std::string& colour, double opacity) {
  return "<rect" + ink(colour) + " fill=\"currentColor\" x=\"" + at(x) + "\" y=\"" + at(y) + "\" width=\"" + at(width) +
         "\" height=\"" + at(height) + "\" fill-opacity=\"" + shown::number(opacity, 2) + "\"/>\n";
}

/// From values to coordinates, with ticks at 1, 2 or 5 times a power of ten.
struct Scale {
  double least = 0, most = 1, from = 0, to = 1;

  double operator()(double value) const { return from + (value - least) / (most - least) * (to - from); }
  bool holds(double value) const {
    const double slack = 1e-9 * (most - least);
    return value >= least - slack && value <= most + slack;
  }
  double step(double wanted) const {
    const double raw = (most - least) / wanted, power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (raw <= 1.25 * factor * power) return factor * power;
    }
    return 10 * power;
  }
  std::vector<double> ticks(double wanted) const {
    std::vector<double> list;
    const double by = step(wanted);
    for (double k = std::ceil(least / by - 1e-9); k * by <= most + 1e-9 * by; k += 1) list.push_back(k * by + 0.0);
    return list;
  }
  /// As many decimals as the step needs.
  std::string number(double tick, double wanted) const {
    const double by = step(wanted);
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(by) - 1e-9)));
    return shown::number(std::abs(tick) < by / 2 ? 0 : tick, decimals);
  }
};

double ticks_along(double length, bool across) {
  return std::max(across ? 4.0 : 2.0, std::floor(length / (across ? 64 : 30)));
}

/// The ends of an axis: its own, or those of the series with a margin.
Scale scale_of(const Panel& panel, const Axis& axis, bool is_x, bool right) {
  Scale scale;
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Series& series : panel.series) {
    if (!is_x && series.right != right) continue;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      const double value = is_x ? series.x[i] : series.y[i];
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  if (!(least <= most)) least = 0, most = 1;
  if (least == most) {
    const double half = least != 0 ? std::abs(least) / 2 : 1;
    least -= half;
    most += half;
  }
  const bool over_time = is_x && !panel.series.empty() && panel.series.front().shape == Shape::line;
  const double margin = over_time ? 0 : 0.05 * (most - least);
  scale.least = std::isfinite(axis.least) ? axis.least : least - margin;
  scale.most = std::isfinite(axis.most) ? axis.most : most + margin;
  return scale;
}

/// Space around a plot, and the scales of its axes.
struct Layout {
  Scale x, y, right;
  double margin_left = 0, margin_right = 12, above = 0, height = 0, below = 0;
  bool has_right = false;
};

double numbers_width(const Scale& scale, double wanted) {
  double width = 0;
  for (const double tick : scale.ticks(wanted)) width = std::max(width, text_width(scale.number(tick, wanted)));
  return width;
}

Layout layout_of(const Panel& panel, double width) {
  Layout l;
  l.x = scale_of(panel, panel.x, true, false);
  l.y = scale_of(panel, panel.y, false, false);
  for (const Series& series : panel.series) l.has_right = l.has_right || series.right;
  l.height = panel.height;
  if (!panel.y.hidden) l.margin_left = 10 + numbers_width(l.y, ticks_along(l.height, false));
  if (l.has_right) {
    l.right = scale_of(panel, panel.right, false, true);
    l.margin_right = 10 + numbers_width(l.right, ticks_along(l.height, false));
  }
  const double titles = text_width(panel.title) + text_width(panel.note) + 20;
  if (!panel.title.empty() || !panel.note.empty()) l.above += line_height;
  if (!panel.title.empty() && !panel.note.empty() && titles > width) l.above += line_height;
  if (!panel.y.name.empty() || l.has_right) l.above += line_height;
  l.above += panel.bands.empty() || panel.bands.front().name.empty() ? 6 : line_height;
  if (!panel.x.hidden) {
    l.below = (panel.x.numbered ? 18 : 6) + (panel.x.name.empty() ? 0 : line_height);
  }
  return l;
}

/// A mark about a point, after "Mx y".
const char* mark_of(Shape shape) { return shape == Shape::squares ? "m-4-4h8v8h-8z" : "h0"; }

std::string attributes_of(const Series& series) {
  std::string more = series.shape == Shape::line ? " stroke-linejoin=\"round\"" : "";
  if (series.shape == Shape::dots) more += " stroke-linecap=\"round\"";
  if (series.opacity < 1) more += " opacity=\"" + shown::number(series.opacity, 2) + "\"";
  if (series.dashed) more += " stroke-dasharray=\"5 4\"";
  return more;
}

std::string drawn_series(const Series& series, const Scale& x, const Scale& y) {
  std::string d, last;
  bool open = false;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const bool inside = y.holds(series.y[i]) && x.holds(series.x[i]);
    const std::string place = inside ? at(x(series.x[i])) + " " + at(y(series.y[i])) : "";
    if (inside && series.shape == Shape::line && !(open && place == last)) d += (open ? "L" : "M") + place;
    if (inside && series.shape != Shape::line) d += "M" + place + mark_of(series.shape);
    open = inside;
    last = place;
  }
  return stroke(d, series.colour, series.width, attributes_of(series));
}

std::string drawn_axes(const Panel& panel, const Layout& l) {
  const Scale &x = l.x, &y = l.y;
  const double across = ticks_along(x.to - x.from, true), up = ticks_along(std::abs(y.to - y.from), false);
  const double top = std::min(y.from, y.to), bottom = std::max(y.from, y.to);
  std::string grid, words;
  if (!panel.x.hidden) {
    for (const double tick : x.ticks(across)) {
      grid += "M" + at(x(tick)) + " " + at(top) + "V" + at(bottom);
      if (panel.x.numbered) words += text(x(tick), bottom + 15, x.number(tick, across), colour::muted, "middle");
    }
    words += panel.x.name.empty()
                 ? ""
                 : text(x.to, bottom + (panel.x.numbered ? 31 : 15), panel.x.name, colour::muted, "end");
  }
  if (!panel.y.hidden) {
    for (const double tick : y.ticks(up)) {
      grid += "M" + at(x.from) + " " + at(y(tick)) + "H" + at(x.to);
      words += text(x.from - 6, y(tick) + 4, y.number(tick, up), colour::muted, "end");
    }
  }
  if (l.has_right) {
    for (const double tick : l.right.ticks(up)) {
      words += text(x.to + 6, l.right(tick) + 4, l.right.number(tick, up), colour::muted, "start");
    }
  }
  return stroke(grid, colour::grid, 1) + words;
}

/// `shared` are the margins of its column: plots below each other begin and end together.
std::string drawn_panel(const Panel& panel, Layout l, double left, double top, double width) {
  l.x.from = left + l.margin_left;
  l.x.to = left + width - l.margin_right;
  double line = top;
  std::string drawn;
  if (!panel.title.empty() || !panel.note.empty()) {
    line += line_height;
    drawn +=
        panel.title.empty() ? "" : text(left, line - 4, panel.title, colour::text, "start", " font-weight=\"600\"");
    if (!panel.title.empty() && text_width(panel.title) + text_width(panel.note) + 20 > width) line += line_height;
    const bool beside = line < top + 1.5 * line_height;
    if (!panel.note.empty())
      drawn += text(beside ? l.x.to : left, line - 4, panel.note, colour::muted, beside ? "end" : "start");
  }
  if (!panel.y.name.empty() || l.has_right) {
    line += line_height;
    drawn += text(left, line - 4, panel.y.name, colour::muted, "start");
    if (l.has_right) drawn += text(left + width, line - 4, panel.right.name, colour::muted, "end");
  }
  const double first = top + l.above, last = first + l.height;
  l.y.from = l.right.from = last;
  l.y.to = l.right.to = first;
  for (const Band& band : panel.bands) {
    const double from = l.x(std::max(band.from, l.x.least)), to = l.x(std::min(band.to, l.x.most));
    drawn += rectangle(from, first, to - from, last - first, band.colour, 0.13);
    if (text_width(band.name) < to - from + 6)
      drawn += text((from + to) / 2, first - 5, band.name, colour::muted, "middle", " font-size=\"11\"");
  }
  drawn += drawn_axes(panel, l);
  for (const Series& series : panel.series) drawn += drawn_series(series, l.x, series.right ? l.right : l.y);
  for (const Label& label : panel.labels)
    drawn += text(l.x(label.x), l.y(label.y) + 4, label.text, colour::muted, label.anchor);
  return drawn;
}

/// Each name once, in its first series' look; `y` goes to what is below.
std::string legend(const Chart& chart, double width, double& y) {
  std::vector<std::string> named;
  std::string drawn;
  double x = 0;
  for (const Panel& panel : chart.panels) {
    for (const Series& series : panel.series) {
      if (series.name.empty() || std::find(named.begin(), named.end(), series.name) != named.end()) continue;
      named.push_back(series.name);
      const double takes = 28 + text_width(series.name) + 16;
      if (x > 0 && x + takes - 16 > width) {
        x = 0;
        y += line_height;
      }
      const double middle = y + 9;
      const std::string place = "M" + at(x + 11) + " " + at(middle);
      if (series.shape == Shape::line) {
        drawn += stroke("M" + at(x) + " " + at(middle) + "h22", series.colour, series.width, attributes_of(series));
      } else {
        drawn += stroke(place + mark_of(series.shape), series.colour,
                        std::max(series.width, series.shape == Shape::dots ? 5 : 1.2), attributes_of(series));
      }
      drawn += text(x + 28, y + 13, series.name, colour::text, "start");
      x += takes;
    }
  }
  if (!named.empty()) y += line_height + 5;
  return drawn;
}

/// The contents of a picture of this width, from `y` on; `y` goes to its end.
std::string drawn_chart(const Chart& chart, double width, double& y) {
  std::string drawn = legend(chart, width, y);
  const auto columns = static_cast<std::size_t>(chart.columns);
  constexpr double gap = 14;
  std::vector<double> left(columns), right(columns), widths(columns);
  double shares = 0;
  for (std::size_t c = 0; c < columns; ++c) shares += columns > 1 ? chart.panels[c].share : 1;
  for (std::size_t c = 0; c < columns; ++c) {
    widths[c] = (width - gap * static_cast<double>(columns - 1)) * (columns > 1 ? chart.panels[c].share : 1) / shares;
  }
  std::vector<Layout> layouts;
  for (std::size_t i = 0; i < chart.panels.size(); ++i) {
    layouts.push_back(layout_of(chart.panels[i], widths[i % columns]));
    left[i % columns] = std::max(left[i % columns], layouts[i].margin_left);
    right[i % columns] = std::max(right[i % columns], layouts[i].margin_right);
  }
  for (std::size_t i = 0; i < chart.panels.size(); i += columns) {
    double x = 0, tallest = 0;
    for (std::size_t c = 0; c < columns && i + c < chart.panels.size(); ++c) {
      Layout& l = layouts[i + c];
      l.margin_left = left[c];
      l.margin_right = right[c];
      drawn += drawn_panel(chart.panels[i + c], l, x, y, widths[c]);
      tallest = std::max(tallest, l.above + l.height + l.below);
      x += widths[c] + gap;
    }
    y += tallest + 10;
  }
  return drawn;
}

/// Seven digits: finer than the eye, and half the page.
void round_values(std::vector<double>& values) {
  for (double& value : values) {
    char text[32];
    std::snprintf(text, sizeof text, "%.7g", value);
    value = std::strtod(text, nullptr);
  }
}

/// Data for charts/main.js; what is not finite is null. Nothing in it can end the element that holds it.
std::string json_of(Chart chart) {
  for (Panel& panel : chart.panels) {
    for (Series& series : panel.series) {
      round_values(series.x);
      round_values(series.y);
    }
  }
  std::string text = nlohmann::json(chart).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t place; (place = text.find('<')) != std::string::npos;) text.replace(place, 1, "\\u003c");
  return text;
}

/// Least, mean and largest of each series.
std::string table_of(const Chart& chart) {
  std::string rows;
  for (const Panel& panel : chart.panels) {
    const bool named = !panel.y.rows.empty();
    const std::string& quantity = named ? panel.x.name : panel.y.name;
    for (const Series& series : panel.series) {
      double least = HUGE_VAL, most = -HUGE_VAL, sum = 0, count = 0;
      for (const double value : named ? series.x : series.y) {
        if (!std::isfinite(value)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
        sum += value;
        ++count;
      }
      if (series.name.empty() || count == 0) continue;
      rows += "<tr><td>" + html_text(panel.title) + "</td><td>" + html_text(quantity) + "</td><td>" +
              html_text(series.name) + "</td>";
      for (const double value : {least, sum / count, most})
        rows += "<td class=\"n\">" + shown::number(value, 3) + "</td>";
      rows += "</tr>\n";
    }
  }
  return "<div class=\"wide\"><table class=\"plain\"><thead><tr><th></th><th></th><th></th><th class=\"n\">least</th>"
         "<th class=\"n\">mean</th><th class=\"n\">largest</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>";
}

}  // namespace

std::string inline_chart(const Chart& chart) {
  if (chart.panels.empty()) return "";
  return "<div class=\"chart\"><script type=\"application/json\">" + json_of(chart) + "</script>" + table_of(chart) +
         "</div>";
}

void write_svg(const std::string& path, const Chart& chart) {
  constexpr double edge = 14, width = wide + 2 * edge;
  double y = 34;
  const std::string drawn = drawn_chart(chart, wide, y);
  const std::string size = "width=\"" + at(width) + "\" height=\"" + at(y) + "\"";
  pinnquad::AtomicFile file(path);
  file.stream() << "<svg xmlns=\"http://www.w3.org/2000/svg\" " << size << " role=\"img\" viewBox=\"" << at(-edge)
                << " 0 " << at(width) << " " << at(y)
                << "\" font-family=\"Inter,Helvetica Neue,Helvetica,Arial,Liberation Sans,DejaVu Sans,sans-serif\" "
                   "font-size=\"12\">\n<title>"
                << html_text(chart.title) << "</title>\n<desc>" << html_text(chart.description) << "</desc>\n<style>\n"
                << page_file("palette.css") << "</style>\n<rect" << ink(colour::ground) << " fill=\"currentColor\" x=\""
                << at(-edge) << "\" " << size << "/>\n"
                << text(0, 22, chart.title, colour::text, "start", " font-size=\"14\" font-weight=\"600\"") << drawn
                << "</svg>\n";
  file.commit();
}

}  // namespace programs
