// SPDX-License-Identifier: MIT
#include "pinnquad/core/rotation.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "support/random_states.hpp"
#include "support/tolerances.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

constexpr double pi = 3.14159265358979323846;

/// Rz(psi) Ry(theta) Rx(phi), body to world, from the three elementary matrices.
Matrix<double, 3, 3> matrix_from_euler(double roll, double pitch, double yaw) {
  Matrix<double, 3, 3> rx, ry, rz;
  rx << 1, 0, 0, 0, std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll);
  ry << std::cos(pitch), 0, std::sin(pitch), 0, 1, 0, -std::sin(pitch), 0, std::cos(pitch);
  rz << std::cos(yaw), -std::sin(yaw), 0, std::sin(yaw), std::cos(yaw), 0, 0, 0, 1;
  return rz * ry * rx;
}

/// Columns are the rotated basis vectors.
template <class Scalar>
Matrix<Scalar, 3, 3> matrix_of(const Quaternion<Scalar>& q) {
  Matrix<Scalar, 3, 3> r;
  r.col(0) = pinnquad::body_to_world<Scalar>(q, Vector3<Scalar>(1, 0, 0));
  r.col(1) = pinnquad::body_to_world<Scalar>(q, Vector3<Scalar>(0, 1, 0));
  r.col(2) = pinnquad::body_to_world<Scalar>(q, Vector3<Scalar>(0, 0, 1));
  return r;
}

/// Distance of two rotations: q and -q are the same one.
template <class Scalar>
double rotation_distance(const Quaternion<Scalar>& a, const Quaternion<Scalar>& b) {
  const Quaternion<Scalar> minus{-b.w, -b.x, -b.y, -b.z};
  return std::min(distance(components(a), components(b)), distance(components(a), components(minus)));
}

}  // namespace

