// SPDX-License-Identifier: MIT
// The certificate's bounds against interval arithmetic with directed rounding: the real function of the stored numbers,
// written down here once more, over boxes of features as wide as the envelope and wider.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/interval.hpp"
#include "support/monotone_shapes.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

/// A value and its derivatives by three angular accelerations, each held over all taps or of the present alone.
using Dual = std::array<Interval, 4>;

struct Enclosure {
  Dual sums[4];          ///< sum of the commands, signed sums, without the residual's share of the value
  Interval residual[4];  ///< that share
};

/// u = A [base + residual] between scalers, from docs/certificate.md and the layout of the parameters alone. `taps`: of
/// how many taps the acceleration is differentiated.
template <class Shape>
Enclosure enclosure_of(const MonotoneModel<Shape>& model, const std::vector<Interval>& x, int taps) {
  using Features = typename Shape::Features;
  using Model = MonotoneModel<Shape>;
  const int all_taps = Model::Base::taps;
  std::vector<Dual> z(x.size());
  std::vector<bool> is_acceleration(x.size(), false);
  for (std::size_t i = 0; i < x.size(); ++i)
    z[i][0] = (x[i] - double(model.input.mean[i])) / double(model.input.standard_deviation[i]);
  for (int tap = 0; tap < all_taps; ++tap) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = std::size_t(angular_acceleration_at<Features>(tap) + axis);
      is_acceleration[place] = true;
      if (tap < taps) z[place][std::size_t(axis) + 1] = Interval(1) / double(model.input.standard_deviation[place]);
    }
  }
  std::vector<Dual> seen;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!is_acceleration[i]) seen.push_back(z[i]);
  }
  const auto add = [](Dual& sum, double weight, const Dual& v) {
    for (std::size_t d = 0; d < 4; ++d) sum[d] = sum[d] + Interval(weight) * v[d];
  };
  Enclosure result;
  std::size_t at = 3 * std::size_t(all_taps);
  const std::size_t intercepts = at + 4 * seen.size();
  for (std::size_t k = 0; k < 4; ++k) {
    Dual y{Interval(double(model.parameters[intercepts + k]))};
    for (const Dual& v : seen) add(y, double(model.parameters[at++]), v);
    for (int tap = 0; k > 0 && tap < all_taps; ++tap) {
      const auto place = std::size_t(angular_acceleration_at<Features>(tap)) + k - 1;
      add(y, double(model.parameters[std::size_t(3 * tap) + k - 1]), z[place]);
    }
    for (std::size_t d = 0; d < 4; ++d) result.sums[k][d] = y[d] * double(model.output.standard_deviation[k]);
    result.sums[k][0] = result.sums[k][0] + double(model.output.mean[k]);
  }
  if constexpr (Model::Structure::has_residual) {
    at = intercepts + 4;
    const std::size_t bounds = at;
    at += 8;
    std::vector<Dual> v = seen;
    for (const std::size_t width : {std::size_t{8}, std::size_t{8}, std::size_t{4}}) {
      std::vector<Dual> next(width);
      const std::size_t biases = at + width * v.size();
      for (std::size_t row = 0; row < width; ++row) {
        next[row][0] = double(model.parameters[biases + row]);
        for (const Dual& input : v) add(next[row], double(model.parameters[at++]), input);
        if (width == 4) continue;
        const Interval slope(next[row][0].lower() > 0 ? 1 : 0, next[row][0].upper() > 0 ? 1 : 0);
        for (std::size_t d = 1; d < 4; ++d) next[row][d] = next[row][d] * slope;
        next[row][0] = clipped(next[row][0], 0, 1e300);
      }
      at += width;
      v = next;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Interval y =
          clipped(v[k][0], double(model.parameters[bounds + k]), double(model.parameters[bounds + 4 + k]));
      result.residual[k] = y * double(model.output.standard_deviation[k]);
      for (std::size_t d = 1; d < 4; ++d) {
        result.sums[k][d] = result.sums[k][d] + v[k][d] * Interval(0, 1) * double(model.output.standard_deviation[k]);
      }
    }
  }
  return result;
}

template <class Shape>
std::vector<Interval> some_box(const MonotoneModel<Shape>& model, std::mt19937_64& engine, double widest) {
  std::vector<Interval> x;
  for (std::size_t i = 0; i < model.input.mean.size(); ++i) {
    const double lower = double(model.envelope_lower[i]), upper = double(model.envelope_upper[i]);
    const double middle = uniform(engine, lower, upper), half = widest * uniform_01(engine) * (upper - lower);
    x.emplace_back(middle - half, middle + half);
  }
  return x;
}

