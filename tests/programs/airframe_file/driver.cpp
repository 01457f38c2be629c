// SPDX-License-Identifier: MIT
// Airframes from TOML files and as written structs: the same bits as compiled ones; what is wrong with a file in one
// line.
#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "airframe/choice.hpp"
#include "airframe/names.hpp"
#include "pinnquad/deploy/airframe_writer.hpp"
#include "support/temporary_folder.hpp"
#include "support/uneven_airframe.hpp"
#include "written_airframes.hpp"

namespace {

using pinnquad::Airframe;

/// Every number of an airframe, in its order.
template <class Scalar>
std::vector<Scalar> numbers(const Airframe<Scalar>& a) {
  std::vector<Scalar> v{a.mass_kg,
                        a.thrust_coefficient,
                        a.power_coefficient,
                        a.propeller_diameter_m,
                        a.max_rotor_speed_rev_s,
                        a.rotor_time_constant_s,
                        a.drag_deadband_m_s};
  for (const auto& triple : {a.inertia_kg_m2, a.inertia_products_kg_m2, a.drag_area_m2}) {
    v.insert(v.end(), triple.begin(), triple.end());
  }
  for (const auto& r : a.rotors) {
    v.insert(v.end(), {r.x_m, r.y_m, r.z_m, Scalar(static_cast<int>(r.spin)), r.thrust_scale, r.thrust_curve,
                       r.rise_time_constant_s, r.fall_time_constant_s});
    v.insert(v.end(), r.axis.begin(), r.axis.end());
  }
  return v;
}

template <class Scalar>
bool same_bits(const Airframe<Scalar>& a, const Airframe<Scalar>& b) {
  const std::vector<Scalar> x = numbers(a), y = numbers(b);
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Scalar)) == 0;
}

const std::string folder = PINNQUAD_AIRFRAMES_DIR;

std::string content(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The complaint about the paper's airframe with one piece of its file replaced, behind the path.
std::string said_of(const std::string& piece, const std::string& instead) {
  std::string text = content(folder + "/paper_quadrotor.toml");
  const std::size_t at = text.find(piece);
  REQUIRE(at != std::string::npos);
  text.replace(at, piece.size(), instead);
  const std::string path = "changed.toml";
  std::ofstream(path) << text;
  try {
    programs::read_airframe_file(path);
  } catch (const pinnquad::InputError& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);
    return what.substr(path.size());
  }
  return "accepted";
}

}  // namespace

TEST_CASE("each airframe of the library: its file has its bits") {
  programs::each_airframe([](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    const programs::NamedAirframe read = programs::read_airframe_file(folder + "/" + Vehicle::name + ".toml");
    CHECK(read.name == Vehicle::name);
    CHECK(same_bits(read.value, Vehicle::template value<double>()));
  });
}

TEST_CASE("written as a struct and compiled: the same bits, and a type that the library takes") {
  static_assert(pinnquad::is_airframe<WrittenRacer>);
  constexpr Airframe<double> racer = pinnquad::airframe_value<WrittenRacer, double>();
  CHECK(same_bits(racer, pinnquad::Racer5Inch::value<double>()));
  CHECK(same_bits(WrittenRacer::value<float>(), pinnquad::Racer5Inch::value<float>()));
  CHECK(same_bits(WrittenCrazyflie::value<double>(), pinnquad::Crazyflie::value<double>()));
  CHECK(same_bits(pinnquad::airframe_value<WrittenUneven, double>(), pinnquad::test::uneven_airframe<double>()));
  CHECK(std::string(WrittenUneven::name) == "uneven \"one\"");
  CHECK(std::string(WrittenRacer::name) == "racer_5_inch");
}

TEST_CASE("what can't be written: nothing is") {
  std::ostringstream out;
  const Airframe<double> good = pinnquad::PaperQuadrotor::value<double>();
  CHECK_THROWS_AS(pinnquad::write_airframe(out, "class", "x", good), std::invalid_argument);
  Airframe<double> bad = good;
  bad.mass_kg = 100;
  CHECK_THROWS_AS(pinnquad::write_airframe(out, "Heavy", "x", bad), std::invalid_argument);
  CHECK(out.str().empty());
}

TEST_CASE("rotors of every kind are read") {
  const std::string plain = "y_m = 0.243952\n";
  CHECK(said_of(plain, plain + "z_m = -0.02\naxis = [0.6, 0, -0.8]\nthrust_scale = 0.9\nthrust_curve = 0.5\n"
                               "rise_time_constant_s = 0.01\nfall_time_constant_s = 0.02\n") == "accepted");
  const programs::NamedAirframe read = programs::read_airframe_file("changed.toml");
  const auto& r = read.value.rotors[0];
  CHECK(numbers(read.value).size() == 7 + 9 + 44);
  CHECK((r.z_m == -0.02 && r.axis == std::array<double, 3>{0.6, 0, -0.8} && r.thrust_scale == 0.9));
  CHECK((r.thrust_curve == 0.5 && r.rise_time_constant_s == 0.01 && r.fall_time_constant_s == 0.02));
  CHECK(said_of("mass_kg", "inertia_products_kg_m2 = [0, 1e-4, 0]\nmass_kg") == "accepted");
  CHECK(said_of("mass_kg = 1.5", "mass_kg = 2") == "accepted");  // an integer is a number
}

