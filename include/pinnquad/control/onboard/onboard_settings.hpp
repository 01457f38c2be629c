// SPDX-License-Identifier: MIT
// Settings of an OnboardInverse.
#pragma once

#include <array>
#include <cstdint>

#include "pinnquad/control/motion_bias.hpp"

namespace pinnquad {

namespace detail {
template <class Scalar>
constexpr BiasSettings<Scalar> unknown_vehicle_bias() noexcept {
  BiasSettings<Scalar> settings;
  settings.most = {Scalar(2.4), Scalar(1), Scalar(1), Scalar(1)};
  return settings;
}
}  // namespace detail

/// Settings of an OnboardInverse.
template <class Scalar>
struct OnboardSettings {
  /// Settings of each sum's regression.
  struct Regression {
    Scalar forget_s = Scalar(20), forget_drag_s = Scalar(30);
    Scalar repeats = Scalar(3);  ///< rows that say the same, as two of them share a period
    /// Feedback answers wind with the commands that a row is of, and least squares take one for the other. Rows are
    /// beside this share of their running means, so long, which the wind is in too; not of yaw.
    std::array<Scalar, 3> wind_s{Scalar(0.15), Scalar(0.3), Scalar(0.3)};
    Scalar wind_share = Scalar(0.9);
    /// So many are one row of roll, pitch or yaw, their mean. Gyro noise, which feedback answers, cancels in rows that
    /// follow each other.
    std::uint32_t rows_of_torque = 5;
    Scalar lag_spread = Scalar(0.7);  ///< standard deviation of log(lag / the start's)
  };

  /// Two sines on each sum, of frequencies that none of the others has.
  struct Excitation {
    /// The two of a sum.
    struct Sines {
      Scalar slow, fast;        ///< amplitudes, m/s^2 (thrust, along z) or rad/s^2
      Scalar slow_Hz, fast_Hz;  ///< multiples of 0.1 Hz: it repeats every 10 s
    };
    std::array<Sines, 4> sums{Sines{Scalar(0.6), Scalar(0.8), Scalar(0.7), Scalar(1.7)},
                              Sines{Scalar(2), Scalar(5), Scalar(1.1), Scalar(2.3)},
                              Sines{Scalar(2), Scalar(5), Scalar(1.4), Scalar(2.9)},
                              Sines{Scalar(0.5), Scalar(1.5), Scalar(0.5), Scalar(1.3)}};
    Scalar most_of_sum = Scalar(0.4);    ///< no sine asks for more of a signed sum of thrust fractions
    Scalar share_unknown = Scalar(0.7);  ///< of them, where nobody asked for sines, while the sum is unknown
    Scalar rise_s = Scalar(0.3);
  };

  /// Settings of each sum's proof: thrust, roll, pitch, yaw.
  struct Proof {
    Scalar least_rows = Scalar(60);
    Scalar most_contradiction = Scalar(9);  ///< mean square of the judged rows over that of its own
    Scalar most_late_s = Scalar(0.012);     ///< a state comes so much later than lag and delay say, by the rise
    Scalar least_share = Scalar(0.1);       ///< of the sines' acceleration that is made
    /// Share of the slope by which the slope of the sines may differ; less sharp than its interval.
    std::array<Scalar, 4> most_disagreement{Scalar(0.25), Scalar(0.5), Scalar(0.5), Scalar(0.25)};
    std::array<Scalar, 4> most_half_width{Scalar(0.15), Scalar(0.15), Scalar(0.15), Scalar(0.15)};  ///< over the slope
    /// In units of a sum, over the envelope; wider for yaw, which has little torque and gives way first.
    std::array<Scalar, 4> most_by_terms{Scalar(1.2), Scalar(0.8), Scalar(0.8), Scalar(1.6)};
  };

  std::uint32_t period_us = 20'000;
  Scalar delay_s = Scalar(0.006);        ///< of a state beside the commands; what it lacks is learnt
  std::uint32_t rows_of_candidate = 50;  ///< a candidate each second
  std::uint32_t rows_of_gain = 100;      ///< is judged for two
  Regression regression{};
  BiasSettings<Scalar> bias = detail::unknown_vehicle_bias<Scalar>();
  Scalar young_bias_s = Scalar(0.1);  ///< its time constants at first; its age is added until they are the bias' own
  Excitation excitation{};
  Proof proof{};
};

}  // namespace pinnquad
