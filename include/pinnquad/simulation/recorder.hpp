// SPDX-License-Identifier: MIT
// What a recorded row holds: the motion of one instant, by the dynamics themselves (NOTES #14), and the commands that
// were in force when it happened.
#pragma once

#include "pinnquad/data/sample.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

/// The vehicle's row at its present time. Accelerations come from the dynamics with the rotors as they turn now, behind
/// their lag, not from differences. `commands` is what was held up to this instant, clipped as the rotors clip it: the
/// command, not the lag-filtered thrust, because that is what a flight log has and what the paper's network is to give.
/// Behind a 5 ms lag the rotors differ from it by about 5 ms times its rate of change, some 1e-2 in agile flight:
/// motion and command determine each other that well and no better. Altitude is above ground.
template <class... Effects>
Sample record(const Quadrotor<double, Effects...>& quadrotor, const VehicleState<double>& vehicle,
              const Commands<double>& commands) {
  const State<double>& body = vehicle.body;
  const Accelerations<double> motion = quadrotor.evaluate(body, vehicle.rotors, vehicle.time_s).motion;
  const EulerAngles<double> euler = to_euler(body.attitude);
  Sample sample;
  sample.time_s = vehicle.time_s;
  sample.linear_acceleration_m_s2 = motion.linear_m_s2;
  sample.angular_acceleration_rad_s2 = motion.angular_rad_s2;
  sample.velocity_m_s = body_velocity(body);
  sample.body_rates_rad_s = body.body_rates_rad_s;
  sample.roll_rad = euler.roll_rad;
  sample.pitch_rad = euler.pitch_rad;
  sample.yaw_rad = euler.yaw_rad;
  sample.altitude_m = quadrotor.site().ground_z_m - body.position_m[2];
  for (std::size_t i = 0; i < commands.size(); ++i) sample.commands[i] = clip_command(commands[i]);
  return sample;
}

}  // namespace pinnquad
