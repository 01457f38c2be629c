// SPDX-License-Identifier: MIT
// Independent pieces of work over the cores.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pinnquad::logs {

/// Calls `work(0)` to `work(count - 1)` on up to `threads` threads, in the order of the indices but not one after the
/// other, and on fewer threads where the system gives no more; `meanwhile()` now and then on the caller's. Once one
/// threw, no further index is started; the first exception is thrown again when all threads are back.
template <class Meanwhile, class Work>
void each_in_parallel(std::size_t count, std::size_t threads, const Meanwhile& meanwhile, const Work& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  std::atomic<std::size_t> next{0}, running{0};
  const auto stop = [&] {
    next.store(count);
    const std::lock_guard<std::mutex> lock(mutex);
    if (!failure) failure = std::current_exception();
  };
  const auto take_turns = [&] {
    try {
      for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) work(i);
    } catch (...) {
      stop();
    }
    running.fetch_sub(1);
  };
  std::vector<std::thread> workers;
  const std::size_t wanted = std::min(threads, count);
  workers.reserve(wanted);
  try {
    while (workers.size() < wanted) {
      running.fetch_add(1);
      workers.emplace_back(take_turns);
    }
  } catch (const std::exception&) {  // the system has no more threads, or no memory for one
    if (!workers.empty()) running.fetch_sub(1);
    if (workers.empty()) take_turns();
  }
  while (running.load() > 0) {
    try {
      meanwhile();
    } catch (...) {
      stop();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (std::thread& worker : workers) worker.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace pinnquad::logs
