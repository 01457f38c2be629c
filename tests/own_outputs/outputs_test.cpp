// SPDX-License-Identifier: MIT
// Models of six accelerations, of a wrench and of a residual on another inverse: everything that is done with a model
// of four commands is done with them, and nothing here asks which of them it has.
#include <doctest/doctest.h>

#include <accelerations.hpp>
#include <cmath>
#include <direct.hpp>
#include <memory>
#include <residual.hpp>
#include <structured.hpp>
#include <wrench.hpp>

#include "own_outputs/setting.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/self_test.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/simulation/tracking.hpp"
#include "support/block_bytes.hpp"
#include "support/jacobian_differences.hpp"

using namespace pinnquad;

namespace {

static_assert(AccelerationsModel::Network::outputs == 6 &&
              AccelerationsModel::golden_commands[0].size() == rotor_count);

/// Float rounding of outputs that are up to a hundred times the commands they become.
constexpr float rounding = 2e-5f;

template <class Model>
constexpr int size = Model::Features::size;

/// By plain loops in double: scaler, layers, scaler; then the schema's own words for what outputs mean.
template <class Model>
Commands<double> by_plain_loops(const typename Model::Scalar* x) {
  using Net = typename Model::Network;
  std::vector<double> v;
  for (std::size_t i = 0; i < Net::inputs; ++i) {
    v.push_back((double(x[i]) - double(Model::input.mean[i])) / double(Model::input.standard_deviation[i]));
  }
  std::size_t at = 0;
  const std::size_t widths[] = {20, 20, Net::outputs};
  for (std::size_t layer = 0; layer < 3; ++layer) {
    std::vector<double> next(widths[layer]);
    for (std::size_t row = 0; row < next.size(); ++row) {
      double sum = double(Model::parameters[at + next.size() * v.size() + row]);
      for (std::size_t k = 0; k < v.size(); ++k) sum += double(Model::parameters[at + row * v.size() + k]) * v[k];
      next[row] = layer < 2 ? std::tanh(sum) : sum;
    }
    at += next.size() * (v.size() + 1);
    v = next;
  }
  REQUIRE(at == Model::parameters.size());
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = v[i] * double(Model::output.standard_deviation[i]) + double(Model::output.mean[i]);
  const auto airframe = PaperQuadrotor::value<double>();
  const Rotors<double> rotors(airframe);
  Wrench<double> wrench;
  if constexpr (Net::outputs == 6) {
    wrench.force_N = airframe.mass_kg * Vector3<double>(v[0], v[1], v[2]);
    wrench.torque_N_m = to_vector(airframe.inertia_kg_m2).cwiseProduct(Vector3<double>(v[3], v[4], v[5]));
    return rotors.commands(wrench, 1.0);
  } else if constexpr (std::is_same_v<typename Model::Outputs, WrenchOutputs>) {
    wrench.force_N = Vector3<double>(0, 0, -v[0]);
    wrench.torque_N_m = Vector3<double>(v[1], v[2], v[3]);
    return rotors.commands(wrench, 1.0);
  } else {
    const Accelerations<double> motion{{double(x[0]), double(x[1]), double(x[2])},
                                       {double(x[3]), double(x[4]), double(x[5])}};
    Commands<double> u = linearized_commands(airframe, rotors, motion, standard_gravity_m_s2<double>, 1.0);
    for (std::size_t i = 0; i < 4; ++i) u[i] += v[i];
    return u;
  }
}

/// `Header` has the numbers of `model`. Of a column's largest entry: what float leaves of weights that partly cancel.
template <class Header, class Model>
void check_jacobian(const Model& model) {
  const InverseDynamics<Model> inverse(model);
  double worst = 0;
  for (std::size_t row = 0; row < 4; ++row) {
    const auto golden = Header::golden_features[row];
    float commands[4], plain[4], jacobian[4 * size<Model>];
    REQUIRE(predict_with_jacobian(inverse, golden.data(), commands, jacobian) == Status::ok);
    REQUIRE(inverse.predict_features(golden.data(), plain) == Status::ok);
    worst = std::fmax(worst, test::worst_column(jacobian, test::jacobian_by_differences<Header>(golden.data())));
    for (int i = 0; i < 4; ++i) CHECK(std::abs(commands[i] - plain[i]) <= rounding);
  }
  CHECK(worst <= 2.5e-5);
}

struct Narrow {
  static constexpr double lower = 0.5, upper = 0.6;
};

template <class Model>
void check_batch(const Model& model) {
  const InverseDynamics<Model, Extend<TrainingGuard, ClipCommands<Narrow>>> inverse(model);
  constexpr int samples = 37;
  std::vector<float> x(samples * size<Model>), commands(4 * samples, -7.0f);
  for (int s = 0; s < samples; ++s) {
    const auto golden = model.golden_features[static_cast<std::size_t>(s % 4)];
    for (int k = 0; k < size<Model>; ++k) {
      const float stretch = 0.3f + 0.1f * float(s);
      x[std::size_t(k * samples + s)] = golden[std::size_t(k)] * stretch;
    }
  }
  Status statuses[samples];
  predict_batch(inverse, x.data(), commands.data(), statuses, samples);
  int clipped = 0, refused = 0;
  for (int s = 0; s < samples; ++s) {
    float alone[size<Model>], expected[4] = {-7, -7, -7, -7};
    for (int k = 0; k < size<Model>; ++k) alone[k] = x[std::size_t(k * samples + s)];
    CHECK(inverse.predict_features(alone, expected) == statuses[s]);
    for (int i = 0; i < 4; ++i) CHECK(std::abs(commands[std::size_t(i * samples + s)] - expected[i]) <= rounding);
    clipped += statuses[s] == Status::limited ? 1 : 0;
    refused += has_output(statuses[s]) ? 0 : 1;
  }
  CHECK(clipped > 0);
  CHECK(refused > 0);
}

template <class Model>
double flown_error_m(const Model& model) {
  using Formula = AnalyticInverse<test::Flown>;
  using Guarded = InverseDynamics<Model, Extend<TrainingGuard, ClipCommands<>, Fallback<Formula>>>;
  using Policy = NetworkInverse<Guarded>;
  FigureEight<double> course;
  course.center_m = Vector3<double>(0, 0, -30);
  const test::Flown vehicle = test::flown_vehicle();
  const auto result = track(vehicle, course, FlightController<double>{},
                            Policy(Guarded(model, typename Guarded::Guard(Formula(vehicle)))));
  CHECK(result.status == Status::ok);
  CHECK(result.flown_s == doctest::Approx(30));
  CHECK(result.fallback.of(Status::ok) + result.fallback.of(Status::limited) > result.fallback.asked / 2);
  return result.rmse_m;
}

}  // namespace

