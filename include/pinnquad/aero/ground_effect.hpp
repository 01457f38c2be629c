// SPDX-License-Identifier: MIT
// Ground effect: near the ground the rotors lift more. Two models of the thrust ratio r(Z / R), applied to the vehicle
// as the paper's authors do in their simulator, or rotor by rotor.
#pragma once

#include <array>
#include <cmath>

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

/// Cheeseman and Bennett (1955): r = 1 / (1 - (R / 4Z)^2) from Z/R = `least_height` up; below, its value there, 4/3,
/// also below the ground, where the low side of a tilted vehicle may reach. NaN stays NaN. The model puts a mirrored
/// source under the ground and holds from Z/R of about 0.5; at Z/R = 0.25 it has a pole. The paper's simulator computes
/// it down to the pole and 1 below; rows of it between 0.25 and 0.5 differ from this.
struct CheesemanBennett {
  static constexpr double least_height = 0.5;
  static constexpr double most_ratio = 4.0 / 3.0;

  template <class Scalar>
  Scalar thrust_ratio(Scalar height_over_radius, const Airframe<Scalar>&) const noexcept {
    const Scalar q = Scalar(0.25) / height_over_radius;
    return select(height_over_radius < Scalar(least_height), Scalar(most_ratio),
                  Scalar(Scalar(1) / (Scalar(1) - q * q)));
  }
};

namespace detail {
/// The root while compiling, where std::sqrt can't be called; from above, by Newton.
template <class Scalar>
constexpr Scalar compiled_root(Scalar value) noexcept {
  const Mask<Scalar> positive = value > Scalar(0);
  if (!any_of(positive)) return value;
  Scalar root = select(value > Scalar(1), value, Scalar(1));
  for (bool falls = true; falls;) {
    const Scalar next = (root + value / root) / Scalar(2);
    const Mask<Scalar> nearer = next < root;
    root = select(nearer, next, root);
    falls = any_of(positive && nearer);
  }
  return select(positive, root, value);
}

/// Length of the diagonals between motors, the mean of both, in whatever order the rotors come: of the three ways to
/// pair four corners the diagonals are the one with the greatest sum. `root` is the square root.
template <class Scalar, class Root>
constexpr Scalar motor_diagonal_m(const Airframe<Scalar>& airframe, const Root& root) noexcept {
  const auto distance = [&airframe, &root](std::size_t i, std::size_t j) {
    const Scalar dx = airframe.rotors[i].x_m - airframe.rotors[j].x_m;
    const Scalar dy = airframe.rotors[i].y_m - airframe.rotors[j].y_m;
    return root(dx * dx + dy * dy);
  };
  Scalar both(0);
  for (std::size_t partner = 1; partner < rotor_count; ++partner) {
    const std::size_t third = partner == 1 ? 2 : 1;
    const Scalar sum = distance(0, partner) + distance(third, 6 - partner - third);
    both = select(sum > both, sum, both);
  }
  return both / Scalar(2);
}
}  // namespace detail

/// Conyers (2019): a ratio of polynomials in Z/R whose coefficients are quadratic in the motor spacing L (diagonal) and
/// the propeller radius R, both in mm; 1 outside 0.25 <= Z/R <= 10.
/// A fit to vehicles near L = 690, R = 114.3: for others, ordinary ones among them (L = 450, R = 127), it has a pole in
/// that range. `status` is `out_of_range` for an airframe whose ratio leaves `least_ratio`..`most_ratio` there.
struct Conyers {
  static constexpr double least_ratio = 0.9;  ///< what the fit gives where it holds lies between 0.97 and 1.37
  static constexpr double most_ratio = 1.5;

  /// The ratio for one airframe, its coefficients worked out.
  template <class Scalar>
  struct Curve {
    std::array<Scalar, 5> numerator{};    ///< x^4, x^3, ..., 1
    std::array<Scalar, 3> denominator{};  ///< x^2, x, 1, behind x^3

    Scalar thrust_ratio(Scalar x, const Airframe<Scalar>&) const noexcept {
      const Mask<Scalar> without = x < Scalar(0.25) || x > Scalar(10);
      if (all_of(without)) return Scalar(1);
      return select(without, Scalar(1), Scalar(above(x) / below(x)));
    }

