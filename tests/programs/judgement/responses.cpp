// SPDX-License-Identifier: MIT
// How a structured model's sums respond to an angular acceleration that is held, with the body rates that it makes, and
// to more thrust: against finite differences of the model as it flies, between two motions.
#include "model/response.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "support/monotone_shapes.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::test;

using WholeWindow = Windowed<PhysicsFeatures, 3, PeriodMicroseconds<20000>>;
using CentredWindow = PartlyWindowed<InverseFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>, Centred>;
template <class Features>
using Plain = MonotoneShape<Features, MonotoneBase<Features>>;
template <class Features>
using Learnt = MonotoneShape<Features, MonotonePredictor<Features, SmallResidual<Features, Tanh>>>;
using Residual = SmallResidual<PhysicsFeatures>;

constexpr double fastest = 3;  ///< body rates, rad/s

template <class Model>
programs::Response response_of(const Model& model, const programs::Direction& direction) {
  RunTimeNetwork network;
  REQUIRE(network.parse(detail::description_text<typename Model::Answer>()));
  return programs::response_along(direction, network, model.parameters.data(), model.input.standard_deviation.data(),
                                  model.output.standard_deviation.data());
}

template <class Shape>
struct Model : MonotoneModel<Shape> {
  using Answer = typename Shape::Network;
  explicit Model(std::uint64_t seed) : MonotoneModel<Shape>(seed) {
    if constexpr (MonotoneModel<Shape>::Structure::has_residual) {
      for (int k = 0; k < 4; ++k) {  // so far away that nothing is clipped
        this->bound(k) = -50;
        this->bound(4 + k) = 50;
      }
    }
    for (std::size_t i = 0; i < this->inputs; ++i) {
      if (std::string(Shape::Features::names[i]).substr(0, 2) != "w_") continue;
      this->envelope_lower[i] = static_cast<float>(-fastest);
      this->envelope_upper[i] = static_cast<float>(fastest);
    }
  }
  std::vector<std::string> names() const { return {Shape::Features::names.begin(), Shape::Features::names.end()}; }
};

template <class Shape>
programs::SeenInstants instants_of() {
  if constexpr (is_windowed<typename Shape::Features>) {
    using Window = typename Shape::Features::Window;
    return {Window::period_s, Window::earliest_s};
  }
  return {};
}

template <class Tap>
void set_motion(Tap& tap, std::mt19937_64& engine) {
  for (int i = 0; i < 3; ++i) {
    tap.linear_acceleration_m_s2[i] = static_cast<float>(uniform(engine, -3, 3));
    tap.angular_acceleration_rad_s2[i] = static_cast<float>(uniform(engine, -8, 8));
    tap.body_rates_rad_s[i] = static_cast<float>(uniform(engine, -fastest, fastest));
  }
}

/// Calls `at(tap, seconds behind the first instant)`.
template <class Features, class Inputs, class At>
void each_instant(Inputs& inputs, const At& at) {
  if constexpr (is_windowed<Features>) {
    using Window = typename Features::Window;
    at(inputs, -Window::earliest_s);
    for (int tap = 0; tap + 1 < Window::taps; ++tap) {
      at(inputs.others[std::size_t(tap)], Window::offset_s(tap) - Window::earliest_s);
    }
    inputs.complete = true;
  } else {
    at(inputs, 0.0);
  }
}

/// Change of the four sums between two motions, per unit of `step`; and what of it may be rounding.
template <class Shape, class More>
std::pair<std::array<double, 4>, double> difference(const Model<Shape>& model, double step, std::mt19937_64& engine,
                                                    const More& more) {
  using Features = typename Shape::Features;
  typename Features::template Inputs<float> inputs{};
  each_instant<Features>(inputs, [&](auto& tap, double) { set_motion(tap, engine); });
  auto asked = inputs;
  each_instant<Features>(asked, more);
  std::array<float, std::size_t(Features::size)> x{}, x_of_more{};
  Features::extract(inputs, x.data());
  Features::extract(asked, x_of_more.data());
  float u[4], u_of_more[4];
  const InverseDynamics<Model<Shape>> inverse(model);
  inverse.evaluate(x.data(), u);
  inverse.evaluate(x_of_more.data(), u_of_more);
  const auto mix = detail::signed_mix(PaperQuadrotor::value<double>());
  std::array<double, 4> sums{};
  double largest = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    largest = std::max({largest, std::abs(double(u[i])), std::abs(double(u_of_more[i]))});
    for (std::size_t k = 0; k < 4; ++k) sums[k] += mix.signs[k][i] * (double(u_of_more[i]) - double(u[i])) / step;
  }
  return {sums, 1e-5 * largest / std::abs(step)};
}

}  // namespace

