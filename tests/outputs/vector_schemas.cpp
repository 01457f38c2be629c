// SPDX-License-Identifier: MIT
// Schemas of wrenches and accelerations on an airframe whose rotors differ, tilt and have curves, and whose inertia has
// products: there and back, and slopes against central differences.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/linearized.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "support/slope_differences.hpp"

using namespace pinnquad;

namespace {

Airframe<double> crooked() {
  Airframe<double> airframe = PaperQuadrotor::value<double>();
  airframe.inertia_products_kg_m2 = {1.1e-3, -0.7e-3, 0.4e-3};
  const double lean = 0.1, upright = std::sqrt(1 - 2 * lean * lean);
  airframe.rotors[0].axis = {lean, -lean, -upright};
  airframe.rotors[1].thrust_scale = 0.9;
  airframe.rotors[2].z_m = 0.03;
  const double curves[] = {0.0, 0.3, 0.6, 1.0};
  for (std::size_t i = 0; i < rotor_count; ++i) airframe.rotors[i].thrust_curve = curves[i];
  REQUIRE(check_airframe(airframe) == Status::ok);
  REQUIRE(Rotors<double>(airframe).status() == Status::ok);
  return airframe;
}

constexpr std::array<double, rotor_count> some_commands = {0.31, 0.62, 0.44, 0.57};

}  // namespace

TEST_CASE_TEMPLATE("a vector schema on a crooked airframe: there and back, slopes", Schema, WrenchOutputs,
                   AccelerationOutputs) {
  const auto setting = Schema::prepare(crooked());
  double y[Schema::size], u[rotor_count], slopes[rotor_count * Schema::size];
  Schema::from_commands(static_cast<const double*>(nullptr), some_commands.data(), setting, y);
  Schema::commands(static_cast<const double*>(nullptr), y, setting, u);
  for (std::size_t i = 0; i < rotor_count; ++i) CHECK(u[i] == doctest::Approx(some_commands[i]).epsilon(1e-12));

  Schema::slopes(static_cast<const double*>(nullptr), static_cast<const double*>(y), setting, slopes);
  test::check_slopes(static_cast<double*>(y), Schema::size, slopes, [&](const double* outputs, double* commands) {
    Schema::commands(static_cast<const double*>(nullptr), outputs, setting, commands);
  });
}

TEST_CASE("a wrench and accelerations on a crooked airframe are what its rotors and its inertia make of commands") {
  const Airframe<double> airframe = crooked();
  const Wrench<double> made =
      Rotors<double>(airframe).wrench({some_commands[0], some_commands[1], some_commands[2], some_commands[3]}, 1.0);
  double wrench[4], motion[6];
  const double* const nothing = nullptr;
  WrenchOutputs::from_commands(nothing, some_commands.data(), WrenchOutputs::prepare(airframe), wrench);
  AccelerationOutputs::from_commands(nothing, some_commands.data(), AccelerationOutputs::prepare(airframe), motion);
  CHECK(wrench[0] == doctest::Approx(-made.force_N[2]).epsilon(1e-12));
  REQUIRE(std::abs(made.force_N[0]) > 0.1);  // a rotor leans
  const Vector3<double> torque = inertia_times(airframe, Vector3<double>(motion[3], motion[4], motion[5]));
  for (int axis = 0; axis < 3; ++axis) {
    CAPTURE(axis);
    CHECK(wrench[1 + axis] == doctest::Approx(made.torque_N_m[axis]).epsilon(1e-12));
    CHECK(motion[axis] * airframe.mass_kg == doctest::Approx(made.force_N[axis]).epsilon(1e-12));
    CHECK(torque[axis] == doctest::Approx(made.torque_N_m[axis]).epsilon(1e-10));
  }
}

TEST_CASE("the linearised inverse of features is Eq. (3) inverted") {
  const Airframe<double> airframe = crooked();
  const double x[6] = {0.3, -0.2, -1.1, 4.0, -3.0, 0.5};
  double u[rotor_count];
  LinearizedBase::commands(static_cast<const double*>(x), LinearizedBase::prepare(airframe), u);
  const Commands<double> expected = linearized_commands(airframe, Rotors<double>(airframe),
                                                        Accelerations<double>{{x[0], x[1], x[2]}, {x[3], x[4], x[5]}},
                                                        standard_gravity_m_s2<double>, 1.0);
  for (std::size_t i = 0; i < rotor_count; ++i) CHECK(u[i] == doctest::Approx(expected[i]).epsilon(1e-12));
}

TEST_CASE("the linearised inverse on a crooked airframe, of more features than it reads: slopes") {
  constexpr int features = PaperFeaturesWithAltitude::size;
  const auto prepared = LinearizedBase::prepare(crooked());
  double x[features] = {0.3, -0.2, -1.1, 4.0, -3.0, 0.5, 1, 2, 3, 0.1, 0.2, 0.3, 0.05, -0.06, 0.6, 0.8, 1.5};
  double slopes[rotor_count * features] = {};
  LinearizedBase::slopes<features>(static_cast<const double*>(x), prepared, slopes);
  test::check_slopes(static_cast<double*>(x), features, slopes, [&](const double* moved, double* commands) {
    LinearizedBase::commands(moved, prepared, commands);
  });
}
