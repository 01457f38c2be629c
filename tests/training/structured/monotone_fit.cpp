// SPDX-License-Identifier: MIT
// A monotone model from rows whose law is known: its slopes found, held above 0 where the rows say otherwise, pinned; a
// residual kept where there is something to learn, and dropped where there is not.
#include "pinnquad/training/structured/residual_fit.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/certificate.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/nn/relu.hpp"

using namespace pinnquad;

namespace {

using Window = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>>;
template <class Features>
using Setting = Context<Features, PaperQuadrotor, AxisCommandOutputs>;
using Residual = Network<float, InputSize<residual_inputs<PhysicsFeatures>>, Dense<16>, Relu, Dense<4>>;

constexpr double own_slope = 0.004;  ///< s^2/rad of each rotor: a signed sum's is four times that

/// u_i = hover + sum over axes of sign (share of now x wdot + the rest x wdot 20 ms ago) + curve of the velocity +
/// noise.
struct Law {
  std::array<double, 3> slope = {own_slope, own_slope, own_slope};
  double share_of_now = 1;
  double curve = 0;
  double noise = 0.002;
};

Flight flight_of(const Law& law, std::uint64_t seed, std::size_t rows = 900) {
  std::mt19937_64 engine(seed);
  Flight flight(rows);
  flight.name = "made";
  for (std::size_t row = 0; row < rows; ++row) {
    Sample& sample = flight[row];
    sample.time_s = 0.02 * static_cast<double>(row);
    for (int i = 0; i < 3; ++i) {
      sample.linear_acceleration_m_s2[i] = uniform(engine, -3, 3);
      sample.angular_acceleration_rad_s2[i] = uniform(engine, -20, 20);
      sample.velocity_m_s[i] = uniform(engine, -2, 2);
      sample.body_rates_rad_s[i] = uniform(engine, -2, 2);
    }
    sample.roll_rad = uniform(engine, -0.5, 0.5);
    sample.pitch_rad = uniform(engine, -0.5, 0.5);
    sample.yaw_rad = uniform(engine, -3, 3);
    const auto airframe = PaperQuadrotor::value<double>();
    for (std::size_t rotor = 0; rotor < rotor_count; ++rotor) {
      double u = 0.5 + law.curve * std::cos(1.5 * sample.velocity_m_s[0]) + law.noise * uniform(engine, -1, 1);
      for (int axis = 0; axis < 3; ++axis) {
        const Sample& before = flight[row > 0 ? row - 1 : row];
        const double asked = law.share_of_now * sample.angular_acceleration_rad_s2[axis] +
                             (1 - law.share_of_now) * before.angular_acceleration_rad_s2[axis];
        u += allocation_signs(airframe, axis)[rotor] * law.slope[std::size_t(axis)] * asked;
      }
      sample.commands[rotor] = u;
    }
  }
  return flight;
}

template <class Features>
Certificate certificate_of_base(const Setting<Features>& context, const AffineMap& map, const RowSet& rows) {
  const auto model = make_trained_model(monotone_base<Setting<Features>>(map), context, rows);
  return certificate_of_trained(model);
}

}  // namespace

TEST_CASE("hover slopes are the inertias over what the commands do: closed form of an X") {
  const auto airframe = PaperQuadrotor::value<double>();
  const AxisSlopes slopes = hover_slopes(airframe);
  const AllocationMatrix<double> effect = allocation(airframe);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(slopes[axis] == doctest::Approx(airframe.inertia_kg_m2[axis] / std::abs(effect[axis + 1][0])).epsilon(1e-9));
  }
  CHECK(hover_thrust_slope(airframe) == doctest::Approx(airframe.mass_kg / effect[0][0]).epsilon(1e-9));
}

TEST_CASE("slopes are learnt, those of other axes are not taken") {
  Law law;
  law.slope = {own_slope, 1.5 * own_slope, 0.7 * own_slope};
  const Flight flight = flight_of(law, 1);
  const RowSet rows(flight, {0, flight.size()});
  const auto context = make_context<Setting<PhysicsFeatures>>(rows);
  const AffineMap map = fit_monotone_base(context, rows);
  const Certificate certificate = certificate_of_base<PhysicsFeatures>(context, map, rows);
  REQUIRE(certificate.proven());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    CHECK(certificate.slope[axis] == doctest::Approx(4 * law.slope[axis]).epsilon(0.02));
  }
  for (int output = 0; output < 4; ++output) {
    for (int axis = 0; axis < 3; ++axis) {
      if (output == axis + 1) continue;
      CHECK(map.weights[std::size_t(output * PhysicsFeatures::size + 3 + axis)] == 0);
    }
  }
}

