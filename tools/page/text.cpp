// SPDX-License-Identifier: MIT
#include "page/text.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>

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

std::string shown::number(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string result = text;
  return result[0] == '-' ? "−" + result.substr(1) : result;
}

}  // namespace programs
