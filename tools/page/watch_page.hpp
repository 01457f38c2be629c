// SPDX-License-Identifier: MIT
// A flight as one HTML page to watch it in 3D, offline. What it is besides a flight is bundled when the program is
// built; this class puts a flight into it. See docs/watch.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "page/page.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace programs {

/// Collects the rows of a flight and writes the page.
///
///   WatchPage page("paper_quadrotor, seed 1", airframe, site.ground_z_m);
///   page.require_available(path);                           // before minutes are spent on the flight
///   page.add(vehicle, commands);                            // each row
///   page.write(path);
///
/// A row takes 51 bytes of the page: time, position (float), velocity (16 bit of the fastest component, below 1 mm/s in
/// flights up to 32 m/s), quaternion (16 bit, 0.003 deg), commands (16 bit). A screen needs no more.
class WatchPage {
 public:
  static bool available(const std::string& bundle = bundle_path("watch"));

  /// Throws OutputError, one line that says what is missing, when write(path) could not work for lack of the bundle.
  static void require_available(const std::string& path, const std::string& bundle = bundle_path("watch"));

  /// `title` is any text, e.g. airframe and seed. Ground level as in Site::ground_z_m, NED.
  WatchPage(std::string title, const pinnquad::Airframe<double>& airframe, double ground_z_m,
            std::string bundle = bundle_path("watch"));

  /// One row. Commands are those in force up to this instant; shown clipped, as the rotors clip them.
  void add(const pinnquad::VehicleState<double>& vehicle, const pinnquad::Commands<double>& commands);

  /// Writes the page, whole or not at all. Throws OutputError: no rows, a row that is not finite or not later than the
  /// one before, no bundle, or what AtomicFile throws.
  void write(const std::string& path) const;

 private:
  struct Row {
    float time_s{0};
    float position_m[3]{};
    float velocity_m_s[3]{};
    std::int16_t attitude[4]{};
    std::uint16_t commands[4]{};
    bool finite{true};
  };

  void check_rows(const std::string& path) const;
  std::string json() const;

  std::string title_;
  pinnquad::Airframe<double> airframe_;
  double ground_z_m_;
  std::string bundle_;
  std::vector<Row> rows_;
};

}  // namespace programs
