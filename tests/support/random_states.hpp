// SPDX-License-Identifier: MIT
// Random states, attitudes, commands and motions for property tests: seeded, the same on every machine.
#pragma once

#include <array>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/dynamics/state.hpp"

namespace pinnquad::test {

/// Draws from one seeded engine. Ranges are those of agile flight: 8 m/s, 6 rad/s, any attitude.
class RandomStates {
 public:
  explicit RandomStates(std::uint64_t seed) : engine_(seed) {}

  std::mt19937_64& engine() { return engine_; }

  template <class Scalar>
  Scalar scalar(double lower, double upper) {
    return static_cast<Scalar>(uniform(engine_, lower, upper));
  }

  template <class Scalar>
  Vector3<Scalar> vector(double largest) {
    const Scalar x = scalar<Scalar>(-largest, largest);
    const Scalar y = scalar<Scalar>(-largest, largest);
    const Scalar z = scalar<Scalar>(-largest, largest);
    return Vector3<Scalar>(x, y, z);
  }

  /// Uniform over all rotations: four normal numbers, normalised.
  template <class Scalar>
  Quaternion<Scalar> attitude() {
    const double w = standard_normal(engine_);
    const double x = standard_normal(engine_);
    const double y = standard_normal(engine_);
    const double z = standard_normal(engine_);
    const Quaternion<double> q = normalized(Quaternion<double>{w, x, y, z});
    return {Scalar(q.w), Scalar(q.x), Scalar(q.y), Scalar(q.z)};
  }

  /// Position within 100 m (height 5 to 105 m above the origin), velocity within 8 m/s and rates within 6 rad/s per
  /// axis.
  template <class Scalar>
  State<Scalar> state() {
    State<Scalar> result;
    result.position_m = vector<Scalar>(50.0);
    result.position_m[2] -= Scalar(55);
    result.velocity_m_s = vector<Scalar>(8.0);
    result.attitude = attitude<Scalar>();
    result.body_rates_rad_s = vector<Scalar>(6.0);
    return result;
  }

  /// Commands within [lower, upper]; outside 0..1 the rotors clip.
  template <class Scalar>
  Commands<Scalar> commands(double lower = 0.0, double upper = 1.0) {
    Commands<Scalar> result{};
    for (Scalar& u : result) u = scalar<Scalar>(lower, upper);
    return result;
  }

  template <class Scalar>
  Accelerations<Scalar> motion() {
    Accelerations<Scalar> result;
    result.linear_m_s2 = vector<Scalar>(15.0);
    result.angular_rad_s2 = vector<Scalar>(30.0);
    return result;
  }

 private:
  std::mt19937_64 engine_;
};

/// As many draws as a property test makes.
inline constexpr int draws = 200;

/// The same state in another scalar type.
template <class To, class From>
State<To> state_cast(const State<From>& s) {
  State<To> result;
  for (int i = 0; i < 3; ++i) {
    result.position_m[i] = static_cast<To>(s.position_m[i]);
    result.velocity_m_s[i] = static_cast<To>(s.velocity_m_s[i]);
    result.body_rates_rad_s[i] = static_cast<To>(s.body_rates_rad_s[i]);
  }
  const Quaternion<From>& q = s.attitude;
  result.attitude = {static_cast<To>(q.w), static_cast<To>(q.x), static_cast<To>(q.y), static_cast<To>(q.z)};
  return result;
}

template <class Scalar>
std::array<Scalar, 4> components(const Quaternion<Scalar>& q) {
  return {q.w, q.x, q.y, q.z};
}

/// True if every bit of two states is the same value: what "untouched" means.
template <class Scalar>
bool same(const State<Scalar>& a, const State<Scalar>& b) {
  bool equal = components(a.attitude) == components(b.attitude);
  for (int i = 0; i < 3; ++i) {
    equal = equal && a.position_m[i] == b.position_m[i] && a.velocity_m_s[i] == b.velocity_m_s[i] &&
            a.body_rates_rad_s[i] == b.body_rates_rad_s[i];
  }
  return equal;
}

}  // namespace pinnquad::test
