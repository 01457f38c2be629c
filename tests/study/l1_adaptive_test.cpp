// SPDX-License-Identifier: MIT
// L1 adaptive control: the piecewise-constant law against its closed form, and on a vehicle with a payload.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/dynamics/airframes/light_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "study/known_drag.hpp"
#include "study/l1_adaptive.hpp"

using namespace pinnquad;
using namespace study;

namespace {

using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
using Inverse = KnownDrag<AnalyticInverse<Vehicle>, Vehicle>;
using Policy = L1Adaptive<double, Inverse, Vehicle>;

Vehicle vehicle_of(double mass) {
  Airframe<double> airframe = airframe_value<LightQuadrotor, double>();
  airframe.mass_kg *= mass;
  return Vehicle(airframe, paper_site<double>());
}
Policy policy() {
  const Vehicle known = vehicle_of(1);
  return Policy(Inverse(AnalyticInverse<Vehicle>(known), known), known);
}

}  // namespace

TEST_CASE("of z' = known + d the error after a period is -T d, the estimate a T e^-aT / (1 - e^-aT) d") {
  const double period_s = 0.002, a = 10, cutoff = 12, d = 3;
  L1Observer<double> observer;
  double z = 0.4;
  observer.start(z);
  const double kept = std::exp(-a * period_s);
  const double settled = a * period_s * kept / (1 - kept) * d;
  for (int n = 1; n <= 400; ++n) {
    const double known = std::sin(0.01 * n);
    z += period_s * (known + d);
    observer.update(z, known, period_s, a, cutoff, 100);
    const double filtered = settled * (1 - std::exp(-cutoff * period_s * n));
    REQUIRE(observer.estimate() == doctest::Approx(filtered).epsilon(1e-9));
  }
  CHECK(observer.estimate() == doctest::Approx(d).epsilon(0.02));  // e^-aT (...) is 1 - aT / 2
}

TEST_CASE("the low-pass is bounded, not the estimate") {
  L1Observer<double> observer;
  double z = 0;
  observer.start(z);
  for (int n = 0; n < 2000; ++n) {
    z += 0.002 * 7;
    observer.update(z, 0, 0.002, 5, 12, 4);
  }
  CHECK(observer.estimate() == 4);
}

TEST_CASE("a payload of 20 %: the figure-eight without and with it") {
  const Vehicle known = vehicle_of(1), heavy = vehicle_of(1.2);
  FigureEight<double> eight;
  eight.center_m = {0, 0, -20};
  const double scale = known.rotor_scale(known.surroundings({}, 0.0));
  const FlightController<double> feedback({}, flight_limits(known.airframe(), scale));
  const auto unseen = [](const auto&...) noexcept {};
  ExactWorld<Vehicle> world{heavy};
  const Inverse inverse(AnalyticInverse<Vehicle>(known), known);
  const double without = track(known, world, eight, feedback, inverse, {}, unseen).rmse_m;
  const double with = track(known, world, eight, feedback, policy(), {}, unseen).rmse_m;
  CHECK(with < 0.15 * without);
}
