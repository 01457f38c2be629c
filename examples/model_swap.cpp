// SPDX-License-Identifier: MIT
// A new model while the vehicle flies: the control thread never waits, locks or allocates; another thread opens a model
// block in the slot that is not in use, tests it, and publishes it with one atomic pointer
// (pinnquad/control/autopilot/model_slots.hpp).
//   exit code 0: every prediction was that of one whole model, all good blocks flew, no bad one did
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "models/demo_quadrotor.hpp"
#include "pinnquad/control/autopilot/model_slots.hpp"
#include "pinnquad/deploy/weight_file.hpp"

namespace {

using namespace pinnquad;
using Clock = std::chrono::steady_clock;
using View = ModelView<DemoQuadModel>;
using Inverse = InverseDynamics<View>;
using Slots = pinnquad::autopilot::ModelSlots<Inverse>;  // says how the old slot is known to be free

/// Loading thread: waits for the control thread's next tick if it has not yet taken the model published last.
Status replace(Slots& slots, const std::vector<unsigned char>& block) {
  while (!slots.settled()) std::this_thread::sleep_for(std::chrono::microseconds(50));
  return slots.offer(block.data(), block.size());
}

/// The demonstration's model after a training that went on: here, its weights moved by a thousandth each.
std::vector<unsigned char> block_of_a_second_model() {
  TrainedModel<DemoQuadModel::Network, Context<DemoQuadModel::Features, DemoQuadModel::Vehicle>> model;
  model.network.parameters = DemoQuadModel::parameters;
  for (float& weight : model.network.parameters) weight *= 1.001f;
  model.input = DemoQuadModel::input;
  model.output = DemoQuadModel::output;
  model.envelope_lower = DemoQuadModel::envelope_lower;
  model.envelope_upper = DemoQuadModel::envelope_upper;
  return model_block(model, {DemoQuadModel::golden_features.begin(), DemoQuadModel::golden_features.end()}, {});
}

using Answers = std::array<Commands<float>, DemoQuadModel::golden_features.size()>;

Answers answers_of(const std::vector<unsigned char>& block) {
  View view;
  Answers answers{};
  const bool sound = View::open(block.data(), block.size(), view) == Status::ok;
  const Inverse inverse(view);
  for (std::size_t i = 0; sound && i < answers.size(); ++i) {
    if (inverse.predict_features(DemoQuadModel::golden_features[i].data(), answers[i]) != Status::ok) break;
  }
  return answers;
}

/// Counts of the control thread; read when it has ended.
struct Counts {
  unsigned long ticks = 0, of_a = 0, of_b = 0, of_neither = 0, declined = 0;
  std::atomic<bool> over{false};
};

/// 2 kHz: one model per tick, several predictions of it, each compared with what models A and B answer, bit for bit.
void control(Slots& slots, const Answers& a, const Answers& b, Counts& counts) {
  auto next = Clock::now();
  while (!counts.over.load(std::memory_order_relaxed)) {
    const Inverse& inverse = *slots.take();
    for (std::size_t k = 0; k < 8 * a.size(); ++k) {
      const std::size_t i = k % a.size();
      Commands<float> u{};
      if (inverse.predict_features(DemoQuadModel::golden_features[i].data(), u) != Status::ok) ++counts.declined;
      if (std::memcmp(&u, &a[i], sizeof u) == 0) {
        ++counts.of_a;
      } else if (std::memcmp(&u, &b[i], sizeof u) == 0) {
        ++counts.of_b;
      } else {
        ++counts.of_neither;
      }
    }
    ++counts.ticks;
    next += std::chrono::microseconds(500);
    std::this_thread::sleep_until(next);
  }
}

}  // namespace

int main() {
  const std::vector<unsigned char> block_a = model_block<DemoQuadModel>();
  const std::vector<unsigned char> block_b = block_of_a_second_model();
  const Answers a = answers_of(block_a), b = answers_of(block_b);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == Commands<float>{} || a[i] == b[i]) return std::puts("the two models can't be told apart"), 1;
  }

  const auto slots = std::make_unique<Slots>(TrainingGuard{});
  if (replace(*slots, block_a) != Status::ok) return 1;

  // broken ones: a flipped bit, a cut, and a weight that was edited under a checksum made again
  std::vector<unsigned char> flipped = block_a, wrong = block_b;
  flipped[flipped.size() / 2] ^= 0x10;
  const std::vector<unsigned char> cut(block_a.begin(), block_a.end() - 100);
  wrong[wrong.size() - 6] ^= 0x40;  // in the exponent of the last bias
  const std::uint32_t sum = crc32(wrong.data(), wrong.size() - 4);
  for (std::size_t byte = 0; byte < 4; ++byte) wrong[wrong.size() - 4 + byte] = (sum >> (8 * byte)) & 0xffu;

  Counts counts;
  std::thread thread(control, std::ref(*slots), std::cref(a), std::cref(b), std::ref(counts));
  int swaps = 0, refused = 0, faults = 0;
  for (const auto end = Clock::now() + std::chrono::milliseconds(800); Clock::now() < end || swaps < 10; ++swaps) {
    const std::vector<unsigned char>& good = swaps % 2 == 0 ? block_b : block_a;
    if (replace(*slots, good) != Status::ok) ++faults;
    const bool all_refused = replace(*slots, flipped) == Status::block_corrupt &&
                             replace(*slots, cut) == Status::block_truncated &&
                             replace(*slots, wrong) == Status::block_corrupt;
    all_refused ? refused += 3 : ++faults;
  }
  counts.over = true;
  thread.join();

  std::printf(
      "%d swaps, %d broken blocks refused; %lu ticks, %lu predictions of A, %lu of B, %lu of neither, %lu declined\n",
      swaps, refused, counts.ticks, counts.of_a, counts.of_b, counts.of_neither, counts.declined);
  const bool both_flew = swaps >= 10 && counts.ticks >= 10 && counts.of_a > 0 && counts.of_b > 0;
  return faults == 0 && both_flew && counts.of_neither == 0 && counts.declined == 0 ? 0 : 1;
}
