// SPDX-License-Identifier: MIT
// Air density over altitude: the troposphere of the standard atmosphere.
#pragma once

#include <array>
#include <cstddef>

#include "pinnquad/aero/effect.hpp"

namespace pinnquad {

namespace detail {
/// The range of the standard's troposphere, m above sea level: from the first row of its tables to the tropopause,
/// which is the reference altitude of the series below.
inline constexpr double lowest_m = -5000.0, tropopause_m = 11000.0;

/// Taylor coefficients in x = h / 11 km of (1 + b h)^n (1 + e h)^-n, from its differential equation
/// f' (1 + b h) (1 + e h) = n (b - e) f. Sixteen terms are exact to 1e-14 for |x| <= 1.
constexpr std::array<double, 16> standard_atmosphere_series() noexcept {
  const double n = 5.255877 - 1.0;
  const double e = tropopause_m / 6378137.0;
  const double b = e - 6.5 / 288.15 * 1e-3 * tropopause_m;
  std::array<double, 16> c{1.0, n * (b - e)};
  for (std::size_t k = 1; k + 1 < c.size(); ++k) {
    const double m = double(k);
    c[k + 1] = ((n * (b - e) - (b + e) * m) * c[k] - b * e * (m - 1.0) * c[k - 1]) / (m + 1.0);
  }
  return c;
}

/// Neighbours first, then pairs, then fours (Estrin): a simulator waits for this sum four times a step, and a plain
/// chain of fifteen multiply-adds takes as long as pow.
template <class Scalar>
constexpr Scalar polynomial(const std::array<double, 16>& c, Scalar x) noexcept {
  const Scalar x2 = x * x, x4 = x2 * x2;
  const auto four = [&](std::size_t k) noexcept {
    return (Scalar(c[k]) + Scalar(c[k + 1]) * x) + (Scalar(c[k + 2]) + Scalar(c[k + 3]) * x) * x2;
  };
  return (four(0) + four(4) * x4) + (four(8) + four(12) * x4) * (x4 * x4);
}

/// False for NaN.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Mask<Scalar> in_troposphere(Scalar altitude_m) noexcept {
  return altitude_m >= Scalar(lowest_m) && altitude_m <= Scalar(tropopause_m);
}

/// standard_atmosphere_density_kg_m3() there.
template <class Scalar>
PINNQUAD_ALWAYS_INLINE constexpr Scalar troposphere_density_kg_m3(Scalar altitude_m) noexcept {
  constexpr std::array<double, 16> series = standard_atmosphere_series();
  return standard_air_density_kg_m3<Scalar> * polynomial(series, altitude_m * Scalar(1.0 / tropopause_m));
}
}  // namespace detail

/// Density at an altitude above sea level, kg/m^3, from -5 to 11 km; beyond, that of the nearer end; NaN for NaN. H =
/// 6378.137 h / (6378.137 + h) km geopotential, T = 288.15 - 6.5 H, P = 101325 (288.15 / T)^-5.255877 Pa, rho = P /
/// (287.053 T), by its power series in h. Source: US Standard Atmosphere 1976 as the paper's simulator evaluates it.
template <class Scalar>
Scalar standard_atmosphere_density_kg_m3(Scalar altitude_m) noexcept {
  const Scalar lowest(detail::lowest_m), highest(detail::tropopause_m);
  const Scalar most = detail::troposphere_density_kg_m3(lowest), least = detail::troposphere_density_kg_m3(highest);
  const Scalar density = detail::troposphere_density_kg_m3(altitude_m);
  return select(altitude_m < lowest, most, select(altitude_m > highest, least, density));
}

/// Sets the density of the surroundings from their altitude; `out_of_range` outside the standard's troposphere.
struct StandardAtmosphere {
  static constexpr VariesWith varies_with = VariesWith::height;

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE void surroundings(Surroundings<Scalar>& air) const noexcept {
    air.air_density_kg_m3 = detail::troposphere_density_kg_m3(air.altitude_m);
    const Mask<Scalar> within = detail::in_troposphere(air.altitude_m);
    if (!all_of(within)) {  // a branch, which no one waits for
      air.air_density_kg_m3 = select(within, air.air_density_kg_m3, standard_atmosphere_density_kg_m3(air.altitude_m));
      air.status = select(within, air.status, Outcome<Scalar>(Status::out_of_range));
    }
  }
};

}  // namespace pinnquad
