// SPDX-License-Identifier: MIT
// Independent pieces of work over the cores, with progress and the time left.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/progress_line.hpp"

namespace programs {

/// Calls `work(0)` to `work(count - 1)` on up to `threads` threads, in the order of the indices but not one after the
/// other, and on fewer threads where the system gives no more; `job` and `share_done()`, 0..1, are for the progress
/// line (no name: none). Once a call threw, no further index is started; the first exception is thrown again when all
/// threads are back, but for Interrupted: what was finished before is the caller's to keep. The time that it took, s.
template <class Work, class ShareDone>
double run_parallel(const std::string& job, std::size_t count, std::size_t threads, const ShareDone& share_done,
                    const Work& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  std::atomic<std::size_t> next{0}, running{0};
  const auto take_turns = [&] {
    try {
      for (std::size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) work(i);
    } catch (const Interrupted&) {
      next.store(count);
    } catch (...) {
      next.store(count);
      const std::lock_guard<std::mutex> lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    running.fetch_sub(1);
  };
  ProgressLine progress(job);
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
    if (!job.empty()) progress.show(share_done());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  for (std::thread& worker : workers) worker.join();
  const double elapsed_s = progress.elapsed_s();
  progress.clear();
  if (failure) std::rethrow_exception(failure);
  return elapsed_s;
}

}  // namespace programs
