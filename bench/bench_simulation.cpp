// SPDX-License-Identifier: MIT
// One 1 kHz step of the simulated vehicle, alone and as one of a thousand in lanes, beside the naive prediction that
// other programs compare with.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <vector>

#include "pinnquad/aero/air_density.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/aero/flapping.hpp"
#include "pinnquad/aero/ground_effect.hpp"
#include "pinnquad/aero/inflow.hpp"
#include "pinnquad/aero/wake.hpp"
#include "pinnquad/aero/wind.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/harder_quadrotor.hpp"
#include "pinnquad/vehicle/lanes_of_vehicles.hpp"
#include "study/mppi.hpp"
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
  const auto step = quadrotor.time_step(Scalar(0.001));
  int steps = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(commands.data());
    if (quadrotor.step(vehicle, commands, step) != Status::ok) {
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

/// The same of a thousand vehicles, each lane with an airframe of its own; the time is that of one vehicle.
template <class Scalar, class... Effects>
void lanes_step(benchmark::State& state) {
  using Wide = Lanes<Scalar, native_lanes<Scalar>>;
  constexpr int vehicles = 1000, steps_per_flight = 100;
  std::mt19937_64 engine(1);
  auto airframes = in_every_lane<Wide>(airframe_value<PaperQuadrotor, Scalar>());
  VehicleState<Wide> start;
  for (int lane = 0; lane < Wide::count; ++lane) {
    airframes.mass_kg.set_lane(lane, airframes.mass_kg.lane(lane) * Scalar(uniform(engine, 0.9, 1.1)));
    set_lane(start, lane, low_and_moving<Scalar>());
  }
  const Site<Scalar> site = paper_site<Scalar>();
  const Site<Wide> same_site{Wide(site.elevation_m), Wide(site.ground_z_m), Wide(site.gravity_m_s2)};
  const Quadrotor<Wide, Effects...> quadrotors(airframes, same_site, Effects{}...);
  const auto step = quadrotors.time_step(Wide(Scalar(0.001)));
  Commands<Wide> commands = {Wide(0.52), Wide(0.50), Wide(0.51), Wide(0.49)};
  std::vector<VehicleState<Wide>> fleet((vehicles + Wide::count - 1) / Wide::count, start);
  std::size_t pack = 0;
  int steps = 0;
  while (state.KeepRunningBatch(Wide::count)) {
    benchmark::DoNotOptimize(commands.data());
    if (any_of(quadrotors.step(fleet[pack], commands, step) != Status::ok)) {
      state.SkipWithError("a vehicle's state diverged");
      break;
    }
    benchmark::ClobberMemory();
    if (++pack < fleet.size()) continue;
    pack = 0;
    if (++steps == steps_per_flight) {
      std::fill(fleet.begin(), fleet.end(), start);
      steps = 0;
    }
  }
}

/// As many divisions as a bare step in lanes has, alone and independent of each other; the time is that of one vehicle.
void step_divisions(benchmark::State& state) {
  using Wide = Lanes<double, native_lanes<double>>;
  constexpr int divisions = 26;
  Wide over(3), by[divisions];
  for (int i = 0; i < divisions; ++i) by[i] = Wide(1.0 + i);
  while (state.KeepRunningBatch(Wide::count)) {
    benchmark::DoNotOptimize(by);
    benchmark::DoNotOptimize(over);
    Wide quotient[divisions];
    for (int i = 0; i < divisions; ++i) quotient[i] = over / by[i];
    benchmark::DoNotOptimize(quotient);
  }
}

void harder_step(benchmark::State& state) {
  std::mt19937_64 engine(1);
  steps_of(state, harder_vehicle(engine));
}

/// Improvements of the plan on the way along the figure-eight: 512 flights of 40 steps each.
void mppi(benchmark::State& state) {
  study::Mppi<Quadrotor<float, StandardAtmosphere, QuadraticDrag>> controller(airframe_value<PaperQuadrotor, float>(),
                                                                              paper_site<float>());
  const FigureEight<float> eight;
  const auto sample = [&eight](double time_s) { return eight.sample(static_cast<float>(time_s)); };
  VehicleState<float> vehicle;
  vehicle.rotors = {0.5f, 0.5f, 0.5f, 0.5f};
  Commands<float> commands{};
  for (auto _ : state) {
    vehicle.time_s = vehicle.time_s < 60 ? vehicle.time_s + 0.02 : 0.0;
    const TrajectoryPoint<float> point = sample(vehicle.time_s);
    FlatMotion<float> flat;
    if (flat_motion(point, standard_gravity_m_s2<float>, flat) != Status::ok) state.SkipWithError("no such motion");
    vehicle.body = {point.position_m, point.velocity_m_s, flat.attitude, flat.body_rates_rad_s};
    if (controller(vehicle, sample, commands) != Status::ok) {
      state.SkipWithError("MPPI has no answer");
      break;
    }
    benchmark::DoNotOptimize(commands.data());
  }
}

}  // namespace

int main(int argc, char** argv) {
  register_naive_eigen(healthy_network());
  benchmark::RegisterBenchmark(
      "SimulationStep/full",
      simulation_step<double, StandardAtmosphere, PeriodicWind, QuadraticDrag, GroundEffect<Conyers>>);
  benchmark::RegisterBenchmark(
      "SimulationStep/full_float",
      simulation_step<float, StandardAtmosphere, PeriodicWind, QuadraticDrag, GroundEffect<Conyers>>);
  benchmark::RegisterBenchmark("SimulationStep/bare", simulation_step<double>);
  benchmark::RegisterBenchmark("SimulationStep/drag", simulation_step<double, StandardAtmosphere, QuadraticDrag>);
  benchmark::RegisterBenchmark(
      "SimulationStep/rotor_air",
      simulation_step<double, StandardAtmosphere, QuadraticDrag, RotorDrag, Inflow, BladeFlapping, Wake>);
  benchmark::RegisterBenchmark("SimulationStep/harder", harder_step);
  benchmark::RegisterBenchmark("SimulationStep/lanes_bare", lanes_step<double>);
  benchmark::RegisterBenchmark("Peak/step_divisions", step_divisions);
  benchmark::RegisterBenchmark("SimulationStep/lanes_bare_float", lanes_step<float>);
  benchmark::RegisterBenchmark(
      "SimulationStep/lanes_full",
      lanes_step<double, StandardAtmosphere, PeriodicWind, QuadraticDrag, GroundEffect<Conyers>>);
  benchmark::RegisterBenchmark(
      "SimulationStep/lanes_full_float",
      lanes_step<float, StandardAtmosphere, PeriodicWind, QuadraticDrag, GroundEffect<Conyers>>);
  benchmark::RegisterBenchmark("Mppi/512x40", mppi);
  return run_benchmarks(argc, argv);
}
