// SPDX-License-Identifier: MIT
#include "pinnquad/core/lanes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/battery.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/dryden.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_contact.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/payload.hpp"
#include "pinnquad/aero/rotor_fault.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/vehicle/lanes_of_vehicles.hpp"
#include "support/random_states.hpp"
#include "support/uneven_airframe.hpp"

namespace {

using namespace pinnquad;
using pinnquad::test::RandomStates;

template <class Value>
bool same_bits(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Each lane's own: numbers up to 5 % off, and of every four the second one is uneven, the fourth has tilted rotors of
/// one lag. The lanes of a quarter of the draws are all of the plain kind.
template <class Scalar>
Airframe<Scalar> drawn_airframe(RandomStates& random, int draw, int lane) {
  const bool general = draw % 4 != 0;
  Airframe<Scalar> a =
      general && lane % 4 == 1 ? pinnquad::test::uneven_airframe<Scalar>() : PaperQuadrotor::value<Scalar>();
  const auto vary = [&](Scalar& number) { number *= random.scalar<Scalar>(0.95, 1.05); };
  vary(a.mass_kg);
  for (Scalar& moment : a.inertia_kg_m2) vary(moment);
  vary(a.thrust_coefficient);
  vary(a.power_coefficient);
  vary(a.rotor_time_constant_s);
  for (Scalar& area : a.drag_area_m2) vary(area);
  for (auto& rotor : a.rotors) {
    vary(rotor.x_m);
    vary(rotor.y_m);
    vary(rotor.thrust_scale);
    if (general && lane % 4 == 3) rotor.axis = {Scalar(0.6), Scalar(0), Scalar(-0.8)};
  }
  return a;
}

/// Some effects, with an airframe of its own in each lane: `steps` steps, lane by lane the bits of the scalar vehicle.
template <class Wide, class... Effects>
void check_lanes(const Effects&... effects) {
  using Scalar = typename Wide::Scalar;
  constexpr int lanes = Wide::count, draws = 12, steps = 8;
  const Scalar step_s = Scalar(0.002), nan = std::numeric_limits<Scalar>::quiet_NaN();
  RandomStates random(41);
  int refused = 0, flown = 0;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<Quadrotor<Scalar, Effects...>> alone;
    std::vector<VehicleState<Scalar>> state(lanes);
    std::vector<Commands<Scalar>> command(lanes);
    Airframe<Wide> airframes = in_every_lane<Wide>(PaperQuadrotor::value<Scalar>());
    Site<Wide> site;
    site.elevation_m = Wide(122), site.ground_z_m = Wide(0.877);
    VehicleState<Wide> states;
    Commands<Wide> commands;
    for (int lane = 0; lane < lanes; ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      Airframe<Scalar> airframe = drawn_airframe<Scalar>(random, draw, lane);
      state[i].body = random.state<Scalar>();
      state[i].body.position_m[2] = random.scalar<Scalar>(-3, 1);
      state[i].time_s = static_cast<double>(random.scalar<Scalar>(0, 10));
      for (Scalar& u : state[i].rotors) u = random.scalar<Scalar>(0.3, 0.7);
      for (Scalar& u : command[i]) u = random.scalar<Scalar>(-0.1, 1.1);
      switch (random.engine()() % 40) {  // one lane in some is refused, each for its own reason
        case 0: state[i].body.velocity_m_s[1] = nan; break;
        case 1: command[i][2] = nan; break;
        case 2: state[i].body.attitude.w += Scalar(0.5); break;
        case 3: state[i].body.body_rates_rad_s[0] = Scalar(4000); break;
        case 4: state[i].body.position_m[2] = Scalar(-2e4); break;
        case 5: airframe.mass_kg = Scalar(-1); break;
        case 6: state[i].time_s = 1e13; break;
        case 7: state[i].body.velocity_m_s[0] = std::numeric_limits<Scalar>::max(); break;
        default: break;
      }
      alone.emplace_back(airframe, paper_site<Scalar>(), effects...);
      REQUIRE(set_lane(airframes, lane, airframe));
      set_lane(states, lane, state[i]);
      set_lane(commands, lane, command[i]);
    }
    const Quadrotor<Wide, Effects...> together(airframes, site, effects...);
    for (int step = 0; step < steps; ++step) {
      const Outcome<Wide> outcome = together.step(states, commands, Wide(step_s));
      for (int lane = 0; lane < lanes; ++lane) {
        const auto i = static_cast<std::size_t>(lane);
        CAPTURE(lane);
        CAPTURE(step);
        CAPTURE(draw);
        const Status status = alone[i].step(state[i], command[i], step_s);
        REQUIRE(to_string(outcome.lane(lane)) == std::string(to_string(status)));
        status == Status::ok ? ++flown : ++refused;
        const VehicleState<Scalar> of_lane = lane_of(states, lane);
        REQUIRE(same_bits(of_lane.body.position_m, state[i].body.position_m));
        REQUIRE(same_bits(of_lane.body.velocity_m_s, state[i].body.velocity_m_s));
        REQUIRE(same_bits(of_lane.body.attitude, state[i].body.attitude));
        REQUIRE(same_bits(of_lane.body.body_rates_rad_s, state[i].body.body_rates_rad_s));
        REQUIRE(same_bits(of_lane.rotors, state[i].rotors));
        REQUIRE(same_bits(of_lane.time_s, state[i].time_s));
      }
    }
  }
  CHECK(refused > 0);
  CHECK(flown > refused);
}

using OneRegister = Lanes<double, native_lanes<double>>;
using TwoRegisters = Lanes<double, 2 * native_lanes<double>>;
using Floats = Lanes<float, native_lanes<float>>;

}  // namespace

