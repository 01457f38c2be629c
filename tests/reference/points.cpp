// SPDX-License-Identifier: MIT
// 1000 random states for each ground effect model, one evaluation each: force, torque, acceleration, density, and the
// way back. Every twentieth of them ships with the tests (test suite "shipped rows").
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "pinnquad/dynamics/airframes/reference_quadrotor.hpp"
#include "reference/reference_rows.hpp"
#include "support/compare_with_plain.hpp"

using pinnquad::test::differences;
using pinnquad::test::Differences;
using pinnquad::test::ReferenceTable;
using pinnquad::test::Statistics;

namespace {

/// How far a row may be off, twice what the worst one is: the simulator's constants are float32 and so are some of its
/// intermediate values, 6e-8 each. Accelerations are what is left of forces and torques that cancel.
struct Quantity {
  const char* name;
  double Differences::*of;
  double tolerance;
};
constexpr Quantity quantities[] = {{"density", &Differences::density, 2.8e-8},
                                   {"rotor force", &Differences::rotor_force, 3.3e-8},
                                   {"rotor torque", &Differences::rotor_torque, 4.9e-8},
                                   {"drag force", &Differences::drag_force, 3.1e-8},
                                   {"ground effect/rotors", &Differences::ground_force, 4e-8},
                                   {"linear acceleration", &Differences::acceleration, 3.4e-7},
                                   {"angular acceleration", &Differences::angular, 7.8e-7}};

/// Cheeseman-Bennett's pole at Z/R = 0.25 multiplies the rounding of Z/R by 2 * 0.25 / (Z/R - 0.25): by 400 in the row
/// at 0.2512.
constexpr double pole_tolerance = 6.8e-9;

/// The simulator's rotors use the float32 diameter, its ground effect the float32 radius in mm times a float32 0.001.
constexpr double ground_radius_m = 114.29999768733978 * 0.0010000000474974513;

/// Commands from the row's accelerations.
constexpr double command_tolerance = 6.2e-8;

plain::Point point(const ReferenceTable& table, std::size_t row) {
  const auto value = [&](const char* column) { return table.at(row, column); };
  plain::Point p{};
  p.ground_effect = static_cast<plain::GroundEffect>(static_cast<int>(value("ge_model")));
  p.pz = value("pz");
  p.qw = value("qw"), p.qx = value("qx"), p.qy = value("qy"), p.qz = value("qz");
  p.vx = value("vx"), p.vy = value("vy"), p.vz = value("vz");
  p.wx = value("wx"), p.wy = value("wy"), p.wz = value("wz");
  p.u1 = value("u1"), p.u2 = value("u2"), p.u3 = value("u3"), p.u4 = value("u4");
  p.wind_x = value("windx"), p.wind_y = value("windy"), p.wind_z = value("windz");
  return p;
}

/// Results of the simulator. fg holds the ground effect only where a model is on; v_dot_B is derived from a.
plain::Result result(const ReferenceTable& table, std::size_t row) {
  plain::Result out{};
  const auto copy = [&](double(&to)[3], const char* prefix) {
    const std::array<double, 3> v = table.vector(row, prefix);
    for (std::size_t i = 0; i < 3; ++i) to[i] = v[i];
  };
  out.rho = table.at(row, "rho");
  copy(out.rotor_force, "fb");
  copy(out.rotor_torque, "tb");
  copy(out.drag_force, "fd");
  if (table.at(row, "ge_model") > 0) copy(out.ground_force, "fg");
  copy(out.acceleration, "a");
  copy(out.angular, "al");
  const pinnquad::State<double> state = pinnquad::test::state_of<double>(point(table, row));
  const pinnquad::Vector3<double> world(out.acceleration[0], out.acceleration[1], out.acceleration[2]);
  pinnquad::test::assign<double>(out.body_derivative, pinnquad::body_derivative(state, world));
  return out;
}

double height_over_radius(const plain::Point& p) { return (0.877 - p.pz) / ground_radius_m; }

/// |dF_ground / dF_rotor|: above 1 the thrust equation can have two solutions.
double gain(const plain::Point& p) {
  double ratio = 1.0;
  if (p.ground_effect == plain::GroundEffect::cheeseman_bennett)
    ratio = plain::cheeseman_bennett(height_over_radius(p));
  if (p.ground_effect == plain::GroundEffect::conyers) ratio = plain::conyers(height_over_radius(p), 690.0, 114.3);
  return std::fabs((ratio - 1.0) * (1.0 - 2.0 * (p.qx * p.qx + p.qy * p.qy)));
}

/// The greatest ground effect that the pole allows a row.
double tolerance_at_pole(const plain::Point& p) {
  const double x = height_over_radius(p);
  return p.ground_effect == plain::GroundEffect::cheeseman_bennett && x > 0.25 ? pole_tolerance * 0.5 / (x - 0.25)
                                                                               : 0.0;
}

/// The reference airframe with the ground effect's radius: same thrust and torque, another Z/R in the eighth digit.
pinnquad::Airframe<double> airframe_of_simulator() {
  pinnquad::Airframe<double> airframe = pinnquad::ReferenceQuadrotor15::value<double>();
  const double scale = airframe.propeller_diameter_m / (2.0 * ground_radius_m);
  airframe.propeller_diameter_m = 2.0 * ground_radius_m;
  airframe.thrust_coefficient *= std::pow(scale, 4);
  airframe.power_coefficient *= std::pow(scale, 5);
  return airframe;
}

/// Compares the library with one file: every row, every quantity.
void compare(const ReferenceTable& table, std::size_t rows, const std::string& label) {
  const auto airframe = airframe_of_simulator();
  REQUIRE(table.size() == rows);
  Statistics statistics[std::size(quantities)];
  for (std::size_t row = 0; row < table.size(); ++row) {
    const plain::Point p = point(table, row);
    const Differences d = differences(pinnquad::test::evaluate(airframe, p), result(table, row));
    CAPTURE(row);
    for (std::size_t i = 0; i < std::size(quantities); ++i) {
      const Quantity& quantity = quantities[i];
      CAPTURE(quantity.name);
      statistics[i].add(d.*quantity.of);
      const double amplified = quantity.of == &Differences::ground_force ? tolerance_at_pole(p) : 0.0;
      CHECK(d.*quantity.of <= std::max(quantity.tolerance, amplified));
    }
  }
  for (std::size_t i = 0; i < std::size(quantities); ++i) statistics[i].print(label.c_str(), quantities[i].name);
}

const char* const files[] = {"points_ge0.csv", "points_ge1.csv", "points_ge2.csv"};

}  // namespace

