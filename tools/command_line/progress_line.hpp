// SPDX-License-Identifier: MIT
// Progress with the time left, on stderr: one line rewritten in place on a terminal, few plain lines elsewhere.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include "command_line/in_words.hpp"
#include "command_line/interrupt.hpp"

namespace programs {

/// The share of a job that was done at a time since its begin.
struct PassedShare {
  double time_s, share;
};

/// How long the job still takes, by what has passed of it, in order of time: at the geometric mean of its speed so far,
/// slow where it begins slowly, and of that in the second half of the time, fast where steps are large. Empty before
/// enough is done to know.
inline std::optional<double> seconds_left(const std::vector<PassedShare>& passed) {
  constexpr double least_share = 0.03;
  const PassedShare now = passed.back();
  if (now.share < least_share || !(now.time_s > 0)) return {};
  const PassedShare half =
      *std::find_if(passed.begin(), passed.end(), [&](const PassedShare& one) { return 2 * one.time_s >= now.time_s; });
  const double speed_1_s = now.share / now.time_s;
  const bool has_half = half.time_s < now.time_s && half.share < now.share;
  const double late_1_s = has_half ? (now.share - half.share) / (now.time_s - half.time_s) : speed_1_s;
  return (1 - now.share) / std::sqrt(speed_1_s * late_1_s);
}

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
    std::fprintf(stderr, "%s%s: %3.0f %%%s%s", terminal_ ? "\r" : "", job_.c_str(), 100 * share, time_left().c_str(),
                 terminal_ ? "       " : "\n");
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
  std::string time_left() const {
    const std::optional<double> left_s = seconds_left(passed_);
    if (!left_s) return "";
    return *left_s < 100 ? in_words(", %.0f s left", *left_s) : in_words(", %.0f min left", *left_s / 60);
  }

  std::string job_;
  bool terminal_;
  bool shown_{false};
  std::vector<PassedShare> passed_;
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
