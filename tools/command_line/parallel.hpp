// SPDX-License-Identifier: MIT
// Independent pieces of work over the cores, with progress and the time left.
#pragma once

#include <cstddef>
#include <string>

#include "command_line/interrupt.hpp"
#include "command_line/progress_line.hpp"
#include "logs/parallel.hpp"

namespace programs {

/// As pinnquad::logs::each_in_parallel(), but that Interrupted only ends it: what was finished before is the caller's
/// to keep. `job` and `share_done()`, 0..1, are for the progress line (no name: none). The time that it took, s.
template <class Work, class ShareDone>
double run_parallel(const std::string& job, std::size_t count, std::size_t threads, const ShareDone& share_done,
                    const Work& work) {
  ProgressLine progress(job);
  const auto show = [&] {
    if (!job.empty()) progress.show(share_done());
  };
  try {
    pinnquad::logs::each_in_parallel(count, threads, show, work);
  } catch (const Interrupted&) {
  }
  return progress.elapsed_s();
}

}  // namespace programs