TEST_CASE("the library agrees with the simulator in every row") {
  for (const char* file : files) compare(ReferenceTable(std::string("points/") + file), 1000, file);
}

TEST_CASE("the library in float agrees with the simulator to float's digits") {
  // rounding of a hundred operations in forces; angular acceleration divides a difference of torques by a small inertia
  const double density_tolerance = 2.4e-7, rotor_tolerance = 4.9e-7, drag_tolerance = 1.39e-6,
               acceleration_tolerance = 2.1e-6, angular_tolerance = 1.8e-5;
  const auto airframe = pinnquad::ReferenceQuadrotor15::value<float>();
  const ReferenceTable table("points/points_ge0.csv");
  Statistics acceleration, angular;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Differences d = differences(pinnquad::test::evaluate(airframe, point(table, row)), result(table, row));
    acceleration.add(d.acceleration);
    angular.add(d.angular);
    CAPTURE(row);
    CHECK(d.density <= density_tolerance);
    CHECK(d.rotor_force <= rotor_tolerance);
    CHECK(d.drag_force <= drag_tolerance);
    CHECK(d.acceleration <= acceleration_tolerance);
    CHECK(d.angular <= angular_tolerance);
  }
  acceleration.print("points_ge0.csv float", "linear acceleration");
  angular.print("points_ge0.csv float", "angular acceleration");
}

namespace {

/// Commands recovered from the simulator's accelerations, where no rotor was clipped. A row may be left out only where
/// the thrust equation has two solutions (vehicle/inverse.hpp) and the simulator flew the other one.
template <class... Ground>
void recover(const ReferenceTable& table, const char* file, std::size_t fewest_rows) {
  const auto airframe = airframe_of_simulator();
  Statistics commands;
  int clipped = 0, other_branch = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const plain::Point p = point(table, row);
    if (std::min({p.u1, p.u2, p.u3, p.u4}) < 0.0 || std::max({p.u1, p.u2, p.u3, p.u4}) > 1.0) {
      ++clipped;
      continue;
    }
    const plain::Result reference = result(table, row);
    pinnquad::Accelerations<double> motion;
    for (int i = 0; i < 3; ++i) {
      motion.linear_m_s2[i] = reference.body_derivative[i];
      motion.angular_rad_s2[i] = reference.angular[i];
    }
    const auto vehicle = pinnquad::test::reference_vehicle<double, Ground...>(airframe, p);
    const auto state = pinnquad::test::state_of<double>(p);
    pinnquad::Commands<double> u{};
    CAPTURE(row);
    REQUIRE(pinnquad::inverse_commands(vehicle, state, motion, 0.0, u) == pinnquad::Status::ok);
    double worst = 0.0;
    const pinnquad::Commands<double> expected = pinnquad::test::commands_of<double>(p);
    for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::fabs(u[i] - expected[i]));
    if (gain(p) > 1.0 && worst > command_tolerance) {
      ++other_branch;
      std::printf("%s row %zu left out: Z/R %.4f, gain %.2f, the simulator flew the lower branch\n", file, row,
                  height_over_radius(p), gain(p));
      continue;
    }
    commands.add(worst);
    CHECK(worst <= command_tolerance);
  }
  std::printf("%s: %d rows with a clipped rotor and %d of the other branch left out\n", file, clipped, other_branch);
  commands.print(file, "commands recovered");
  CHECK(commands.count() >= fewest_rows);
  CHECK(other_branch <= 5);
}

}  // namespace

TEST_CASE("the inverse recovers the simulator's commands") {
  recover<>(ReferenceTable("points/points_ge0.csv"), "points_ge0.csv", 800);
  recover<pinnquad::test::SimulatorGroundEffect>(ReferenceTable("points/points_ge1.csv"), "points_ge1.csv", 800);
  recover<pinnquad::GroundEffect<pinnquad::Conyers>>(ReferenceTable("points/points_ge2.csv"), "points_ge2.csv", 800);
}

TEST_SUITE("shipped rows") {
  TEST_CASE("the library agrees with the simulator in each of fifty rows per ground effect, and back") {
    using pinnquad::test::shipped_rows;
    for (const char* file : files) compare(shipped_rows(file), 50, std::string(file) + " shipped");
    recover<>(shipped_rows("points_ge0.csv"), "points_ge0.csv", 40);
    recover<pinnquad::test::SimulatorGroundEffect>(shipped_rows("points_ge1.csv"), "points_ge1.csv", 40);
    recover<pinnquad::GroundEffect<pinnquad::Conyers>>(shipped_rows("points_ge2.csv"), "points_ge2.csv", 40);
  }
}
