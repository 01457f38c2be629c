// SPDX-License-Identifier: MIT
// Progress with the time left, on stderr: one line rewritten in place on a terminal, few plain lines elsewhere.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "command_line/in_words.hpp"
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

  /// The same, interrupted or not. A share below one that was shown counts as that.
  void show(double share) {
    constexpr double terminal_interval_s = 0.1, plain_interval_s = 5.0;
    const double now_s = elapsed_s();
    share = std::max(share, passed_.empty() ? 0.0 : passed_.back().share);
    if (share < 1 && now_s < next_s_) return;
    passed_.push_back({now_s, share});
    if (!terminal_ && share >= 1) return;  // the summary says so
    next_s_ = now_s + (terminal_ ? terminal_interval_s : plain_interval_s);
    if (!terminal_ && now_s < plain_interval_s) return;
    std::fprintf(stderr, "%s%s: %3.0f %%%s%s", terminal_ ? "\r" : "", job_.c_str(), 100 * share,
                 time_left(share).c_str(), terminal_ ? "       " : "\n");
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
  struct Passed {
    double time_s, share;
  };

  /// At the speed of the second half of the time so far, which a machine that others use too changes. Empty before
  /// enough is done to know.
  std::string time_left(double share) const {
    constexpr double least_share = 0.03;
    const Passed now = passed_.back();
    const Passed half = *std::find_if(passed_.begin(), passed_.end(),
                                      [&](const Passed& passed) { return 2 * passed.time_s >= now.time_s; });
    const bool began = half.time_s >= now.time_s || half.share >= share;
    const double speed_1_s = began ? share / now.time_s : (share - half.share) / (now.time_s - half.time_s);
    if (share < least_share || !(speed_1_s > 0)) return "";
    const double left_s = (1 - share) / speed_1_s;
    return left_s < 100 ? in_words(", %.0f s left", left_s) : in_words(", %.0f min left", left_s / 60);
  }

  std::string job_;
  bool terminal_;
  bool shown_{false};
  std::vector<Passed> passed_;
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
  /// Takes the line off the terminal.
  void clear() { line_.reset(); }

 private:
  std::optional<ProgressLine> line_;
  std::string job_;
};

}  // namespace programs
