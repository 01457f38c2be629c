// SPDX-License-Identifier: MIT
// Progress with the time left, on stderr: one line rewritten in place on a terminal, few plain lines elsewhere.
#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <unistd.h>

#include "command_line/interrupt.hpp"

namespace programs {

/// Shows how much of one job is done. update() may be called as often as one likes; what is shown is limited.
class ProgressLine {
 public:
  explicit ProgressLine(std::string job) : job_(std::move(job)), terminal_(isatty(STDERR_FILENO) != 0) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() { clear(); }

  /// `share` of the job done, 0..1. Throws Interrupted after Ctrl-C.
  void update(double share) {
    stop_if_interrupted();
    show(share);
  }

  /// The same, interrupted or not.
  void show(double share) {
    constexpr double terminal_interval_s = 0.1, plain_interval_s = 5.0;
    const double now_s = elapsed_s();
    if (share < 1 && now_s < next_s_) return;
    if (!terminal_ && share >= 1) return;  // the summary says so
    next_s_ = now_s + (terminal_ ? terminal_interval_s : plain_interval_s);
    if (!terminal_ && now_s < plain_interval_s) return;
    char left[32] = "";  // nobody knows before something is done
    if (share > 0) std::snprintf(left, sizeof left, ", %.0f s left", now_s * (1 - share) / share);
    std::fprintf(stderr, "%s%s: %3.0f %%%s%s", terminal_ ? "\r" : "", job_.c_str(), 100 * share, left,
                 terminal_ ? "   " : "\n");
    std::fflush(stderr);
    shown_ = terminal_;
  }

  /// Takes the line off the terminal, so that other text can follow.
  void clear() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
    shown_ = false;
  }

  double elapsed_s() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::string job_;
  bool terminal_;
  bool shown_{false};
  double next_s_{0};
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};

/// Progress of one job after the other.
class JobLine {
 public:
  void update(const std::string& job, double share) {
    if (!line_ || job != job_) line_.emplace(job_ = job);
    line_->update(share);
  }

 private:
  std::optional<ProgressLine> line_;
  std::string job_;
};

}  // namespace programs
