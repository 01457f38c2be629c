// SPDX-License-Identifier: MIT
// A battery that the rotors empty: its voltage falls with its charge and under load, and with it all thrust.
#pragma once

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// A lithium-polymer pack of `cells` in series. With z the share of its charge that is left, 0 to 1, one cell at rest
/// has
///   E(z) = 3.685 - 1.031 exp(-35 z) + 0.2156 z - 0.1178 z^2 + 0.3201 z^3   V
/// (Chen and Rincon-Mora, Accurate electrical battery model capable of predicting runtime and I-V performance, IEEE
/// Trans. Energy Conversion 21(2), 2006; 4.103 V full, 2.654 V empty), and under load U = cells (E - R I), with
/// U I = P / efficiency. P is the rotors' shaft power at their present speeds, C_P rho n^3 D^5 each. At one command a
/// motor's speed goes with the voltage, and thrust and torque with the speed's square: the thrust scale is
/// (U / U_full)^2, U_full = cells E(1), at which the airframe's thrust is as it says. A controller of speed would not
/// sag. With v = U / U_full and x = rho / rho_0 times the mean of s_i^1.5 over the thrust fractions, P goes with x v^3:
/// v solves v = E / E(1) - r x v^2, which has one solution above 0, in closed form.
/// The load is that of the rotors at the start of a step; the density is what effects before this one made it. Left
/// out: the minutes in which a pack recovers, temperature, the power of electronics.
/// The resistance of a cell is 0.02 ohm over its capacity in ampere-hours (the small cell of that paper: 0.063). That,
/// three cells of 2.2 Ah, and the efficiency of motors and speed controllers are ours.
struct Battery {
  static constexpr bool is_battery = true;

  double cells{3};
  double capacity_Ah{2.2};
  double start_charge{1};               ///< z at the start of the flight
  double cell_resistance_ohm_Ah{0.02};  ///< R of a cell times its capacity
  double efficiency{0.75};              ///< shaft power of the rotors over the battery's
  double rated_V{0};                    ///< in place of U_full, of an airframe that was measured at it; 0: cells E(1)

  static constexpr double full_cell_V = 3.685 + 0.2156 - 0.1178 + 0.3201;  ///< but for exp(-35)

  /// Voltage at rest, V, by the share of the charge that is left, held in 0 to 1.
  template <class Scalar>
  static PINNQUAD_ALWAYS_INLINE Scalar cell_at_rest_V(const Scalar& charge) noexcept {
    const Scalar z = clip_command(charge);
    return Scalar(3.685) - Scalar(1.031) * detail::exponential(Scalar(-35) * z) +
           z * (Scalar(0.2156) + z * (Scalar(-0.1178) + z * Scalar(0.3201)));
  }

  /// With the rotors of an airframe.
  template <class Scalar>
  struct Pack {
    Scalar start_charge{}, inverse_charge_1_C{};
    Scalar cells{}, rated_V{};
    Scalar full_current_A{};  ///< at the rated voltage and density, all rotors at full thrust
    Scalar resistance{};      ///< voltage that this current takes, over the rated one

    /// `Same` is `Scalar`: the contract's functions are templates.
    template <class Same>
    PINNQUAD_ALWAYS_INLINE void surroundings(Surroundings<Same>& air) const noexcept {
      Scalar load(0);
      for (const Scalar& fraction : air.battery.load) {
        const Scalar s = clip_command(fraction);
        load += s * detail::square_root(s);
      }
      load *= air.air_density_kg_m3 * (Scalar(0.25) / standard_air_density_kg_m3<Scalar>);
      const Scalar rest =
          cells * cell_at_rest_V(Scalar(start_charge - air.battery.charge_used_C * inverse_charge_1_C)) / rated_V;
      const Scalar bend = Scalar(1) + Scalar(4) * resistance * load * rest;
      const Scalar v = Scalar(2) * rest / (Scalar(1) + detail::square_root(bend));
      air.battery.voltage_V = v * rated_V;
      air.battery.current_A = full_current_A * load * (v * v);
      air.thrust_scale *= v * v;
    }
  };

  template <class Scalar>
  Pack<Scalar> bound(const Airframe<Scalar>& airframe) const noexcept {
    const double rated = rated_V > 0 ? rated_V : cells * full_cell_V;
    Scalar rotors(0);
    for (const RotorMount<Scalar>& rotor : airframe.rotors) rotors += rotor.thrust_scale;
    const Scalar power_W = rotors * airframe.max_rotor_torque_N_m() * (Scalar(2 * pi) * airframe.max_rotor_speed_rev_s);
    const Scalar current_A = power_W * Scalar(1 / (efficiency * rated));
    return {Scalar(start_charge),
            Scalar(1 / (3600 * capacity_Ah)),
            Scalar(cells),
            Scalar(rated),
            current_A,
            current_A * Scalar(cells * cell_resistance_ohm_Ah / capacity_Ah / rated)};
  }

  /// `out_of_range` for cells, a capacity or an efficiency that aren't positive, an efficiency or a charge above 1, a
  /// charge, a resistance or a rated voltage below 0.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    const bool holds = detail::plausible(cells) && detail::plausible(capacity_Ah) &&
                       detail::plausible_or_zero(cell_resistance_ohm_Ah) && detail::plausible(efficiency) &&
                       efficiency <= 1 && start_charge >= 0 && start_charge <= 1 && detail::plausible_or_zero(rated_V);
    return holds ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
