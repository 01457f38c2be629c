// SPDX-License-Identifier: MIT
// Wind fields: the air's velocity over ground, NED.
#pragma once

#include <array>

#include "pinnquad/aero/effect.hpp"
#include "pinnquad/core/scalar_math.hpp"

namespace pinnquad {

namespace detail {
/// Unit length, within what three printed digits leave; false for NaN.
template <std::size_t Size>
constexpr bool is_direction(const std::array<double, Size>& direction) noexcept {
  double square = 0;
  for (const double component : direction) square += component * component;
  return square >= 1 - 1e-2 && square <= 1 + 1e-2;
}
}  // namespace detail

/// The same wind everywhere and always; adds to the wind set so far.
struct ConstantWind {
  static constexpr VariesWith varies_with = VariesWith::motion;
  std::array<double, 3> velocity_m_s{0.0, 0.0, 0.0};  ///< NED

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE void surroundings(Surroundings<Scalar>& air) const noexcept {
    air.wind_m_s[0] += Scalar(velocity_m_s[0]);  // no loop: an index keeps the air in memory
    air.wind_m_s[1] += Scalar(velocity_m_s[1]);
    air.wind_m_s[2] += Scalar(velocity_m_s[2]);
  }

  /// `out_of_range` for a velocity that is no number.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    return detail::all_bounded(velocity_m_s) ? Status::ok : Status::out_of_range;
  }
};

/// amplitude sin(2 pi t / period) + mean along one direction; adds to the wind set so far.
/// The defaults are those of the paper's D3: 2.5 sin(pi t / 5) + 2.5 m/s towards north.
struct PeriodicWind {
  std::array<double, 3> direction{1.0, 0.0, 0.0};  ///< NED unit vector
  double mean_m_s{2.5};
  double amplitude_m_s{2.5};
  double period_s{10.0};

  template <class Scalar>
  PINNQUAD_ALWAYS_INLINE void surroundings(Surroundings<Scalar>& air) const noexcept {
    const Scalar turns = air.time_s * Scalar(1 / period_s);
    const Scalar speed = Scalar(amplitude_m_s) * sine_of_turns(turns) + Scalar(mean_m_s);
    air.wind_m_s[0] += speed * Scalar(direction[0]);
    air.wind_m_s[1] += speed * Scalar(direction[1]);
    air.wind_m_s[2] += speed * Scalar(direction[2]);
  }

  /// `out_of_range` for a period that isn't positive, a direction that isn't a unit vector, or speeds that are no
  /// numbers.
  template <class Scalar>
  constexpr Status status(const Airframe<Scalar>&) const noexcept {
    const bool holds = detail::is_direction(direction) && detail::plausible(period_s) &&
                       detail::all_bounded(std::array<double, 2>{mean_m_s, amplitude_m_s});
    return holds ? Status::ok : Status::out_of_range;
  }
};

}  // namespace pinnquad
