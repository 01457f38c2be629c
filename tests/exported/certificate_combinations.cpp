// SPDX-License-Identifier: MIT
// A certificate's slopes against finite differences of the whole model, for every combination of features, formula that
// the sums are added to, structure of the answer and centre of gravity that compiles. A combination that does not
// compile has no certificate.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/outputs/rigid_body_base.hpp"
#include "support/monotone_shapes.hpp"

using namespace pinnquad;
using namespace pinnquad::test;

namespace {

template <class FeatureSet, class Answer, class Schema>
struct AnyShape : MonotoneShape<FeatureSet, Answer> {
  using Outputs = Schema;
};

using OnRigidBody = SignedSumsOn<RigidBodyBase>;
using WithBattery = WithColumns<PhysicsFeatures, BatteryVoltage>;
using CentredWindow = PartlyWindowed<InverseFeatures, AccelerationFeatures, 3, PeriodMicroseconds<20000>, Centred>;
using WholeWindow = Windowed<PhysicsFeaturesWithoutVelocity, 2, PeriodMicroseconds<10000>>;

template <class Features, class Schema>
inline constexpr bool certified = has_certificate<AnyShape<Features, MonotoneBase<Features>, Schema>>;
static_assert(certified<PhysicsFeatures, OnRigidBody> && certified<PhysicsWindow, OnRigidBody> &&
              certified<WithBattery, OnRigidBody> && certified<WholeWindow, OnRigidBody>);
static_assert(!certified<InverseFeatures, OnRigidBody> && !certified<PaperFeatures, OnRigidBody> &&
              !certified<CentredWindow, OnRigidBody> && !certified<InverseFeaturesWithAltitude, OnRigidBody>);

/// Centre of gravity in the middle, 3 cm back and 2 cm aside of it; inertia about other axes than the body's, curved
/// thrust.
std::vector<Airframe<double>> airframes() {
  std::vector<Airframe<double>> all(4, PaperQuadrotor::value<double>());
  for (auto& rotor : all[1].rotors) rotor.x_m -= 0.03;
  for (auto& rotor : all[2].rotors) rotor.y_m += 0.02;
  for (auto& rotor : all[3].rotors) rotor.x_m += 0.03;
  all[3].inertia_products_kg_m2 = {1.1e-3, -0.7e-3, 0.4e-3};
  for (std::size_t i = 0; i < rotor_count; ++i) all[3].rotors[i].thrust_curve = 0.2 * double(i);
  return all;
}

/// The model as it flies, but that its vehicle is known at run time.
template <class Model>
Commands<double> commands_of(const Model& model, const Airframe<double>& airframe, const std::vector<float>& x) {
  using Schema = typename Model::Outputs;
  float z[Model::inputs], y[4], outputs[4], u[rotor_count];
  model.input.standardise(x.data(), static_cast<float*>(z));
  model.forward(static_cast<const float*>(z), static_cast<float*>(y));
  model.output.restore(static_cast<const float*>(y), static_cast<float*>(outputs));
  Schema::commands(x.data(), static_cast<const float*>(outputs), Schema::prepare(airframe_in<float>(airframe)),
                   static_cast<float*>(u));
  Commands<double> commands{};
  for (std::size_t i = 0; i < commands.size(); ++i) commands[i] = double(u[i]);
  return commands;
}

/// (sum, signed sums) of commands.
std::array<double, 4> sums_of(const Airframe<double>& airframe, const Commands<double>& u) {
  const auto mix = detail::signed_mix(airframe);
  std::array<double, 4> sums{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < rotor_count; ++i) sums[k] += mix.signs[k][i] * u[i];
  }
  return sums;
}

