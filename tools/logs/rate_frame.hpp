// SPDX-License-Identifier: MIT
// Are body rates those of the body, in FRD and rad/s? Asked of the motion: over a step of time the attitude turns by
// them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "logs/finding.hpp"
#include "logs/specific_force.hpp"
#include "pinnquad/data/motion_checks.hpp"

namespace programs {

namespace detail {

enum class RateFrame { body, world, flu, enu, euler, reversed };
inline constexpr std::size_t rate_frames = 6;
inline constexpr std::array<const char*, rate_frames> rate_frame_sentences = {
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
inline std::array<pinnquad::Vector3<double>, rate_frames> logged_rates(const pinnquad::Sample& a,
                                                                       const pinnquad::Sample& b,
                                                                       const pinnquad::Vector3<double>& turning) {
  const auto euler = pinnquad::to_euler(attitude(a));
  const double sr = std::sin(euler.roll_rad), cr = std::cos(euler.roll_rad);
  const double tp = std::tan(euler.pitch_rad), cp = std::cos(euler.pitch_rad);
  const double yawing = (sr * turning[1] + cr * turning[2]) / cp;
  const pinnquad::Vector3<double> angles(turning[0] + tp * (sr * turning[1] + cr * turning[2]),
                                         cr * turning[1] - sr * turning[2], yawing);
  // at the middle of the step
  const pinnquad::Quaternion<double> q_a = attitude(a), q_b = attitude(b);
  const double same = q_a.w * q_b.w + q_a.x * q_b.x + q_a.y * q_b.y + q_a.z * q_b.z < 0 ? -1 : 1;
  const pinnquad::Quaternion<double> middle = pinnquad::normalized(pinnquad::Quaternion<double>{
      q_a.w + same * q_b.w, q_a.x + same * q_b.x, q_a.y + same * q_b.y, q_a.z + same * q_b.z});
  const pinnquad::Vector3<double> world = pinnquad::body_to_world(middle, turning);
  return {turning, world, pinnquad::swap_flu_frd(turning), pinnquad::swap_enu_ned(world), angles, -turning};
}

}  // namespace detail

/// Compares, over steps of 0.2 s, what the logged rates would be in each frame with what they are: per axis the share
/// of the rates' squares that is left unexplained, mean of the three. A finding where body rates leave 0.3 or more, and
/// another frame less than a third of that. number: the share that body rates leave.
/// Limits: where the vehicle stays near level and at one heading near north the frames agree, and nothing is found; an
/// attitude that is wrong by itself shows here, see check_attitude().
inline std::optional<Finding> check_rate_frame(const std::vector<pinnquad::Flight>& segments) {
  constexpr double unexplained = 0.3, better = 1.0 / 3, smallest_rates = 1e-3;  // mean square, (rad/s)^2
  std::array<pinnquad::Vector3<double>, detail::rate_frames> residual;
  residual.fill(pinnquad::Vector3<double>::Zero());
  pinnquad::Vector3<double> rates = pinnquad::Vector3<double>::Zero();
  double steps = 0;
  const auto judge = [&](const pinnquad::Sample& a, const pinnquad::Sample& b, const pinnquad::Vector3<double>& rate,
                         double dt_s) {
    const pinnquad::Vector3<double> turning = pinnquad::detail::turning_rate(
        {a.roll_rad, a.pitch_rad, a.yaw_rad}, {b.roll_rad, b.pitch_rad, b.yaw_rad}, dt_s);
    const auto expected = detail::logged_rates(a, b, turning);
    for (std::size_t frame = 0; frame < residual.size(); ++frame) {
      residual[frame] += (rate - expected[frame]).cwiseAbs2();
    }
    rates += rate.cwiseAbs2();
    steps += 1;
  };
  for (const pinnquad::Flight& segment : segments) pinnquad::detail::for_each_turning_step(segment, judge);
  if (!(rates.sum() > smallest_rates * steps)) return std::nullopt;
  std::array<double, detail::rate_frames> left{};
  for (std::size_t frame = 0; frame < left.size(); ++frame) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      left[frame] += residual[frame][axis] / std::max(rates[axis], smallest_rates * steps) / 3;
    }
  }
  if (!(left[0] > unexplained)) return std::nullopt;
  const auto best = static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin());
  if (!(left[best] < better * left[0])) return std::nullopt;
  return Finding{"rate_frame", left[0], "1",
                 std::string(detail::rate_frame_sentences[best]) + " (taken as the body's they leave " +
                     detail::percent(left[0]) + " of the turning unexplained, so " + detail::percent(left[best]) + ")"};
}

/// find_degrees_by_motion() over all segments as one flight; number: how many of the four columns are in degrees.
inline std::optional<Finding> check_degrees(const std::vector<pinnquad::Flight>& segments) {
  pinnquad::Flight all;
  double last_s = 0;
  for (const pinnquad::Flight& segment : segments) {
    const double shift_s = all.empty() || segment.empty() ? 0 : last_s + 10 - segment.front().time_s;
    for (pinnquad::Sample sample : segment) {
      sample.time_s += shift_s;
      last_s = sample.time_s;
      all.push_back(sample);
    }
  }
  const auto found = pinnquad::find_degrees_by_motion(all);
  constexpr std::array<const char*, 3> names = {"roll", "pitch", "yaw"};
  std::string columns;
  double number = 0;
  const auto add = [&](bool in_degrees, const char* name) {
    if (!in_degrees) return;
    columns += (columns.empty() ? "" : ", ") + std::string(name);
    number += 1;
  };
  for (std::size_t i = 0; i < 3; ++i) add(found.angle[i], names[i]);
  add(found.body_rates, "body rates");
  if (columns.empty()) return std::nullopt;
  return Finding{"degrees", number, "columns",
                 "in degrees, by how attitude and body rates change together: " + columns + " (say so in the mapping)"};
}

}  // namespace programs
