// SPDX-License-Identifier: MIT
#include "pinnquad/features/shown_acceleration.hpp"

#include <doctest/doctest.h>

using namespace pinnquad;

namespace {

constexpr ShownAcceleration of_feature(std::string_view name, std::string_view unit) {
  return detail::shown_acceleration(name, unit, false);
}
constexpr ShownAcceleration of_column(std::string_view name, std::string_view unit) {
  return detail::shown_acceleration(name, unit, true);
}

/// A value that moves with the angular acceleration has this derivative by it, about each axis in turn.
template <class Part>
void names_say_what_moves() {
  MotionInputs<double> at;
  for (int i = 0; i < 3; ++i) at.body_rates_rad_s[i] = at.velocity_m_s[i] = 0.5 + i;
  for (int axis = 0; axis < 3; ++axis) {
    MotionInputs<double> more = at;
    more.angular_acceleration_rad_s2[axis] += 2;
    double x[Part::size], x_of_more[Part::size];
    Part::extract(at, static_cast<double*>(x));
    Part::extract(more, static_cast<double*>(x_of_more));
    for (int i = 0; i < Part::size; ++i) {
      const bool moves = x[i] < x_of_more[i] || x[i] > x_of_more[i];
      CAPTURE(Part::names[std::size_t(i)]);
      CHECK(moves == (detail::shown_acceleration_of<Part>(i) == static_cast<ShownAcceleration>(axis)));
      CHECK(detail::shown_acceleration_of<Part>(i) != ShownAcceleration::unknown);
    }
  }
}

}  // namespace

TEST_CASE_TEMPLATE("each feature of the library moves with the angular acceleration that its name says, or with none",
                   Part, NamedFeatures, PaperFeatures, PhysicsFeatures, InverseFeatures) {
  names_say_what_moves<Part>();
}

TEST_CASE("another tap shows the same, another unit or name nobody knows") {
  CHECK(of_feature("wdot_y[-3]", "rad/s^2") == ShownAcceleration::about_y);
  CHECK(of_feature("wdot_z[+1]", "rad/s^2") == ShownAcceleration::about_z);
  CHECK(of_feature("w_z[+1]", "rad/s") == ShownAcceleration::none);
  CHECK(of_feature("altitude", "m") == ShownAcceleration::none);
  for (const auto& [name, unit] :
       {std::pair{"wdot_x", "deg/s^2"}, {"w_x", "rad/s^2"}, {"altitude", "ft"}, {"effort", "1"}, {"wdot", "rad/s^2"}}) {
    CHECK(of_feature(name, unit) == ShownAcceleration::unknown);
  }
}

TEST_CASE("a column stands, but for one that may be an angular acceleration, or a torque, by its name or unit") {
  for (const char* unit : {"V", "m/s", "m/s^2", "mm/s^2", "m s^-2", "N", "1", "rad/s", "%", ""}) {
    CAPTURE(unit);
    CHECK(of_column("anything", unit) == ShownAcceleration::none);
  }
  for (const char* unit : {"rad/s^2", "mrad/s^2", "deg/s/s", "1/s^2", "rad s^-2", "rev/s2", "N m", "mN*m", "Nm"}) {
    CAPTURE(unit);
    CHECK(of_column("anything", unit) == ShownAcceleration::unknown);
  }
  CHECK(of_column("wdot_filtered[-1]", "1") == ShownAcceleration::unknown);
}
