// SPDX-License-Identifier: MIT
// HTML for a report that opens offline: escaping, numbers, tables, embedded pictures. No script, no reference to anything
// outside the page.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "pictures/html_text.hpp"

namespace programs {
namespace html {

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
  std::string result = html_text(text);
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
  return "<img alt=\"" + html_text(description) + "\" src=\"data:image/svg+xml;base64," + base64(svg) + "\"/>";
}

}  // namespace html
}  // namespace programs
