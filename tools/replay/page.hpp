// SPDX-License-Identifier: MIT
// A flight as one HTML page that replays it in 3D, offline. The page without a flight is made by the target
// replay_bundle (tools/replay); this class puts a flight into it. See docs/replay.md.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "pictures/html_text.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

#ifndef PINNQUAD_REPLAY_PAGE
#error "replay/page.hpp: link the CMake target pinnquad_replay, which says where the page without a flight is built"
#endif

namespace programs {

namespace detail {

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

}  // namespace detail

/// Collects the rows of a flight and writes the page.
///
///   ReplayPage::require_available(path);                    // before minutes are spent on the flight
///   ReplayPage page("paper_quadrotor, seed 1", airframe, site.ground_z_m);
///   page.add(vehicle, commands);                            // each row
///   page.write(path);
///
/// A row takes 51 bytes of the page: time, position (float), velocity (16 bit of the fastest component, below 1 mm/s in
/// flights up to 32 m/s), quaternion (16 bit, 0.003 deg), commands (16 bit). A screen needs no more.
class ReplayPage {
 public:
  /// Where the page without a flight is: where the build puts it, or beside the program where that was installed.
  static std::string built_page() {
    std::error_code ignored;
    const std::filesystem::path built = PINNQUAD_REPLAY_PAGE;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::filesystem::path installed = program.parent_path().parent_path() / "share/pinnquad/replay.html";
    const bool use_installed =
        !std::filesystem::is_regular_file(built, ignored) && std::filesystem::is_regular_file(installed, ignored);
    return (use_installed ? installed : built).string();
  }

  static bool available() {
    std::error_code ignored;
    return std::filesystem::is_regular_file(built_page(), ignored);
  }

  /// Throws OutputError, one line that says what is missing, when write(path) could not work for lack of the bundle.
  static void require_available(const std::string& path) {
    if (!available()) throw pinnquad::OutputError(path, unavailable());
  }

  /// `title` is any text, e.g. airframe and seed. Ground level as in Site::ground_z_m, NED.
  ReplayPage(std::string title, const pinnquad::Airframe<double>& airframe, double ground_z_m)
      : title_(std::move(title)), airframe_(airframe), ground_z_m_(ground_z_m) {}

  /// One row. Commands are those in force up to this instant; shown clipped, as the rotors clip them.
  void add(const pinnquad::VehicleState<double>& vehicle, const pinnquad::Commands<double>& commands) {
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
      row.attitude[i] = static_cast<std::int16_t>(std::lround(within(-1, attitude[i], 1) * 32767));
      row.commands[i] = static_cast<std::uint16_t>(std::lround(within(0, commands[i], 1) * 65535));
    }
    rows_.push_back(row);
  }

  std::size_t rows() const noexcept { return rows_.size(); }

  /// Writes the page, whole or not at all. Throws OutputError: no rows, a row that is not finite or not later than the
  /// one before, no bundle, or what AtomicFile throws.
  void write(const std::string& path) const {
    check_rows(path);
    const std::string page = read_page(path);
    const std::size_t title = marker(path, page, title_marker);
    const std::size_t flight = marker(path, page, flight_marker);
    if (flight < title) throw pinnquad::OutputError(path, unavailable());
    const std::size_t after_title = title + std::strlen(title_marker);
    const std::size_t after_flight = flight + std::strlen(flight_marker);
    pinnquad::AtomicFile file(path);
    file.stream() << page.substr(0, title) << html_text(title_) << page.substr(after_title, flight - after_title)
                  << json() << page.substr(after_flight);
    file.commit();
  }

 private:
  struct Row {
    float time_s{0};
    float position_m[3]{};
    float velocity_m_s[3]{};
    std::int16_t attitude[4]{};
    std::uint16_t commands[4]{};
    bool finite{true};
  };

  static constexpr const char* title_marker = "@PINNQUAD_TITLE@";
  static constexpr const char* flight_marker = "@PINNQUAD_FLIGHT@";

  static const char* unavailable() {
    return "the replay page is not built; build the target replay_bundle (it needs Node.js, npm and the network)";
  }

  static double within(double low, double value, double high) {
    return value < low ? low : (value > high ? high : value);
  }

  void check_rows(const std::string& path) const {
    if (rows_.empty()) throw pinnquad::OutputError(path, "the flight has no rows");
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::string which = "row " + std::to_string(i + 1) + " of the flight ";
      if (!rows_[i].finite) throw pinnquad::OutputError(path, which + "is not finite");
      if (i > 0 && rows_[i].time_s <= rows_[i - 1].time_s) {
        throw pinnquad::OutputError(path, which + "is not later than the row before");
      }
    }
  }

  static std::string read_page(const std::string& path) {
    std::ifstream file(built_page(), std::ios::binary);
    if (!file) throw pinnquad::OutputError(path, unavailable());
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }

  static std::size_t marker(const std::string& path, const std::string& page, const char* text) {
    const std::size_t place = page.find(text);
    if (place == std::string::npos) throw pinnquad::OutputError(path, unavailable());
    return place;
  }

  /// `get(row)` is an array of `width` values: all rows of it, one after the other.
  template <class Value, class Get>
  std::string column(std::size_t width, const Get& get) const {
    std::vector<Value> values;
    values.reserve(rows_.size() * width);
    for (const Row& row : rows_) values.insert(values.end(), get(row), get(row) + width);
    return detail::base64_of(values);
  }

  /// Numbers as JSON wants them, with all the digits that a float has.
  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
  }

  /// Only numbers and base64: nothing in it can end the element that holds it.
  std::string json() const {
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
      rotors += "{\"x_m\":" + number(rotor.x_m) + ",\"y_m\":" + number(rotor.y_m) +
                ",\"spin\":" + std::to_string(static_cast<int>(rotor.spin)) + "}";
    }
    return "{\"rotors\":[" + rotors + "],\"propeller_diameter_m\":" + number(airframe_.propeller_diameter_m) +
           ",\"ground_z_m\":" + number(ground_z_m_) + ",\"velocity_unit_m_s\":" + number(unit_m_s) + ",\"time_s\":\"" +
           column<float>(1, [](const Row& row) { return &row.time_s; }) + "\",\"position_m\":\"" +
           column<float>(3, [](const Row& row) { return row.position_m; }) + "\",\"velocity\":\"" +
           detail::base64_of(velocity) + "\",\"attitude\":\"" +
           column<std::int16_t>(4, [](const Row& row) { return row.attitude; }) + "\",\"commands\":\"" +
           column<std::uint16_t>(4, [](const Row& row) { return row.commands; }) + "\"}";
  }

  std::string title_;
  pinnquad::Airframe<double> airframe_;
  double ground_z_m_;
  std::vector<Row> rows_;
};

}  // namespace programs
