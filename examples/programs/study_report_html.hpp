// SPDX-License-Identifier: MIT
// HTML and SVG for a report that opens offline: escaping, numbers, tables, a plot with axes, one style sheet for light,
// dark and paper. No script, no reference to anything outside the page.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace programs {
namespace html {

/// Text as HTML: markup escaped, control characters as spaces.
inline std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
    }
  }
  return result;
}

/// A number with a true minus sign and fixed decimals; a dash where there is none.
inline std::string number(double value, int decimals, bool plus = false) {
  if (!std::isfinite(value)) return "&ndash;";
  char text[64];
  std::snprintf(text, sizeof text, plus ? "%+.*f" : "%.*f", decimals, value);
  std::string result = text;
  return result[0] == '-' ? "&minus;" + result.substr(1) : result;
}

/// A figure with its unit as text, such as "-4.1e-3" or "3.2 deg", in the page's signs.
inline std::string quantity(const std::string& text) {
  std::string result = escaped(text);
  if (!result.empty() && result[0] == '-') result = "&minus;" + result.substr(1);
  const auto replace = [&result](const std::string& what, const std::string& with) {
    const std::size_t at = result.find(what);
    if (at != std::string::npos) result.replace(at, what.size(), with);
  };
  replace("e-3", "&times;10<sup>&minus;3</sup>");
  replace(" deg", "&#176;");
  replace(" %", "&#160;%");
  return result;
}

/// Two significant figures; powers of ten below a thousandth.
inline std::string p_value(double p) {
  char text[64];
  if (p >= 0.001) {
    std::snprintf(text, sizeof text, p >= 0.1 ? "%.2f" : "%.3f", p);
    return text;
  }
  std::snprintf(text, sizeof text, "%.1e", p);
  const std::string result = text;
  const std::size_t e = result.find('e');
  return result.substr(0, e) + "&times;10<sup>&minus;" + std::to_string(std::abs(std::stoi(result.substr(e + 1)))) +
         "</sup>";
}

