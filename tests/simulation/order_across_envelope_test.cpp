// SPDX-License-Identifier: MIT
// Every inverse that flies keeps the order: more angular acceleration asked for about an axis never means less of that
// axis' signed command sum, across the envelope's edge too. Guard, clipping and fallback together; motions of flights,
// rays in every direction.
// Here and not beside the guard, because inference may not include simulation.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../examples/models/demo_quadrotor.hpp"
#include "../examples/models/structured_quadrotor.hpp"
#include "models/own_racer.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/features/input_history.hpp"
#include "pinnquad/simulation/flights.hpp"

namespace {

using namespace pinnquad;

using Vehicle = AgileFlight::Vehicle;
using Formula = AnalyticInverse<Vehicle>;

template <class Model>
using Flown = InverseDynamics<Model, Extend<TrainingGuard, ClipCommands<>, Fallback<Formula>>>;

/// Rounding of four float commands of magnitude 1 and of the differences between them.
constexpr double rounding = 1e-6;

template <class Airframe = PaperQuadrotor>
Vehicle vehicle() {
  return Vehicle(airframe_value<Airframe, double>(), paper_site<double>(), {}, {});
}

/// Motions of an agile flight, some faster than the shipped models were trained on.
std::vector<Sample> motions(std::size_t every) {
  std::vector<Sample> result;
  for (const double max_speed_m_s : {8.0, 12.0}) {
    const auto pilot = AgileFlight::pilot(vehicle(), std::mt19937_64(41), max_speed_m_s);
    FlightPlan plan = AgileFlight::plan();
    plan.samples = 3000;
    const auto recorded = fly(vehicle(), pilot, plan);
    for (std::size_t row = 0; row < recorded.flight.size(); row += every) result.push_back(recorded.flight[row]);
  }
  return result;
}

template <class Model>
using InputsOf = typename InverseDynamics<Model>::Inputs;

template <class Model>
InputsOf<Model> inputs_of(const Sample& sample) {
  return sample_inputs<InputsOf<Model>>(sample);
}

template <class Model>
double own_sum(const Commands<typename Model::Scalar>& commands, int axis) {
  const auto signs = allocation_signs(airframe_value<typename Model::Vehicle, double>(), axis);
  double sum = 0;
  for (std::size_t i = 0; i < rotor_count; ++i) sum += signs[i] * static_cast<double>(commands[i]);
  return sum;
}

struct Order {
  int steps = 0, crossings = 0, falls = 0;
  double worst = 0;
};

/// Whether the own sum falls between two instants of a ray; a crossing is a change of who answers.
template <class Model>
void compare(const Flown<Model>& inverse, const InputsOf<Model>& less, const InputsOf<Model>& more, int axis,
             Order& order) {
  using Answer = Commands<typename Model::Scalar>;
  const PlaceAndTime<double> place{};
  Answer low{}, high{};
  const Status first = inverse.predict(less, place, low), second = inverse.predict(more, place, high);
  REQUIRE(has_output(first));
  REQUIRE(has_output(second));
  ++order.steps;
  order.crossings += (first == Status::fell_back) != (second == Status::fell_back);
  const double rise = own_sum<Model>(high, axis) - own_sum<Model>(low, axis);
  order.falls += rise < -rounding;
  order.worst = std::min(order.worst, rise);
}

}  // namespace

namespace {

/// Steps of every size along each axis, through either edge, within and without, with the other axes anywhere.
template <class Model>
Order along_rays() {
  const Flown<Model> inverse{typename Flown<Model>::Guard(Formula(vehicle()))};
  using Scalar = typename Model::Scalar;
  std::mt19937_64 engine(43);
  Order order;
  for (const Sample& sample : motions(24)) {
    InputsOf<Model> less = inputs_of<Model>(sample);
    const auto anywhere = [&](int axis, double share) {
      const auto at = static_cast<std::size_t>(Model::Features::angular_acceleration + axis);
      const auto lower = static_cast<double>(Model::envelope_lower[at]),
                 upper = static_cast<double>(Model::envelope_upper[at]);
      return static_cast<Scalar>((lower + upper) / 2 + share * (upper - lower));
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (int other = 0; other < 3; ++other) {
        less.angular_acceleration_rad_s2[other] = anywhere(other, uniform(engine, -1, 1));
      }
      InputsOf<Model> more = less;
      for (const double from : {-0.5, 0.5, uniform(engine, -1, 1)}) {
        for (int step = 0; step < 8; ++step) {
          less.angular_acceleration_rad_s2[axis] = anywhere(axis, from - std::pow(10, uniform(engine, -5, -0.3)));
          more.angular_acceleration_rad_s2[axis] = anywhere(axis, from + std::pow(10, uniform(engine, -5, -0.3)));
          compare<Model>(inverse, less, more, axis, order);
        }
      }
    }
  }
  return order;
}

}  // namespace

TEST_CASE("along rays of angular acceleration, through the envelope and out of it, the own sum never falls") {
  const Order order = along_rays<StructuredQuadModel>();
  MESSAGE(order.falls, " of ", order.steps, " steps fall, worst ", order.worst);
  CHECK(order.crossings > 1000);
  CHECK(order.falls == 0);
}

namespace {

/// A motion within the envelope: hover.
template <class Model>
InputsOf<Model> hovering() {
  return {};
}
template <>
InputsOf<OwnRacer> hovering<OwnRacer>() {
  InputsOf<OwnRacer> inputs;
  using Present = InputHistory<OwnRacer::Features, double>::Present;
  auto& present = static_cast<Present&>(inputs);
  constexpr auto voltage_at = static_cast<std::size_t>(PaperFeatures::size);
  present.column<BatteryVoltage>() = (OwnRacer::envelope_lower[voltage_at] + OwnRacer::envelope_upper[voltage_at]) / 2;
  inputs.others[0] = present;
  inputs.complete = true;
  return inputs;
}

}  // namespace

TEST_CASE_TEMPLATE(
    "a network without proof, with a past too: nothing is promised within; no jump at the edge, and order "
    "beyond it",
    Model, DemoQuadModel, OwnRacer) {
  using Scalar = typename Model::Scalar;
  const Flown<Model> inverse{typename Flown<Model>::Guard(Formula(vehicle<typename Model::Vehicle>()))};
  const PlaceAndTime<double> place{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(Model::Features::angular_acceleration + axis);
    const Scalar upper = Model::envelope_upper[at];
    InputsOf<Model> less = hovering<Model>(), more = less;
    Commands<Scalar> low{}, high{};
    less.angular_acceleration_rad_s2[axis] = upper;
    more.angular_acceleration_rad_s2[axis] = upper * Scalar(1 + 1e-6);
    REQUIRE(inverse.predict(less, place, low) == Status::ok);
    REQUIRE(inverse.predict(more, place, high) == Status::fell_back);
    constexpr double step_and_rounding = 5e-6;
    for (std::size_t i = 0; i < rotor_count; ++i) CHECK(std::abs(double(high[i] - low[i])) <= step_and_rounding);
    Order order;
    for (int step = 0; step < 100; ++step) {
      less.angular_acceleration_rad_s2[axis] = upper * Scalar(1.001 + 0.05 * step);
      more.angular_acceleration_rad_s2[axis] = upper * Scalar(1.001 + 0.05 * (step + 1));
      compare<Model>(inverse, less, more, axis, order);
    }
    CHECK(order.falls == 0);
    CHECK(order.worst >= 0);
  }
}
