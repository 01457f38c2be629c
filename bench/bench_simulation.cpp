// SPDX-License-Identifier: MIT
// One 1 kHz step of the simulated vehicle, beside the naive prediction that other programs compare with.
#include <benchmark/benchmark.h>

#include <random>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/harder_quadrotor.hpp"
#include "pinnquad/vehicle/quadrotor.hpp"
#include "support/naive_eigen_network.hpp"
#include "support/program.hpp"

namespace {

using namespace pinnquad;
using namespace pinnquad::bench;

/// Half a metre above ground, where the ground effect works, tilted, turning and moving on every axis.
template <class Scalar>
VehicleState<Scalar> low_and_moving() {
  VehicleState<Scalar> state;
  state.body.position_m = Vector3<Scalar>(Scalar(1), Scalar(-2), Scalar(0.377));
  state.body.velocity_m_s = Vector3<Scalar>(Scalar(3), Scalar(-2), Scalar(0.5));
  state.body.attitude = from_euler<Scalar>({Scalar(0.2), Scalar(-0.1), Scalar(0.7)});
  state.body.body_rates_rad_s = Vector3<Scalar>(Scalar(0.4), Scalar(-0.3), Scalar(0.2));
  state.rotors = {Scalar(0.50), Scalar(0.51), Scalar(0.49), Scalar(0.50)};
  state.time_s = 1.0;
  return state;
}

/// Each step starts from the last one's end; every 100 steps (0.1 s) the vehicle is put back, so that it stays in the
/// ground effect however long the measurement takes.
template <class Scalar, class... Effects>
void steps_of(benchmark::State& state, const Quadrotor<Scalar, Effects...>& quadrotor) {
  constexpr int steps_per_flight = 100;
  const VehicleState<Scalar> start = low_and_moving<Scalar>();
  VehicleState<Scalar> vehicle = start;
  Commands<Scalar> commands = {Scalar(0.52), Scalar(0.50), Scalar(0.51), Scalar(0.49)};
  int steps = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(commands.data());
    if (quadrotor.step(vehicle, commands, Scalar(0.001)) != Status::ok) {
      state.SkipWithError("the vehicle's state diverged");
      break;
    }
    benchmark::DoNotOptimize(&vehicle);
    benchmark::ClobberMemory();
    if (++steps == steps_per_flight) {
      vehicle = start;
      steps = 0;
    }
  }
}

template <class Scalar, class... Effects>
void simulation_step(benchmark::State& state) {
  steps_of(state,
           Quadrotor<Scalar, Effects...>(airframe_value<PaperQuadrotor, Scalar>(), paper_site<Scalar>(), Effects{}...));
}

void harder_step(benchmark::State& state) {
  std::mt19937_64 engine(1);
  steps_of(state, harder_vehicle(engine));
}

}  // namespace

int main(int argc, char** argv) {
  register_naive_eigen(healthy_network());
  benchmark::RegisterBenchmark(
      "SimulationStep/full",
      simulation_step<double, StandardAtmosphere, PeriodicWind, QuadraticDrag, ConyersGroundEffect>);
  benchmark::RegisterBenchmark(
      "SimulationStep/full_float",
      simulation_step<float, StandardAtmosphere, PeriodicWind, QuadraticDrag, ConyersGroundEffect>);
  benchmark::RegisterBenchmark("SimulationStep/bare", simulation_step<double>);
  benchmark::RegisterBenchmark("SimulationStep/drag", simulation_step<double, StandardAtmosphere, QuadraticDrag>);
  benchmark::RegisterBenchmark(
      "SimulationStep/rotor_air",
      simulation_step<double, StandardAtmosphere, QuadraticDrag, RotorDrag, Inflow, BladeFlapping, Wake>);
  benchmark::RegisterBenchmark("SimulationStep/harder", harder_step);
  return run_benchmarks(argc, argv);
}
