// SPDX-License-Identifier: MIT
#include "study/known_drag.hpp"

#include <doctest/doctest.h>

#include <cstdint>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/tracking.hpp"

using namespace pinnquad;
using study::KnownDrag;

namespace {

using Draggy = Quadrotor<double, ConstantWind, LinearDamping>;

Airframe<double> airframe() { return airframe_value<PaperQuadrotor, double>(); }

struct Silent {
  Status operator()(const State<double>&, const Accelerations<double>&, std::uint64_t, Commands<double>&) noexcept {
    return Status::ok;
  }
};

}  // namespace

TEST_CASE("drag that is known: - k v / m across the thrust, in NED, relative to the air") {
  const LinearDamping drag{1.2, 0.0};
  const Draggy vehicle(airframe(), {}, ConstantWind{{-3, 1, 0}}, drag);
  const KnownDrag<Silent, Draggy> policy({}, vehicle);
  State<double> state;
  state.velocity_m_s = {4, -2, 1};
  state.attitude = from_euler<double>({0, 0, 0.7});  // the thrust points up: across is horizontal
  const Vector3<double> expected = Vector3<double>(4 + 3, -2 - 1, 0) * (-1.2 / airframe().mass_kg);
  CHECK((policy.across_m_s2(state) - expected).norm() <= 1e-12);
  // tilted, what acts along the thrust is not across
  state.attitude = from_euler<double>({0, 0.4, 0});
  const Vector3<double> down = body_down_axis(state.attitude);
  const Vector3<double> whole = Vector3<double>(7, -3, 1) * (-1.2 / airframe().mass_kg);
  CHECK((policy.across_m_s2(state) - (whole - down * down.dot(whole))).norm() <= 1e-12);
}

TEST_CASE("known drag leans the attitude: the error of the figure-eight falls") {
  using Vehicle = Quadrotor<double, StandardAtmosphere, QuadraticDrag>;
  const Vehicle vehicle(airframe(), paper_site<double>());
  FigureEight<double> eight;
  eight.center_m = {0, 0, -20};
  const FlightController<double> feedback({}, flight_limits(airframe(), 1.0));
  const AnalyticInverse<Vehicle> inverse(vehicle);
  const double without = track(vehicle, eight, feedback, inverse).rmse_m;
  const double with =
      track(vehicle, eight, feedback, KnownDrag<AnalyticInverse<Vehicle>, Vehicle>(inverse, vehicle)).rmse_m;
  CHECK(with < 0.5 * without);
}
