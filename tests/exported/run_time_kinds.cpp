// SPDX-License-Identifier: MIT
// A model of every kind, as its block describes it, commands what the compiled model commands, to the bit; so are its
// features, and so is what is said of inputs that are none. Its derivatives and its certificate are those of the
// compiled model.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "models/own_racer.hpp"
#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/exported/run_time_batch.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "support/block_bytes.hpp"
#include "support/drawn_model.hpp"
#include "support/random_states.hpp"
#include "support/uneven_airframe.hpp"

using namespace pinnquad;
using pinnquad::test::BlockBytes;
using pinnquad::test::drawn_block;
using pinnquad::test::drawn_features;
using pinnquad::test::drawn_model;
using pinnquad::test::ModelOf;
using pinnquad::test::RandomStates;

namespace {

#if defined(__OPTIMIZE__)
constexpr int inputs_per_kind = 2000, motions_per_set = 500;  // 10^5 and more in all
#else
constexpr int inputs_per_kind = 100, motions_per_set = 50;
#endif

/// Tilted rotors with curves, known to the compiler.
using Racer = OwnRacerAirframe;

/// Products of inertia, and no two rotors alike: known at run time alone.
GivenAirframe uneven() { return {"uneven", test::uneven_airframe<double>()}; }

template <class Scalar>
std::unique_ptr<RunTimeModel<Scalar>> opened(const BlockBytes& block) {
  auto model = std::make_unique<RunTimeModel<Scalar>>();
  const Status status = RunTimeModel<Scalar>::open(block.data(), block.size(), *model);
  INFO("expected " << (model->fault().expected == nullptr ? "" : model->fault().expected));
  REQUIRE(status == Status::ok);
  return model;
}

/// By the portable kernel, of the block that a shape reads.
template <class Model>
Commands<typename Model::Scalar> by_view(const ModelView<Model>& view, const typename Model::Scalar* x) {
  typename Model::Scalar outputs[Model::Network::outputs] = {};
  Commands<typename Model::Scalar> u{};
  detail::Pipeline<typename Model::Features, typename Model::Outputs, typename Model::Vehicle>::run(
      detail::scales_of(view), x, outputs, u.data(),
      [&view](const auto* standardised, auto* made) { view.forward(standardised, made); });
  return u;
}

template <class Scalar>
bool same_bits(const Commands<Scalar>& a, const Commands<Scalar>& b) {
  return std::memcmp(a.data(), b.data(), sizeof(Scalar) * a.size()) == 0;
}

/// How often `predict` commands what the run-time model does, to the bit.
template <class Model, class Predict>
int same_commands(const Model& model, const RunTimeModel<typename Model::Scalar>& run_time, const Predict& predict) {
  std::vector<typename Model::Scalar> work(run_time.workspace());
  std::mt19937_64 engine(11);
  int same = 0;
  for (int i = 0; i < inputs_per_kind; ++i) {
    const auto x = drawn_features(model, engine);
    Commands<typename Model::Scalar> u{};
    run_time.commands(x.data(), u.data(), work.data());
    same += same_bits(u, predict(x)) && run_time.inside_envelope(x.data());
  }
  return same;
}

/// Rows of a whole batch, of a part of one and of none: each to the bit what it is alone.
template <class Model>
void rows_are_the_same(const Model& model, const RunTimeModel<typename Model::Scalar>& run_time) {
  using Scalar = typename Model::Scalar;
  constexpr std::size_t most = 2 * std::size_t(run_time_lanes) + 5;
  std::vector<Scalar> work(run_time.workspace()), batch_work(batch_workspace(run_time)), x;
  std::mt19937_64 engine(12);
  for (std::size_t row = 0; row < most; ++row) {
    const auto motion = drawn_features(model, engine);
    x.insert(x.end(), motion.begin(), motion.end());
  }
  for (const std::size_t rows : {std::size_t(0), std::size_t(1), std::size_t(run_time_lanes), most}) {
    std::vector<Scalar> u(4 * most, Scalar(7));
    commands_of_rows(run_time, x.data(), rows, u.data(), batch_work.data());
    for (std::size_t row = 0; row < most; ++row) {
      Commands<Scalar> alone{Scalar(7), Scalar(7), Scalar(7), Scalar(7)}, of_batch{};
      std::copy_n(u.data() + 4 * row, 4, of_batch.begin());
      if (row < rows) run_time.commands(x.data() + row * (x.size() / most), alone.data(), work.data());
      CHECK(same_bits(alone, of_batch));
    }
  }
}

template <class Model>
void commands_are_the_same(const Model& model) {
  const BlockBytes block(drawn_block(model));
  const auto run_time = opened<typename Model::Scalar>(block);
  std::vector<typename Model::Scalar> work(run_time->workspace());
  CHECK(run_time->golden_difference(work.data()) <= 0);
  rows_are_the_same(model, *run_time);
  CHECK(same_commands(model, *run_time, [&](const auto& x) { return model.predict(x); }) == inputs_per_kind);
  const RunTimeRow<typename Model::Scalar> row(*run_time);
  std::vector<typename Model::Scalar> row_work(row.workspace());
  CHECK(same_commands(model, *run_time, [&](const auto& x) {
          Commands<typename Model::Scalar> u{};
          row.commands(x.data(), u.data(), row_work.data());
          return u;
        }) == inputs_per_kind);
  if constexpr (!std::is_same_v<typename Model::Vehicle, GivenAirframe>) {
    ModelView<Model> view;
    REQUIRE(ModelView<Model>::open(block.data(), block.size(), view) == Status::ok);
    CHECK(same_commands(model, *run_time, [&](const auto& x) { return by_view(view, x.data()); }) == inputs_per_kind);
  }
}

template <class Model>
void commands_are_the_same(std::uint64_t seed) {
  if constexpr (std::is_same_v<typename Model::Vehicle, GivenAirframe>) {
    commands_are_the_same(drawn_model<Model>(seed, Model{uneven()}));
  } else {
    commands_are_the_same(drawn_model<Model>(seed));
  }
}

template <class Scalar, class Activation>
using Small = Network<Scalar, InputSize<16>, Dense<9>, Activation, Dense<7>, Activation, Dense<4>>;
template <class Activation>
using Activated = ModelOf<Small<float, Activation>, PaperFeatures>;
template <class Activation>
using ActivatedInDouble = ModelOf<Small<double, Activation>, PaperFeatures, CommandOutputs, Racer>;

/// `Size` features in, the schema's outputs out.
template <int Size, class Outputs, class Scalar = float>
using SmallOf = Network<Scalar, InputSize<Size>, Dense<8>, Tanh, Dense<OutputMap<Outputs>::size>>;
template <class Outputs, class Vehicle, class Features = PaperFeatures, class Scalar = float>
using OfSchema = ModelOf<SmallOf<Features::size, Outputs, Scalar>, Features, Outputs, Vehicle>;
template <class Features, class Scalar = float>
using OfFeatures = ModelOf<SmallOf<Features::size, CommandOutputs, Scalar>, Features>;

using Paper10 =
    Network<float, InputSize<16>, Dense<25>, Relu, Dense<25>, Relu, Dense<25>, Relu, Dense<25>, Relu, Dense<25>, Relu,
            Dense<25>, Relu, Dense<25>, Relu, Dense<25>, Relu, Dense<25>, Relu, Dense<25>, Relu, Dense<4>>;
using WithoutBias = Network<float, InputSize<16>, DenseWithoutBias<9>, Gelu, DenseWithoutBias<4>>;
template <class Scalar>
using Normed = Network<Scalar, InputSize<16>, LayerNorm<16>, Dense<9>, RmsNorm<9>, Relu, Dense<7>, LayerNorm<4>, Glu<3>,
                       Tanh, Dense<4>>;
using Clipped = Network<double, InputSize<16>, Clip, Dense<40>, Softplus, Dense<4>>;

using Residual = Network<float, InputSize<residual_inputs<PhysicsFeatures>>, Dense<8>, Relu, Dense<4>>;
using Period = PeriodMicroseconds<20000>;
using PhysicsWindow = PartlyWindowed<PhysicsFeatures, AccelerationFeatures, 3, Period>;
using WindowResidual = Network<double, InputSize<residual_inputs<PhysicsWindow>>, Dense<8>, Silu, Dense<4>>;
using OnBase = SignedSumsOn<RigidBodyBase>;

using BaseAlone = ModelOf<MonotoneBase<PhysicsFeatures>, PhysicsFeatures, AxisCommandOutputs>;
using Monotone = ModelOf<MonotonePredictor<PhysicsFeatures, Residual>, PhysicsFeatures, AxisCommandOutputs>;
using MonotoneWindow = ModelOf<MonotonePredictor<PhysicsWindow, WindowResidual>, PhysicsWindow, AxisCommandOutputs>;
using MonotoneOnBase = ModelOf<MonotonePredictor<PhysicsFeatures, Residual>, PhysicsFeatures, OnBase>;
/// No structure that is proven: two networks, a base that covers no angular acceleration.
using TwoNetworks = ModelOf<Sum<Small<float, Relu>, Small<float, Sine>>, PaperFeatures>;
using OtherThrees =
    ModelOf<Sum<AxisAligned<double, 16, 0, 6>, Masked<Network<double, InputSize<10>, Dense<4>>, 16, 3, 9>>,
            PaperFeatures, AxisCommandOutputs>;

struct Load {
  static constexpr const char* name = "load";
  static constexpr const char* unit = "N";
};
using WithTwo = WithColumns<PaperFeatures, BatteryVoltage, Load>;
using WithTwoByTwo = WithColumns<WithColumns<PaperFeatures, Load>, BatteryVoltage>;
using AltitudeAndColumn = WithColumns<InverseFeaturesWithAltitude, BatteryVoltage>;
using ColumnsInFront = Chosen<WithTwo, 17, 16, 5, 3, 4, 0, 9>;
using CausalWindow = Windowed<WithTwo, 4, Period>;
using CentredWindow = Windowed<PaperFeaturesWithAltitude, 5, Period, Centred>;
using PartlyCentred = PartlyWindowed<AltitudeAndColumn, AngularAcceleration, 3, Period, Centred>;

/// Inputs and features of a user's own: two names that the library does not know, and some that it does.
template <class Scalar>
struct WindInputs : MotionInputs<Scalar> {
  Scalar wind_m_s = Scalar(0), pull_N = Scalar(0);
};
struct WindFeatures {
  template <class Scalar>
  using Inputs = WindInputs<Scalar>;
  static constexpr int size = 6;
  static constexpr int angular_acceleration = 1;
  static constexpr std::array<const char*, 6> names = {"wind", "wdot_x", "wdot_y", "wdot_z", "pull", "s_z"};
  static constexpr std::array<const char*, 6> units = {"m/s", "rad/s^2", "rad/s^2", "rad/s^2", "N", "m/s^2"};

