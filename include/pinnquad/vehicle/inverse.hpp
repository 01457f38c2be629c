// SPDX-License-Identifier: MIT
// The analytic inverse: motion -> wrench -> commands, through the same effects that fly.
#pragma once

#include "pinnquad/vehicle/quadrotor.hpp"

namespace pinnquad {

namespace detail {

/// The four components that rotors command: -F_z, tau_x, tau_y, tau_z, body.
template <class Scalar>
std::array<Scalar, 4> commanded_part(const Wrench<Scalar>& w) noexcept {
  return {-w.force_N[2], w.torque_N_m[0], w.torque_N_m[1], w.torque_N_m[2]};
}

template <class Scalar>
Scalar largest_magnitude(const ThrustFractions<Scalar>& values) noexcept {
  Scalar largest(0);
  for (const Scalar value : values) {
    const Scalar magnitude = value < Scalar(0) ? -value : value;
    if (!(magnitude <= largest)) largest = magnitude;
    if (!is_finite(largest)) return largest;  // NaN would lose the next comparison
  }
  return largest;
}

/// The rounding of one evaluation in commands: that of some thousand operations, as torque is a small difference.
template <class Scalar>
inline constexpr Scalar settled = Scalar(5000) * std::numeric_limits<Scalar>::epsilon();

/// So close that no other branch need be looked at.
template <class Scalar>
inline constexpr Scalar certainly_met = Scalar(64) * std::numeric_limits<Scalar>::epsilon();

/// The wrench of rotors and effects from thrust fractions on one branch, and the fractions of a given wrench.
template <class Scalar, class... Effects>
class RotorEquation {
 public:
  RotorEquation(const Quadrotor<Scalar, Effects...>& quadrotor, const State<Scalar>& state,
                const Surroundings<Scalar>& air) noexcept
      : quadrotor_(quadrotor), state_(state), air_(air), scale_(quadrotor.rotor_scale(air)) {}

  /// A solution on one branch, and by how much it misses the true equation, each effect on the branch where it lies.
  struct Solution {
    Status status{Status::no_solution};
    ThrustFractions<Scalar> thrusts{};
    Scalar mismatch{0};  ///< in thrust fractions
    Scalar size{1};      ///< 1 + largest fraction, by which mismatch is to be judged
  };

  Solution solve(ThrustBranch branch, const std::array<Scalar, 4>& wanted) const noexcept {
    Solution solution;
    const auto made = [&](const ThrustFractions<Scalar>& s) noexcept {
      return total(s, quadrotor_.aerodynamic_wrench_on(branch, state_, air_, s));
    };
    AllocationMatrix<Scalar> matrix{}, inverse{};
    const std::array<Scalar, 4> at_rest = made({});
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      ThrustFractions<Scalar> unit{};
      unit[rotor] = Scalar(1);
      const std::array<Scalar, 4> column = made(unit);
      for (std::size_t row = 0; row < 4; ++row) matrix[row][rotor] = column[row] - at_rest[row];
    }
    if (invert_allocation(matrix, inverse) != Status::ok) return solution;

    constexpr int rounds = 40;  // an affine equation takes one, the next one confirms it
    ThrustFractions<Scalar>& s = solution.thrusts;
    for (int round = 0; round < rounds && solution.status != Status::ok; ++round) {
      const ThrustFractions<Scalar> change = product(inverse, difference(wanted, made(s)));
      for (std::size_t i = 0; i < rotor_count; ++i) s[i] += change[i];
      solution.size = Scalar(1) + largest_magnitude(s);
      if (largest_magnitude(change) <= settled<Scalar> * solution.size) solution.status = Status::ok;
    }
    const std::array<Scalar, 4> truly = total(s, quadrotor_.aerodynamic_wrench(state_, air_, s));
    solution.mismatch = largest_magnitude(product(inverse, difference(wanted, truly)));
    return solution;
  }

 private:
  std::array<Scalar, 4> total(const ThrustFractions<Scalar>& s, const Wrench<Scalar>& effects) const noexcept {
    return commanded_part(quadrotor_.rotors().wrench_of(s, scale_) + effects);
  }
  static std::array<Scalar, 4> difference(const std::array<Scalar, 4>& a, const std::array<Scalar, 4>& b) noexcept {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
  }

  const Quadrotor<Scalar, Effects...>& quadrotor_;
  const State<Scalar>& state_;
  const Surroundings<Scalar>& air_;
  Scalar scale_;
};

}  // namespace detail

