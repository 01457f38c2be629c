// SPDX-License-Identifier: MIT
// A model that train wrote, and its limits beside it, in flight: it answers as the trainer's did; rows of the flight
// pass, motions far from them do not, and a monitor that sees the commands of another vehicle says so.
//   guarded <replay.txt>      exit code 0: all of it was seen
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "model.hpp"
#include "trust.hpp"

#include "pinnquad/inference/joint_distance.hpp"
#include "pinnquad/inference/monitored_inverse.hpp"

using namespace pinnquad;

namespace {

constexpr float rounding = 1e-6F;  ///< of another order of summation, commands in 0..1

using Guarded = InverseDynamics<TrainedQuadModel, Extend<TrainingGuard, JointDistance<TrainedQuadModelTrust>>>;

struct Row {
  MotionInputs<float> motion;
  Commands<float> predicted, flown;
};

bool read(std::istream& in, Row& row) {
  for (auto* vector : {&row.motion.linear_acceleration_m_s2, &row.motion.angular_acceleration_rad_s2,
                       &row.motion.velocity_m_s, &row.motion.body_rates_rad_s}) {
    in >> (*vector)[0] >> (*vector)[1] >> (*vector)[2];
  }
  in >> row.motion.attitude.w >> row.motion.attitude.x >> row.motion.attitude.y >> row.motion.attitude.z;
  for (auto* commands : {&row.predicted, &row.flown}) {
    for (float& command : *commands) in >> command;
  }
  return bool(in);
}

int say(bool right, const char* what, int count, int of) {
  std::printf("%s: %d of %d%s\n", what, count, of, right ? "" : "  WRONG");
  return right ? 0 : 1;
}

}  // namespace

int main(int, char** argv) {
  std::ifstream in(argv[1]);
  std::string line;
  std::getline(in, line);
  const Guarded guarded;
  const InverseDynamics<TrainedQuadModel, Guard<FiniteInputs, JointDistance<TrainedQuadModelTrust>>> boundless;
  MonitoredInverse<Guarded, TrainedQuadModelTrust> same{guarded}, heavier{guarded};
  Row row{};
  Commands<float> commands{};
  int rows = 0, usual = 0, refused = 0, distrusted = 0, unlike = 0;
  while (read(in, row)) {
    ++rows;
    const Status status = guarded.predict(row.motion, commands);
    if (status == Status::outside_distribution) ++usual;
    for (std::size_t i = 0; i < rotor_count && has_output(status); ++i) {
      if (std::abs(commands[i] - row.predicted[i]) > rounding) ++unlike;
    }
    (void)same.observe(row.motion, row.flown);
    if (same.predict(row.motion, commands) == Status::distrusted) ++distrusted;
    Commands<float> more = row.flown;
    for (float& command : more) command += 0.1F;  // what a payload takes
    (void)heavier.observe(row.motion, more);
    // asked without the envelope, which stops such a motion before
    MotionInputs<float> far = row.motion;
    for (auto* part : {&far.angular_acceleration_rad_s2, &far.velocity_m_s, &far.body_rates_rad_s}) *part *= 6.0F;
    if (boundless.predict(far, commands) == Status::outside_distribution) ++refused;
  }
  const bool paid = heavier.predict(row.motion, commands) == Status::distrusted;
  return say(unlike == 0, "commands that are not the trainer's", unlike, rows) +
         say(rows > 500 && 50 * usual < rows, "rows of the flight that are refused", usual, rows) +
         say(2 * refused > rows, "motions six times as fast that are refused", refused, rows) +
         say(50 * distrusted < rows, "rows of the flight after which it is distrusted", distrusted, rows) +
         say(paid, "distrusted with a payload", paid ? 1 : 0, 1);
}