/// How the four sums change over a step of some features, per unit of it, from a random motion; and how much of that
/// may be rounding.
struct Change {
  std::array<double, 4> by{};
  double doubt = 0;
};
template <class Model>
Change change_of(const Model& model, const Airframe<double>& airframe, const std::vector<int>& places, float step,
                 std::mt19937_64& engine) {
  std::vector<float> x;
  for (std::size_t i = 0; i < Model::inputs; ++i) {
    x.push_back(static_cast<float>(uniform(engine, double(model.envelope_lower[i]), double(model.envelope_upper[i]))));
  }
  std::vector<float> more(x);
  double moved = 0;
  for (const int place : places) {
    more[std::size_t(place)] += step;
    moved = double(more[std::size_t(place)]) - double(x[std::size_t(place)]);
  }
  const Commands<double> u = commands_of(model, airframe, x), u_of_more = commands_of(model, airframe, more);
  const auto before = sums_of(airframe, u), after = sums_of(airframe, u_of_more);
  Change change;
  double largest = 1;
  for (std::size_t i = 0; i < rotor_count; ++i) largest = std::max({largest, std::abs(u[i]), std::abs(u_of_more[i])});
  for (std::size_t k = 0; k < 4; ++k) change.by[k] = (after[k] - before[k]) / moved;
  change.doubt = 4e-6 * largest / std::abs(moved);
  return change;
}

std::vector<int> taps_of(const std::vector<int>& places, int axis) {
  std::vector<int> all;
  for (const int place : places) all.push_back(place + axis);
  return all;
}

/// Places of features of a name, the present one and those of a window's taps.
template <class Features>
std::vector<int> places_named(const std::string& name) {
  std::vector<int> all;
  for (int i = 0; i < Features::size; ++i) {
    const std::string own = Features::names[std::size_t(i)];
    if (own.substr(0, own.find('[')) == name) all.push_back(i);
  }
  return all;
}

template <class Shape>
MonotoneModel<Shape> model_of(std::uint64_t seed) {
  return MonotoneModel<Shape>(seed);
}

template <class Shape>
void check_slopes() {
  using Features = typename Shape::Features;
  std::mt19937_64 engine(1);
  int proven = 0;
  std::vector<int> places;
  for (int tap = 0; tap < detail::angular_acceleration_taps<Features>(); ++tap) {
    places.push_back(angular_acceleration_at<Features>(tap));
  }
  for (const Airframe<double>& airframe : airframes()) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto model = model_of<Shape>(seed);
      const Certificate certificate = model.certificate(airframe_in<float>(airframe));
      proven += certificate.proven() ? 1 : 0;
      for (int sample = 0; sample < 20; ++sample) {
        for (int axis = 0; axis < 3; ++axis) {
          const float step = sample % 2 == 0 ? 3.0F : -7.0F;
          const Change now = change_of(model, airframe, {places[0] + axis}, step, engine);
          const Change held = change_of(model, airframe, taps_of(places, axis), step, engine);
          double others = 0, held_others = 0;
          for (int k = 0; k < 4; ++k) {
            if (k == 1 + axis) continue;
            others += std::abs(now.by[std::size_t(k)]);
            held_others += std::abs(held.by[std::size_t(k)]);
          }
          CHECK(certificate.slope[axis] <= now.by[std::size_t(1 + axis)] + now.doubt);
          CHECK(certificate.held_slope[axis] <= held.by[std::size_t(1 + axis)] + held.doubt);
          CHECK(others <= 3 * now.doubt);
          CHECK(held_others <= 3 * held.doubt);
        }
      }
    }
  }
  CHECK(proven > 0);
}

/// All answers of a feature set on a schema.
template <class Features, class Schema>
void check_answers() {
  CAPTURE(Features::size);
  check_slopes<AnyShape<Features, MonotoneBase<Features>, Schema>>();
  check_slopes<AnyShape<Features, MonotonePredictor<Features, SmallResidual<Features>>, Schema>>();
}

}  // namespace

TEST_CASE_TEMPLATE("slopes are no more than differences give, other sums no less: whatever the centre of gravity",
                   Features, PhysicsFeatures, PhysicsFeaturesWithoutVelocity, InverseFeatures,
                   InverseFeaturesWithAltitude, PaperFeatures, WithBattery, PhysicsWindow, ForceWindow, CentredWindow,
                   WholeWindow) {
  check_answers<Features, AxisCommandOutputs>();
  if constexpr (certified<Features, OnRigidBody>) check_answers<Features, OnRigidBody>();
}