/// Commands (not clipped) with rotors(u) + effects(u) = required in thrust and torque.
/// It is solved in thrust fractions s and turned into commands by the rotors' curves.
/// Without effects that use the rotors' wrench: s = A^-1 (required - effects). With them the equation is affine in s on
/// each ThrustBranch: its matrix is read off at s = 0 and at the four unit fractions and inverted, so that one round is
/// exact. Ground effect by |F_z|: with k = (r - 1) |R_zz|, more thrust always lifts more while k < 1 and there is one
/// solution. Beyond (an effect of one's own with a ratio above 2) a wanted force has two solutions, of which the upper
/// branch's, with the greater thrust, is returned, or none (`no_solution`).
/// An effect that is only nearly affine is iterated, at most 40 rounds; `no_solution` if they don't settle. The air's
/// own status, `out_of_range` where there is none (density 0 or less) or no power (thrust scale 0 or less). `commands`
/// is untouched unless ok.
template <class Scalar, class... Effects>
Status commands_for_wrench(const Quadrotor<Scalar, Effects...>& quadrotor, const State<Scalar>& state,
                           const Surroundings<Scalar>& air, const Wrench<Scalar>& required,
                           Commands<Scalar>& commands) noexcept {
  if (air.status != Status::ok) return air.status;
  if (!(air.air_density_kg_m3 > Scalar(0) && air.thrust_scale > Scalar(0))) return Status::out_of_range;
  if constexpr ((uses_rotor_wrench<Effects> || ...)) {
    if (quadrotor.has_rotor_effect()) {
      const detail::RotorEquation<Scalar, Effects...> equation(quadrotor, state, air);
      const std::array<Scalar, 4> wanted = detail::commanded_part(required);
      auto best = equation.solve(ThrustBranch::upper, wanted);
      // where the branches meet, rounding may call both right: the better one is
      const bool met = best.status == Status::ok && best.mismatch <= detail::certainly_met<Scalar> * best.size;
      if (!met && quadrotor.has_branched_effect()) {
        const auto lower = equation.solve(ThrustBranch::lower, wanted);
        const bool better = best.status != Status::ok || lower.mismatch < best.mismatch;
        if (lower.status == Status::ok && better) best = lower;
      }
      if (best.status != Status::ok) return best.status;
      if (!(best.mismatch <= detail::settled<Scalar> * best.size)) return Status::no_solution;
      commands = quadrotor.rotors().commands_of(best.thrusts);
      return Status::ok;
    }
  }
  const Wrench<Scalar> effects = quadrotor.aerodynamic_wrench(state, air, {});
  commands = quadrotor.rotors().commands(required - effects, quadrotor.rotor_scale(air));
  return Status::ok;
}

namespace detail {
template <class Scalar, class... Effects>
Status inverse_commands(const Quadrotor<Scalar, Effects...>& quadrotor, const State<Scalar>& state,
                        const Accelerations<Scalar>& motion, const Surroundings<Scalar>& air,
                        Commands<Scalar>& commands) noexcept {
  if (quadrotor.status() != Status::ok) return quadrotor.status();
  if (!(all_finite(state) && all_finite(motion.linear_m_s2) && all_finite(motion.angular_rad_s2) &&
        is_finite(air.time_s))) {
    return Status::not_finite;
  }
  if (!is_unit(state.attitude)) return Status::not_unit_quaternion;
  const Wrench<Scalar> required = required_wrench(quadrotor.airframe(), state, motion, quadrotor.site().gravity_m_s2);
  Commands<Scalar> result{};
  const Status status = commands_for_wrench(quadrotor, state, air, required, result);
  if (status != Status::ok) return status;
  if (!all_finite(result)) return Status::output_not_finite;
  commands = result;
  return Status::ok;
}
}  // namespace detail

/// Commands (not clipped) that make the motion in this state at this time.
/// The wrench of Eq. (1) less the aerodynamic one, through the inverted Eq. (2); where an effect depends on the rotors
/// (ground effect), both are solved together (commands_for_wrench()). The rotors can't make lateral force: what the
/// motion demands of it is ignored. Where two solutions exist, the one with the greater thrust; `no_solution` where
/// none. `not_finite` for NaN or Inf in state or motion, `not_unit_quaternion`, `out_of_range` where the air has no
/// answer (Surroundings), and what Quadrotor::status() says; the commands are untouched unless the Status is ok.
template <class Scalar, class... Effects>
Status inverse_commands(const Quadrotor<Scalar, Effects...>& quadrotor, const State<Scalar>& state,
                        const Accelerations<Scalar>& motion, Scalar time_s, Commands<Scalar>& commands) noexcept {
  return detail::inverse_commands(quadrotor, state, motion, quadrotor.surroundings(state, time_s), commands);
}

/// The same in the state of a vehicle, at the voltage that its battery has under the rotors as they turn.
template <class Scalar, class... Effects>
Status inverse_commands(const Quadrotor<Scalar, Effects...>& quadrotor, const VehicleState<Scalar>& vehicle,
                        const Accelerations<Scalar>& motion, Commands<Scalar>& commands) noexcept {
  return detail::inverse_commands(quadrotor, vehicle.body, motion, quadrotor.surroundings(vehicle), commands);
}

}  // namespace pinnquad
