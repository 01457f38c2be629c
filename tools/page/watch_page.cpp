// SPDX-License-Identifier: MIT
#include "page/watch_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <type_traits>
#include <utility>

#include <nlohmann/json.hpp>

#include "page/text.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/io/atomic_file.hpp"

namespace programs {
namespace {

constexpr const char* unavailable =
    "this program was built without its pages: apt-get install nodejs npm, then build it again, with a network";

/// Base64 of the values as a little-endian array, on any machine.
template <class Value>
std::string base64_of(const std::vector<Value>& values) {
  using Bits = std::conditional_t<sizeof(Value) == 4, std::uint32_t, std::uint16_t>;
  static_assert(sizeof(Bits) == sizeof(Value));
  std::string bytes;
  bytes.reserve(values.size() * sizeof(Value));
  for (const Value value : values) {
    Bits bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (std::size_t i = 0; i < sizeof(Value); ++i) {
      bytes += static_cast<char>(static_cast<unsigned char>(std::uint32_t{bits} >> (8 * i)));
    }
  }
  return base64(std::move(bytes));
}

/// `get(row)` is an array of `width` values: all rows of it, one after the other.
template <class Value, class Rows, class Get>
std::string column(const Rows& rows, std::size_t width, const Get& get) {
  std::vector<Value> values;
  values.reserve(rows.size() * width);
  for (const auto& row : rows) values.insert(values.end(), get(row), get(row) + width);
  return base64_of(values);
}

/// Numbers as JSON wants them, with all the digits that a float has.
std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

bool WatchPage::available(const std::string& bundle) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(bundle, ignored);
}

void WatchPage::require_available(const std::string& path, const std::string& bundle) {
  if (!available(bundle)) throw pinnquad::OutputError(path, unavailable);
}

WatchPage::WatchPage(std::string title, const pinnquad::Airframe<double>& airframe, double ground_z_m,
                     std::string bundle)
    : title_(std::move(title)), airframe_(airframe), ground_z_m_(ground_z_m), bundle_(std::move(bundle)) {}

void WatchPage::add(const pinnquad::VehicleState<double>& vehicle, const pinnquad::Commands<double>& commands) {
  Row row;
  row.time_s = static_cast<float>(vehicle.time_s);
  row.finite = pinnquad::is_finite(row.time_s) && all_finite(vehicle.body) && pinnquad::all_finite(commands);
  const pinnquad::Quaternion<double>& q = vehicle.body.attitude;
  const double attitude[4] = {q.w, q.x, q.y, q.z};
  for (int i = 0; i < 3; ++i) {
    row.position_m[i] = static_cast<float>(vehicle.body.position_m[i]);
    row.velocity_m_s[i] = static_cast<float>(vehicle.body.velocity_m_s[i]);
  }
  for (std::size_t i = 0; i < 4 && row.finite; ++i) {  // a NaN has no integer
    row.attitude[i] = static_cast<std::int16_t>(std::lround(std::clamp(attitude[i], -1.0, 1.0) * 32767));
    row.commands[i] = static_cast<std::uint16_t>(std::lround(std::clamp(commands[i], 0.0, 1.0) * 65535));
  }
  rows_.push_back(row);
}

void WatchPage::write(const std::string& path) const {
  check_rows(path);
  const nlohmann::json bundle = read_bundle(bundle_);
  if (bundle.is_null()) throw pinnquad::OutputError(path, unavailable);
  const auto part = [&bundle](const char* name) { return bundle[name].get<std::string>(); };
  pinnquad::AtomicFile page(path);
  page.stream() << whole_page(title_, part("style"),
                              part("body") + "\n<script type=\"application/json\" id=\"flight\">" + json() +
                                  "</script>\n<script>" + part("script") + "</script>");
  page.commit();
}

void WatchPage::check_rows(const std::string& path) const {
  if (rows_.empty()) throw pinnquad::OutputError(path, "the flight has no rows");
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::string which = "row " + std::to_string(i + 1) + " of the flight ";
    if (!rows_[i].finite) throw pinnquad::OutputError(path, which + "is not finite");
    if (i > 0 && rows_[i].time_s <= rows_[i - 1].time_s) {
      throw pinnquad::OutputError(path, which + "is not later than the row before");
    }
  }
}

/// Only numbers and base64: nothing in it can end the element that holds it.
std::string WatchPage::json() const {
  float fastest = 0;
  for (const Row& row : rows_) {
    for (const float v : row.velocity_m_s) fastest = std::fmax(fastest, std::fabs(v));
  }
  const double unit_m_s = fastest > 0 ? static_cast<double>(fastest) / 32767 : 1;
  std::vector<std::int16_t> velocity;
  velocity.reserve(3 * rows_.size());
  for (const Row& row : rows_) {
    for (const float v : row.velocity_m_s) {
      velocity.push_back(static_cast<std::int16_t>(std::lround(static_cast<double>(v) / unit_m_s)));
    }
  }
  std::string rotors;
  for (const pinnquad::RotorMount<double>& rotor : airframe_.rotors) {
    rotors += (rotors.empty() ? "" : ",");
    rotors += "{\"x_m\":" + digits(rotor.x_m) + ",\"y_m\":" + digits(rotor.y_m) +
              ",\"spin\":" + std::to_string(static_cast<int>(rotor.spin)) + "}";
  }
  return "{\"rotors\":[" + rotors + "],\"propeller_diameter_m\":" + digits(airframe_.propeller_diameter_m) +
         ",\"ground_z_m\":" + digits(ground_z_m_) + ",\"velocity_unit_m_s\":" + digits(unit_m_s) + ",\"time_s\":\"" +
         column<float>(rows_, 1, [](const Row& row) { return &row.time_s; }) + "\",\"position_m\":\"" +
         column<float>(rows_, 3, [](const Row& row) { return row.position_m; }) + "\",\"velocity\":\"" +
         base64_of(velocity) + "\",\"attitude\":\"" +
         column<std::int16_t>(rows_, 4, [](const Row& row) { return row.attitude; }) + "\",\"commands\":\"" +
         column<std::uint16_t>(rows_, 4, [](const Row& row) { return row.commands; }) + "\"}";
}

}  // namespace programs
