// SPDX-License-Identifier: MIT
// Dryden turbulence at low altitude (MIL-F-8785C) as a frozen field of gusts that the mean wind carries along.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "pinnquad/aero/wind.hpp"
#include "pinnquad/core/lanes.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad {

/// Scale lengths and intensities of MIL-F-8785C below 1000 ft, from the wind speed at 20 ft and the height above
/// ground: L_w = h, L_u = L_v = h / (0.177 + 0.000823 h)^1.2, sigma_w = 0.1 W_20, sigma_u = sigma_v = sigma_w / (0.177
/// + 0.000823 h)^0.4, with h in feet, held between 10 and 1000.
struct DrydenParameters {
  std::array<double, 3> length_m{};       ///< along the wind, across, vertical
  std::array<double, 3> intensity_m_s{};  ///< standard deviation of each component

  static DrydenParameters low_altitude(double wind_at_20_ft_m_s, double height_m) noexcept {
    constexpr double feet_per_m = 1 / 0.3048;
    double h = height_m * feet_per_m;
    h = h < 10 ? 10 : (h > 1000 ? 1000 : h);
    const double base = 0.177 + 0.000823 * h;
    const double along_m = h / std::pow(base, 1.2) / feet_per_m, vertical_m_s = 0.1 * wind_at_20_ft_m_s;
    const double along_m_s = vertical_m_s / std::pow(base, 0.4);
    return {{along_m, along_m, h / feet_per_m}, {along_m_s, along_m_s, vertical_m_s}};
  }
};

/// Gusts u(s), v(s), w(s) over s = d . (x - W d t), the distance from the air that the mean wind W carries along d
/// (Taylor's hypothesis): hovering in wind and flying through it both meet the spectra
///   Phi_u = sigma^2 (2 L / pi) / (1 + (L k)^2),  Phi_v,w = sigma^2 (L / pi) (1 + 3 (L k)^2) / (1 + (L k)^2)^2,
/// k in rad/m. Each component is a sum of `Waves` cosines of equal energy whose wave numbers are drawn one from each
/// equal-energy slice of the spectrum, so a vehicle and a place give the same air every time: no filter state. Adds
/// gusts alone: the mean wind is a ConstantWind beside it.
template <int Waves = 24>
class DrydenTurbulence {
  static_assert(Waves >= 1, "pinnquad: Dryden turbulence needs at least one wave per component (aero/dryden.hpp)");

 public:
  DrydenTurbulence() = default;  ///< no gusts
  /// `direction`: where the mean wind blows to, NED, horizontal, unit length. The engine draws wave numbers and phases.
  template <class Engine>
  DrydenTurbulence(Engine& engine, const DrydenParameters& parameters, double mean_wind_m_s,
                   std::array<double, 2> direction = {1.0, 0.0})
      : direction_(direction),
        mean_wind_m_s_(mean_wind_m_s),
        holds_(detail::is_direction(direction) && detail::bounded(mean_wind_m_s)) {
    constexpr double two_pi = 6.283185307179586;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      holds_ = holds_ && detail::plausible(parameters.length_m[axis]) &&
               detail::plausible_or_zero(parameters.intensity_m_s[axis]);
      for (std::size_t i = 0; i < waves; ++i) {
        const double energy_below = (static_cast<double>(i) + uniform_01(engine)) / static_cast<double>(waves);
        const double scaled = axis == 0 ? along_wave_number(energy_below) : across_wave_number(energy_below);
        wave_number_1_m_[axis][i] = scaled / parameters.length_m[axis] / two_pi;
        phase_turns_[axis][i] = uniform_01(engine);
      }
      amplitude_m_s_[axis] = parameters.intensity_m_s[axis] * std::sqrt(2.0 / static_cast<double>(waves));
    }
  }

  template <class Scalar>
  void surroundings(Surroundings<Scalar>& air) const noexcept {
    using Real = Wide<Scalar>;
    const Real x = Real(air.position_m[0]), y = Real(air.position_m[1]);
    const Real north(direction_[0]), east(direction_[1]);
    const Real along_m = north * x + east * y - Real(mean_wind_m_s_) * Real(air.time_s);
    const Real u = gust(0, along_m), v = gust(1, along_m), w = gust(2, along_m);
    air.wind_m_s[0] += Scalar(north * u - east * v);
    air.wind_m_s[1] += Scalar(east * u + north * v);
    air.wind_m_s[2] += Scalar(w);
  }

  /// `out_of_range` for parameters that are negative or no numbers, lengths of 0, or a direction that isn't a unit
  /// vector.
  template <class Scalar>
  Status status(const Airframe<Scalar>&) const noexcept {
    return holds_ ? Status::ok : Status::out_of_range;
  }

  /// One component at a distance along the field, m/s: 0 along the wind, 1 across (to its right), 2 down.
  template <class Real>
  Real gust(std::size_t axis, Real along_m) const noexcept {
    std::array<Real, waves> wave;
    if constexpr (std::is_same_v<Real, double> && waves % native_lanes<double> == 0) {
      using Several = Lanes<double, native_lanes<double>>;
      for (std::size_t i = 0; i < waves; i += Several::count) {
        Several number_1_m, turns;
        std::memcpy(&number_1_m.part, &wave_number_1_m_[axis][i], sizeof number_1_m.part);
        std::memcpy(&turns.part, &phase_turns_[axis][i], sizeof turns.part);
        const Several cosines = cosine_of_turns(number_1_m * Several(along_m) + turns);
        std::memcpy(&wave[i], &cosines.part, sizeof cosines.part);
      }
    } else {
      for (std::size_t i = 0; i < waves; ++i) {
        wave[i] = cosine_of_turns(Real(wave_number_1_m_[axis][i]) * along_m + Real(phase_turns_[axis][i]));
      }
    }
    Real sum(0);
    for (const Real& one : wave) sum += one;
    return Real(amplitude_m_s_[axis]) * sum;
  }

 private:
  static constexpr auto waves = static_cast<std::size_t>(Waves);

  /// Inverse of the energy below x = L k: (2 / pi) atan x.
  static double along_wave_number(double energy_below) noexcept {
    constexpr double half_pi = 1.5707963267948966;
    return std::tan(half_pi * energy_below);
  }
  /// Inverse of (2 atan x - x / (1 + x^2)) / pi, which rises from 0 to 1; by bisection in atan x.
  static double across_wave_number(double energy_below) noexcept {
    double low = 0, high = pi / 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2, x = std::tan(middle);
      ((2 * middle - x / (1 + x * x)) / pi < energy_below ? low : high) = middle;
    }
    return std::tan(low);
  }

  std::array<double, 2> direction_{1.0, 0.0};
  double mean_wind_m_s_ = 0;
  bool holds_ = true;
  std::array<std::array<double, waves>, 3> wave_number_1_m_{};
  std::array<std::array<double, waves>, 3> phase_turns_{};
  std::array<double, 3> amplitude_m_s_{};
};

}  // namespace pinnquad