  template <class Scalar>
  static Status check(const WindInputs<Scalar>& in) noexcept {
    if (!is_finite(in.wind_m_s) || !is_finite(in.pull_N)) return Status::not_finite;
    return PaperFeatures::check<Scalar>(in);
  }
  template <class Scalar>
  static void extract(const WindInputs<Scalar>& in, Scalar* x) noexcept {
    x[0] = in.wind_m_s;
    AngularAcceleration::extract(static_cast<const MotionInputs<Scalar>&>(in), x + 1);
    x[4] = in.pull_N;
    ThrustAxisForce::extract(static_cast<const MotionInputs<Scalar>&>(in), x + 5);
  }
};

/// A linear schema of a user's own: pairs of rotors, and what each differs from its pair.
struct PairOutputs {
  static constexpr int size = 5;
  static constexpr bool linear = true;
  static constexpr bool takes_features = false;
  static constexpr std::array<const char*, size> names = {"first", "second", "within_first", "within_second", "all"};
  static constexpr std::array<const char*, size> units = {"1", "1", "1", "1", "%"};

  template <class Scalar>
  static void commands(const Scalar*, const Scalar* y, const Airframe<Scalar>&, Scalar* u) noexcept {
    u[0] = y[0] + y[2] + Scalar(0.01) * y[4] + Scalar(0.125);
    u[1] = y[0] - y[2] + Scalar(0.01) * y[4];
    u[2] = y[1] + y[3] + Scalar(0.01) * y[4];
    u[3] = y[1] - y[3] + Scalar(0.01) * y[4];
  }
  template <class Scalar>
  static void from_commands(const Scalar*, const Scalar* u, const Airframe<Scalar>&, Scalar* y) noexcept {
    y[0] = (u[0] + u[1]) / 2;
    y[1] = (u[2] + u[3]) / 2;
    y[2] = (u[0] - u[1]) / 2;
    y[3] = (u[2] - u[3]) / 2;
    y[4] = Scalar(0);
  }
};

// random inputs of each kind; one in ten is none

template <class Scalar>
Scalar number(RandomStates& random, double largest) {
  const Scalar broken[] = {std::numeric_limits<Scalar>::quiet_NaN(), std::numeric_limits<Scalar>::infinity()};
  const std::uint64_t die = random.engine()() % 200;
  return die < 2 ? broken[die] : random.scalar<Scalar>(-largest, largest);
}
template <class Scalar>
void draw(RandomStates& random, MotionInputs<Scalar>& in) {
  for (int i = 0; i < 3; ++i) {
    in.linear_acceleration_m_s2[i] = number<Scalar>(random, 20);
    in.angular_acceleration_rad_s2[i] = number<Scalar>(random, 60);
    in.velocity_m_s[i] = random.scalar<Scalar>(-8, 8);
    in.body_rates_rad_s[i] = random.scalar<Scalar>(-6, 6);
  }
  in.attitude = random.attitude<Scalar>();
  if (random.engine()() % 30 == 0) in.attitude.x += Scalar(0.3);
}
template <class Scalar>
void draw(RandomStates& random, MotionInputsWithAltitude<Scalar>& in) {
  draw(random, static_cast<MotionInputs<Scalar>&>(in));
  in.altitude_m = number<Scalar>(random, 30);
}
template <class Base, class Scalar, class... Column>
void draw(RandomStates& random, detail::InputsWithColumns<Base, Scalar, Column...>& in) {
  draw(random, static_cast<Base&>(in));
  for (Scalar& value : in.columns) value = number<Scalar>(random, 15);
}
template <class Scalar>
void draw(RandomStates& random, WindInputs<Scalar>& in) {
  draw(random, static_cast<MotionInputs<Scalar>&>(in));
  in.wind_m_s = number<Scalar>(random, 10);
  in.pull_N = number<Scalar>(random, 3);
}
template <class Tap, class Scalar, class Window>
void draw(RandomStates& random, detail::WindowInputs<Tap, Scalar, Window>& in) {
  draw(random, static_cast<Tap&>(in));
  for (Tap& other : in.others) draw(random, other);
  in.complete = true;
}

// the same as a run-time model asks for them; columns in the order of the features

template <class Scalar>
void take(const MotionInputs<Scalar>& in, RunTimeFeatures::Inputs<Scalar>& to, std::size_t&) {
  static_cast<MotionInputs<Scalar>&>(to) = in;
}
template <class Scalar>
void take(const MotionInputsWithAltitude<Scalar>& in, RunTimeFeatures::Inputs<Scalar>& to, std::size_t&) {
  static_cast<MotionInputsWithAltitude<Scalar>&>(to) = in;
}
template <class Base, class Scalar, class... Column>
void take(const detail::InputsWithColumns<Base, Scalar, Column...>& in, RunTimeFeatures::Inputs<Scalar>& to,
          std::size_t& at) {
  take(static_cast<const Base&>(in), to, at);
  for (const Scalar value : in.columns) to.columns[at++] = value;
}
template <class Scalar>
void take(const WindInputs<Scalar>& in, RunTimeFeatures::Inputs<Scalar>& to, std::size_t& at) {
  take(static_cast<const MotionInputs<Scalar>&>(in), to, at);
  to.columns[at++] = in.wind_m_s;
  to.columns[at++] = in.pull_N;
}
template <class Inputs, class Scalar>
RunTimeFeatures::Inputs<Scalar> tap_of(const Inputs& in) {
  RunTimeFeatures::Inputs<Scalar> to;
  std::size_t at = 0;
  take(in, to, at);
  return to;
}
template <class Features, class Scalar>
std::vector<RunTimeFeatures::Inputs<Scalar>> taps_of(const typename Features::template Inputs<Scalar>& in) {
  if constexpr (is_windowed<Features>) {
    using Tap = typename Features::TapFeatures::template Inputs<Scalar>;
    std::vector<RunTimeFeatures::Inputs<Scalar>> taps = {tap_of<Tap, Scalar>(in)};
    for (const Tap& other : in.others) taps.push_back(tap_of<Tap, Scalar>(other));
    return taps;
  } else {
    return {tap_of<typename Features::template Inputs<Scalar>, Scalar>(in)};
  }
}

template <class Features, class Scalar>
void features_are_the_same() {
  using Model = OfFeatures<Features, Scalar>;
  const BlockBytes block(drawn_block(drawn_model<Model>(3)));
  const auto model = opened<Scalar>(block);
  const RunTimeFeatures& features = model->features();
  REQUIRE(features.size() == Features::size);
  if constexpr (is_windowed<Features>) {
    for (int tap = 0; tap < Features::Window::taps; ++tap) {
      CHECK(features.angular_acceleration(tap) == angular_acceleration_at<Features>(tap));
    }
  } else {
    CHECK(features.angular_acceleration(0) == Features::angular_acceleration);
  }
  RandomStates random(5);
  int sound = 0, same_status = 0, same = 0;
  for (int i = 0; i < motions_per_set; ++i) {
    typename Features::template Inputs<Scalar> in;
    draw(random, in);
    const auto taps = taps_of<Features, Scalar>(in);
    const Status status = Features::check(in);
    same_status += features.check(taps.data()) == status;
    if (status != Status::ok) continue;
    ++sound;
    typename Model::FeatureVector expected{}, x{};
    Features::extract(in, expected.data());
    features.extract(taps.data(), x.data());
    same += std::memcmp(x.data(), expected.data(), sizeof x) == 0;
  }
  CHECK(same_status == motions_per_set);
  CHECK(sound > motions_per_set / 4);
  CHECK(sound < motions_per_set);
  CHECK(same == sound);
}

}  // namespace

