// SPDX-License-Identifier: MIT
// Flies a core through the fault script in the simulator and writes what it received and answered, with the models that
// flew, for `pinnquad replay`.
//   flight_stacks_record px4|crazyflie|structured|payload hover|eight|random_places FOLDER
//   flight_stacks_record jumps eight FOLDER  a weak motor, jumping and silent set points at 8 m/s
//   flight_stacks_record onboard px4|crazyflie FOLDER  a vehicle that nobody knows, which is learnt (docs/onboard.md)
// `structured`: PX4's core with a structured model, other effects in the analytic inverse and limits of trust, in a
// flight with a payload. `payload`: a model that needs much of its bias without one, without limits of trust.
#include <cstdio>
#include <cstring>

#include "flight.hpp"
#include "flight_paths.hpp"
#include "onboard_stacks.hpp"
#include "record_csv.hpp"
#include "trusting_stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::autopilot::CoreRecord;
using pinnquad::autopilot::CoreSettings;
using pinnquad::autopilot::Reaction;

constexpr double duration_s = 33;

void write(const std::string& path, const Block& block) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
}

constexpr std::array<Fault, 2> payload = {
    {{0.1, 100, FaultKind::model_low, 0, "a model of too low commands", Reaction::flies},
     {6, 8, FaultKind::payload, 1.5, "half as heavy again", Reaction::flies}}};

template <class Stack>
std::vector<Fault> faults_of() {
  std::vector<Fault> faults(fault_script.begin(), fault_script.end());
  if constexpr (is_trusting<
                    Stack>) {  // its limits refuse models of other training data; and some words of a missing position
    faults = {{8, 0.6, FaultKind::local_stops, 0, "position and velocity stop for 600 ms", Reaction::levels},
              {12, 6, FaultKind::payload, 1.25, "25 % heavier for 6 s", Reaction::flies}};
  }
  faults.push_back({30.5, 1.5, FaultKind::flown_by_hand, 0, "flown by hand for 1.5 s", Reaction::gives_up});
  return faults;
}

template <class Stack, class Target>
int record(const std::string& folder, const Target& target, const std::vector<Fault>& faults) {
  using Model = typename Stack::Model;
  write(folder + "/sound.block", sound_block<Model>());
  write(folder + "/other.block", other_block<Model>());
  write(folder + "/narrow.block", narrow_block<Model>());
  write(folder + "/bit.block", bit_block<Model>());
  write(folder + "/low.block", low_block<Model>());
  FaultyFlight<Stack> flight;
  if (!flight.boot()) return 1;
  std::ofstream settings = record_file<CoreSettings>(folder, "flight");
  settings << csv_row(flight.settings());
  std::ofstream ticks = record_file<CoreRecord>(folder, "flight");
  const FlightFigures flown =
      flight.fly(target, duration_s, faults, [&](const CoreRecord& tick) { ticks << csv_row(tick); });
  settings.close();
  ticks.close();
  return settings && ticks && !flown.crashed ? 0 : 1;
}

template <class Stack>
int record(const std::string& path, const std::string& folder, double half_length_m, double period_s, double half_box_m,
           const std::vector<Fault>& faults = faults_of<Stack>()) {
  if (path == "hover") return record<Stack>(folder, hover, faults);
  if (path == "eight") return record<Stack>(folder, Eight(half_length_m, period_s), faults);
  return record<Stack>(folder, RandomPlaces(half_box_m), faults);
}

/// A vehicle that is learnt, with a payload that comes and goes and a rotor that weakens; and what flew at the end.
template <class Stack>
int record_learning(const std::string& folder) {
  const Block block = sound_block<typename Stack::Model>();
  write(folder + "/sound.block", block);
  Stack stack;
  if (stack.offer(block.data(), block.size()) != pinnquad::Status::ok) return 1;
  std::ofstream settings = record_file<CoreSettings>(folder, "flight");
  settings << csv_row(stack.settings());
  settings.close();
  std::ofstream ticks = record_file<CoreRecord>(folder, "flight");
  StrangeVehicle<Stack> vehicle;
  pinnquad::Commands<double> commands{};
  for (long tick = 0; tick * Stack::period_ms < 40'000; ++tick) {
    const double time_s = static_cast<double>(tick) * StrangeVehicle<Stack>::tick_s;
    const std::uint64_t now_us = StrangeVehicle<Stack>::time_us(tick);
    if (tick * Stack::period_ms == 24'000) vehicle.weigh(1.2);
    if (tick * Stack::period_ms == 32'000) vehicle.weigh(1);
    vehicle.rotor_0 = time_s < 34 ? 1 : 0.95;
    vehicle.feed(stack, tick, now_us, strange_course(time_s));
    // on the ground for a second, off for a while, with sines, and frozen at the end
    using pinnquad::autopilot::Learning;
    const Learning learning = time_s < 2    ? Learning::off
                              : time_s < 14 ? Learning::excites
                              : time_s < 29 ? Learning::learns
                              : time_s < 30 ? Learning::off
                              : time_s < 37 ? Learning::learns
                                            : Learning::frozen;
    stack.situation({time_s >= 1, false, learning});
    const Answer answer = stack.run(now_us);
    ticks << csv_row(stack.record());
    if (answer.has_commands) commands = answer.commands;
    vehicle.held = time_s < 1;
    if (!vehicle.fly(commands)) return 1;
  }
  ticks.close();
  std::ofstream learnt(folder + "/flown.csv");
  for (const auto& sum : stack.controller().onboard().certificate()) {
    std::string line;
    add_cell(line, sum.proven ? 1 : 0);
    add_cell(line, sum.proven_row);
    add_cell(line, sum.half_width);
    for (const float term : sum.forward.theta) add_cell(line, term);
    learnt << line << "\n";
  }
  learnt.close();
  return ticks && learnt ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return std::fprintf(stderr, "flight_stacks_record STACK PATH FOLDER\n"), 2;
  if (std::strcmp(arguments[1], "structured") == 0) {
    return record<TrustingPx4Stack>(arguments[2], arguments[3], 4, 9, 1.5);
  }
  if (std::strcmp(arguments[1], "payload") == 0) {
    return record<Px4Stack>(arguments[2], arguments[3], 4, 9, 1.5, {payload.begin(), payload.end()});
  }
  if (std::strcmp(arguments[1], "onboard") == 0) {
    return std::strcmp(arguments[2], "px4") == 0 ? record_learning<OnboardPx4Stack>(arguments[3])
                                                 : record_learning<OnboardCrazyflieStack>(arguments[3]);
  }
  if (std::strcmp(arguments[1], "jumps") == 0) {
    return record<Px4Stack>(arguments[3], FastEight{}, jumps_with_a_weak_motor());
  }
  return std::strcmp(arguments[1], "px4") == 0
             ? record<Px4Stack>(arguments[2], arguments[3], 4, 9, 1.5)
             : record<CrazyflieStackOf<QuickCrazyflieModel>>(arguments[2], arguments[3], 1.5, 6, 1);
}
