// SPDX-License-Identifier: MIT
// An extended Kalman filter of what a residual wrench is not told: the wind, the rotors' thrust, and a force that
// nothing explains. It compares the specific force flown with that of rotors and residual wrench.
#pragma once

#include <cmath>
#include <cstdint>

#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/control/tick_clock.hpp"
#include "pinnquad/core/detected.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/status.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "study/wrench_inverse.hpp"

namespace study {

using namespace pinnquad;

/// Settings of a WindFilter. Standard deviations; those of a walk are after one second.
template <class Scalar>
struct WindFilterSettings {
  Scalar force_noise_m_s2 = Scalar(1);  ///< of a specific force, each axis
  Scalar wind_start_m_s = Scalar(2), thrust_start = Scalar(0.1), force_start_m_s2 = Scalar(0.3);
  Scalar wind_walk_m_s = Scalar(0.4), thrust_walk = Scalar(0.01), force_walk_m_s2 = Scalar(0.05);
  Scalar most_wind_m_s = Scalar(20), most_force_m_s2 = Scalar(4);
  Scalar least_thrust = Scalar(0.5), most_thrust = Scalar(1.5);
  Scalar gate = Scalar(16.3);        ///< squared innovation over its variance, 3 degrees of freedom: 0.1 % lie beyond
  Scalar patience_s = Scalar(0.25);  ///< refused for so long it is no outlier
};

namespace detail {
/// d(force / mass) / d(air's velocity), body: the residual's own, else central differences.
template <class Residual, class Scalar>
using ForceAndSlopeCall = decltype(std::declval<const Residual&>().force_and_slope(
    std::declval<const WrenchInputs<Scalar>&>(), std::declval<Matrix<Scalar, 3, 3>&>()));
template <class Residual, class Scalar>
Vector3<Scalar> force_and_slope(const Residual& residual, const WrenchInputs<Scalar>& in,
                                Matrix<Scalar, 3, 3>& by_velocity) noexcept {
  if constexpr (is_detected<ForceAndSlopeCall, Residual, Scalar>) {
    return residual.force_and_slope(in, by_velocity);
  } else {
    constexpr Scalar step = Scalar(0.05);
    for (int k = 0; k < 3; ++k) {
      WrenchInputs<Scalar> more = in, less = in;
      more.air_velocity_m_s[k] += step;
      less.air_velocity_m_s[k] -= step;
      const Vector3<Scalar> change = residual(more).linear_m_s2 - residual(less).linear_m_s2;
      for (int i = 0; i < 3; ++i) by_velocity(i, k) = change[i] / (Scalar(2) * step);
    }
    return residual(in).linear_m_s2;
  }
}
}  // namespace detail

/// State x = (wind, thrust scale, force / mass), NED, each a random walk. Measurement, body:
///   s = scale F(rotors) / m + N(R^T (v - wind), w, rotors) + R^T force
/// with N's own Jacobian. One update takes the same time whatever the numbers.
template <class Scalar>
class WindFilter {
 public:
  static constexpr int size = 7;
  using Covariance = Matrix<Scalar, size, size>;

  explicit WindFilter(const WindFilterSettings<Scalar>& settings = {}) noexcept : settings_(settings) { reset(); }

  const WindFilterSettings<Scalar>& settings() const noexcept { return settings_; }
  const WindAndThrust<Scalar>& estimate() const noexcept { return estimate_; }
  const Covariance& covariance() const noexcept { return covariance_; }
  void reset() noexcept {
    estimate_ = {};
    covariance_.setZero();
    add(settings_.wind_start_m_s, settings_.thrust_start, settings_.force_start_m_s2, Scalar(1));
    refused_s_ = Scalar(0);
  }

  /// Time without a measurement: the variances rise, up to those of the start.
  void wait(Scalar step_s) noexcept {
    if (!(step_s > Scalar(0)) || !is_finite(step_s)) return;
    const WindFilterSettings<Scalar>& s = settings_;
    add(s.wind_walk_m_s, s.thrust_walk, s.force_walk_m_s2, step_s);
    for (int i = 0; i < size; ++i) {
      const Scalar start = i < 3 ? s.wind_start_m_s : (i == 3 ? s.thrust_start : s.force_start_m_s2);
      const Scalar most = start * start, now = covariance_(i, i);
      if (now > most) scale(i, most, now);
    }
  }