TEST_CASE_TEMPLATE("commands to the bit: the paper's network, each activation, double, layers without bias", Model,
                   ModelOf<Paper10, PaperFeatures>, Activated<Relu>, Activated<Tanh>, Activated<Gelu>, Activated<Silu>,
                   Activated<Softplus>, Activated<Sine>, Activated<Clip>, Activated<Elu>, Activated<LeakyRelu>,
                   Activated<GeluTanh>, Activated<HardSwish>, Activated<Mish>, Activated<Softsign>,
                   ActivatedInDouble<Tanh>, ActivatedInDouble<Gelu>, ActivatedInDouble<Elu>,
                   ModelOf<WithoutBias, PaperFeatures>, ModelOf<Clipped, PaperFeatures>,
                   ModelOf<Normed<float>, PaperFeatures>, ModelOf<Normed<double>, PaperFeatures>) {
  commands_are_the_same<Model>(1);
}

TEST_CASE("a norm or a gate of more numbers than there are is no description") {
  RunTimeNetwork network;
  for (const char* layer : {"LayerNorm<25>", "RmsNorm<1>", "Glu<12>"}) {
    const std::string text =
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<25>, pinnquad::" + std::string(layer) +
        ", pinnquad::Dense<4>>";
    CHECK(network.parse(text));
    CHECK(network.outputs() == 4);
  }
  for (const char* layer : {"LayerNorm<26>", "RmsNorm<0>", "RmsNorm<>", "LayerNorm", "Glu<13>", "Glu<0>", "Glu<-1>"}) {
    const std::string text =
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<25>, pinnquad::" + std::string(layer) +
        ", pinnquad::Dense<4>>";
    CHECK_FALSE(network.parse(text));
  }
}

