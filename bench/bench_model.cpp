// SPDX-License-Identifier: MIT
// Time that a control loop spends on an exported model: features, guard, scaling and network together; the fallback;
// the self test at boot; weights in a memory block.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "../examples/models/demo_quadrotor.hpp"
#include "../examples/models/structured_quadrotor.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/command_jacobian.hpp"
#include "pinnquad/inference/monitored_inverse.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

using Model = DemoQuadModel;
using Vehicle = Quadrotor<double, QuadraticDrag>;
using Analytic = AnalyticInverse<Vehicle>;
using Clipped = Extend<TrainingGuard, ClipCommands<>>;
using Backed = Extend<Clipped, Fallback<Analytic>>;

/// Wide enough for a motion of ordinary flight: what is measured is the time.
constexpr std::array<float, 136> any_factor() {
  std::array<float, 136> factor{};
  for (std::size_t i = 0; i < factor.size(); ++i) factor[i] = 0.01F * static_cast<float>(1 + i % 7);
  return factor;
}
struct Trust {
  static constexpr std::array<float, 16> distribution_mean{};
  static constexpr std::array<float, 136> whitening = any_factor();
  static constexpr double squared_distance_limit = 1e6;
  static constexpr double command_residual_factor = 0.2, command_residual_limit = 0.05, command_residual_cleared = 0.02;
};
using Measuring = Extend<TrainingGuard, JointDistance<Trust>>;

Vehicle vehicle() { return Vehicle(airframe_value<Model::Vehicle, double>(), paper_site<double>(), QuadraticDrag{}); }

/// A motion of ordinary flight.
Model::Inputs ordinary() {
  Model::Inputs inputs{};
  inputs.linear_acceleration_m_s2 = Vector3<float>(0.5f, -0.3f, 0.2f);
  inputs.angular_acceleration_rad_s2 = Vector3<float>(1.0f, -2.0f, 0.3f);
  inputs.velocity_m_s = Vector3<float>(2.0f, -1.0f, 0.4f);
  inputs.body_rates_rad_s = Vector3<float>(0.2f, 0.1f, -0.3f);
  inputs.attitude = from_euler<float>({0.1f, -0.05f, 0.7f});
  return inputs;
}

/// Of a flight: hardly any specific force but along the thrust.
Model::Inputs upright() {
  Model::Inputs inputs = ordinary();
  inputs.linear_acceleration_m_s2 = Vector3<float>(0.1f, -0.1f, 0.2f);
  inputs.body_rates_rad_s = Vector3<float>(0.01f, 0.01f, -0.01f);
  inputs.attitude = from_euler<float>({0.0f, 0.0f, 0.7f});
  return inputs;
}

/// One prediction after the other; the commands move the next motion a little, so that nothing is overlapped.
template <class Inverse>
void predict_in_loop(benchmark::State& state, const Inverse& inverse, const Model::Inputs& start, Status expected) {
  Commands<float> commands{};
  Model::Inputs inputs = start;
  if (inverse.predict(inputs, commands) != expected) {
    state.SkipWithError("another Status than this benchmark is for");
    return;
  }
  for (auto _ : state) {
    Status status = inverse.predict(inputs, commands);
    inputs.velocity_m_s[0] = start.velocity_m_s[0] + 0.01f * commands[0];
    benchmark::DoNotOptimize(status);
    benchmark::DoNotOptimize(&inputs);
    benchmark::ClobberMemory();
  }
}

template <class Inverse>
void add(const std::string& name, const Inverse& inverse, const Model::Inputs& inputs, Status expected) {
  benchmark::RegisterBenchmark(("Model/" + name).c_str(), [inverse, inputs, expected](benchmark::State& state) {
    predict_in_loop(state, inverse, inputs, expected);
  });
}

void register_guards() {
  Model::Inputs beyond = ordinary();
  beyond.velocity_m_s[2] = 14.0f;
  Model::Inputs broken = ordinary();
  broken.body_rates_rad_s[1] = std::numeric_limits<float>::quiet_NaN();
  const Analytic analytic{vehicle()};
  add("predict", InverseDynamics<Model>{}, ordinary(), Status::ok);
  add("predict_structured", InverseDynamics<StructuredQuadModel>{}, upright(), Status::ok);
  add("predict_clipped", InverseDynamics<Model, Clipped>{}, ordinary(), Status::ok);
  add("predict_joint_distance", InverseDynamics<Model, Measuring>{}, ordinary(), Status::ok);
  add("predict_with_fallback", InverseDynamics<Model, Backed>(Backed(analytic)), ordinary(), Status::ok);
  add("fell_back", InverseDynamics<Model, Backed>(Backed(analytic)), beyond, Status::fell_back);
  add("refused_outside_envelope", InverseDynamics<Model>{}, beyond, Status::outside_envelope);
  add("refused_nan", InverseDynamics<Model>{}, broken, Status::not_finite);
}