TEST_CASE("one line with line and column for what is wrong") {
  CHECK(said_of("mass_kg = 1.5", "mass_kg = \"heavy\"") == ":4:11: expected a number, found \"heavy\"");
  CHECK(said_of("mass_kg = 1.5\n", "") == ":1:1: expected `mass_kg`, a number, found no such key");
  CHECK(said_of("mass_kg = 1.5", "mass_kg = 1.5\nmass_g = 1") ==
        ":5:1: expected a key of an airframe, found `mass_g`; nearest: mass_kg, name, rotor");
  CHECK(said_of("mass_kg = 1.5", "mass_kg = -1.5").find(":4:11: expected a value above 0") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg = nan").find(":4:11: expected a value above 0") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg = 90").find(":4:11: expected an airframe that can hover") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg 1.5").find(":4:9: expected TOML") == 0);
  CHECK(said_of("0.01469, ", "").find(":5:17: expected an array of three numbers, found an array of 2") == 0);
  CHECK(said_of("0.01469, ", "0.9, ").find(":5:17: expected an inertia that a body can have") == 0);
  CHECK(said_of("\"counter_clockwise\"", "\"left\"").find(":17:8: expected \"clockwise\" or \"counter_clockwise\"") ==
        0);
  CHECK(said_of("y_m = 0.243952\n", "y_m = 0.243952\nz_cm = 2\n").find(":17:1: expected a key") == 0);
  const std::string place = "y_m = 0.243952\n";
  CHECK(said_of(place, place + "axis = [0, 0, 1e-3]\n") == ":17:8: expected a vector of length 1, found [0, 0, 0.001]");
  CHECK(said_of(place, place + "rise_time_constant_s = -1\n").find(":17:24: expected a value of 0 or more") == 0);
  CHECK(said_of(place, place + "thrust_scale = 0\n").find(":17:16: expected a value above 0") == 0);
  CHECK(said_of(place, place + "thrust_curve = 1.5\n") == ":17:16: expected a value from 0 to 1, found 1.5");
  CHECK(said_of("0.00538309", "nan").find(":11:17: expected a value of 0 or more, at most 1e9, found nan") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg = 9007199254740993").find(":4:11: expected a value above 0") == 0);
  CHECK(said_of("mass_kg = 1.5", "inertia_products_kg_m2 = [1, 0, 0]\nmass_kg = 1.5")
            .find(":4:26: expected an inertia") == 0);
  CHECK(said_of("[[rotor]]\nx_m = 0.243952\ny_m = 0.243952\nspin = \"counter_clockwise\"\n", "")
            .find("expected four tables [[rotor]]") != std::string::npos);
  CHECK(said_of("x_m = -0.243952\ny_m = -0.243952", "x_m = 0.243952\ny_m = 0.243952")
            .find("expected rotors that make thrust and three torques") != std::string::npos);
  CHECK_THROWS_AS(programs::read_airframe_file("no such file.toml"), pinnquad::InputError);
  CHECK_THROWS_AS(programs::read_airframe_file("."), pinnquad::InputError);
}

TEST_CASE("what a file holds is shown on one line, whatever it is; broken TOML ends no program") {
  CHECK(said_of("mass_kg = 1.5", "mass_kg = \"a\\nb\"") == ":4:11: expected a number, found \"a?b\"");
  CHECK(said_of("mass_kg = 1.5", "\"a\\nb\" = 1\nmass_kg = 1.5") ==
        ":4:1: expected a key of an airframe, found `a?b`; nearest: name, rotor, mass_kg");
  CHECK(said_of("\"paper_quadrotor\"", "\"a\\nb\"") == ":3:8: expected a text on one line, found \"a?b\"");
  CHECK(said_of("\"paper_quadrotor\"", "\"\"") == ":3:8: expected a text on one line, found \"\"");
  CHECK(said_of("mass_kg = 1.5", "[[[[").find(":4:3: expected TOML") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg = \xff").find(": expected TOML") != std::string::npos);
  // toml++ 3.3 runs into undefined behaviour on this letter where a key may stand
  CHECK(said_of("mass_kg = 1.5", "\xCF\xBB[") ==
        ":4:1: expected TOML, found a character beyond ASCII outside texts and comments");
  CHECK(said_of("mass_kg = 1.5", "x = \"\"\"a\n\\\"\xCF\xBB\"\"\"\"\n  \xCF\xBB = 1")
            .find(":6:3: expected TOML, found a character beyond ASCII") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg = 4rrt:0ta\"----\xCF\x9D.ttz").find(": expected TOML") != std::string::npos);
  CHECK(said_of("# Table 1",
                "\xEF\xBB\xBF# T\xC3\xA4"
                "ble 1") == "accepted");
  CHECK(said_of("mass_kg = 1.5", "mass_kg = \"\xCF\xBB\" # \xCF\xBB").find(":4:11: expected a number") == 0);
  CHECK(said_of("mass_kg = 1.5", "mass_kg = '\\' # \xCF\xBB 'a").find(":4:11: expected a number") == 0);
}