TEST_CASE_TEMPLATE("commands to the bit: each output schema, rotors with curves, tilted, no two alike", Model,
                   OfSchema<RotorSpeedOutputs, PaperQuadrotor>, OfSchema<RotorSpeedOutputs, Racer>,
                   OfSchema<AxisCommandOutputs, PaperQuadrotor>, OfSchema<AxisCommandOutputs, GivenAirframe>,
                   OfSchema<WrenchOutputs, Racer>, OfSchema<WrenchOutputs, GivenAirframe>,
                   OfSchema<AccelerationOutputs, PaperQuadrotor, PaperFeatures, double>,
                   OfSchema<AccelerationOutputs, GivenAirframe>,
                   OfSchema<ResidualOutputs<LinearizedBase>, PaperQuadrotor>,
                   OfSchema<ResidualOutputs<LinearizedBase>, Racer>,
                   OfSchema<ResidualOutputs<RigidBodyBase>, PaperQuadrotor, PhysicsFeatures>,
                   OfSchema<ResidualOutputs<RigidBodyBase>, GivenAirframe, PhysicsFeatures, double>,
                   OfSchema<OnBase, PaperQuadrotor, PhysicsFeatures>,
                   OfSchema<OnBase, GivenAirframe, PhysicsFeatures>) {
  commands_are_the_same<Model>(2);
}

