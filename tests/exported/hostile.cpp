// SPDX-License-Identifier: MIT
// Hostile inputs against every kind of guard, float and double: NaN, infinities, denormals, random bits, attitudes that
// are none. The rules are counted by code of their own (std::isfinite, memcmp), not by the guard's.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/guarded_inputs.hpp"
#include "support/numbers_of.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;
using pinnquad::test::DoubleModel;
using pinnquad::test::marked;
using pinnquad::test::same_bits;
using pinnquad::test::SmallModel;

namespace {

#if defined(__OPTIMIZE__)
constexpr int inputs_per_guard = 60000;
#else
constexpr int inputs_per_guard = 12000;
#endif

template <class Scalar>
using Bits = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;

template <class Scalar>
class Hostility {
 public:
  explicit Hostility(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t below(std::uint64_t count) { return engine_() % count; }

  Scalar random_bits() {
    const auto bits = static_cast<Bits<Scalar>>(engine_());
    Scalar value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  Scalar uniform(Scalar size) {
    return size * (Scalar(2) * static_cast<Scalar>(engine_() >> 40) / static_cast<Scalar>(1 << 24) - Scalar(1));
  }

  /// Values that no sensor should give.
  Scalar value() {
    using Limits = std::numeric_limits<Scalar>;
    const Scalar sign = below(2) == 0 ? Scalar(1) : Scalar(-1);
    switch (below(10)) {
      case 0: return sign * Limits::quiet_NaN();
      case 1: return sign * Limits::infinity();
      case 2: return sign * Limits::denorm_min();
      case 3: return sign * Limits::min() / Scalar(2);
      case 4: return sign * Scalar(1e30);
      case 5: return sign * Scalar(0);
      case 6: return sign * Limits::max();
      case 7: return sign * Limits::min();
      case 8: return Limits::signaling_NaN();
      default: return random_bits();
    }
  }

  /// Ordinary where `spoiled` is 0; else that many of its 16 numbers are hostile.
  MotionInputs<Scalar> inputs(std::uint64_t spoiled) {
    MotionInputs<Scalar> result;
    const Scalar size = below(4) == 0 ? Scalar(3) : Scalar(0.9);
    for (int i = 0; i < 3; ++i) {
      result.linear_acceleration_m_s2[i] = uniform(Scalar(9) * size);
      result.angular_acceleration_rad_s2[i] = uniform(Scalar(5) * size);
      result.velocity_m_s[i] = uniform(Scalar(6) * size);
      result.body_rates_rad_s[i] = uniform(Scalar(3) * size);
    }
    result.attitude = from_euler(EulerAngles<Scalar>{uniform(Scalar(0.7)), uniform(Scalar(0.7)), uniform(Scalar(3))});
    if (below(8) == 0) spoil_attitude(result.attitude);
    for (std::uint64_t i = 0; i < spoiled; ++i) *pinnquad::test::numbers_of(result)[below(16)] = value();
    return result;
  }

 private:
  void spoil_attitude(Quaternion<Scalar>& q) {
    const Scalar scale = uniform(Scalar(3));
    switch (below(5)) {
      case 0: q = {Scalar(0), Scalar(0), Scalar(0), Scalar(0)}; break;
      case 1: q = {q.w * scale, q.x * scale, q.y * scale, q.z * scale}; break;
      case 2: q.y = std::numeric_limits<Scalar>::quiet_NaN(); break;
      case 3: q = {random_bits(), random_bits(), random_bits(), random_bits()}; break;
      default: q = {value(), value(), value(), value()};
    }
  }

  std::mt19937_64 engine_;
};

template <class Scalar>
bool sound(const MotionInputs<Scalar>& inputs) {
  MotionInputs<Scalar> copy = inputs;
  bool finite = true;
  for (const Scalar* number : pinnquad::test::numbers_of(copy)) finite = finite && std::isfinite(*number);
  return finite;
}

template <class Scalar>
bool unit(const MotionInputs<Scalar>& in) {
  const double w = double(in.attitude.w), x = double(in.attitude.x), y = double(in.attitude.y),
               z = double(in.attitude.z);
  return std::fabs(w * w + x * x + y * y + z * z - 1) <= 1.001e-3;  // the tolerance, and rounding of the sum
}

/// Far from what a rotor can do, but not absurd.
struct WideCommands {
  static constexpr double lower = -50.0;
  static constexpr double upper = 50.0;
};

/// Faults, by rule; all must stay 0.
struct Broken {
  int not_finite_written = 0;  ///< a command that is NaN or infinite
  int touched = 0;             ///< commands changed though the Status has no output
  int bad_input_answered = 0;  ///< the network answered a NaN, an infinity or (where inputs are checked) a bad attitude
  int bad_input_fell_back = 0;     ///< the analytic inverse answered one
  int outside_limits_written = 0;  ///< a command outside the guard's limits
  int report_differs = 0;          ///< the overload with a report gives another Status or other bits
  int features_differ = 0;         ///< predict_features() answers what is not finite, or writes it
};

template <class Guard, class Scalar>
bool within_limits(const Commands<Scalar>& commands) {
  if (!Guard::clips_commands && !Guard::refuses_commands) return true;
  bool inside = true;
  for (const Scalar u : commands) inside = inside && u >= Scalar(0) && u <= Scalar(1);
  return inside;
}

template <class Inverse>
struct Attack {
  using Scalar = typename Inverse::Scalar;
  using Guard = typename Inverse::Guard;

  Broken broken;
  std::array<int, static_cast<std::size_t>(status_count)> by_status{};
  int worst_named_inside = 0;

  void operator()(const Inverse& inverse, std::uint64_t seed) {
    Hostility<Scalar> hostility(seed);
    for (int i = 0; i < inputs_per_guard; ++i) {
      const auto inputs = hostility.inputs(hostility.below(3) == 0 ? 0 : 1 + hostility.below(4));
      PlaceAndTime<Scalar> place;
      place.position_m = Vector3<Scalar>(hostility.uniform(Scalar(50)), Scalar(0), -Scalar(2));
      if (hostility.below(4) == 0) place.position_m[2] = hostility.value();
      if (hostility.below(4) == 0) place.time_s = hostility.value();
      one(inverse, inputs, place);
      if (i % 4 == 0) features(inverse, hostility);
    }
  }

 private:
  void one(const Inverse& inverse, const MotionInputs<Scalar>& inputs, const PlaceAndTime<Scalar>& place) {
    Commands<Scalar> commands = marked<Scalar>(), reported = marked<Scalar>();
    typename Inverse::Report report;
    const Status status = inverse.predict(inputs, place, commands);
    ++by_status[static_cast<std::size_t>(status)];
    const Status again = inverse.predict(inputs, place, reported, report);
    if (again != status || !same_bits(commands, reported)) ++broken.report_differs;
    const bool named = report.worst_feature >= 0;
    if (named && report.cause == Status::ok && Guard::refuses_outside_envelope) {
      ++worst_named_inside;
    }
    if (!has_output(status)) {
      if (!same_bits(commands, marked<Scalar>())) ++broken.touched;
      return;
    }
    for (const Scalar u : commands) {
      if (!std::isfinite(u)) ++broken.not_finite_written;
    }
    if (!within_limits<Guard>(commands)) ++broken.outside_limits_written;
    const bool good = sound(inputs) && (unit(inputs) || !Guard::checks_inputs);
    if (!good && status != Status::fell_back) ++broken.bad_input_answered;
    if (!good && status == Status::fell_back) ++broken.bad_input_fell_back;
  }

  void features(const Inverse& inverse, Hostility<Scalar>& hostility) {
    Scalar x[16];
    for (std::size_t i = 0; i < 16; ++i) x[i] = static_cast<Scalar>(SmallModel::golden_features[2][i]);
    for (std::uint64_t i = hostility.below(4); i > 0; --i) x[hostility.below(16)] = hostility.value();
    bool finite = true;
    for (const Scalar v : x) finite = finite && std::isfinite(v);
    Commands<Scalar> commands = marked<Scalar>();
    const Status status = inverse.predict_features(x, commands.data());
    if (has_output(status)) {
      for (const Scalar u : commands) {
        if (!std::isfinite(u) || !finite) ++broken.features_differ;
      }
    } else if (!same_bits(commands, marked<Scalar>())) {
      ++broken.touched;
    }
  }
};

template <class Guard, class Model>
void attack(const char* name, const InverseDynamics<Model, Guard>& inverse, std::uint64_t seed) {
  Attack<InverseDynamics<Model, Guard>> result;
  result(inverse, seed);
  CAPTURE(name);
  CHECK(result.broken.not_finite_written == 0);
  CHECK(result.broken.touched == 0);
  CHECK(result.broken.bad_input_answered == 0);
  CHECK(result.broken.bad_input_fell_back == 0);
  CHECK(result.broken.outside_limits_written == 0);
  CHECK(result.broken.report_differs == 0);
  CHECK(result.broken.features_differ == 0);
  CHECK(result.worst_named_inside == 0);
  const auto count = [&](Status status) { return result.by_status[static_cast<std::size_t>(status)]; };
  CHECK(count(Status::ok) > inputs_per_guard / 20);  // or nothing was tried
  CHECK((count(Status::not_finite) > inputs_per_guard / 20) == Guard::checks_inputs);
  CHECK((count(Status::not_unit_quaternion) > inputs_per_guard / 50) == Guard::checks_inputs);
  if (Guard::refuses_outside_envelope && !Guard::falls_back) CHECK(count(Status::outside_envelope) > 1000);
  if (Guard::falls_back && Guard::refuses_outside_envelope) CHECK(count(Status::fell_back) > 1000);
}

template <class Scalar>
using Calm = Quadrotor<Scalar, QuadraticDrag>;
template <class Scalar>
using Gusty = Quadrotor<Scalar, StandardAtmosphere, PeriodicWind, QuadraticDrag, GroundEffect<Conyers>>;

template <class Vehicle, class Scalar>
AnalyticInverse<Vehicle> by_formula() {
  return AnalyticInverse<Vehicle>(Vehicle(airframe_value<PaperQuadrotor, Scalar>(), paper_site<Scalar>()));
}

template <class Model>
void attack_all() {
  using Scalar = typename Model::Scalar;
  using CalmFallback = Fallback<AnalyticInverse<Calm<Scalar>>>;
  using GustyFallback = Fallback<AnalyticInverse<Gusty<Scalar>>>;
  using Unchecked = Guard<TrainingEnvelope>;
  using Anywhere = Guard<FiniteInputs>;
  using UncheckedFallingBack = Extend<Unchecked, CalmFallback>;
  using Everything = Extend<TrainingGuard, RefuseCommands<WideCommands>, ClipCommands<>, GustyFallback>;
  const auto calm = by_formula<Calm<Scalar>, Scalar>();
  const auto gusty = by_formula<Gusty<Scalar>, Scalar>();

  attack("training guard", InverseDynamics<Model>{}, 1);
  attack("no envelope, clipped", InverseDynamics<Model, Extend<Anywhere, ClipCommands<>>>{}, 7);
  attack("inputs unchecked, fallback", InverseDynamics<Model, UncheckedFallingBack>(UncheckedFallingBack(calm)), 9);
  attack("everything, gusty fallback", InverseDynamics<Model, Everything>(Everything(gusty)), 10);
}

}  // namespace

TEST_CASE("hostile inputs: no surprise") {
  attack_all<SmallModel>();
  attack_all<DoubleModel>();
}
