// SPDX-License-Identifier: MIT
#include "pinnquad/aero/air_density.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "pinnquad/core/finite.hpp"
#include "support/plain_dynamics.hpp"
#include "support/tolerances.hpp"

using pinnquad::standard_atmosphere_density_kg_m3;

TEST_CASE_TEMPLATE("the table of the US Standard Atmosphere 1976", Scalar, float, double) {
  // geometric altitude and density as printed in Table I: six digits, five of them compared
  const struct {
    double altitude_m, density;
  } rows[] = {{-1000, 1.3470}, {0, 1.2250},     {1000, 1.1117},  {2000, 1.0066},
              {3000, 0.90925}, {5000, 0.73643}, {8000, 0.52579}, {10000, 0.41351}};
  const double printed_digits = 1e-4;
  for (const auto& row : rows) {
    CAPTURE(row.altitude_m);
    CHECK(static_cast<double>(standard_atmosphere_density_kg_m3(Scalar(row.altitude_m))) ==
          doctest::Approx(row.density).epsilon(printed_digits));
  }
}

TEST_CASE_TEMPLATE("the formula as it stands, temperature, pressure and gas law, from below the sea to 11 km", Scalar,
                   float, double) {
  for (int altitude = -500; altitude <= 11000; altitude += 50) {
    CAPTURE(altitude);
    CHECK(static_cast<double>(standard_atmosphere_density_kg_m3(Scalar(altitude))) ==
          doctest::Approx(plain::density(altitude)).epsilon(pinnquad::test::rounding<Scalar>(100)));
  }
}

TEST_CASE_TEMPLATE("what the running simulator prints", Scalar, float, double) {
  const double printed_digits = 1e-6;  // float32
  CHECK(static_cast<double>(standard_atmosphere_density_kg_m3(Scalar(0))) ==
        doctest::Approx(1.22499945).epsilon(printed_digits));
  CHECK(static_cast<double>(standard_atmosphere_density_kg_m3(Scalar(122))) ==
        doctest::Approx(1.21071629).epsilon(printed_digits));
}

TEST_CASE_TEMPLATE("the effect sets the density of its altitude and nothing else", Scalar, float, double) {
  pinnquad::Surroundings<Scalar> air;
  air.altitude_m = Scalar(1000);
  air.wind_m_s[1] = Scalar(3);
  pinnquad::StandardAtmosphere{}.surroundings(air);
  CHECK(air.air_density_kg_m3 == standard_atmosphere_density_kg_m3(Scalar(1000)));
  CHECK(air.wind_m_s == pinnquad::Vector3<Scalar>(0, 3, 0));
  CHECK(air.altitude_m == Scalar(1000));
  static_assert(pinnquad::changes_surroundings<pinnquad::StandardAtmosphere>);
  static_assert(!pinnquad::makes_wrench<pinnquad::StandardAtmosphere>);
}

TEST_CASE_TEMPLATE("outside the standard's troposphere: out_of_range, and a density that stays that of the nearer end",
                   Scalar, float, double) {
  const Scalar infinity = std::numeric_limits<Scalar>::infinity();
  const Scalar top = standard_atmosphere_density_kg_m3(Scalar(11000)),
               bottom = standard_atmosphere_density_kg_m3(Scalar(-5000));
  CHECK(static_cast<double>(top) == doctest::Approx(0.36480).epsilon(1e-4));    // Table I
  CHECK(static_cast<double>(bottom) == doctest::Approx(1.9311).epsilon(1e-4));  // Table I
  for (const Scalar altitude_m : {Scalar(11001), Scalar(44000), Scalar(45000), Scalar(1e6), Scalar(1e30), infinity}) {
    pinnquad::Surroundings<Scalar> air;
    air.altitude_m = altitude_m;
    pinnquad::StandardAtmosphere{}.surroundings(air);
    CHECK(air.status == pinnquad::Status::out_of_range);
    CHECK(air.air_density_kg_m3 == top);
    air.altitude_m = -altitude_m;
    pinnquad::StandardAtmosphere{}.surroundings(air);
    CHECK(air.air_density_kg_m3 == bottom);
  }
  pinnquad::Surroundings<Scalar> air;
  air.altitude_m = std::numeric_limits<Scalar>::quiet_NaN();
  pinnquad::StandardAtmosphere{}.surroundings(air);
  CHECK(air.status == pinnquad::Status::out_of_range);
  CHECK(!pinnquad::is_finite(air.air_density_kg_m3));
  for (const int altitude : {-5000, 0, 11000}) {
    pinnquad::Surroundings<Scalar> fair;
    fair.altitude_m = Scalar(altitude);
    pinnquad::StandardAtmosphere{}.surroundings(fair);
    CHECK(fair.status == pinnquad::Status::ok);
  }
}

TEST_CASE_TEMPLATE("without the effect the density is that of sea level", Scalar, float, double) {
  CHECK(pinnquad::Surroundings<Scalar>{}.air_density_kg_m3 == standard_atmosphere_density_kg_m3(Scalar(0)));
}