TEST_CASE_TEMPLATE("commands to the bit: sums, monotone models", Model, BaseAlone, Monotone, MonotoneWindow,
                   MonotoneOnBase, TwoNetworks, OtherThrees) {
  commands_are_the_same<Model>(3);
}

TEST_CASE_TEMPLATE("commands to the bit: columns, altitude, windows, features of a user's own", Model,
                   OfFeatures<WithTwo>, OfFeatures<ColumnsInFront>, OfFeatures<WithTwoByTwo>,
                   OfFeatures<AltitudeAndColumn, double>, OfFeatures<CausalWindow>, OfFeatures<CentredWindow>,
                   OfFeatures<PartlyCentred>, OfFeatures<WindFeatures>) {
  commands_are_the_same<Model>(4);
}

TEST_CASE("a linear schema that no library has: its numbers are in the block, and its commands agree to rounding") {
  using Model = OfSchema<PairOutputs, PaperQuadrotor, PaperFeatures, double>;
  const Model model = drawn_model<Model>(5);
  const BlockBytes block(drawn_block(model));
  const auto run_time = opened<double>(block);
  CHECK(run_time->records().affine != nullptr);
  CHECK(run_time->output(4).name == "all");
  CHECK(run_time->output(4).unit == "%");
  std::vector<double> work(run_time->workspace());
  std::mt19937_64 engine(12);
  for (int i = 0; i < inputs_per_kind; ++i) {
    const auto x = drawn_features(model, engine);
    Commands<double> u{};
    run_time->commands(x.data(), u.data(), work.data());
    const auto expected = model.predict(x);
    for (std::size_t k = 0; k < u.size(); ++k) CHECK(std::abs(u[k] - expected[k]) <= 1e-13);
  }
  const BlockModel ground("drawn.block", drawn_block(model));
  CHECK(ground.has_affine_schema());
  CHECK_FALSE(ground.is_axis_commands());
}

