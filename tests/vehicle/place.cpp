// SPDX-License-Identifier: MIT
// Effects that see where the vehicle is: the downwash of a neighbour above, the pull of a cable that is paid out.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/vehicle/inverse.hpp"

using namespace pinnquad;

namespace {

/// Pushes down by `strength_N` right below the neighbour, less by a Gaussian of the horizontal distance.
struct Downwash {
  std::array<double, 3> neighbour_m{};  ///< NED
  double strength_N{1.0};
  double width_m{0.5};

  template <class Scalar>
  Wrench<Scalar> wrench(const PlaceCondition<Scalar>& condition, const Airframe<Scalar>&) const noexcept {
    using std::exp;
    const Scalar north = condition.position_m[0] - Scalar(neighbour_m[0]);
    const Scalar east = condition.position_m[1] - Scalar(neighbour_m[1]);
    const Scalar share = exp(-(north * north + east * east) / Scalar(width_m * width_m));
    Wrench<Scalar> result;
    result.force_N = world_to_body<Scalar>(condition.attitude, {Scalar(0), Scalar(0), Scalar(strength_N) * share});
    return result;
  }
};

/// Brakes by the speed over ground, more where the rotors pull harder.
struct Cable {
  template <class Scalar>
  Wrench<Scalar> wrench(const PlaceAndRotorCondition<Scalar>& condition, const Airframe<Scalar>&) const noexcept {
    const Scalar pull = Scalar(0.01) * -condition.rotors.force_N[2];
    Wrench<Scalar> result;
    result.force_N = world_to_body<Scalar>(condition.attitude, Vector3<Scalar>(-pull * condition.ground_velocity_m_s));
    return result;
  }
};

static_assert(uses_place<Downwash> && !uses_rotor_wrench<Downwash>);
static_assert(uses_place<Cable> && uses_rotor_wrench<Cable>);
static_assert(!uses_place<QuadraticDrag>);
static_assert(varies_with<Downwash> == VariesWith::place_and_time);

const Airframe<double> airframe = PaperQuadrotor::value<double>();

State<double> somewhere() {
  State<double> state;
  state.position_m = {0.3, -0.4, -5.0};
  state.velocity_m_s = {1.0, -2.0, 0.5};
  state.attitude = normalized(Quaternion<double>{0.95, 0.2, -0.1, 0.15});
  state.body_rates_rad_s = {0.3, -0.2, 0.1};
  return state;
}

}  // namespace

TEST_CASE("a neighbour's downwash pushes as far as it stands away") {
  const Downwash downwash{{0.0, 0.0, -8.0}, 2.0, 0.5};
  const Quadrotor<double, QuadraticDrag, Downwash> near(airframe, {}, QuadraticDrag{}, downwash);
  const Quadrotor<double, QuadraticDrag> alone(airframe, {}, QuadraticDrag{});
  const State<double> state = somewhere();
  const Commands<double> u{0.5, 0.6, 0.4, 0.5};
  const auto with = near.evaluate(state, u, 0.0), without = alone.evaluate(state, u, 0.0);
  const Vector3<double> pushed =
      body_to_world<double>(state.attitude, with.aerodynamic.force_N - without.aerodynamic.force_N);
  CHECK(pushed[0] == doctest::Approx(0.0).epsilon(1e-12));
  CHECK(pushed[1] == doctest::Approx(0.0).epsilon(1e-12));
  CHECK(pushed[2] == doctest::Approx(2.0 * std::exp(-1.0)).epsilon(1e-12));  // 0.5 m away, 0.5 m wide
}

TEST_CASE("place, ground velocity and rotors together: braked by hand, and the inverse finds the commands again") {
  const Downwash downwash{{0.0, 0.0, -8.0}, 2.0, 0.5};
  const Quadrotor<double, Cable, Downwash> vehicle(airframe, {}, Cable{}, downwash);
  const State<double> state = somewhere();
  const Commands<double> u{0.5, 0.6, 0.4, 0.5};
  const auto there = vehicle.evaluate(state, u, 0.0);
  const double thrust = -there.rotors.force_N[2];
  const Vector3<double> force = body_to_world<double>(state.attitude, there.aerodynamic.force_N);
  CHECK(force[0] == doctest::Approx(-0.01 * thrust * 1.0));
  CHECK(force[1] == doctest::Approx(0.01 * thrust * 2.0));
  CHECK(force[2] == doctest::Approx(-0.01 * thrust * 0.5 + 2.0 * std::exp(-1.0)));

  Commands<double> again{};
  REQUIRE(inverse_commands(vehicle, state, there.motion, 0.0, again) == Status::ok);
  for (std::size_t i = 0; i < rotor_count; ++i) CHECK(again[i] == doctest::Approx(u[i]).epsilon(1e-10));
}