inline std::string tag(const std::string& name, const std::string& content, const std::string& kind = "") {
  return "<" + name + (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + content + "</" + name + ">";
}

/// Cells are HTML; those of class "n" are figures and stand right.
struct Cell {
  std::string content;
  std::string kind;
  int columns = 1;
};

inline std::string row(const std::vector<Cell>& cells, const std::string& kind = "", bool header = false) {
  std::string text = "<tr" + (kind.empty() ? "" : " class=\"" + kind + "\"") + ">";
  for (const Cell& cell : cells) {
    const std::string name = header ? "th" : "td";
    text += "<" + name;
    if (!cell.kind.empty()) text += " class=\"" + cell.kind + "\"";
    if (cell.columns > 1) text += " colspan=\"" + std::to_string(cell.columns) + "\"";
    text += ">" + cell.content + "</" + name + ">";
  }
  return text + "</tr>\n";
}

inline std::string table(const std::string& head, const std::string& body, const std::string& kind = "") {
  return "<div class=\"wide\"><table" + (kind.empty() ? "" : " class=\"" + kind + "\"") + "><thead>" + head +
         "</thead><tbody>" + body + "</tbody></table></div>\n";
}

inline std::string figure(const std::string& drawing, const std::string& caption) {
  return "<figure>" + drawing + "<figcaption>" + caption + "</figcaption></figure>\n";
}

/// An SVG drawing as an image of its own, so that its names and styles stay in it.
inline std::string embedded_svg(const std::string& svg, const std::string& description) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < svg.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = (bits << 8) | (i + k < svg.size() ? static_cast<unsigned char>(svg[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k > svg.size() - i ? '=' : digits[(bits >> (18 - 6 * k)) & 63u];
    }
  }
  return "<img alt=\"" + escaped(description) + "\" src=\"data:image/svg+xml;base64," + text + "\"/>";
}

/// A coordinate: a tenth of a unit is finer than the eye.
inline std::string at(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

inline std::string svg(double width, double height, const std::string& content, const std::string& label) {
  return "<svg viewBox=\"0 0 " + at(width) + " " + at(height) + "\" role=\"img\" aria-label=\"" + escaped(label) +
         "\">\n" + content + "</svg>\n";
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
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" class=\"" + kind + "\">" + content + "</text>\n";
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
    return number(std::abs(value) < by / 2 ? 0 : value, decimals);
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
         ") rotate(-90)\">" + name + "</text>\n";
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

/// The style of the page. Colours are variables; the drawings use the same ones.
inline const char* style() {
  return R"css(
:root{--paper:#fdfdfb;--ink:#1d2126;--soft:#5d656f;--faint:#8d949d;--rule:#d9dcdf;--panel:#f4f4f0;
--blue:#1f5f9e;--pale:#9cc0e2;--orange:#c8561b;--green:#2f7d4f;--amber:#9a6a00;--red:#b0322b;--purple:#6b4fa0}
@media (prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e4e6e8;--soft:#a6adb5;--faint:#7d858e;--rule:#343a41;
--panel:#1d2126;--blue:#79b0e6;--pale:#3f6a94;--orange:#ee9560;--green:#76c596;--amber:#e0b354;--red:#ef8a80;--purple:#b39ce0}}
@media print{:root{--paper:#fff;--ink:#000;--soft:#444;--faint:#666;--rule:#bbb;--panel:#f6f6f6;--blue:#1f5f9e;--pale:#9cc0e2;
--orange:#c8561b;--green:#2f7d4f;--amber:#9a6a00;--red:#b0322b;--purple:#6b4fa0}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:17px/1.58 Charter,"Bitstream Charter","Source Serif 4",Georgia,serif}
main{max-width:1120px;margin:0 auto;padding:56px 36px 96px}
h1{font-size:2.15em;line-height:1.15;font-weight:600;margin:0 0 .25em;letter-spacing:-.01em}
h2{font-size:1.38em;font-weight:600;margin:2.6em 0 .6em;padding-top:.7em;border-top:1px solid var(--rule)}
h3{font-size:1.05em;font-weight:600;margin:1.8em 0 .5em}
p{max-width:44em;margin:.6em 0}
.lead{font-size:1.1em;color:var(--soft)}
.note{color:var(--soft);font-size:.88em;max-width:52em}
a{color:var(--blue);text-decoration:none}
table,svg,.badge,figcaption,nav,.tally,.gap{font-family:"Inter","Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif}
table{border-collapse:collapse;font-size:.78em;line-height:1.42;font-variant-numeric:tabular-nums lining-nums;width:100%}
.wide{overflow-x:auto;margin:1em 0 1.2em}
th{font-weight:600;text-align:left;color:var(--soft);border-bottom:1.5px solid var(--ink);padding:5px 9px;vertical-align:bottom}
td{padding:5px 9px;border-bottom:1px solid var(--rule);vertical-align:top}
thead tr:not(:last-child) th{border-bottom:0;padding-bottom:0}
th.n,td.n{text-align:right;white-space:nowrap}th.c{text-align:center}
tr.group td{border-bottom:1.2px solid var(--faint)}
td.paper{color:var(--soft)}td.best{font-weight:700}td.dev{color:var(--faint);padding-left:0}th.dev{padding-left:0}
td.key{white-space:nowrap}.good{color:var(--green)}.bad{color:var(--red)}.mild{color:var(--soft)}
table.plain{width:auto;min-width:50%}
.badge{display:inline-block;font-size:.72rem;font-weight:600;letter-spacing:.02em;padding:2px 9px;border-radius:999px;border:1.2px solid;white-space:nowrap}
.badge.reproduced{color:var(--green)}.badge.part{color:var(--amber)}.badge.not{color:var(--red)}.badge.open{color:var(--faint)}
.tally{display:flex;flex-wrap:wrap;gap:14px;margin:1.6em 0 1.2em;padding:0}
.tally div{flex:1 1 150px;background:var(--panel);border-radius:8px;padding:13px 18px}
.tally b{display:block;font-size:1.75rem;font-weight:600;line-height:1.2}.tally span{font-size:.8rem;color:var(--soft)}
.claim{display:grid;grid-template-columns:3.2em 1fr auto;gap:2px 10px;padding:15px 0 4px;break-inside:avoid}
.claim .id{color:var(--faint);font-variant-numeric:tabular-nums}
.claim .statement{font-weight:600;max-width:44em}
.claim .rest{grid-column:2/4}
.claim .rule::first-letter{text-transform:uppercase}
.claim table{table-layout:fixed;min-width:700px}.claim th:first-child{width:25%}.claim th:last-child{width:21%}
table.overview td{padding-top:7px;padding-bottom:7px;font-size:1.08em}table.overview .badge{font-size:.86em}
.claim .rule{color:var(--soft);font-size:.84em;margin:.15em 0 .5em;max-width:56em}
.claim .wide{margin:.3em 0 .8em}.claim table{font-size:.74em}.claim th{border-bottom-width:1px;border-color:var(--faint)}
.gap{background:var(--panel);border-left:4px solid var(--amber);padding:12px 18px;font-size:.85em;border-radius:0 6px 6px 0;margin:1.2em 0}
.gap p{margin:.2em 0;max-width:none}
nav{font-size:.84em;display:flex;flex-wrap:wrap;gap:4px 20px;margin:1.4em 0 0;color:var(--soft)}
figure{margin:1.6em 0 2.2em}figure svg,figure img{display:block;width:100%;height:auto}
figure img{background:#fff;border-radius:4px}
figcaption{font-size:.8em;color:var(--soft);margin-top:.5em;max-width:70em;line-height:1.45}
sup,sub{line-height:0;font-size:.75em}
svg text{fill:var(--ink);font-size:12px}svg .tick{fill:var(--soft);font-size:11.5px;font-variant-numeric:tabular-nums}
svg .name{fill:var(--soft)}svg .title{font-weight:600;font-size:13px}svg .small{font-size:11px;fill:var(--soft)}
svg .middle{text-anchor:middle}svg .end{text-anchor:end}
svg .grid{stroke:var(--rule);stroke-width:1}svg .axis{stroke:var(--faint);stroke-width:1.2}
svg path,svg line{fill:none}
svg .first{stroke:var(--blue);stroke-width:1.8}svg .second{stroke:var(--orange);stroke-width:1.8}
svg .thick{stroke:var(--pale);stroke-width:3.2}svg .thin{stroke:var(--orange);stroke-width:1.2}
svg .dash{stroke-dasharray:5 4}svg .cloud{stroke:var(--pale);stroke-width:2.6;stroke-linecap:round}
svg .plus{stroke:var(--orange);stroke-width:.9;opacity:.62}
svg .seed{stroke:var(--blue);stroke-width:5;stroke-linecap:round;opacity:.33}
svg .mean{stroke:var(--ink);stroke-width:2.4}svg .deviation{stroke:var(--ink);stroke-width:1.3}
svg .reference{fill:var(--paper);stroke:var(--orange);stroke-width:1.8}svg .reference-line{stroke:var(--orange);stroke-width:1.1;opacity:.7}
svg .red{fill:#c65a50}svg .green{fill:#4f9c6c}svg .yellow{fill:#d3a83f}svg .orange{fill:#d98243}svg .violet{fill:#8a76b8}svg .blue{fill:#5b8fc0}
svg .vanilla{opacity:.62}
@page{size:A4;margin:15mm 14mm}
@media print{body{font-size:10pt}main{max-width:none;padding:0}nav{display:none}
figure,tr,.claim,.gap{break-inside:avoid}h2,h3{break-after:avoid}h2{margin-top:1.6em}
.wide{overflow:visible}table{font-size:7.1pt}th,td{padding:2.5px 4px}.claim table{min-width:0;font-size:6.9pt}
.claim{grid-template-columns:2em 1fr auto}.badge{font-size:7pt;padding:1px 6px}table.overview td{font-size:8pt}}
)css";
}

}  // namespace html
}  // namespace programs