TEST_CASE_TEMPLATE("features to the bit, and the same statuses, of float and double", Features, PaperFeatures,
                   PhysicsFeatures, PhysicsFeaturesWithoutVelocity, InverseFeaturesWithAltitude, WithTwo, WithTwoByTwo,
                   AltitudeAndColumn, CausalWindow, CentredWindow, PartlyCentred, PhysicsWindow, WindFeatures) {
  features_are_the_same<Features, float>();
  features_are_the_same<Features, double>();
}

TEST_CASE("columns are asked for in the order of the features, each once, with its unit") {
  const BlockModel model("drawn.block", drawn_block(drawn_model<OfFeatures<CausalWindow>>(3)));
  const auto columns = model.columns();
  REQUIRE(columns.size() == 2);
  CHECK(columns[0].name == "battery_voltage");
  CHECK(columns[0].unit == "V");
  CHECK(columns[1].name == "load");
  CHECK(columns[1].unit == "N");
  CHECK_FALSE(model.features().asks_for_altitude());
  const BlockModel other("drawn.block", drawn_block(drawn_model<OfFeatures<PartlyCentred>>(3)));
  CHECK(other.features().asks_for_altitude());
  CHECK_FALSE(other.features().window().causal);
}

namespace {

/// Signed sums of the commands' derivatives by a held angular acceleration: `by_feature(feature)` are derivatives of
/// the commands.
template <class Features, class ByFeature>
AxisSlopes held(const Airframe<double>& airframe, bool all_taps, const ByFeature& by_feature) {
  AxisSlopes result{};
  int taps = 1;
  if constexpr (is_windowed<Features>) taps = all_taps ? Features::Window::taps : 1;
  for (int tap = 0; tap < taps; ++tap) {
    const int place = angular_acceleration_at<Features>(tap);
    for (int axis = 0; place >= 0 && axis < 3; ++axis) {
      const auto signs = allocation_signs(airframe, axis);
      const Commands<double> by = by_feature(place + axis);
      for (std::size_t rotor = 0; rotor < by.size(); ++rotor) result[std::size_t(axis)] += signs[rotor] * by[rotor];
    }
  }
  return result;
}

template <class Model>
Model some(std::uint64_t seed) {
  if constexpr (std::is_same_v<typename Model::Vehicle, GivenAirframe>)
    return drawn_model<Model>(seed, Model{uneven()});
  return drawn_model<Model>(seed, Model{});
}

}  // namespace

