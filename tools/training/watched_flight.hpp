// SPDX-License-Identifier: MIT
// A logged flight as a page to watch it in 3D. A dataset has no positions: the path is integrated from the
// velocity.
#pragma once

#include <cstddef>
#include <string>

#include "page/watch_page.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace programs {

/// The page's second 0 on the flight's clock. A clock that counts for days, as since 1970, has no milliseconds in the
/// page's float: there it is the flight's first row.
inline double watched_from_s(const pinnquad::Flight& flight) { return flight[0].time_s > 1e5 ? flight[0].time_s : 0; }

/// Without a velocity the vehicle stays in its place and turns. Times are those of the flight less watched_from_s():
/// page.html#t=12.5 is its second 12.5.
inline void write_watched_flight(const std::string& path, const pinnquad::Flight& flight,
                                 const pinnquad::logs::ImportedDataset& dataset,
                                 const pinnquad::Airframe<double>& airframe) {
  const bool has_altitude = !dataset.lacks("altitude");
  WatchPage page(flight.name + ", path integrated from the velocity", airframe, 0);
  pinnquad::VehicleState<double> vehicle;
  pinnquad::Vector3<double> last_velocity = pinnquad::Vector3<double>::Zero();
  for (std::size_t row = 0; row < flight.size(); ++row) {
    const pinnquad::Sample& sample = flight[row];
    vehicle.time_s = sample.time_s - watched_from_s(flight);
    vehicle.body.attitude =
        pinnquad::from_euler(pinnquad::EulerAngles<double>{sample.roll_rad, sample.pitch_rad, sample.yaw_rad});
    vehicle.body.velocity_m_s = pinnquad::body_to_world(vehicle.body.attitude, sample.velocity_m_s);
    if (row > 0) {
      vehicle.body.position_m +=
          0.5 * (sample.time_s - flight[row - 1].time_s) * (vehicle.body.velocity_m_s + last_velocity);
    }
    if (has_altitude) vehicle.body.position_m[2] = -sample.altitude_m;
    last_velocity = vehicle.body.velocity_m_s;
    page.add(vehicle, sample.commands);
  }
  page.write(path);
}

}  // namespace programs