void register_features() {
  benchmark::RegisterBenchmark("Model/observe", [](benchmark::State& state) {
    MonitoredInverse<InverseDynamics<Model>, Trust> monitored;
    Model::Inputs inputs = ordinary();
    const float start = inputs.velocity_m_s[0];
    for (auto _ : state) {
      Status status = monitored.observe(inputs, {0.5f, 0.5f, 0.5f, 0.5f});
      inputs.velocity_m_s[0] = start + 0.01f * monitored.monitor().mean();
      benchmark::DoNotOptimize(status);
      benchmark::DoNotOptimize(&inputs);
      benchmark::ClobberMemory();
    }
  });
  benchmark::RegisterBenchmark("Model/predict_features", [](benchmark::State& state) {
    const InverseDynamics<Model> inverse;
    auto x = Model::golden_features[1];
    const float start = x[0];
    float commands[4] = {};
    for (auto _ : state) {
      Status status = inverse.predict_features(x.data(), commands);
      x[0] = start + 0.01f * commands[0];
      benchmark::DoNotOptimize(status);
      benchmark::ClobberMemory();
    }
  });
  benchmark::RegisterBenchmark("Model/predict_with_jacobian", [](benchmark::State& state) {
    const InverseDynamics<Model> inverse;
    auto x = Model::golden_features[1];
    const float start = x[0];
    float commands[4] = {}, jacobian[64];
    for (auto _ : state) {
      Status status = predict_with_jacobian(inverse, x.data(), commands, jacobian);
      x[0] = start + 0.01f * commands[0];
      benchmark::DoNotOptimize(status);
      benchmark::DoNotOptimize(jacobian);
      benchmark::ClobberMemory();
    }
  });
  benchmark::RegisterBenchmark("Model/self_test", [](benchmark::State& state) {
    const InverseDynamics<Model> inverse;
    for (auto _ : state) {
      Status status = self_test(inverse);
      benchmark::DoNotOptimize(status);
      benchmark::ClobberMemory();
    }
  });
}

/// The same weights in a block: opening it (length, version, checksum, contents), opening and packing, predicting
/// packed and in place.
void register_block() {
  static const std::vector<unsigned char> bytes = model_block<Model>();
  static std::vector<std::uint64_t> block((bytes.size() + 7) / 8);
  std::memcpy(block.data(), bytes.data(), bytes.size());
  using View = ModelView<Model>;
  static View in_place, view;
  static View::Packed packed;
  if (View::open(block.data(), bytes.size(), in_place) != Status::ok ||
      View::open(block.data(), bytes.size(), view, packed) != Status::ok) {
    std::fprintf(stderr, "bench_model: the block of the demo's model does not open\n");
    std::exit(1);
  }
  benchmark::RegisterBenchmark("Block/open", [](benchmark::State& state) {
    for (auto _ : state) {
      View opened;
      Status status = View::open(block.data(), bytes.size(), opened);
      benchmark::DoNotOptimize(status);
      benchmark::DoNotOptimize(&opened);
    }
  });
  benchmark::RegisterBenchmark("Block/open_packed", [](benchmark::State& state) {
    for (auto _ : state) {
      View opened;
      Status status = View::open(block.data(), bytes.size(), opened, packed);
      benchmark::DoNotOptimize(status);
      benchmark::ClobberMemory();
    }
  });
  benchmark::RegisterBenchmark("Block/predict_view", [](benchmark::State& state) {
    predict_in_loop(state, InverseDynamics<View>(view), ordinary(), Status::ok);
  });
  benchmark::RegisterBenchmark("Block/predict_view_in_place", [](benchmark::State& state) {
    predict_in_loop(state, InverseDynamics<View>(in_place), ordinary(), Status::ok);
  });
}

}  // namespace

int main(int argc, char** argv) {
  register_guards();
  register_features();
  register_block();
  return run_benchmarks(argc, argv);
}