TEST_CASE_TEMPLATE("an acceleration that is held, with its body rates: between the bounds, and near them", Shape,
                   Plain<PhysicsFeatures>, Plain<PhysicsWindow>, Plain<WholeWindow>, Plain<CentredWindow>,
                   Learnt<PhysicsWindow>, Learnt<WholeWindow>) {
  std::mt19937_64 engine(1);
  double largest_rates = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Model<Shape> model(seed);
    const std::vector<double> lower(model.envelope_lower.begin(), model.envelope_lower.end());
    const std::vector<double> upper(model.envelope_upper.begin(), model.envelope_upper.end());
    const Certificate certificate = model.certificate();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto direction = programs::held_with_rates(model.names(), axis, instants_of<Shape>(), lower, upper);
      REQUIRE(direction.has_value());
      const programs::Response response = response_of(model, *direction);
      double least = 1e300, most = -1e300;
      for (int sample = 0; sample < 300; ++sample) {
        const double step = sample % 2 == 0 ? 2 : -5;
        const auto [sums, doubt] = difference(model, step, engine, [&](auto& tap, double elapsed) {
          tap.angular_acceleration_rad_s2[int(axis)] += static_cast<float>(step);
          tap.body_rates_rad_s[int(axis)] += static_cast<float>(step * elapsed);
          // velocities are 0: the specific force does not turn
        });
        for (std::size_t k = 0; k < 4; ++k) {
          CHECK(sums[k] >= response.base_least[k] + response.residual_least[k] - doubt);
          CHECK(sums[k] <= response.base_most[k] + response.residual_most[k] + doubt);
        }
        least = std::min(least, sums[axis + 1]);
        most = std::max(most, sums[axis + 1]);
      }
      const double room = response.base_most[axis + 1] - response.base_least[axis + 1];
      if (!Model<Shape>::Structure::has_residual) {  // exact of an affine base
        CHECK(least - response.least(axis + 1) <= 0.25 * room + 1e-4);
      }
      largest_rates = std::max(largest_rates, std::abs(response.least(axis + 1) - certificate.held_slope[axis]));
    }
  }
  if (is_windowed<typename Shape::Features>) {
    CHECK(largest_rates > 1e-3);  // the body rates do count
  } else if (!Model<Shape>::Structure::has_residual) {
    CHECK(largest_rates < 1e-6);
  }
}

TEST_CASE_TEMPLATE("more thrust at all instants: the base's slope exactly, with the residual's paths at every input",
                   Shape, Plain<PhysicsFeatures>, Plain<WholeWindow>, Learnt<PhysicsFeatures>, Learnt<CentredWindow>) {
  std::mt19937_64 engine(2);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Model<Shape> model(seed);
    const auto direction = programs::more_thrust(model.names());
    REQUIRE(direction.has_value());
    const programs::Response response = response_of(model, *direction);
    CHECK(response.base_least[0] == doctest::Approx(model.certificate().held_thrust_slope).epsilon(1e-9));
    for (int sample = 0; sample < 300; ++sample) {
      const double step = sample % 2 == 0 ? 0.5 : 4;
      const auto [sums, doubt] = difference(
          model, step, engine, [&](auto& tap, double) { tap.linear_acceleration_m_s2[2] -= static_cast<float>(step); });
      CHECK(sums[0] >= response.least(0) - doubt);
    }
  }
}

TEST_CASE("a body rate's weight can take a held acceleration's whole slope: it is seen") {
  Model<Plain<PhysicsWindow>> model(1);
  using Base = Model<Plain<PhysicsWindow>>::Base;
  model.input.standard_deviation.fill(1);
  model.output.standard_deviation.fill(1);
  model.slope(2) = 0.0375F;
  model.slope(5) = model.slope(8) = 0;
  const int yaw_rate = 8 - 3;  // among the features that are no angular acceleration
  model.parameters[std::size_t(Base::weights + 3 * Base::Threes::others + yaw_rate)] = -0.95F;
  model.parameters[std::size_t(Base::weights + 3 * Base::Threes::others + yaw_rate + 1)] = 0;
  model.parameters[std::size_t(Base::weights + 3 * Base::Threes::others + yaw_rate + 2)] = 0;
  CHECK(model.certificate().held_slope[2] == doctest::Approx(0.0375));
  const std::vector<double> lower(model.envelope_lower.begin(), model.envelope_lower.end());
  const std::vector<double> upper(model.envelope_upper.begin(), model.envelope_upper.end());
  const auto direction = programs::held_with_rates(model.names(), 2, instants_of<Plain<PhysicsWindow>>(), lower, upper);
  CHECK(response_of(model, *direction).least(3) == doctest::Approx(0.0375 - 0.95 * 0.04).epsilon(1e-6));  // -.0005
}

TEST_CASE("features without what is asked for, products without their rates") {
  CHECK(!programs::more_thrust({"w_x", "wdot_x"}));
  CHECK(!programs::held_with_rates({"wdot_x", "w_x", "w_xy"}, 0, {}, {0, 0, 0}, {1, 1, 1}));
  const auto direction = programs::held_with_rates({"wdot_x", "w_x", "w_zx", "w_z[-2]", "w_yz"}, 1, {0.1, -0.2},
                                                   {0, 0, 0, 0, 0}, {1, 1, 1, 1, 1});
  CHECK(!direction);  // w_yz of the present, whose w_z is another tap's
}
