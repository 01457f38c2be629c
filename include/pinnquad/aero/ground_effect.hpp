// SPDX-License-Identifier: MIT
// Ground effect: near the ground the rotors lift more. Two models of the thrust ratio r(Z / R), applied as the paper's
// authors do in their simulator.
#pragma once

#include <array>
#include <cmath>

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// Cheeseman and Bennett (1955): r = 1 / (1 - (R / 4Z)^2) for Z/R > 0.25, else 1. Pole at Z/R = 0.25.
struct CheesemanBennett {
  template <class Scalar>
  Scalar thrust_ratio(Scalar height_over_radius, const Airframe<Scalar>&) const noexcept {
    if (height_over_radius <= Scalar(0.25)) return Scalar(1);
    const Scalar q = Scalar(0.25) / height_over_radius;
    return Scalar(1) / (Scalar(1) - q * q);
  }
};

/// Conyers (2019): a ratio of polynomials in Z/R whose coefficients are quadratic in the motor spacing L and the
/// propeller radius R, both in mm; 1 outside 0.25 <= Z/R <= 10.
struct Conyers {
  /// The ratio for one airframe, its coefficients worked out.
  template <class Scalar>
  struct Curve {
    std::array<Scalar, 5> numerator{};    ///< x^4, x^3, ..., 1
    std::array<Scalar, 3> denominator{};  ///< x^2, x, 1, behind x^3

    Scalar thrust_ratio(Scalar x, const Airframe<Scalar>&) const noexcept {
      if (x < Scalar(0.25) || x > Scalar(10)) return Scalar(1);
      const auto& [p1, p2, p3, p4, p5] = numerator;
      const auto& [q1, q2, q3] = denominator;
      const Scalar x2 = x * x;  // two short chains instead of one long one
      return ((p1 * x2 + (p2 * x + p3)) * x2 + (p4 * x + p5)) / ((x + q1) * x2 + (q2 * x + q3));
    }
  };

  template <class Scalar>
  Curve<Scalar> bound(const Airframe<Scalar>& airframe) const noexcept {
    const Scalar dx = airframe.rotors[0].x_m - airframe.rotors[1].x_m;
    const Scalar dy = airframe.rotors[0].y_m - airframe.rotors[1].y_m;
    using std::sqrt;
    const Scalar l = Scalar(1000) * sqrt(dx * dx + dy * dy);  // rotors 1 and 2 are diagonal: L = 690 mm in Table 1
    const Scalar r = Scalar(500) * airframe.propeller_diameter_m;
    const auto quadratic = [l, r](double l2, double l1, double r2, double r1, double one) noexcept {
      return Scalar(l2) * l * l + Scalar(l1) * l + Scalar(r2) * r * r + Scalar(r1) * r + Scalar(one);
    };
    return {{quadratic(-2.794e-7, 3.761e-4, 3.197e-5, -7.5479e-3, 0.3357119),
             quadratic(5.3178e-6, -7.1388e-3, -6.703e-4, 0.1643906, -7.0388236),
             quadratic(-2.2529e-5, 2.19849e-2, 1.04943e-2, -2.6402066, 163.3198037),
             quadratic(3.2426e-5, -2.89233e-2, -1.56903e-2, 3.9426111, -248.2897537),
             quadratic(-1.8056e-4, 0.2518899, 4.58834e-2, -11.4527617, 636.8788317)},
            {quadratic(1.0736e-5, -2.31523e-2, 5.3983e-3, -1.3630188, 96.3637597),
             quadratic(-4.4379e-5, 7.80762e-2, -2.4483e-3, 0.6141837, -71.9829075),
             quadratic(-1.3482e-4, 0.1883013, 3.59764e-2, -8.9660684, 500.2544495)}};
  }

  template <class Scalar>
  Scalar thrust_ratio(Scalar height_over_radius, const Airframe<Scalar>& airframe) const noexcept {
    return bound(airframe).thrust_ratio(height_over_radius, airframe);
  }
};

/// dT = (r - 1) |F_z|, F_z the world-vertical part of rotor and previous aerodynamic force, along body -z; no torque.
/// As the paper's authors apply it: one ratio for the vehicle, from the height of its centre.
/// `ThrustRatio`: `thrust_ratio(Z / R, airframe)`; where its coefficients follow from the airframe, `bound(airframe)` gives
/// a ratio that has them worked out.
template <class ThrustRatio>
struct GroundEffect {
  static constexpr bool uses_rotor_wrench = true;
  static constexpr VariesWith varies_with = VariesWith::height;
  ThrustRatio ratio{};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const AeroCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Scalar vertical = vertical_force(condition);
    return lift(condition, airframe, vertical < Scalar(0) ? -vertical : vertical);
  }

  /// F_z has the sign of -R_zz where thrust outweighs drag: there, on the upper branch, |F_z| grows with thrust.
  template <class Scalar>
  Wrench<Scalar> wrench_on(ThrustBranch branch, const AeroCondition<Scalar>& condition,
                           const Airframe<Scalar>& airframe) const noexcept {
    const bool upright = world_down_axis(condition.attitude)[2] >= Scalar(0);
    const Scalar vertical = vertical_force(condition);
    return lift(condition, airframe, upright == (branch == ThrustBranch::upper) ? -vertical : vertical);
  }

  template <class Scalar>
  auto bound(const Airframe<Scalar>& airframe) const noexcept {
    if constexpr (is_bindable<ThrustRatio, Scalar>) {
      return GroundEffect<decltype(ratio.bound(airframe))>{ratio.bound(airframe)};
    } else {
      return *this;
    }
  }

 private:
  /// World-vertical part of rotor and previous aerodynamic force, N, down: third row of R times the body force.
  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE static Scalar vertical_force(const AeroCondition<Scalar>& condition) noexcept {
    const auto force = [&](int axis) noexcept {
      return condition.rotors.force_N[axis] + condition.aerodynamic.force_N[axis];
    };
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    return down[0] * force(0) + down[1] * force(1) + down[2] * force(2);
  }

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> lift(const AeroCondition<Scalar>& condition, const Airframe<Scalar>& airframe,
                                             Scalar magnitude) const noexcept {
    const Scalar per_radius_1_m = Scalar(2) / airframe.propeller_diameter_m;
    const Scalar r = ratio.thrust_ratio(condition.height_above_ground_m * per_radius_1_m, airframe);
    Wrench<Scalar> result;
    result.force_N[2] = -(r - Scalar(1)) * magnitude;
    return result;
  }
};

using CheesemanBennettGroundEffect = GroundEffect<CheesemanBennett>;
using ConyersGroundEffect = GroundEffect<Conyers>;

}  // namespace pinnquad