TEST_CASE_TEMPLATE("the thrust slope is no more than differences give, the residual's range taken off", Features,
                   PhysicsFeatures, InverseFeatures, PaperFeatures, PhysicsWindow, CentredWindow) {
  const auto check = [](auto shape) {
    using Shape = decltype(shape);
    std::vector<int> places = places_named<Features>("s_z");
    if (places.empty()) places = places_named<Features>("vdot_bz");
    REQUIRE(!places.empty());
    std::mt19937_64 engine(2);
    for (const Airframe<double>& airframe : airframes()) {
      const auto model = model_of<Shape>(3);
      const Certificate certificate = model.certificate(airframe_in<float>(airframe));
      const double range = certificate.residual_upper[0] - certificate.residual_lower[0];
      // a formula's curve is known to be no steeper than at command 1 while its commands are in 0 to 1
      constexpr bool on_formula = !std::is_same_v<typename Shape::Outputs, AxisCommandOutputs>;
      const bool curved = on_formula && airframe.rotors[3].thrust_curve > 0;
      double nearest = 1e300, nearest_held = 1e300;
      for (int sample = 0; sample < 60 && !curved; ++sample) {
        const float step = sample % 2 == 0 ? -2.0F : -11.0F;
        const Change now = change_of(model, airframe, {places[0]}, step, engine);
        const Change held = change_of(model, airframe, places, step, engine);
        const double most = range / std::abs(double(step));
        CHECK(-now.by[0] >= certificate.thrust_slope - most - now.doubt);
        CHECK(-held.by[0] >= certificate.held_thrust_slope - most - held.doubt);
        nearest = std::min(nearest, -now.by[0] - certificate.thrust_slope - now.doubt);
        nearest_held = std::min(nearest_held, -held.by[0] - certificate.held_thrust_slope - held.doubt);
      }
      if (curved) continue;
      CHECK(nearest <= 1e-6);  // it is no idle bound
      CHECK(nearest_held <= 1e-6);
    }
  };
  check(AnyShape<Features, MonotoneBase<Features>, AxisCommandOutputs>{});
  check(AnyShape<Features, MonotonePredictor<Features, SmallResidual<Features>>, AxisCommandOutputs>{});
  if constexpr (certified<Features, OnRigidBody>) {
    check(AnyShape<Features, MonotoneBase<Features>, OnRigidBody>{});
    check(AnyShape<Features, MonotonePredictor<Features, SmallResidual<Features>>, OnRigidBody>{});
  }
}

TEST_CASE("of a formula with curved thrust the least thrust slope is below each between commands 0 and 1") {
  for (const Airframe<double>& airframe : airframes()) {
    const double least = RigidBodyBase::least_thrust_slope(airframe);
    const auto body = RigidBodyBase::prepare(airframe);
    double nearest = 1e300;
    int inside = 0;
    for (double force = -0.5; force > -40; force -= 0.5) {
      double x[9] = {0, 0, force}, less[9] = {0, 0, force + 1e-4}, u[rotor_count], u_of_less[rotor_count];
      RigidBodyBase::commands(static_cast<const double*>(x), body, static_cast<double*>(u));
      RigidBodyBase::commands(static_cast<const double*>(less), body, static_cast<double*>(u_of_less));
      double rise = 0;
      for (std::size_t i = 0; i < rotor_count; ++i) rise += (u[i] - u_of_less[i]) / 1e-4;
      if (*std::max_element(u, u + rotor_count) > 1) continue;
      CHECK(rise >= least - 1e-9);
      nearest = std::min(nearest, rise - least);
      ++inside;
    }
    CHECK(inside > 10);
    CHECK(nearest < 0.1 * least);
  }
}