  /// A motion that was flown, the rotors that made it, and the time since the one before. `rotor_force_m_s2`: of these
  /// rotors over mass, body, at a thrust scale of 1.
  /// `ok`; `limited`: the estimate stands at a bound; `distrusted`: refused by the gate; `not_finite`, `out_of_range`
  /// of a period that is none: nothing changes.
  template <class Residual>
  Status update(const Residual& residual, const MotionInputs<Scalar>& motion, const Commands<Scalar>& rotors,
                const Vector3<Scalar>& rotor_force_m_s2, Scalar period_s) noexcept {
    if (!(all_finite(rotors) && all_finite(rotor_force_m_s2) && is_finite(period_s)) ||
        PaperFeatures::check<Scalar>(motion) != Status::ok) {
      return Status::not_finite;
    }
    if (!(period_s > Scalar(0))) return Status::out_of_range;
    const auto to_body = [&motion](const Vector3<Scalar>& world) noexcept {
      return world_to_body<Scalar>(motion.attitude, world);
    };
    Matrix<Scalar, 3, 3> slope;
    const WrenchInputs<Scalar> in{motion.velocity_m_s - to_body(estimate_.wind_m_s), motion.body_rates_rad_s, rotors};
    const Vector3<Scalar> air = detail::force_and_slope(residual, in, slope);
    const Vector3<Scalar> innovation = SpecificForce::of<Scalar>(motion) - air -
                                       estimate_.thrust_scale * rotor_force_m_s2 - to_body(estimate_.force_m_s2);
    Matrix<Scalar, 3, size> by_state;
    for (int k = 0; k < 3; ++k) {
      Vector3<Scalar> axis = Vector3<Scalar>::Zero();
      axis[k] = Scalar(1);
      const Vector3<Scalar> turned = to_body(axis);
      by_state.col(k) = -(slope * turned);
      by_state.col(4 + k) = turned;
    }
    by_state.col(3) = rotor_force_m_s2;
    if (!(all_finite(innovation) && all_finite(by_state))) return Status::not_finite;
    wait(period_s);
    return correct(by_state, innovation, period_s);
  }

 private:
  void add(Scalar wind, Scalar thrust, Scalar force, Scalar time_s) noexcept {
    for (int i = 0; i < 3; ++i) {
      covariance_(i, i) += wind * wind * time_s;
      covariance_(4 + i, 4 + i) += force * force * time_s;
    }
    covariance_(3, 3) += thrust * thrust * time_s;
  }
  /// Row and column i, so that the variance becomes `most`.
  void scale(int i, Scalar most, Scalar now) noexcept {
    using std::sqrt;
    const Scalar factor = sqrt(most / now);
    for (int k = 0; k < size; ++k) {
      covariance_(i, k) *= factor;
      covariance_(k, i) *= factor;
    }
  }

  Status correct(const Matrix<Scalar, 3, size>& h, const Vector3<Scalar>& innovation, Scalar period_s) noexcept {
    const Scalar noise = settings_.force_noise_m_s2 * settings_.force_noise_m_s2;
    const Matrix<Scalar, size, 3> spread = covariance_ * h.transpose();
    Matrix<Scalar, 3, 3> s = h * spread;
    for (int i = 0; i < 3; ++i) s(i, i) += noise;
    Matrix<Scalar, 3, 3> inverse;  // of a symmetric matrix that is at least `noise`
    const Vector3<Scalar> a = s.col(0), b = s.col(1), c = s.col(2);
    inverse.row(0) = cross<Scalar>(b, c).transpose();
    inverse.row(1) = cross<Scalar>(c, a).transpose();
    inverse.row(2) = cross<Scalar>(a, b).transpose();
    inverse /= a.dot(cross<Scalar>(b, c));
    const Vector3<Scalar> weighed = inverse * innovation;
    const Scalar distance = innovation.dot(weighed);
    if (!is_finite(distance)) return Status::not_finite;
    if (distance > settings_.gate && refused_s_ < settings_.patience_s) {
      refused_s_ += period_s;
      return Status::distrusted;
    }
    refused_s_ = Scalar(0);
    const Matrix<Scalar, size, 3> gain = spread * inverse;
    Covariance kept = -(gain * h);
    for (int i = 0; i < size; ++i) kept(i, i) += Scalar(1);
    const Covariance next = kept * covariance_ * kept.transpose() + noise * (gain * gain.transpose());  // Joseph's form
    const Matrix<Scalar, size> change = gain * innovation;
    if (!(all_finite(next) && all_finite(change))) return Status::not_finite;
    covariance_ = next;
    for (int i = 0; i < 3; ++i) {
      estimate_.wind_m_s[i] += change[i];
      estimate_.force_m_s2[i] += change[4 + i];
    }
    estimate_.thrust_scale += change[3];
    return bounded() ? Status::limited : Status::ok;
  }