TEST_CASE_TEMPLATE("the product composes rotations and the conjugate undoes one", Scalar, float, double) {
  RandomStates random(10);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> a = random.attitude<Scalar>(), b = random.attitude<Scalar>();
    const Vector3<Scalar> v = random.vector<Scalar>(1.0);
    const Vector3<Scalar> twice = pinnquad::body_to_world<Scalar>(a, pinnquad::body_to_world<Scalar>(b, v));
    CHECK(distance(pinnquad::body_to_world<Scalar>(a * b, v), twice) <= 2 * rotation_tolerance<Scalar>);
    CHECK(distance(pinnquad::world_to_body<Scalar>(a, pinnquad::body_to_world<Scalar>(a, v)), v) <=
          2 * rotation_tolerance<Scalar>);
    CHECK(rotation_distance(a * pinnquad::conjugate(a), Quaternion<Scalar>{}) <= rotation_tolerance<Scalar>);
    CHECK(std::abs(static_cast<double>(pinnquad::squared_norm(a * b)) - 1.0) <= rotation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("a rotation keeps lengths, angles and handedness", Scalar, float, double) {
  RandomStates random(11);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    const Vector3<Scalar> a = random.vector<Scalar>(1.0), b = random.vector<Scalar>(1.0);
    const Vector3<Scalar> ra = pinnquad::body_to_world<Scalar>(q, a), rb = pinnquad::body_to_world<Scalar>(q, b);
    CHECK(static_cast<double>(std::abs(ra.dot(rb) - a.dot(b))) <= 3 * rotation_tolerance<Scalar>);
    CHECK(
        distance(pinnquad::cross<Scalar>(ra, rb), pinnquad::body_to_world<Scalar>(q, pinnquad::cross<Scalar>(a, b))) <=
        4 * rotation_tolerance<Scalar>);
  }
}

TEST_CASE("the meaning of each axis: NED, FRD, body to world") {
  const auto rotated = [](double roll, double pitch, double yaw, const Vector3<double>& v) {
    return pinnquad::body_to_world<double>(pinnquad::from_euler<double>({roll, pitch, yaw}), v);
  };
  const Vector3<double> forward(1, 0, 0), right(0, 1, 0), down(0, 0, 1);
  const double tolerance = rotation_tolerance<double>;
  CHECK(distance(rotated(0, 0, pi / 2, forward), Vector3<double>(0, 1, 0)) <= tolerance);   // yaw 90: nose east
  CHECK(distance(rotated(0, pi / 2, 0, forward), Vector3<double>(0, 0, -1)) <= tolerance);  // pitch 90: nose up
  CHECK(distance(rotated(pi / 2, 0, 0, right), Vector3<double>(0, 0, 1)) <= tolerance);     // roll 90: right side down
  CHECK(distance(rotated(0.3, 0, 0, down), Vector3<double>(0, -std::sin(0.3), std::cos(0.3))) <= tolerance);
}

TEST_CASE("from_euler is Rz Ry Rx") {
  RandomStates random(12);
  for (int draw = 0; draw < draws; ++draw) {
    const double roll = random.scalar<double>(-pi, pi), pitch = random.scalar<double>(-pi / 2, pi / 2),
                 yaw = random.scalar<double>(-pi, pi);
    const Matrix<double, 3, 3> expected = matrix_from_euler(roll, pitch, yaw);
    CHECK((matrix_of(pinnquad::from_euler<double>({roll, pitch, yaw})) - expected).norm() <=
          rotation_tolerance<double>);
  }
}

TEST_CASE_TEMPLATE("Euler angles: round trips both ways", Scalar, float, double) {
  RandomStates random(13);
  // asin near +-1 amplifies rounding by 1 / cos(pitch); pitch stays within 80 degrees here
  const double tolerance = rotation_tolerance<Scalar> / std::cos(80.0 * pi / 180.0);
  for (int draw = 0; draw < draws; ++draw) {
    const EulerAngles<Scalar> angles{random.scalar<Scalar>(-3.1, 3.1), random.scalar<Scalar>(-1.39, 1.39),
                                     random.scalar<Scalar>(-3.1, 3.1)};
    const EulerAngles<Scalar> again = pinnquad::to_euler(pinnquad::from_euler(angles));
    CHECK(std::abs(static_cast<double>(again.roll_rad - angles.roll_rad)) <= tolerance);
    CHECK(std::abs(static_cast<double>(again.pitch_rad - angles.pitch_rad)) <= tolerance);
    CHECK(std::abs(static_cast<double>(again.yaw_rad - angles.yaw_rad)) <= tolerance);
  }
  int compared = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    const EulerAngles<Scalar> angles = pinnquad::to_euler(q);
    if (std::abs(static_cast<double>(angles.pitch_rad)) > 1.39) continue;
    ++compared;
    CHECK(rotation_distance(pinnquad::from_euler(angles), q) <= tolerance);
  }
  CHECK(compared > 9 * draws / 10);
}

TEST_CASE_TEMPLATE("Euler angles stay in their range and numbers straight up and straight down", Scalar, float,
                   double) {
  RandomStates random(14);
  for (int draw = 0; draw < draws; ++draw) {
    const Scalar nose = draw % 2 == 0 ? Scalar(pi / 2) : Scalar(-pi / 2);
    const EulerAngles<Scalar> angles{random.scalar<Scalar>(-3.1, 3.1), nose, random.scalar<Scalar>(-3.1, 3.1)};
    const EulerAngles<Scalar> again = pinnquad::to_euler(pinnquad::from_euler(angles));
    CHECK(std::isfinite(again.roll_rad));
    CHECK(std::isfinite(again.yaw_rad));
    // asin loses half the digits at its end
    CHECK(std::abs(static_cast<double>(again.pitch_rad - nose)) <= std::sqrt(rotation_tolerance<Scalar>));
  }
}

TEST_CASE_TEMPLATE("to_euler lets NaN through", Scalar, float, double) {
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  const EulerAngles<Scalar> angles = pinnquad::to_euler(Quaternion<Scalar>{nan, Scalar(0), Scalar(0), Scalar(0)});
  CHECK_FALSE(pinnquad::is_finite(angles.pitch_rad));
  const pinnquad::Heading<Scalar> yaw = pinnquad::heading(Quaternion<Scalar>{nan, Scalar(0), Scalar(0), Scalar(0)});
  CHECK_FALSE(pinnquad::is_finite(yaw.sine));
}