TEST_CASE_TEMPLATE("a model of other outputs", Model, AccelerationsModel, WrenchModel, ResidualModel) {
  const test::BlockBytes bytes(model_block<Model>());
  ModelView<Model> view;
  REQUIRE(ModelView<Model>::open(bytes.data(), bytes.size(), view) == Status::ok);
  ModelView<Model> packed_view;
  const auto packed = std::make_unique<typename ModelView<Model>::Packed>();
  REQUIRE(ModelView<Model>::open(bytes.data(), bytes.size(), packed_view, *packed) == Status::ok);

  SUBCASE("header, view and packed view pass their self test and say what plain loops say") {
    const InverseDynamics<Model> header;
    const InverseDynamics<ModelView<Model>> viewed(view);
    const InverseDynamics<ModelView<Model>> own(packed_view);
    CHECK(self_test(header) == Status::ok);
    CHECK(self_test(viewed) == Status::ok);
    CHECK(self_test(own) == Status::ok);
    for (const auto& x : Model::golden_features) {
      const Commands<double> expected = by_plain_loops<Model>(x.data());
      for (int way = 0; way < 3; ++way) {
        Commands<float> u{};
        const Status status = way == 0   ? header.predict_features(x.data(), u)
                              : way == 1 ? viewed.predict_features(x.data(), u)
                                         : own.predict_features(x.data(), u);
        REQUIRE(status == Status::ok);
        for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(double(u[i]) - expected[i]) <= double(rounding));
      }
    }
  }
  SUBCASE("a broken output scaler is found") {
    ModelView<Model> broken = packed_view;
    broken.output.mean[Model::Network::outputs - 1] = std::nanf("");
    CHECK(self_test(InverseDynamics<ModelView<Model>>(broken)) == Status::self_test_failed);
    broken.output.mean[Model::Network::outputs - 1] = 1e3f;
    CHECK(self_test(InverseDynamics<ModelView<Model>>(broken)) == Status::self_test_failed);
  }
  SUBCASE("derivatives") {
    check_jacobian<Model>(Model{});
    check_jacobian<Model>(view);
    check_jacobian<Model>(packed_view);
  }
  SUBCASE("batches and the guard") {
    check_batch(Model{});
    check_batch(packed_view);
  }
  SUBCASE("outputs of commands are those commands again") {
    using Map = OutputMap<typename Model::Outputs>;
    const auto setting = Map::setting(airframe_value<PaperQuadrotor, double>());
    const double u[4] = {0.3, 0.7, 0.45, 0.6};
    double x[size<Model>], y[Map::size], again[4];
    for (int k = 0; k < size<Model>; ++k) x[k] = double(Model::golden_features[1][std::size_t(k)]);
    Map::from_commands(x, u, setting, y);
    Map::commands(x, static_cast<const double*>(y), setting, again);
    for (int i = 0; i < 4; ++i) CHECK(std::abs(again[i] - u[i]) <= 1e-12);
  }
  SUBCASE("it flies in closed loop, clearly better than the analytic inverse without jerk") {
    const test::Flown vehicle = test::flown_vehicle();
    struct Plain {
      FigureEight<double> path;
      TrajectoryPoint<double> sample(double time_s) const noexcept { return without_jerk(path.sample(time_s)); }
    };
    FigureEight<double> course;
    course.center_m = Vector3<double>(0, 0, -30);
    const AnalyticInverse<test::Flown> analytic(vehicle);
    const double alone = track(vehicle, Plain{course}, FlightController<double>{}, analytic).rmse_m;
    const double flown = flown_error_m(Model{});
    MESSAGE(std::string(Model::name), ": ", 100 * flown, " cm; without jerk: ", 100 * alone, " cm");
    CHECK(flown < 0.7 * alone);
  }
}