TEST_CASE_TEMPLATE("derivatives are those of central differences in double", Model, ActivatedInDouble<Tanh>,
                   ActivatedInDouble<Silu>, OfSchema<RotorSpeedOutputs, Racer, PaperFeatures, double>,
                   OfSchema<AccelerationOutputs, PaperQuadrotor, PaperFeatures, double>,
                   OfSchema<PairOutputs, PaperQuadrotor, PaperFeatures, double>,
                   OfSchema<ResidualOutputs<LinearizedBase>, Racer, PaperFeatures, double>,
                   OfSchema<ResidualOutputs<RigidBodyBase>, PaperQuadrotor, PhysicsFeatures, double>, MonotoneWindow,
                   OfFeatures<CausalWindow, double>, OfFeatures<CentredWindow, double>,
                   ModelOf<Normed<double>, PaperFeatures>) {
  const Model model = some<Model>(6);
  const BlockModel block("drawn.block", drawn_block(model));
  std::mt19937_64 engine(13);
  int worse = 0;
  for (int i = 0; i < 50; ++i) {
    const auto x = drawn_features(model, engine);
    const auto difference = [&](int feature) {
      constexpr double step = 1e-5;
      auto above = x, below = x;
      above[std::size_t(feature)] += step;
      below[std::size_t(feature)] -= step;
      Commands<double> by = model.predict(above);
      const Commands<double> other = model.predict(below);
      for (std::size_t k = 0; k < by.size(); ++k) by[k] = (by[k] - other[k]) / (2 * step);
      return by;
    };
    for (const bool all_taps : {true, false}) {
      const auto expected = held<typename Model::Features>(block.airframe(), all_taps, difference);
      const auto own = block.derivatives({x.begin(), x.end()}, all_taps);
      for (std::size_t axis = 0; axis < 3; ++axis) worse += !(std::abs(own[axis] - expected[axis]) <= 1e-7);
    }
  }
  CHECK(worse <= (std::is_same_v<Model, MonotoneWindow> ? 5 : 0));  // a bound of the residual within the step is a kink
}

