// SPDX-License-Identifier: MIT
// Built twice: with <charconv>, and with what stands in where the standard library has none for floating point.
#include <doctest/doctest.h>

#include <clocale>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <pinnquad/io/decimal.hpp>
#include <random>
#include <string>

using pinnquad::number_text;
using pinnquad::parse_number;

namespace {

/// A locale with a decimal comma while it lives, if the machine has one.
struct DecimalComma {
  DecimalComma() {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) return;
    }
    MESSAGE("this machine has no locale with a decimal comma: the C locale alone is tested");
  }
  ~DecimalComma() { std::setlocale(LC_ALL, "C"); }
};

std::string reading_of(const std::string& text) {
  double value = 0;
  return parse_number(text, value) ? number_text(value) : "refused";
}

}  // namespace

TEST_CASE("numbers are read and written alike under any locale") {
  const DecimalComma elsewhere;
  const auto check = [](const std::string& text, const std::string& same) { CHECK(reading_of(text) == same); };
  check("0", "0");
  check("-0.0", "-0");
  check("+1.5", "1.5");
  check(".5", "0.5");
  check("5.", "5");
  check("1e5", "1e+05");
  check("12345", "12345");
  check("100000", "1e+05");
  check("0.0001", "1e-04");
  check("0.00012", "0.00012");
  check("1E-7", "1e-07");
  check("1e300", "1e+300");
  check("123456789012345678901", "123456789012345683968");
  check("4.9e-324", "5e-324");
  check("2.2250738585072011e-308", "2.225073858507201e-308");
  check("1.7976931348623157e308", "1.7976931348623157e+308");
  // nearer to 0 than to the smallest number, as strtod reads them; beyond the largest
  check("1e-400", "0");
  check("-1e-330", "-0");
  check("0e-400", "0");
  check("3e-324", "5e-324");
  check("4e-320", "4e-320");
  check("1e-99999999999999999999", "0");
  check("0." + std::string(400, '0') + "1", "0");
  check("0." + std::string(400, '0') + "1e300", "1e-101");
  check("0." + std::string(400, '0') + "1e800", "refused");
  check(std::string(400, '9') + "e-900", "0");
  check(std::string(400, '9') + "e-300", "1e+100");
  check(std::string(400, '9'), "refused");
  check("1e999", "refused");
  check("1e99999999999999999999", "refused");
  check("1e-400x", "refused");
  // forty digits decide between two neighbours: 2^53 + 1 lies half way
  check("9007199254740993.00000000000000000000000000000", "9007199254740992");
  check("9007199254740993.00000000000000000000000000001", "9007199254740994");
  for (const char* text : {"", "+", "-", "+-1", "++1", "1,5", "1 ", " 1", "0x10", "1e", "1e+", "e5", ".", "nan", "inf",
                           "-inf", "infinity", "1f", "1.2.3"}) {
    CAPTURE(text);
    check(text, "refused");
  }
  CHECK(number_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
  CHECK(number_text(-std::numeric_limits<double>::infinity()) == "-inf");
}

TEST_CASE("the shortest text gives the bits back, and no shorter one does") {
  const DecimalComma elsewhere;
  std::mt19937_64 engine(1);
  int compared = 0, different = 0;
  for (int i = 0; i < 20000; ++i) {
    std::uint64_t bits = engine();
    double value = 0, back = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!pinnquad::is_finite(value)) continue;
    ++compared;
    if (i % 2 == 0) value = static_cast<double>(static_cast<std::int64_t>(bits)) / static_cast<double>(1 + (i % 1000));
    const std::string text = number_text(value);
    different += parse_number(text, back) && std::memcmp(&back, &value, sizeof back) == 0 ? 0 : 1;
#if defined(__cpp_lib_to_chars)
    char buffer[pinnquad::detail::longest_number];
    different += text == std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr) ? 0 : 1;
#endif
  }
  CHECK(compared > 19900);  // one exponent in 2048 is that of NaN and infinity
  CHECK(different == 0);
}