  /// True where a bound has moved the estimate.
  bool bounded() noexcept {
    const auto shorten = [](Vector3<Scalar>& v, Scalar most) noexcept {
      const Scalar length = v.norm();
      if (!(length > most)) return false;
      v *= most / length;
      return true;
    };
    bool moved = shorten(estimate_.wind_m_s, settings_.most_wind_m_s);
    moved |= shorten(estimate_.force_m_s2, settings_.most_force_m_s2);
    Scalar& thrust = estimate_.thrust_scale;
    const Scalar within = thrust < settings_.least_thrust
                              ? settings_.least_thrust
                              : (thrust > settings_.most_thrust ? settings_.most_thrust : thrust);
    moved |= thrust < within || thrust > within;
    thrust = within;
    return moved;
  }

  WindFilterSettings<Scalar> settings_;
  WindAndThrust<Scalar> estimate_{};
  Covariance covariance_ = Covariance::Zero();
  Scalar refused_s_{0};
};

/// A WrenchInverse that is told what a WindFilter finds, from means over two periods (FlownMotion).
template <class Scalar, class Residual>
class WindInverse {
 public:
  using Inverse = WrenchInverse<Scalar, Residual>;

  WindInverse(const Inverse& inverse, const WindFilterSettings<Scalar>& settings,
              const FlownMotion<Scalar>& motion) noexcept
      : inverse_(inverse), filter_(settings), motion_(motion) {}

  const Inverse& inverse() const noexcept { return inverse_; }
  const WindFilter<Scalar>& filter() const noexcept { return filter_; }
  /// Of the last motion.
  Status status() const noexcept { return status_; }

  void learn(std::uint64_t now_us, bool known, const State<Scalar>& state, const Commands<Scalar>& commands) noexcept {
    inverse_.learn(now_us, known, state, commands);
    waited_s_ += clock_.step_s(now_us);
    motion_.velocity(now_us, state.velocity_m_s);
    motion_.body_rates(now_us, state.body_rates_rad_s);
    if (motion_.tick(now_us, known, state, commands)) {
      const Scalar period_s = motion_.period_s(Scalar(0));
      status_ = filter_.update(inverse_.residual(), motion_.motion(), motion_.flown(),
                               inverse_.rotor_force_m_s2(motion_.flown()), period_s);
      if (has_output(status_)) inverse_.tell(filter_.estimate());
      waited_s_ = Scalar(0);
    } else if (waited_s_ > Scalar(2) * motion_.period_s(Scalar(0))) {
      filter_.wait(waited_s_);
      waited_s_ = Scalar(0);
    }
  }
  Status operator()(const State<Scalar>& state, const Accelerations<Scalar>& wanted, std::uint64_t time_us,
                    Commands<Scalar>& commands) noexcept {
    return inverse_(state, wanted, time_us, commands);
  }
  Vector3<Scalar> across_m_s2(const State<Scalar>& state) const noexcept { return inverse_.across_m_s2(state); }

 private:
  Inverse inverse_;
  WindFilter<Scalar> filter_;
  FlownMotion<Scalar> motion_;
  pinnquad::detail::TickClock<Scalar> clock_;
  Scalar waited_s_{0};
  Status status_ = Status::warming_up;
};

}  // namespace study
