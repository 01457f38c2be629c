// SPDX-License-Identifier: MIT
// The faults of a flight, their times, and the worst reaction that the module may have.
#pragma once

#include <array>
#include <vector>

#include "pinnquad/control/autopilot/inputs.hpp"

namespace pinnquad::autopilot::test {

enum class FaultKind {
  rates_stop,
  attitude_stops,
  local_stops,
  set_point_stops,
  set_point_jumps,  ///< to the north, by `value` m
  nan_everywhere,
  infinite_rates,
  denormal_motion,   ///< body rates and velocity
  attitude_scaled,   ///< by `value`
  stamps_ahead,      ///< all, by `value` seconds
  commands_lost,     ///< the motors keep what they were told last
  model_swapped,     ///< for another sound one
  model_corrupt,     ///< offered, with a flipped bit
  model_wrong,       ///< offered, with a weight that is wrong under a right hash and checksum
  model_too_narrow,  ///< a sound one whose envelope holds hardly any motion: all is the analytic inverse's
  model_low,         ///< a sound one whose commands are all too low
  payload,           ///< the vehicle weighs `value` times what it did
  bent_rotor,        ///< rotor 1 makes `value` of its thrust
  rotor_flutters,    ///< the same, for 0.2 s of every 0.4 s
  weak_battery,      ///< all rotors make `value` of their thrust
  wind,              ///< to the north, `value` m/s
  velocity_nan,
  velocity_frozen,  ///< it and the position repeat themselves under new time stamps
  local_late,       ///< time stamps of position and velocity `value` seconds old
  flown_by_hand,    ///< the pilot has it, or it is disarmed: nothing is asked of the module
};

struct Fault {
  double start_s;
  double duration_s;
  FaultKind kind;
  double value;
  const char* text;
  Reaction worst;  ///< exactly this is the worst reaction while it lasts
};

/// The same for every flight; limits are those of CoreSettings{}.
inline constexpr std::array<Fault, 19> fault_script = {{
    {4.0, 0.008, FaultKind::rates_stop, 0, "body rates stop for 8 ms", Reaction::flies},
    {5.0, 0.015, FaultKind::attitude_stops, 0, "attitude stops for 15 ms", Reaction::flies},
    {6.0, 0.080, FaultKind::local_stops, 0, "position and velocity stop for 80 ms", Reaction::flies},
    {8.0, 0.600, FaultKind::local_stops, 0, "position and velocity stop for 600 ms", Reaction::levels},
    {11.0, 1.500, FaultKind::set_point_stops, 0, "set points stop for 1.5 s", Reaction::holds_position},
    {15.0, 0.030, FaultKind::rates_stop, 0, "body rates stop for 30 ms", Reaction::keeps_commands},
    {16.0, 0.030, FaultKind::nan_everywhere, 0, "NaN in all samples for 30 ms", Reaction::keeps_commands},
    {17.0, 0.006, FaultKind::infinite_rates, 0, "infinite body rates for 6 ms", Reaction::flies},
    {18.0, 0.010, FaultKind::denormal_motion, 0, "denormal body rates and velocity for 10 ms", Reaction::flies},
    {19.0, 0.500, FaultKind::attitude_scaled, 1.0004, "attitude of norm 1.0004 for 500 ms", Reaction::flies},
    {20.0, 0.040, FaultKind::attitude_scaled, 1.2, "attitude of norm 1.2 for 40 ms", Reaction::keeps_commands},
    {21.0, 0.030, FaultKind::stamps_ahead, 1.0, "time stamps 1 s ahead for 30 ms", Reaction::keeps_commands},
    {22.0, 0.030, FaultKind::commands_lost, 0, "commands don't reach the motors for 30 ms", Reaction::flies},
    {23.0, 0.500, FaultKind::model_swapped, 0, "another model", Reaction::flies},
    {23.6, 0.100, FaultKind::model_corrupt, 0, "a corrupt model offered", Reaction::flies},
    {23.8, 0.100, FaultKind::model_wrong, 0, "a model with a wrong weight offered", Reaction::flies},
    {24.5, 1.500, FaultKind::model_too_narrow, 0, "a model that declines nearly everything", Reaction::flies},
    {27.0, 0.030, FaultKind::attitude_stops, 0, "attitude stops for 30 ms", Reaction::keeps_commands},
    {28.0, 0.300, FaultKind::attitude_stops, 0, "attitude stops for 300 ms", Reaction::gives_up},
}};

/// By the analytic inverse: a motor makes 85 % of its thrust; every 1.4 s the set points jump by 2 m for 0.7 s and fall
/// silent for 0.4 s.
inline std::vector<Fault> jumps_with_a_weak_motor() {
  std::vector<Fault> faults = {{4, 100, FaultKind::bent_rotor, 0.85, "a weak motor", Reaction::flies},
                               {0.5, 100, FaultKind::model_too_narrow, 0, "no network", Reaction::flies}};
  for (int i = 0; i < 8; ++i) {
    const double at_s = 5 + 1.4 * i;
    faults.push_back({at_s, 0.7, FaultKind::set_point_jumps, 2, "a jump", Reaction::flies});
    faults.push_back({at_s, 0.4, FaultKind::set_point_stops, 0, "silence", Reaction::flies});
  }
  return faults;
}

}  // namespace pinnquad::autopilot::test
