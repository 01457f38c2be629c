// SPDX-License-Identifier: MIT
#include "pinnquad/training/checkpoint.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <stdexcept>

using pinnquad::Checkpoint;

namespace {

/// Stands for a trainer: its network is the epoch's number.
struct Source {
  int value = 0;
  mutable int asked = 0;
  int network() const {
    ++asked;
    return value;
  }
};

}  // namespace

TEST_CASE("the least error wins, the earliest of equals; no other network is asked for") {
  Checkpoint<int> best;
  CHECK(best.empty());
  const double errors[] = {5.0, 3.0, 4.0, 3.0, 2.5, 2.6};
  int asked = 0;
  for (int epoch = 0; epoch < 6; ++epoch) {
    const Source source{100 + epoch};
    const bool better = epoch == 0 || epoch == 1 || epoch == 4;
    CHECK(best.offer(epoch, errors[epoch], source) == better);
    asked += source.asked;
  }
  CHECK_FALSE(best.empty());
  CHECK(best.epoch() == 4);
  CHECK(best.error() == 2.5);
  CHECK(best.network() == 104);
  CHECK(asked == 3);
}

TEST_CASE("NaN is never the best, not even as the first") {
  Checkpoint<int> best;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(best.offer(0, nan, Source{7}));
  CHECK(best.empty());
  CHECK(best.offer(1, 3.0, Source{8}));
  CHECK_FALSE(best.offer(2, nan, Source{9}));
  CHECK(best.network() == 8);
}

TEST_CASE("an empty checkpoint has no network to fly, instead of one of zeros") {
  Checkpoint<int> best;
  CHECK_THROWS_WITH_AS(best.network(), "Checkpoint: expected a network with an error, found none", std::logic_error);
  best.offer(0, std::numeric_limits<double>::quiet_NaN(), Source{7});
  CHECK_THROWS_AS(best.network(), std::logic_error);
}

TEST_CASE("early stopping: `patience` epochs without a lower error, then no more; 0 waits for ever") {
  const auto epochs_run = [](int patience, int best_epoch, int epochs) {
    Checkpoint<int> best;
    int epoch = 0;
    for (; epoch < epochs && !best.is_stale(epoch, patience); ++epoch) {
      best.offer(epoch, epoch <= best_epoch ? 10.0 - epoch : 100.0, Source{epoch});
    }
    return epoch;
  };
  CHECK(epochs_run(3, 4, 100) == 8);  // epochs 5, 6 and 7 were not better
  CHECK(epochs_run(1, 0, 100) == 2);
  CHECK(epochs_run(0, 4, 100) == 100);
  CHECK(epochs_run(3, 99, 100) == 100);
  // errors that are never finite: ends too
  Checkpoint<int> none;
  CHECK_FALSE(none.is_stale(2, 3));
  CHECK(none.is_stale(3, 3));
}