TEST_CASE_TEMPLATE("heading is the sine and cosine of yaw", Scalar, float, double) {
  RandomStates random(15);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    const EulerAngles<Scalar> angles = pinnquad::to_euler(q);
    const pinnquad::Heading<Scalar> yaw = pinnquad::heading(q);
    // both divide by cos(pitch)
    const double tolerance =
        rotation_tolerance<Scalar> / std::max(1e-3, std::cos(static_cast<double>(angles.pitch_rad)));
    CHECK(std::abs(static_cast<double>(yaw.sine) - std::sin(static_cast<double>(angles.yaw_rad))) <= tolerance);
    CHECK(std::abs(static_cast<double>(yaw.cosine) - std::cos(static_cast<double>(angles.yaw_rad))) <= tolerance);
    CHECK(std::abs(static_cast<double>(yaw.sine * yaw.sine + yaw.cosine * yaw.cosine) - 1.0) <=
          rotation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("roll, pitch and yaw are those of the attitude, whatever the quaternion's norm", Scalar, float,
                   double) {
  RandomStates random(16);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    const EulerAngles<Scalar> angles = pinnquad::to_euler(q);
    const pinnquad::Heading<Scalar> yaw = pinnquad::heading(q);
    for (const Scalar scale : {Scalar(0.5), Scalar(2)}) {  // powers of two: no rounding
      const Quaternion<Scalar> longer{q.w * scale, q.x * scale, q.y * scale, q.z * scale};
      const EulerAngles<Scalar> again = pinnquad::to_euler(longer);
      CHECK(again.roll_rad == angles.roll_rad);
      CHECK(again.pitch_rad == angles.pitch_rad);
      CHECK(again.yaw_rad == angles.yaw_rad);
      CHECK(pinnquad::heading(longer).sine == yaw.sine);
      CHECK(pinnquad::heading(longer).cosine == yaw.cosine);
    }
  }
}

TEST_CASE("heading straight up is defined") {
  const double h = 0.5;  // (h, h, -h, h): pitch of exactly -90 degrees in binary arithmetic
  const pinnquad::Heading<double> yaw = pinnquad::heading(Quaternion<double>{h, h, -h, h});
  CHECK(yaw.sine == 0.0);
  CHECK(yaw.cosine == 1.0);
}

TEST_CASE_TEMPLATE("rotation matrix: round trip for every attitude, half turns included", Scalar, float, double) {
  RandomStates random(16);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    CHECK(rotation_distance(pinnquad::from_rotation_matrix(matrix_of(q)), q) <= rotation_tolerance<Scalar>);
  }
  // each branch of the choice, and its edge
  for (const Quaternion<Scalar>& q :
       {Quaternion<Scalar>{1, 0, 0, 0}, Quaternion<Scalar>{0, 1, 0, 0}, Quaternion<Scalar>{0, 0, 1, 0},
        Quaternion<Scalar>{0, 0, 0, 1}, Quaternion<Scalar>{Scalar(0.5), Scalar(0.5), Scalar(0.5), Scalar(0.5)},
        Quaternion<Scalar>{Scalar(0.1), Scalar(0.7), Scalar(0.7), Scalar(0.1)}}) {
    const Quaternion<Scalar> unit = pinnquad::normalized(q);
    CHECK(rotation_distance(pinnquad::from_rotation_matrix(matrix_of(unit)), unit) <= rotation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("body_down_axis is the third column", Scalar, float, double) {
  RandomStates random(17);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    CHECK(distance(pinnquad::body_down_axis(q), pinnquad::body_to_world<Scalar>(q, Vector3<Scalar>(0, 0, 1))) <=
          rotation_tolerance<Scalar>);
  }
}

TEST_CASE("attitude_rate is the derivative of turning about a body axis") {
  RandomStates random(18);
  const double h = 1e-5;
  const double tolerance = 1e-9;  // central difference: h^2 |rates|^3 / 48, and rounding / h
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<double> q = random.attitude<double>();
    const Vector3<double> rates = random.vector<double>(3.0);
    const double angle = rates.norm() * h;
    const Vector3<double> axis = rates / rates.norm();
    const auto turned = [&](double a) {
      const double s = std::sin(a / 2);
      return q * Quaternion<double>{std::cos(a / 2), s * axis[0], s * axis[1], s * axis[2]};
    };
    const Quaternion<double> after = turned(angle), before = turned(-angle), rate = pinnquad::attitude_rate(q, rates);
    const std::array<double, 4> difference{(after.w - before.w) / (2 * h), (after.x - before.x) / (2 * h),
                                           (after.y - before.y) / (2 * h), (after.z - before.z) / (2 * h)};
    CHECK(distance(components(rate), difference) <= tolerance);
  }
}

TEST_CASE_TEMPLATE("NED/FRD and ENU/FLU: vectors and attitudes, there and back", Scalar, float, double) {
  CHECK(pinnquad::swap_enu_ned<Scalar>(Vector3<Scalar>(1, 2, 3)) == Vector3<Scalar>(2, 1, -3));
  CHECK(pinnquad::swap_flu_frd<Scalar>(Vector3<Scalar>(1, 2, 3)) == Vector3<Scalar>(1, -2, -3));
  RandomStates random(19);
  for (int draw = 0; draw < draws; ++draw) {
    const Vector3<Scalar> v = random.vector<Scalar>(5.0);
    CHECK(pinnquad::swap_enu_ned<Scalar>(pinnquad::swap_enu_ned<Scalar>(v)) == v);
    CHECK(pinnquad::swap_flu_frd<Scalar>(pinnquad::swap_flu_frd<Scalar>(v)) == v);
    const Quaternion<Scalar> ned = random.attitude<Scalar>();
    const Quaternion<Scalar> enu = pinnquad::swap_enu_flu_ned_frd(ned);
    CHECK(rotation_distance(pinnquad::swap_enu_flu_ned_frd(enu), ned) <= rotation_tolerance<Scalar>);
    // the same body vector ends as the same world vector, whichever frames it is written in
    const Vector3<Scalar> unit = v / v.norm();
    const Vector3<Scalar> world_enu = pinnquad::body_to_world<Scalar>(enu, pinnquad::swap_flu_frd<Scalar>(unit));
    CHECK(distance(pinnquad::swap_enu_ned<Scalar>(world_enu), pinnquad::body_to_world<Scalar>(ned, unit)) <=
          2 * rotation_tolerance<Scalar>);
  }
}

TEST_CASE("a level vehicle that looks north has yaw 90 degrees in ENU") {
  const Quaternion<double> enu = pinnquad::swap_enu_flu_ned_frd(Quaternion<double>{});
  CHECK(rotation_distance(enu, Quaternion<double>{std::sqrt(0.5), 0, 0, std::sqrt(0.5)}) <= rotation_tolerance<double>);
}

TEST_CASE_TEMPLATE("normalized has norm 1 and keeps the direction", Scalar, float, double) {
  RandomStates random(20);
  for (int draw = 0; draw < draws; ++draw) {
    const Quaternion<Scalar> q = random.attitude<Scalar>();
    const Scalar scale = random.scalar<Scalar>(0.01, 100.0);
    const Quaternion<Scalar> unit =
        pinnquad::normalized(Quaternion<Scalar>{q.w * scale, q.x * scale, q.y * scale, q.z * scale});
    CHECK(distance(components(unit), components(q)) <= rotation_tolerance<Scalar>);
  }
}

TEST_CASE_TEMPLATE("a quaternion too short is no rotation, as one too long is none", Scalar, float, double) {
  const auto scaled = [](double norm) {
    return pinnquad::is_unit(Quaternion<Scalar>{Scalar(0.6 * norm), Scalar(0), Scalar(-0.8 * norm), Scalar(0)});
  };
  CHECK(scaled(1));
  CHECK_FALSE(scaled(0));
  CHECK_FALSE(scaled(0.8));
  CHECK_FALSE(scaled(1.2));
}
