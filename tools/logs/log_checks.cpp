// SPDX-License-Identifier: MIT
#include "logs/log_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "logs/specific_force.hpp"
#include "pinnquad/data/motion_checks.hpp"
#include "pinnquad/data/split.hpp"

namespace pinnquad::logs {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Runs of identical values that last `longest_s` or longer and hold `fewest_rows` or more; NaN ends a run.
std::vector<IndexRange> frozen_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                                    double longest_s = 0.3, std::size_t fewest_rows = 10) {
  std::vector<IndexRange> runs;
  for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
    for (end = begin + 1; end < values.size() && !(values[end] < values[begin] || values[end] > values[begin]) &&
                          std::isfinite(values[end]);) {
      ++end;
    }
    if (!std::isfinite(values[begin]) || end - begin < fewest_rows) continue;
    if (time_s[end - 1] - time_s[begin] >= longest_s) runs.push_back({begin, end});
  }
  return runs;
}

enum class RateFrame { body, world, flu, enu, euler, reversed };

constexpr std::size_t rate_frames = 6;

constexpr std::array<const char*, rate_frames> rate_frame_sentences = {
    "",
    "the body rates behave as rates in the world's axes: turn them by the attitude into the body (R^T w), or log the "
    "gyro",
    "the body rates behave as rates in x forward, y left, z up: negate y and z",
    "the body rates behave as rates in the world's axes east, north, up: turn them into the body",
    "the body rates behave as derivatives of roll, pitch and yaw: turn them into p, q, r",
    "the attitude turns against the body rates: it is that of the world in the body (conjugate the quaternion), or all "
    "rates are "
    "negated"};

/// The body rates of a log if the vehicle turns with `turning` (body, FRD) while it is at `a`.
std::array<Vector3<double>, rate_frames> logged_rates(const Sample& a, const Sample& b,
                                                      const Vector3<double>& turning) {
  const auto euler = to_euler(attitude(a));
  const double sr = std::sin(euler.roll_rad), cr = std::cos(euler.roll_rad);
  const double tp = std::tan(euler.pitch_rad), cp = std::cos(euler.pitch_rad);
  const double yawing = (sr * turning[1] + cr * turning[2]) / cp;
  const Vector3<double> angles(turning[0] + tp * (sr * turning[1] + cr * turning[2]), cr * turning[1] - sr * turning[2],
                               yawing);
  // at the middle of the step
  const Quaternion<double> q_a = attitude(a), q_b = attitude(b);
  const double same = q_a.w * q_b.w + q_a.x * q_b.x + q_a.y * q_b.y + q_a.z * q_b.z < 0 ? -1 : 1;
  const Quaternion<double> middle = normalized(
      Quaternion<double>{q_a.w + same * q_b.w, q_a.x + same * q_b.x, q_a.y + same * q_b.y, q_a.z + same * q_b.z});
  const Vector3<double> world = body_to_world(middle, turning);
  return {turning, world, swap_flu_frd(turning), swap_enu_ned(world), angles, -turning};
}

}  // namespace

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

std::vector<std::string> check_clock(const std::string& topic, const ClockReport& report) {
  constexpr double jump_s = 1, jump_periods = 20, share_in_gaps = 0.05, share_of_rows = 0.01;
  std::vector<std::string> findings;
  const double period = report.nominal_period_s;
  if (report.restarts > 0) {
    findings.push_back(topic + ": time steps back by up to " + short_number(report.largest_step_back_s) + " s, " +
                       std::to_string(report.restarts) +
                       " times: two recordings in one file, or a clock that was set in flight; cut it there");
  }
  if (report.largest_step_s > jump_s && report.largest_step_s > jump_periods * period) {
    findings.push_back(topic + ": time jumps by " + short_number(report.largest_step_s) + " s between rows that are " +
                       short_number(1e3 * period) +
                       " ms apart elsewhere; what lies on both sides is treated as two flights");
  }
  const double rows = static_cast<double>(report.rows_kept);
  const double steady = report.time_in_gaps_s - (report.largest_step_s > jump_s ? report.largest_step_s : 0);
  if (period > 0 && steady > share_in_gaps * rows * period) {
    findings.push_back(topic + ": " + std::to_string(report.gaps) + " gaps, " + short_number(steady) +
                       " s in sum: the logger lost rows; a faster card or fewer topics help");
  }
  const double lost = static_cast<double>(report.same_time + report.not_a_time);
  if (lost > share_of_rows * static_cast<double>(report.rows_read)) {
    findings.push_back(topic + ": " + std::to_string(report.same_time) + " rows have a time that another row has, " +
                       std::to_string(report.not_a_time) + " have none");
  }
  return findings;
}

