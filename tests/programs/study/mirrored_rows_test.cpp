// SPDX-License-Identifier: MIT
// Mirror images and turned flights against the equations of motion: what a vehicle does under the mirrored commands is
// the mirror image of what it does, and a heading changes nothing in the body's frame.
#include "study/mirrored_rows.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/dynamics/airframes/racer_5_inch.hpp"
#include "pinnquad/dynamics/rotor.hpp"

using namespace pinnquad;
using study::mirror_of, study::mirrored, study::RotorMirror, study::SymmetricRows, study::turned;

namespace {

constexpr double tolerance = 1e-12;  ///< of sums of a few doubles

Sample any_sample(std::mt19937_64& engine) {
  Sample sample;
  for (int i = 0; i < 3; ++i) {
    sample.velocity_m_s[i] = uniform(engine, -5, 5);
    sample.body_rates_rad_s[i] = uniform(engine, -4, 4);
  }
  sample.roll_rad = uniform(engine, -1, 1);
  sample.pitch_rad = uniform(engine, -1, 1);
  sample.yaw_rad = uniform(engine, -3, 3);
  sample.altitude_m = uniform(engine, 1, 9);
  for (double& command : sample.commands) command = uniform(engine, 0, 1);
  return sample;
}

/// Newton and Euler, written down once more: thrust, gravity and a drag along each body axis.
void take_accelerations(const Airframe<double>& airframe, Sample& sample) {
  const AllocationMatrix<double> matrix = allocation(airframe);
  double wrench[4] = {};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t i = 0; i < rotor_count; ++i) wrench[row] += matrix[row][i] * sample.commands[i];
  }
  const Vector3<double>& w = sample.body_rates_rad_s;
  const Vector3<double>& v = sample.velocity_m_s;
  const double sr = std::sin(sample.roll_rad), cr = std::cos(sample.roll_rad), sp = std::sin(sample.pitch_rad),
               cp = std::cos(sample.pitch_rad), g = 9.80665;
  Vector3<double> force(-g * sp, g * sr * cp, g * cr * cp - wrench[0] / airframe.mass_kg);
  for (int i = 0; i < 3; ++i) force[i] -= 0.1 * std::abs(v[i]) * v[i];
  sample.linear_acceleration_m_s2 = force - cross<double>(w, v);
  const auto& j = airframe.inertia_kg_m2;
  sample.angular_acceleration_rad_s2 = {(wrench[1] - (j[2] - j[1]) * w[1] * w[2]) / j[0],
                                        (wrench[2] - (j[0] - j[2]) * w[2] * w[0]) / j[1],
                                        (wrench[3] - (j[1] - j[0]) * w[0] * w[1]) / j[2]};
}

void check_alike(const Sample& a, const Sample& b) {
  const Sample::Values left = to_values(a), right = to_values(b);
  for (std::size_t i = 0; i < left.size(); ++i)
    CHECK(left[i] == doctest::Approx(right[i]).epsilon(tolerance).scale(10));
}

}  // namespace

TEST_CASE_TEMPLATE("what mirrored commands do is the mirror image of what the commands do", Vehicle, PaperQuadrotor,
                   Racer5Inch, Crazyflie) {
  const auto airframe = airframe_value<Vehicle, double>();
  const RotorMirror mirror = mirror_of(airframe);
  REQUIRE(mirror.exists);
  CHECK(mirror.partner == std::array<int, 4>{2, 3, 0, 1});  // front right and front left, rear left and rear right
  std::mt19937_64 engine(1);
  for (int i = 0; i < 50; ++i) {
    Sample sample = any_sample(engine);
    Sample image = mirrored(sample, mirror);
    take_accelerations(airframe, sample);
    take_accelerations(airframe, image);
    check_alike(image, mirrored(sample, mirror));
    check_alike(mirrored(mirrored(sample, mirror), mirror), sample);
    Sample elsewhere = turned(sample, 1.3);
    take_accelerations(airframe, elsewhere);
    check_alike(elsewhere, turned(sample, 1.3));
    CHECK(std::abs(elsewhere.yaw_rad - sample.yaw_rad) > 1);
  }
}

TEST_CASE("a vehicle whose left is not its right has no mirror image") {
  const auto sound = PaperQuadrotor::value<double>();
  const Flight flight(3);
  CHECK(mirrored(flight, sound).size() == 3);
  const auto refused = [&](const auto& bend) {
    auto airframe = sound;
    bend(airframe);
    CHECK(!mirror_of(airframe).exists);
    CHECK_THROWS_AS(mirrored(flight, airframe), std::invalid_argument);
  };
  refused([](auto& a) { a.rotors[0].y_m += 0.01; });
  refused([](auto& a) { a.rotors[3].x_m -= 0.01; });
  refused([](auto& a) { a.rotors[1].thrust_scale = 0.95; });
  refused([](auto& a) { a.rotors[2].axis = {0, 0.1, -0.995}; });
  refused([](auto& a) { a.rotors[2].spin = a.rotors[0].spin; });
  refused([](auto& a) { a.inertia_products_kg_m2[0] = 0.1 * a.inertia_kg_m2[0]; });
  refused([](auto& a) { a.inertia_products_kg_m2[2] = 0.1 * a.inertia_kg_m2[0]; });
  auto leaning = sound;  // forward: left as right
  leaning.inertia_products_kg_m2[1] = 0.1 * sound.inertia_kg_m2[0];
  leaning.rotors[0].axis = leaning.rotors[2].axis = {0.1, 0, -0.995};
  CHECK(mirror_of(leaning).exists);

  Flight with_column(3);
  with_column.add_column({{"wind_y", "m/s"}, {1, 2, 3}});
  CHECK_THROWS_AS(mirrored(with_column, sound), std::invalid_argument);
  CHECK_THROWS_AS(turned(with_column, 1), std::invalid_argument);
}

TEST_CASE("rows beside their mirror images and under other headings: how many, and which") {
  std::mt19937_64 engine(2);
  Flight flight;
  for (int i = 0; i < 20; ++i) {
    flight.push_back(any_sample(engine));
    flight[std::size_t(i)].time_s = i;
  }
  const auto airframe = PaperQuadrotor::value<double>();
  const SymmetricRows rows(RowSet(flight, {5, 15}), airframe, {true, true}, engine);
  REQUIRE(rows.rows().size() == 40);
  REQUIRE(rows.rows().pieces().size() == 4);
  CHECK(rows.rows().pieces()[0].flight == &flight);
  const Flight& image = *rows.rows().pieces()[1].flight;
  check_alike(image[7], mirrored(flight[7], mirror_of(airframe)));
  const Flight& other = *rows.rows().pieces()[3].flight;  // mirrored and turned
  CHECK(std::abs(other[7].yaw_rad - image[7].yaw_rad) > 1e-3);
  check_alike(turned(other[7], image[7].yaw_rad - other[7].yaw_rad), image[7]);
  CHECK(std::abs((other[8].yaw_rad - image[8].yaw_rad) - (other[7].yaw_rad - image[7].yaw_rad)) > 1e-3);
}
