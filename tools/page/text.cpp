// SPDX-License-Identifier: MIT
#include "page/text.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace programs {

std::string html_text(const std::string& text) {
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

std::string base64(std::string bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t size = bytes.size();
  bytes.resize((size + 2) / 3 * 3);
  std::string text;
  text.reserve(bytes.size() / 3 * 4);
  const auto byte = [&bytes](std::size_t i) { return std::uint32_t{static_cast<unsigned char>(bytes[i])}; };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::uint32_t group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (int shift = 18; shift >= 0; shift -= 6) text += digits[(group >> shift) & 63u];
  }
  for (std::size_t pad = bytes.size() - size; pad > 0; --pad) text[text.size() - pad] = '=';
  return text;
}

std::string shown::number(double value, int decimals, bool plus) {
  if (!std::isfinite(value)) return "–";
  char text[64];
  std::snprintf(text, sizeof text, plus ? "%+.*f" : "%.*f", decimals, value);
  std::string result = text;
  return result[0] == '-' ? "−" + result.substr(1) : result;
}

std::string shown::quantity(const std::string& text) {
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

std::string shown::p_value(double p) {
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

}  // namespace programs