constexpr double tight = 1e-13;  ///< rounding of a few operations in double, relative

}  // namespace

TEST_CASE("intervals enclose what a third is, and nothing that doubles can tell apart from it") {
  const Interval third = Interval(1) / Interval(3);
  CHECK(third.lower() < third.upper());
  CHECK(std::nextafter(third.lower(), 1.0) == third.upper());
  const Interval one = third * Interval(3);
  CHECK(one.contains(1));
  CHECK(one.upper() > 1);
}

TEST_CASE_TEMPLATE("slopes: enclosed over any box, to the last digits", Shape, BaseAlone, WithResidual,
                   ForceWindowedModel) {
  std::mt19937_64 engine(2);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MonotoneModel<Shape> model(seed);
    const Certificate certificate = model.certificate();
    REQUIRE(certificate.proven());
    for (const double widest : {0.0, 0.1, 1.0, 50.0}) {
      const Enclosure found = enclosure_of(model, some_box(model, engine, widest), 1);
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const Interval& slope = found.sums[k][axis + 1];
          if (k != axis + 1) {
            CHECK(slope.lower() == 0);
            CHECK(slope.upper() == 0);
            continue;
          }
          CHECK(certificate.slope[axis] <= slope.lower());
          CHECK(certificate.slope[axis] >= slope.upper() * (1 - tight));
          CHECK(slope.lower() > 0);
        }
      }
    }
  }
}

TEST_CASE("slopes of an acceleration that is held over all taps: enclosed") {
  using Shape = MonotoneShape<PhysicsWindow, MonotoneBase<PhysicsWindow>>;
  std::mt19937_64 engine(3);
  int proven = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    MonotoneModel<Shape> model(seed);
    for (int i = 3; i < 9; ++i) model.slope(i) -= 0.5F;  // the other taps take away, from some too much
    const Certificate certificate = model.certificate();
    const Enclosure held = enclosure_of(model, some_box(model, engine, 1), 3);
    bool above_zero = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Interval& slope = held.sums[axis + 1][axis + 1];
      CHECK(certificate.held_slope[axis] <= slope.lower());
      CHECK(certificate.held_slope[axis] >= slope.upper() - tight);
      above_zero = above_zero && slope.lower() > 0;
    }
    CHECK(certificate.monotone == above_zero);
    proven += certificate.monotone ? 1 : 0;
  }
  CHECK(proven > 5);
  CHECK(proven < 55);
}

TEST_CASE("the slope by thrust is rounded to its safe side") {
  using Base = MonotoneModel<BaseAlone>::Base;
  constexpr std::size_t force_z = 2;  // among what row 0, the sum of the commands, weighs
  static_assert(PhysicsFeatures::names[force_z][0] == 's' && PhysicsFeatures::names[force_z][2] == 'z');
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const MonotoneModel<BaseAlone> model(seed);
    const Interval slope = Interval(-1) * Interval(double(model.parameters[std::size_t(3 * Base::taps) + force_z])) /
                           Interval(double(model.input.standard_deviation[force_z])) *
                           Interval(double(model.output.standard_deviation[0]));
    const Certificate certificate = model.certificate();
    CHECK(certificate.thrust_slope <= slope.lower());
    CHECK(certificate.held_thrust_slope <= slope.lower());
    CHECK(certificate.thrust_slope == doctest::Approx(slope.upper()).epsilon(tight));
  }
}

TEST_CASE("the residual stays between the certificate's bounds over any box, and each command within its own") {
  std::mt19937_64 engine(4);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MonotoneModel<WithResidual> model(seed);
    const Certificate certificate = model.certificate();
    for (const double widest : {0.0, 1.0, 1000.0}) {
      const Enclosure found = enclosure_of(model, some_box(model, engine, widest), 1);
      Interval commands[4];
      for (std::size_t k = 0; k < 4; ++k) {
        CHECK(certificate.residual_lower[k] <= found.residual[k].lower());
        CHECK(certificate.residual_upper[k] >= found.residual[k].upper());
        if (widest > 100) {
          CHECK(certificate.residual_lower[k] >= found.residual[k].lower() * (1 + tight));
          CHECK(certificate.residual_upper[k] <= found.residual[k].upper() * (1 + tight));
        }
        for (auto& command : commands) command = command + Interval(-0.25, 0.25) * found.residual[k];
      }
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(certificate.command_bound[i] >= commands[i].upper());
        CHECK(certificate.command_bound[i] >= -commands[i].lower());
      }
    }
  }
}