TEST_CASE_TEMPLATE("derivatives are those that the flight side works out", Model, Activated<Relu>, Activated<Gelu>,
                   Activated<Elu>, ActivatedInDouble<LeakyRelu>, ActivatedInDouble<Softplus>,
                   OfSchema<WrenchOutputs, Racer>, Monotone, MonotoneOnBase, TwoNetworks, OfFeatures<CausalWindow>,
                   ModelOf<Normed<float>, PaperFeatures>) {
  using Scalar = typename Model::Scalar;
  const Model model = some<Model>(7);
  const auto bytes = drawn_block(model);
  const BlockBytes aligned(bytes);
  const BlockModel block("drawn.block", bytes);
  ModelView<Model> view;
  REQUIRE(ModelView<Model>::open(aligned.data(), aligned.size(), view) == Status::ok);
  const InverseDynamics<ModelView<Model>> inverse(view);
  std::mt19937_64 engine(14);
  for (int i = 0; i < 50; ++i) {
    const auto x = drawn_features(model, engine);
    Scalar u[rotor_count], jacobian[rotor_count * Model::Features::size];
    REQUIRE(predict_with_jacobian(inverse, x.data(), u, jacobian) == Status::ok);
    const auto column = [&jacobian](int feature) {
      Commands<double> by{};
      for (std::size_t k = 0; k < by.size(); ++k) {
        by[k] = static_cast<double>(jacobian[k * std::size_t(Model::Features::size) + std::size_t(feature)]);
      }
      return by;
    };
    const auto expected = held<typename Model::Features>(block.airframe(), true, column);
    const auto own = block.derivatives({x.begin(), x.end()});
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK(std::abs(own[axis] - expected[axis]) <= 2e-5);
  }
}

TEST_CASE_TEMPLATE("the certificate of a block is that of its training, number by number", Model, BaseAlone, Monotone,
                   MonotoneWindow, MonotoneOnBase) {
  const Model model = some<Model>(8);
  const BlockModel block("drawn.block", drawn_block(model));
  const std::optional<Certificate> own = block.certificate();
  REQUIRE(own.has_value());
  const Certificate expected = certificate_of_trained(model);
  CHECK(expected.proven());
  CHECK(own->monotone == expected.monotone);
  CHECK(own->bounded == expected.bounded);
  const auto same = [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  CHECK(same(own->slope, expected.slope));
  CHECK(same(own->held_slope, expected.held_slope));
  CHECK(same(own->thrust_slope, expected.thrust_slope));
  CHECK(same(own->held_thrust_slope, expected.held_thrust_slope));
  CHECK(same(own->rounding, expected.rounding));
  CHECK(same(own->sure_step, expected.sure_step));
  CHECK(same(own->residual_lower, expected.residual_lower));
  CHECK(same(own->residual_upper, expected.residual_upper));
  CHECK(same(own->command_bound, expected.command_bound));
}

TEST_CASE_TEMPLATE("a model without a structure has no certificate", Model, Activated<Relu>, TwoNetworks, OtherThrees,
                   OfSchema<AxisCommandOutputs, PaperQuadrotor>) {
  CHECK_FALSE(BlockModel("drawn.block", drawn_block(some<Model>(9))).certificate().has_value());
}