TEST_CASE_TEMPLATE("each lane of a step has the bits of the vehicle alone: bare", Wide, OneRegister, TwoRegisters,
                   Floats) {
  check_lanes<Wide>();
}

TEST_CASE_TEMPLATE("each lane of a step has the bits of the vehicle alone: air, wind, drag, ground", Wide, OneRegister,
                   Floats) {
  check_lanes<Wide>(StandardAtmosphere{}, ConstantWind{{1, -2, 0.5}}, PeriodicWind{}, QuadraticDrag{},
                    GroundEffect<Conyers>{});
}

TEST_CASE_TEMPLATE("each lane of a step has the bits of the vehicle alone: all other effects", Wide, OneRegister,
                   Floats) {
  std::mt19937_64 engine(3);
  check_lanes<Wide>(DrydenTurbulence<>(engine, DrydenParameters::low_altitude(2.0, 30.0), 3.0), Battery{4, 0.01, 0.9},
                    LinearDamping{}, RotorDrag{}, Inflow{}, BladeFlapping{}, Wake{},
                    RotorGroundEffect<CheesemanBennett>{}, GroundEffect<CheesemanBennett>{}, RotorFault{1, 0.7, 5.0},
                    GroundContact{}, Payload{0.3, 4.0});
}

TEST_CASE("a NaN in one lane leaves the others' flight untouched") {
  using Wide = TwoRegisters;
  const auto airframes = in_every_lane<Wide>(PaperQuadrotor::value<double>());
  const Quadrotor<Wide, QuadraticDrag> vehicles(airframes);
  const Commands<Wide> commands{Wide(0.6), Wide(0.5), Wide(0.55), Wide(0.52)};
  VehicleState<Wide> whole, broken;
  broken.body.position_m[0].set_lane(1, std::nan(""));
  for (int i = 0; i < 50; ++i) {
    CHECK(all_of(vehicles.step(whole, commands, Wide(0.002)) == Status::ok));
    const Outcome<Wide> outcome = vehicles.step(broken, commands, Wide(0.002));
    for (int lane = 0; lane < Wide::count; ++lane) {
      CHECK(outcome.lane(lane) == (lane == 1 ? Status::not_finite : Status::ok));
      if (lane != 1) CHECK(same_bits(lane_of(whole, lane).body, lane_of(broken, lane).body));
    }
  }
}

TEST_CASE("an airframe whose rotors turn the other way has no lane among these") {
  using Wide = OneRegister;
  Airframe<Wide> all = in_every_lane<Wide>(PaperQuadrotor::value<double>());
  Airframe<double> other = PaperQuadrotor::value<double>();
  std::swap(other.rotors[0].spin, other.rotors[2].spin);
  other.mass_kg = 9;
  CHECK(!set_lane(all, 0, other));
  CHECK(all.mass_kg.lane(0) == PaperQuadrotor::value<double>().mass_kg);
}

TEST_CASE_TEMPLATE("lanes compute, compare and choose each for itself", Wide, OneRegister, TwoRegisters, Floats) {
  using Scalar = typename Wide::Scalar;
  RandomStates random(5);
  for (int draw = 0; draw < 50; ++draw) {
    Wide a, b;
    for (int i = 0; i < Wide::count; ++i) {
      a.set_lane(i, random.scalar<Scalar>(-4, 4));
      b.set_lane(i, i % 3 == 0 ? a.lane(i) : random.scalar<Scalar>(-4, 4));
    }
    const Wide least = select(a < b, a, b), root = sqrt(a * a), whole = floor(a), grown = exp(a);
    const auto equal = pinnquad::detail::equal(a, b);
    for (int i = 0; i < Wide::count; ++i) {
      const Scalar x = a.lane(i), y = b.lane(i);
      CHECK(least.lane(i) == (x < y ? x : y));
      CHECK(root.lane(i) == std::sqrt(x * x));
      CHECK(whole.lane(i) == std::floor(x));
      CHECK(grown.lane(i) == std::exp(x));
      CHECK((a / b).lane(i) == x / y);
      CHECK((-a).lane(i) == -x);
      CHECK(equal.lane(i) == (i % 3 == 0));
      CHECK(sine_of_turns(a).lane(i) == sine_of_turns(x));
      CHECK(cosine_of_turns(a).lane(i) == cosine_of_turns(x));
    }
    CHECK(any_of(equal));
    CHECK(!all_of(equal));
    CHECK(all_of(equal || !equal));
    CHECK(!any_of(equal && !equal));
  }
  CHECK(std::signbit(Wide(Scalar(-0.0)).lane(0)));
  constexpr auto infinite = std::numeric_limits<double>::infinity();
  for (const double special :
       {-0.0, -0.25, 0x1p31, -0x1p31, 0x1p31 + 0.5, -0x1p31 - 0.5, 0x1p52 - 0.5, -1e30, infinite}) {
    Wide held(Scalar(0.75));  // beside a usual number
    const auto x = static_cast<Scalar>(special);
    held.set_lane(1, x);
    CHECK(same_bits(floor(held).lane(1), std::floor(x)));
    CHECK(same_bits(absolute(held).lane(1), std::abs(x)));
    CHECK(same_bits(floor(held).lane(0), Scalar(0)));
  }
  Wide odd(1);
  CHECK(all_of(is_finite(odd)));
  odd.set_lane(1, std::numeric_limits<Scalar>::infinity());
  CHECK(is_finite(odd).lane(0));
  CHECK(!is_finite(odd).lane(1));
}