TEST_CASE("rows that say the contrary of a vehicle are not believed: the least share of its own slope") {
  Law law;
  law.slope[1] = -own_slope;
  const Flight flight = flight_of(law, 2);
  const RowSet rows(flight, {0, flight.size()});
  const auto context = make_context<Setting<PhysicsFeatures>>(rows);
  const AxisSlopes own = hover_slopes(PaperQuadrotor::value<double>());
  const Certificate certificate = certificate_of_base<PhysicsFeatures>(context, fit_monotone_base(context, rows), rows);
  REQUIRE(certificate.proven());
  CHECK(certificate.slope[1] == doctest::Approx(0.01 * own[1]).epsilon(1e-5));
  CHECK(certificate.slope[0] == doctest::Approx(4 * own_slope).epsilon(0.02));

  const Certificate pinned = certificate_of_base<PhysicsFeatures>(context, fit_monotone_base(context, rows, own), rows);
  for (std::size_t axis = 0; axis < 3; ++axis) CHECK(pinned.slope[axis] == doctest::Approx(own[axis]).epsilon(1e-5));
  CHECK_THROWS_AS(fit_monotone_base(context, rows, AxisSlopes{1, -1, 1}), std::invalid_argument);
}

TEST_CASE("of a window the present and the sum over the taps are held above 0, each on its own") {
  const auto least_of = [](const Law& law) {
    const Flight flight = flight_of(law, 3);
    const RowSet rows(flight, {0, flight.size()});
    const auto context = make_context<Setting<Window>>(rows);
    return certificate_of_base<Window>(context, fit_monotone_base(context, rows), rows);
  };
  Law late;
  late.share_of_now = 0.3;
  Certificate found = least_of(late);
  REQUIRE(found.proven());
  CHECK(found.slope[0] == doctest::Approx(0.3 * 4 * own_slope).epsilon(0.05));
  CHECK(found.held_slope[0] == doctest::Approx(4 * own_slope).epsilon(0.02));
  late.share_of_now = -0.5;  // what is asked now is taken away of what was asked
  found = least_of(late);
  REQUIRE(found.proven());
  const AxisSlopes own = hover_slopes(PaperQuadrotor::value<double>());
  for (std::size_t axis = 0; axis < 3; ++axis)
    CHECK(found.slope[axis] == doctest::Approx(0.01 * own[axis]).epsilon(1e-4));
  Law against;
  against.slope = {-own_slope, own_slope, own_slope};
  against.share_of_now = -0.5;  // of the sum below 0 the present is above it
  found = least_of(against);
  REQUIRE(found.proven());
  CHECK(found.held_slope[0] == doctest::Approx(0.01 * own[0]).epsilon(1e-4));
  CHECK(found.slope[0] > 0.1 * own[0]);
}

TEST_CASE("a residual is kept where there is something to learn, bounded to what it says on the training rows") {
  const auto fitted = [](const Law& law, double least_gain = ResidualTraining{}.least_gain) {
    const Flight flight = flight_of(law, 4, 1500);
    const RowSet training(flight, {0, 1000}), validation(flight, {1000, 1500});
    const auto context = make_context<Setting<PhysicsFeatures>>(training);
    std::mt19937_64 engine(1);
    ResidualTraining how;
    how.epochs = 60;
    how.least_gain = least_gain;
    return fit_monotone<Residual>(context, training, validation, fit_monotone_base(context, training), how, engine,
                                  [](int) { return true; });
  };
  Law curved;
  curved.curve = 0.05;
  const auto fit = fitted(curved);
  CHECK(fit.finished);
  CHECK(fit.residual_kept);
  CHECK(fit.error < 0.5 * fit.base_error);
  CHECK(!fitted(Law{}).residual_kept);
  const auto asked = fitted(curved, 0.999);  // for more than there is to gain
  CHECK(asked.error > 0.001 * asked.base_error);
  CHECK(!asked.residual_kept);

  // far away it says no more than it did in training
  float x[PhysicsFeatures::size], y[4], base[4];
  std::mt19937_64 engine(9);
  const auto* bounds = fit.predictor.parameters.data() + fit.base.parameter_count;
  bool on_bound = false;
  for (int sample = 0; sample < 300; ++sample) {
    for (float& v : x) v = float(uniform(engine, -50, 50));
    fit.predictor.forward(x, y);
    fit.base.forward(x, base);
    for (int k = 0; k < 4; ++k) {
      const float said = y[k] - base[k], rounding = 1e-5F * (1 + std::abs(base[k]));
      CHECK(said >= bounds[k] - rounding);
      CHECK(said <= bounds[4 + k] + rounding);
      on_bound = on_bound || said <= bounds[k] + rounding || said >= bounds[4 + k] - rounding;
    }
  }
  CHECK(on_bound);
}

TEST_CASE("what is told to stop stops") {
  const Flight flight = flight_of(Law{}, 5);
  const RowSet rows(flight, {0, flight.size()});
  const auto context = make_context<Setting<PhysicsFeatures>>(rows);
  std::mt19937_64 engine(1);
  int asked = 0;
  const auto fit = fit_monotone<Residual>(context, rows, rows, fit_monotone_base(context, rows), ResidualTraining{},
                                          engine, [&asked](int) { return ++asked < 3; });
  CHECK(!fit.finished);
  CHECK(asked == 3);
}