TEST_CASE("a block of one meaning is none of another: six accelerations, a wrench, a residual") {
  const test::BlockBytes bytes(model_block<WrenchModel>());
  ModelView<ResidualModel> view;
  CHECK(ModelView<ResidualModel>::open(bytes.data(), bytes.size(), view) == Status::block_incompatible);
}

TEST_CASE("a structured model brings its certificate, and its block none that its numbers do not keep") {
  static_assert(has_certificate<StructuredModel> && !has_certificate<DirectModel>);
  constexpr Certificate certificate = certificate_of<StructuredModel>();
  static_assert(certificate.proven());
  const AxisSlopes own = hover_slopes(PaperQuadrotor::value<double>());
  for (std::size_t axis = 0; axis < 3; ++axis)
    CHECK(certificate.slope[axis] == doctest::Approx(own[axis]).epsilon(0.2));

  test::BlockBytes bytes(model_block<StructuredModel>());
  ModelView<StructuredModel> view;
  REQUIRE(ModelView<StructuredModel>::open(bytes.data(), bytes.size(), view) == Status::ok);
  using Layout = ModelBlockLayout<StructuredModel>;
  const std::size_t first = Layout::parameters(StructuredModel::golden_features.size());
  const std::size_t bounds = first + MonotoneBase<PhysicsFeatures>::parameter_count;  // lower, then upper ones
  const auto opened_with = [&](std::size_t at, float value) {
    test::BlockBytes changed(model_block<StructuredModel>());
    changed.set_scalar(at, value);
    changed.seal();
    return ModelView<StructuredModel>::open(changed.data(), changed.size(), view);
  };
  CHECK(opened_with(first, 1e-3F) == Status::ok);             // a smaller slope is proven too, as the numbers have it
  CHECK(opened_with(first, 1e-6F) == Status::block_corrupt);  // positive, but below its floor
  CHECK(opened_with(first, -1e-3F) == Status::block_corrupt);
  CHECK(opened_with(first + 2, 0.0F) == Status::block_corrupt);
  CHECK(opened_with(first + 3, -1.0F) == Status::ok);  // of another feature
  CHECK(opened_with(bounds, 1e3F) == Status::block_corrupt);
}

namespace {

struct Written {
  std::string text;
  void add(std::string_view piece) { text += piece; }
  void add(int number) { text += std::to_string(number); }
};
template <class T>
std::string written() {
  Written sink;
  detail::describe<T>(sink);
  return sink.text;
}

/// A layer of one's own that names itself, and one that does not.
struct Named : Relu {
  static constexpr const char* description = "mine/leaky 0.1";
};

}  // namespace

TEST_CASE("what a model is made of is written, whichever compiler reads it") {
  CHECK(written<Network<float, InputSize<16>, Dense<25>, Named, Dense<4>>>() ==
        "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<25>, mine/leaky 0.1, pinnquad::Dense<4>>");
}
