// SPDX-License-Identifier: MIT
#include "logs/rebuilt_commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/dynamics/rotor.hpp"

namespace pinnquad::logs {
namespace {

/// Thrust shares of a symmetric X quadrotor from what its controller asked for, torque normalised to -1..1 and thrust
/// to 0..1:
///   u = T -+ r x +- r y +- z, r = sqrt(1/2), as PX4's allocation makes them while no motor is at its limit.
/// NaN where one would be beyond: its desaturation is not known then.
std::array<double, 4> rebuilt_commands(const std::array<double, 3>& torque, double thrust) {
  const double r = std::sqrt(0.5), x = r * torque[0], y = r * torque[1], z = torque[2];
  const std::array<double, 4> u = {thrust - x + y + z, thrust + x - y + z, thrust + x + y - z, thrust - x - y - z};
  for (const double one : u) {
    if (one >= 0 && one <= 1) continue;
    const double none = std::nan("");
    return {none, none, none, none};
  }
  return u;
}

/// Thrust shares of an airframe's rotors that make the torque [N m] and the thrust [N] in still air of the rated
/// density. NaN where one would be beyond 0..1.
std::array<double, 4> wrench_commands(const AllocationMatrix<double>& inverse, const std::array<double, 3>& torque_N_m,
                                      double thrust_N) {
  constexpr double rounding = 1e-9;
  std::array<double, 4> u = product(inverse, {thrust_N, torque_N_m[0], torque_N_m[1], torque_N_m[2]});
  for (double& one : u) {
    if (!(one >= -rounding && one <= 1 + rounding)) return {std::nan(""), std::nan(""), std::nan(""), std::nan("")};
    one = std::clamp(one, 0.0, 1.0);
  }
  return u;
}

}  // namespace

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::isfinite(value) ? std::max(most, std::abs(value)) : most;
  return most;
}

double largest_torque(const std::vector<std::vector<double>>& values) {
  return std::max({largest(values[0]), largest(values[1]), largest(values[2])});
}

bool are_no_shares(const std::vector<std::vector<double>>& values) {
  constexpr double least_torque = 0.0015, least_thrust = 0.05, most_thrust = 1.05;
  constexpr std::size_t fewest_rows = 64;
  const std::vector<double>& thrust = values[3];
  const auto above =
      std::count_if(thrust.begin(), thrust.end(), [](double value) { return std::abs(value) > most_thrust; });
  if (thrust.size() < fewest_rows) return false;
  return (largest_torque(values) < least_torque && largest(thrust) > least_thrust) ||
         2 * static_cast<std::size_t>(above) > thrust.size();
}

void rebuild_commands(const Source& source, const std::optional<NamedAirframe>& airframe,
                      std::vector<std::vector<double>>& values) {
  AllocationMatrix<double> inverse{};
  if (source.wrench && invert_allocation(allocation(airframe->value), inverse) != Status::ok) {
    throw std::invalid_argument("airframe " + airframe->name + ": its rotors cannot make every torque and thrust");
  }
  for (std::size_t row = 0; row < values[0].size(); ++row) {
    const double thrust = source.thrust_is_up ? values[3][row] : -values[3][row];
    const std::array<double, 3> torque = {values[0][row], values[1][row], values[2][row]};
    const std::array<double, 4> u =
        source.wrench ? wrench_commands(inverse, torque, thrust) : rebuilt_commands(torque, thrust);
    for (std::size_t place = 0; place < u.size(); ++place) {
      values[place][row] = command_of_fraction(airframe ? airframe->value.rotors[place].thrust_curve : 0.0, u[place]);
    }
  }
}

}  // namespace pinnquad::logs
