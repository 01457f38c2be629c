// SPDX-License-Identifier: MIT
// The same messages through both cores, in a program that is built twice: as everything here, and as PX4 builds with
// -funsafe-math-optimizations. Compared are commands, within a tolerance, and reactions, exactly.
//   replay FILE            writes
//   replay FILE TOLERANCE  compares; exit code 1 if anything is further off
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include "model_blocks.hpp"
#include "pinnquad/core/random.hpp"
#include "stacks.hpp"

namespace {

using namespace pinnquad::autopilot::test;
using pinnquad::Vector3;

constexpr int ticks = 5000;

struct Row {
  double reaction = 0, status = 0;
  std::array<double, 4> commands{};
};

/// Motions of agile flight, far from one another; every 16th tick a NaN and every 61st an infinity, which -ffast-math's
/// relatives must not lose.
template <class Stack>
std::vector<Row> replayed() {
  const Block block = sound_block<typename Stack::Model>();
  Stack stack;
  if (stack.offer(block.data(), block.size()) != pinnquad::Status::ok) std::exit(2);
  std::mt19937_64 engine(5);
  const auto draw = [&engine](double half) {
    const double x = pinnquad::uniform(engine, -half, half);
    const double y = pinnquad::uniform(engine, -half, half);
    const double z = pinnquad::uniform(engine, -half, half);
    return Vector3<double>(x, y, z);
  };
  std::vector<Row> rows;
  for (int tick = 0; tick < ticks; ++tick) {
    const auto now_us = static_cast<std::uint64_t>(1'000'000 + 1000 * Stack::period_ms * tick);
    Vector3<double> rates = draw(1.5);
    const Vector3<double> tilt = draw(0.6), position = draw(2), velocity = draw(3);
    pinnquad::TrajectoryPoint<double> point;
    point.position_m = position + draw(1);
    point.velocity_m_s = velocity + draw(1);
    point.acceleration_m_s2 = draw(2);
    point.yaw_rad = tilt[2] + draw(0.3)[0];
    if (tick % 16 == 15) rates[1] = std::numeric_limits<double>::quiet_NaN();
    if (tick % 61 == 60) rates[2] = -std::numeric_limits<double>::infinity();
    stack.rates(now_us, rates);
    stack.attitude(now_us, pinnquad::from_euler<double>({tilt[0], tilt[1], tilt[2]}));
    stack.local(now_us, position, velocity);
    stack.set_point(now_us, point);
    const Answer answer = stack.run(now_us);
    rows.push_back({static_cast<double>(answer.reaction), static_cast<double>(answer.status), answer.commands});
  }
  return rows;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return std::fprintf(stderr, "replay FILE [TOLERANCE]\n"), 2;
  std::vector<Row> rows = replayed<Px4Stack>();
  const std::vector<Row> small = replayed<CrazyflieStack>();
  rows.insert(rows.end(), small.begin(), small.end());
  if (count == 2) {
    std::ofstream file(arguments[1]);
    file.precision(9);
    for (const Row& row : rows) {
      file << row.reaction << ' ' << row.status;
      for (const double u : row.commands) file << ' ' << u;
      file << '\n';
    }
    file.close();
    return file ? 0 : 2;
  }
  const double tolerance = std::atof(arguments[2]);
  std::ifstream file(arguments[1]);
  double worst = 0;
  int other_reactions = 0, other_statuses = 0;
  for (const Row& row : rows) {
    Row plain;
    file >> plain.reaction >> plain.status;
    for (double& u : plain.commands) file >> u;
    if (!file) return std::fprintf(stderr, "%s: too short\n", arguments[1]), 2;
    other_reactions += row.reaction == plain.reaction ? 0 : 1;
    if (row.status !=
        plain.status) {  // on the edge of the envelope: analytic inverse in one build, network in the other
      ++other_statuses;
      continue;
    }
    for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::fabs(row.commands[i] - plain.commands[i]));
  }
  std::printf("%zu steps: commands differ by up to %.2e (tolerance %.0e), %d other reactions, %d other statuses\n",
              rows.size(), worst, tolerance, other_reactions, other_statuses);
  return worst <= tolerance && other_reactions == 0 && other_statuses <= 2 ? 0 : 1;
}