std::optional<std::string> check_log_rate(const std::string& topic, double period_s, bool px4) {
  if (!(period_s * least_log_rate_Hz > 1.0 + 1e-3)) return std::nullopt;
  std::string sentence = topic + " was logged at " + short_number(1 / period_s) +
                         " Hz, too slow to see what the motors do (50 Hz or more is good)";
  if (px4) {
    sentence += ": set SDLOG_PROFILE to 25 (default 1, system identification 8 and high rate 16 together) and restart";
  }
  return sentence;
}

std::optional<std::string> check_frozen(const std::string& name, const std::vector<double>& time_s,
                                        const std::vector<double>& values, double longest_s) {
  const std::vector<IndexRange> runs = frozen_rows(time_s, values, longest_s);
  if (runs.empty()) return std::nullopt;
  double sum_s = 0;
  for (const IndexRange& run : runs) sum_s += time_s[run.end - 1] - time_s[run.begin];
  const IndexRange& first = runs.front();
  const bool whole = first.size() == values.size();
  return whole ? name + " never changes: it was not measured"
               : name + " stands still for " + short_number(sum_s) + " s in " + std::to_string(runs.size()) +
                     (runs.size() == 1 ? " stretch" : " stretches") + ", first at " +
                     short_number(time_s[first.begin] - time_s.front()) +
                     " s: what stopped there measured nothing, drop it";
}

std::optional<std::string> check_rate_frame(const std::vector<Flight>& segments) {
  constexpr double unexplained = 0.3, better = 1.0 / 3, smallest_rates = 1e-3;  // mean square, (rad/s)^2
  std::array<Vector3<double>, rate_frames> residual;
  residual.fill(Vector3<double>::Zero());
  Vector3<double> rates = Vector3<double>::Zero();
  double steps = 0;
  const auto judge = [&](const Sample& a, const Sample& b, const Vector3<double>& rate, double dt_s) {
    const Vector3<double> turning =
        detail::turning_rate({a.roll_rad, a.pitch_rad, a.yaw_rad}, {b.roll_rad, b.pitch_rad, b.yaw_rad}, dt_s);
    const auto expected = logged_rates(a, b, turning);
    for (std::size_t frame = 0; frame < residual.size(); ++frame) {
      residual[frame] += (rate - expected[frame]).cwiseAbs2();
    }
    rates += rate.cwiseAbs2();
    steps += 1;
  };
  for (const Flight& segment : segments) detail::for_each_turning_step(segment, judge);
  if (!(rates.sum() > smallest_rates * steps)) return std::nullopt;
  std::array<double, rate_frames> left{};
  for (std::size_t frame = 0; frame < left.size(); ++frame) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      left[frame] += residual[frame][axis] / std::max(rates[axis], smallest_rates * steps) / 3;
    }
  }
  if (!(left[0] > unexplained)) return std::nullopt;
  const auto best = static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin());
  if (!(left[best] < better * left[0])) return std::nullopt;
  return std::string(rate_frame_sentences[best]) + " (taken as the body's they leave " + percent(left[0]) +
         " of the turning unexplained, so " + percent(left[best]) + ")";
}

}  // namespace pinnquad::logs