    /// No pole in the range and no ratio out of its bounds. The polynomials bend slowly: between two points looked at,
    /// a denominator that touches zero is so small at both that the ratio there is out of bounds.
    constexpr Mask<Scalar> plausible() const noexcept {
      constexpr int intervals = 195;
      Mask<Scalar> holds(true);
      for (int i = 0; i <= intervals; ++i) {
        const Scalar x = Scalar(0.25) + Scalar(9.75) * Scalar(i) / Scalar(intervals);
        const Scalar divisor = below(x);
        holds = holds && divisor > Scalar(0) && above(x) >= Scalar(least_ratio) * divisor &&
                above(x) <= Scalar(most_ratio) * divisor;
      }
      return holds;
    }

   private:
    // two short chains instead of one long one
    constexpr Scalar above(Scalar x) const noexcept {
      const auto& [p1, p2, p3, p4, p5] = numerator;
      const Scalar x2 = x * x;
      return (p1 * x2 + (p2 * x + p3)) * x2 + (p4 * x + p5);
    }
    constexpr Scalar below(Scalar x) const noexcept {
      const auto& [q1, q2, q3] = denominator;
      const Scalar x2 = x * x;
      return (x + q1) * x2 + (q2 * x + q3);
    }
  };

  template <class Scalar>
  Curve<Scalar> bound(const Airframe<Scalar>& airframe) const noexcept {
    using std::sqrt;
    return curve(airframe, [](Scalar square) noexcept { return sqrt(square); });
  }

  /// A literal airframe's can be asked for when compiled.
  template <class Scalar>
  constexpr Outcome<Scalar> status(const Airframe<Scalar>& airframe) const noexcept {
    const auto root = [](Scalar square) { return Scalar(detail::compiled_root(Wide<Scalar>(square))); };
    return select(curve(airframe, root).plausible(), Status::ok, Status::out_of_range);
  }

  template <class Scalar>
  Scalar thrust_ratio(Scalar height_over_radius, const Airframe<Scalar>& airframe) const noexcept {
    return bound(airframe).thrust_ratio(height_over_radius, airframe);
  }

