// SPDX-License-Identifier: MIT
// Limits of a vehicle, for pilots: the rotor with most to do decides, in thrust and not in commands.
#include "pinnquad/simulation/flights.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "pinnquad/aero/drag.hpp"
#include "support/uneven_airframe.hpp"

using namespace pinnquad;

TEST_CASE(
    "hover takes the share of thrust that leaves the controller's limit, of even rotors and of uneven ones with "
    "curves") {
  for (Airframe<double> airframe : {PaperQuadrotor::value<double>(), test::uneven_airframe<double>()}) {
    airframe.mass_kg *= 1.4;
    const Quadrotor<double> quadrotor(airframe, Site<double>{});
    const double hover = hover_command(quadrotor, Vector3<double>::Zero());
    CHECK(flight_limits(airframe, 1.0).max_specific_force_m_s2 ==
          doctest::Approx(0.97 * standard_gravity_m_s2<double> / hover).epsilon(1e-12));
  }
}

TEST_CASE(
    "the first rotor is not asked alone: a vehicle whose others work harder climbs as slowly as its mirror image") {
  Airframe<double> front = PaperQuadrotor::value<double>(), rear = front;
  for (auto& rotor : front.rotors) rotor.x_m -= 0.08;  // front rotors, the first among them, are nearer and give more
  for (auto& rotor : rear.rotors) rotor.x_m += 0.08;
  const PilotStyle a = pilot_style(Quadrotor<double, QuadraticDrag>(front, Site<double>{}, {}),
                                   Vector3<double>::Zero()),
                   b = pilot_style(Quadrotor<double, QuadraticDrag>(rear, Site<double>{}, {}), Vector3<double>::Zero());
  CHECK(a.max_climb_m_s == doctest::Approx(b.max_climb_m_s));
  CHECK(a.max_yaw_rate_rad_s == doctest::Approx(b.max_yaw_rate_rad_s));
  CHECK(a.max_climb_m_s <
        pilot_style(Quadrotor<double, QuadraticDrag>(PaperQuadrotor::value<double>(), Site<double>{}, {}),
                    Vector3<double>::Zero())
            .max_climb_m_s);
}

namespace {

/// The share of its greatest thrust that a vehicle with this drag needs on its way up or down at constant speed, in air
/// of the rated density, from the drag's own formula.
struct Vertical {
  explicit Vertical(const Airframe<double>& airframe)
      : hover(1 / airframe.thrust_to_weight()),
        drag_per_weight_s2_m2(airframe.drag_area_m2[2] * 1.225 / (airframe.mass_kg * 9.80665)) {}
  double speed_m_s(double drag_over_weight) const { return std::sqrt(drag_over_weight / drag_per_weight_s2_m2); }
  double hover, drag_per_weight_s2_m2;
};

PilotStyle style_of(const Airframe<double>& airframe) {
  return pilot_style(Quadrotor<double, QuadraticDrag>(airframe, Site<double>{}, {}), Vector3<double>::Zero());
}

constexpr double search_step_m_s = 8.0 / 80;

}  // namespace

TEST_CASE("climb: 60 % of the thrust above hover; descent: 35 % of the hover's is left, and 1.5 times the climb") {
  const auto just_below = [](double value, double limit) {
    CHECK(value <= limit);
    CHECK(value > limit - search_step_m_s);
  };
  Airframe<double> airframe = PaperQuadrotor::value<double>();
  airframe.drag_area_m2[2] *= 2;
  const Vertical draggy(airframe);
  const PilotStyle style = style_of(airframe);
  just_below(style.max_climb_m_s, draggy.speed_m_s(0.6 * (1 - draggy.hover) / draggy.hover));
  just_below(style.max_descent_m_s, draggy.speed_m_s(1 - 0.35));
  REQUIRE(style.max_descent_m_s < 1.5 * style.max_climb_m_s - search_step_m_s);
  CHECK(style.max_yaw_rate_rad_s == PilotStyle{}.max_yaw_rate_rad_s);  // hover leaves more than 35 % of the thrust

  airframe.mass_kg *= 1.6;
  const Vertical heavy(airframe);
  const PilotStyle calm = style_of(airframe);
  just_below(calm.max_climb_m_s, heavy.speed_m_s(0.6 * (1 - heavy.hover) / heavy.hover));
  CHECK(calm.max_descent_m_s == 1.5 * calm.max_climb_m_s);  // the drag would allow more
  const double share = (1 - heavy.hover) / 0.35;
  REQUIRE(share < 1);
  CHECK(calm.max_yaw_rate_rad_s == doctest::Approx(1.0 * share).epsilon(1e-9));
  CHECK(calm.thumbs.yaw_deviation_rad_s == doctest::Approx(0.062 * share).epsilon(1e-9));
  CHECK(calm.thumbs.roll_pitch_deviation_rad_s == doctest::Approx(0.21 * share).epsilon(1e-9));
  CHECK(calm.velocity_lag_s == doctest::Approx(0.45 / share).epsilon(1e-9));
}

TEST_CASE("near the ground: as calm as pilot_style, and a third of what the thrust above hover gives") {
  Airframe<double> airframe = PaperQuadrotor::value<double>();
  airframe.mass_kg *= 1.75;
  const double hover = 1 / airframe.thrust_to_weight(), share = (1 - hover) / 0.35;
  const PilotStyle agile = style_of(airframe);
  const NearGroundStyle style =
      near_ground_style(Quadrotor<double, QuadraticDrag>(airframe, Site<double>{}, {}), Vector3<double>::Zero(), 1.0);
  const NearGroundStyle usual;
  CHECK(style.max_vertical_acceleration_m_s2 == doctest::Approx((1 / hover - 1) * 9.80665 / 3).epsilon(1e-9));
  CHECK(style.velocity_lag_s == doctest::Approx(usual.velocity_lag_s / share).epsilon(1e-9));
  CHECK(style.max_climb_m_s == std::min(usual.max_climb_m_s, agile.max_climb_m_s));
  CHECK(style.max_descent_m_s == std::min(usual.max_descent_m_s, agile.max_descent_m_s));
  CHECK(style.max_yaw_rate_rad_s == std::min(usual.max_yaw_rate_rad_s, agile.max_yaw_rate_rad_s));
  CHECK(style.thumbs.yaw_deviation_rad_s ==
        std::min(usual.thumbs.yaw_deviation_rad_s, agile.thumbs.yaw_deviation_rad_s));
  CHECK(style.thumbs.roll_pitch_deviation_rad_s ==
        std::min(usual.thumbs.roll_pitch_deviation_rad_s, agile.thumbs.roll_pitch_deviation_rad_s));
  CHECK(style.max_speed_m_s == 1.0);
  CHECK(style.hover_speed_m_s == std::min(usual.hover_speed_m_s, 1.0));
}
