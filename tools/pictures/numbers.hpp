// SPDX-License-Identifier: MIT
// Figures as a page shows them: true minus signs, powers of ten, a dash where there is none. Plain text.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace programs {
namespace shown {

/// A number with fixed decimals.
inline std::string number(double value, int decimals, bool plus = false) {
  if (!std::isfinite(value)) return "–";
  char text[64];
  std::snprintf(text, sizeof text, plus ? "%+.*f" : "%.*f", decimals, value);
  std::string result = text;
  return result[0] == '-' ? "−" + result.substr(1) : result;
}

/// A figure with its unit in plain ASCII, such as "-4.1e-3" or "3.2 deg", in the page's signs.
inline std::string quantity(const std::string& text) {
  std::string result = text;
  if (!result.empty() && result[0] == '-') result = "−" + result.substr(1);
  const auto replace = [&result](const std::string& what, const std::string& with) {
    const std::size_t at = result.find(what);
    if (at != std::string::npos) result.replace(at, what.size(), with);
  };
  replace("e-3", "×10⁻³");
  replace(" deg", "°");
  replace(" %", "\u00a0%");
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
  std::string power;
  for (const char digit : std::to_string(std::abs(std::stoi(result.substr(e + 1))))) {
    static constexpr const char* raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    power += raised[digit - '0'];
  }
  return result.substr(0, e) + "×10⁻" + power;
}

}  // namespace shown
}  // namespace programs