 private:
  template <class Scalar, class Root>
  static constexpr Curve<Scalar> curve(const Airframe<Scalar>& airframe, const Root& root) noexcept {
    const Scalar l = Scalar(1000) * detail::motor_diagonal_m(airframe, root);  // 690 mm in Table 1
    const Scalar r = Scalar(500) * airframe.propeller_diameter_m;
    const auto quadratic = [l, r](double l2, double l1, double r2, double r1, double one) {
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
};

/// dT = (r - 1) |F_z|, F_z the world-vertical part of rotor and previous aerodynamic force, along body -z; no torque.
/// As the paper's authors apply it: one ratio for the vehicle, from the height of its centre.
/// `ThrustRatio`: `thrust_ratio(Z / R, airframe)`; where its coefficients follow from the airframe, `bound(airframe)`
/// gives a ratio that has them worked out, and `status(airframe)` says whether it holds for the airframe.
template <class ThrustRatio>
struct GroundEffect {
  static constexpr VariesWith varies_with = VariesWith::height;
  ThrustRatio ratio{};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Scalar vertical = vertical_force(condition);
    return lift(condition, airframe, select(vertical < Scalar(0), Scalar(-vertical), vertical));
  }

  /// F_z has the sign of -R_zz where thrust outweighs drag: there, on the upper branch, |F_z| grows with thrust.
  template <class Scalar>
  Wrench<Scalar> wrench_on(ThrustBranch branch, const RotorCondition<Scalar>& condition,
                           const Airframe<Scalar>& airframe) const noexcept {
    const Mask<Scalar> upright = world_down_axis(condition.attitude)[2] >= Scalar(0);
    const Mask<Scalar> turned = branch == ThrustBranch::upper ? upright : !upright;
    const Scalar vertical = vertical_force(condition);
    return lift(condition, airframe, select(turned, Scalar(-vertical), vertical));
  }

  template <class Scalar>
  auto bound(const Airframe<Scalar>& airframe) const noexcept {
    return GroundEffect<detail::BoundEffect<ThrustRatio, Scalar>>{detail::bound_effect(ratio, airframe)};
  }

  template <class Scalar>
  constexpr Outcome<Scalar> status(const Airframe<Scalar>& airframe) const noexcept {
    return effect_status(ratio, airframe);
  }

 private:
  /// World-vertical part of rotor and previous aerodynamic force, N, down: third row of R times the body force.
  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE static Scalar vertical_force(const RotorCondition<Scalar>& condition) noexcept {
    const auto force = [&](int axis) noexcept {
      return condition.rotors.force_N[axis] + condition.aerodynamic.force_N[axis];
    };
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    return down[0] * force(0) + down[1] * force(1) + down[2] * force(2);
  }

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> lift(const RotorCondition<Scalar>& condition, const Airframe<Scalar>& airframe,
                                             Scalar magnitude) const noexcept {
    const Scalar per_radius_1_m = Scalar(2) / airframe.propeller_diameter_m;
    const Scalar r = ratio.thrust_ratio(condition.height_above_ground_m * per_radius_1_m, airframe);
    Wrench<Scalar> result;
    result.force_N[2] = -(r - Scalar(1)) * magnitude;
    return result;
  }
};

/// dT_i = (r(Z_i / R) - 1) |R_zz| T_i along the axis of rotor i (body -z unless tilted), at its hub, with Z_i the
/// height of the hub above ground and |R_zz| the vertical share of its thrust: an alternative to GroundEffect, which
/// applies one ratio at the vehicle's centre and makes no torque. Level and without drag both give the same force.
/// `ThrustRatio` as in GroundEffect: a hub below its range, as one that a tilt brings under the ground, has the ratio
/// that it states there.
template <class ThrustRatio>
struct RotorGroundEffect {
  static constexpr VariesWith varies_with = VariesWith::height;
  ThrustRatio ratio{};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE Wrench<Scalar> wrench(const RotorCondition<Scalar>& condition,
                                               const Airframe<Scalar>& airframe) const noexcept {
    const Scalar per_radius_1_m = Scalar(2) / airframe.propeller_diameter_m;
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    const Scalar share = select(down[2] < Scalar(0), Scalar(-down[2]), Scalar(down[2]));
    Wrench<Scalar> result;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const RotorMount<Scalar>& hub = airframe.rotors[i];
      const Mask<Scalar> plain = is_upright(hub) && detail::equal(hub.z_m, Scalar(0));
      const Wrench<Scalar> before = result;
      if (any_of(plain)) {
        const Scalar height_m = condition.height_above_ground_m - (down[0] * hub.x_m + down[1] * hub.y_m);
        const Scalar r = ratio.thrust_ratio(height_m * per_radius_1_m, airframe);
        const Scalar lift = (r - Scalar(1)) * share * condition.rotor_thrust_N[i];
        result.force_N[2] -= lift;
        result.torque_N_m[0] -= hub.y_m * lift;
        result.torque_N_m[1] += hub.x_m * lift;
      }
      if (!all_of(plain)) {
        result = select(plain, result, with_any(hub, condition, airframe, condition.rotor_thrust_N[i], before));
      }
    }
    return result;
  }

  template <class Scalar>
  auto bound(const Airframe<Scalar>& airframe) const noexcept {
    return RotorGroundEffect<detail::BoundEffect<ThrustRatio, Scalar>>{detail::bound_effect(ratio, airframe)};
  }

  template <class Scalar>
  constexpr Outcome<Scalar> status(const Airframe<Scalar>& airframe) const noexcept {
    return effect_status(ratio, airframe);
  }

 private:
  /// One tilted rotor, or one above or below the centre of gravity.
  template <class Scalar>
  Wrench<Scalar> with_any(const RotorMount<Scalar>& hub, const RotorCondition<Scalar>& condition,
                          const Airframe<Scalar>& airframe, Scalar thrust_N, Wrench<Scalar> sum) const noexcept {
    const Vector3<Scalar> down = world_down_axis(condition.attitude);
    const Vector3<Scalar> arm(hub.x_m, hub.y_m, hub.z_m), axis = to_vector(hub.axis);
    const Scalar upright = dot(down, axis), share = select(upright < Scalar(0), Scalar(-upright), upright);
    const Scalar height_m = condition.height_above_ground_m - dot(down, arm);
    const Scalar r = ratio.thrust_ratio(height_m * (Scalar(2) / airframe.propeller_diameter_m), airframe);
    const Vector3<Scalar> force = axis * ((r - Scalar(1)) * share * thrust_N);
    sum.force_N += force;
    sum.torque_N_m += cross<Scalar>(arm, force);
    return sum;
  }
};

}  // namespace pinnquad
