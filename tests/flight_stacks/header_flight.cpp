// SPDX-License-Identifier: MIT
// Flies an exported header, whatever it asks for, with its block in both cores: a figure-eight in the simulator, by
// the header's own airframe, which the model's envelope holds. The battery is silent for a while;
// another block takes the place of the first. What the cores recorded is for `pinnquad replay`.
//   header_flight MODEL.block OTHER.block FOLDER
#include <cstdio>
#include <fstream>
#include <iterator>

#include <model.hpp>  // the exported one

#include "../../tools/flight/loop_trajectories.hpp"
#include "../../tools/flight/model_range.hpp"
#include "pinnquad/aero/drag.hpp"
#include "pinnquad/control/desaturate.hpp"
#include "pinnquad/control/feed_forward.hpp"
#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/features/input_history.hpp"
#include "record_csv.hpp"
#include "stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Status;
using pinnquad::autopilot::CoreRecord;
using pinnquad::autopilot::CoreSettings;
using pinnquad::autopilot::Reaction;

using Vehicle = pinnquad::Quadrotor<double, pinnquad::QuadraticDrag>;

constexpr double duration_s = 12, other_block_s = 3, battery_stops_s = 6, battery_is_back_s = 9;

/// Ticks by who answered.
struct Phase {
  int ticks = 0, by_model = 0, warming_up = 0, not_finite = 0, outside = 0, others = 0;

  void take(const Answer& answer) {
    ++ticks;
    by_model += answer.status == Status::ok ? 1 : 0;
    warming_up += answer.cause == Status::warming_up ? 1 : 0;
    not_finite += answer.cause == Status::not_finite ? 1 : 0;
    outside += answer.cause == Status::outside_envelope || answer.cause == Status::outside_limits ? 1 : 0;
    others += answer.reaction != Reaction::flies ? 1 : 0;
  }
  void print(const char* stack, const char* phase) const {
    std::printf("%s %s: ticks %d model %d warming_up %d not_finite %d outside %d others %d\n", stack, phase, ticks,
                by_model, warming_up, not_finite, outside, others);
  }
};

/// In the middle of what the model was trained with; 0 of one that is not shown it.
double trained_voltage() {
  using Model = TrainedQuadModel;
  for (std::size_t i = 0; i < Model::Features::names.size(); ++i) {
    if (std::string_view(Model::Features::names[i]) != pinnquad::BatteryVoltage::name) continue;
    return 0.5 * (static_cast<double>(Model::envelope_lower[i]) + static_cast<double>(Model::envelope_upper[i]));
  }
  return 0;
}

/// The motions that an exported model answers.
template <class Model>
programs::ModelRange range_of_header() {
  using Features = typename Model::Features;
  programs::ModelRange range;
  for (std::size_t i = 0; i < std::size_t(Features::size); ++i) {
    range.features.push_back({Features::names[i], Features::units[i], static_cast<double>(Model::envelope_lower[i]),
                              static_cast<double>(Model::envelope_upper[i]),
                              pinnquad::detail::is_column<Features>(static_cast<int>(i))});
  }
  range.of = [](const programs::ModelRange::Motion& motion) {
    typename pinnquad::InputHistory<Features, double>::Present present{};
    static_cast<pinnquad::MotionInputs<double>&>(present) = motion;
    if constexpr (std::is_base_of_v<programs::ModelRange::Motion, decltype(present)>)
      present.altitude_m = motion.altitude_m;
    std::vector<double> x(static_cast<std::size_t>(Features::size));
    Features::extract(pinnquad::InputHistory<Features, double>{}.lasting(present), x.data());
    return x;
  };
  return range;
}

template <class Stack>
bool fly(const std::vector<char>& block, const std::vector<char>& other, const std::string& folder) {
  Stack stack;
  const Status offered = stack.offer(block.data(), block.size());
  if (offered != Status::ok) return std::printf("%s refuses the block: %s\n", Stack::name, to_string(offered)), false;
  const auto airframe = pinnquad::airframe_value<typename Stack::Model::Vehicle, double>();
  const Vehicle vehicle(airframe);
  const double volts = trained_voltage();
  const auto range = range_of_header<typename Stack::Model>();
  const auto held = programs::eight_for(airframe, 0, range);
  if (!held) return std::printf("%s: the envelope holds no figure-eight\n", Stack::name), false;
  const pinnquad::FigureEight<double>& eight = *held;
  pinnquad::VehicleState<double> state{};
  state.body.position_m = eight.sample(0).position_m;
  pinnquad::Commands<double> trim{};
  if (hover_trim(vehicle, state.body.position_m, trim) != Status::ok) return false;
  state.rotors = trim;
  pinnquad::Commands<double> commands = trim;
  Phase start, flight, silent;
  double squares = 0;
  int counted = 0;
  std::ofstream settings = record_file<CoreSettings>(folder, Stack::name);
  std::ofstream ticks = record_file<CoreRecord>(folder, Stack::name);
  settings << csv_row(stack.settings());
  for (int ms = 0; ms < 1000 * duration_s; ms += Stack::period_ms) {
    const double time_s = 1e-3 * ms;
    const auto now_us = static_cast<std::uint64_t>(5'000'000 + 1000 * ms);
    stack.rates(now_us, state.body.body_rates_rad_s);
    stack.attitude(now_us, state.body.attitude);
    stack.local(now_us, state.body.position_m, state.body.velocity_m_s);
    if (ms % 20 == 0) stack.set_point(now_us, eight.sample(time_s));
    const bool silent_battery = time_s >= battery_stops_s && time_s < battery_is_back_s;
    if (ms % 200 == 0 || Stack::period_ms == 2) stack.battery(now_us, silent_battery ? 0 : volts);
    stack.situation({true, false});
    if (ms == 1000 * other_block_s) {
      std::printf("%s other block: %s\n", Stack::name, to_string(stack.offer(other.data(), other.size())));
    }
    const Answer answer = stack.run(now_us);
    ticks << csv_row(stack.record());
    // the voltage is in force for 2 s, the window is 0.16 s long
    (time_s < 0.2 ? start : silent_battery && time_s > battery_stops_s + 2 ? silent : flight).take(answer);
    if (answer.has_commands) std::copy(answer.commands.begin(), answer.commands.end(), commands.begin());
    for (int i = 0; i < Stack::period_ms; ++i) {
      if (vehicle.step(state, commands, 1e-3) != Status::ok) return std::printf("%s crashed\n", Stack::name), false;
    }
    const double error_m = (eight.sample(time_s).position_m - state.body.position_m).norm();
    squares += error_m * error_m;
    ++counted;
  }
  start.print(Stack::name, "start");
  flight.print(Stack::name, "flight");
  silent.print(Stack::name, "silent");
  std::printf("%s error %.3f m\n", Stack::name, std::sqrt(squares / counted));
  return true;
}

std::vector<char> bytes_of(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return std::fprintf(stderr, "header_flight MODEL.block OTHER.block FOLDER\n"), 2;
  const std::vector<char> block = bytes_of(arguments[1]), other = bytes_of(arguments[2]);
  const bool px4 = fly<Px4StackOf<TrainedQuadModel>>(block, other, arguments[3]);
  const bool crazyflie = fly<CrazyflieStackOf<TrainedQuadModel>>(block, other, arguments[3]);
  return px4 && crazyflie ? 0 : 1;
}
