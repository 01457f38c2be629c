// SPDX-License-Identifier: MIT
// A pilot who repeats a stick recording, as the paper's manual flights were steered; and how one is read and written.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/simulation/pilot.hpp"

namespace pinnquad {

namespace detail {

/// A set point and its time.
struct StickRow {
  double time_s{0};
  SetPoint<double> set_point{};
};

}  // namespace detail

/// Time strictly increasing.
using StickRecording = std::vector<detail::StickRow>;

/// Columns of a stick recording: a SetPoint with its time.
///   time_s                                  since the start of the flight, not negative
///   v_north_m_s, v_east_m_s, v_down_m_s     velocity over ground, NED
///   yaw_rate_rad_s                          about world down, positive to the right
///   stick_roll_rad_s, _pitch_, _yaw_        added to the body rates wanted, FRD
inline const std::vector<std::string>& stick_columns() {
  static const std::vector<std::string> columns = {
      "time_s",         "v_north_m_s",      "v_east_m_s",        "v_down_m_s",
      "yaw_rate_rad_s", "stick_roll_rad_s", "stick_pitch_rad_s", "stick_yaw_rad_s"};
  return columns;
}

/// Reads a stick recording. Columns are found by name, in any order; others are ignored. Throws InputError: as
/// `read_csv` does; a negative time or one that does not increase.
inline StickRecording read_sticks_csv(const std::string& path) {
  constexpr std::size_t minimum_rows = 2;
  StickRecording recording;
  detail::for_each_csv_row(path, stick_columns(), minimum_rows,
                           [&](const std::vector<double>& v, std::size_t line, const std::vector<std::size_t>& fields) {
                             if (recording.empty() ? v[0] < 0 : !(v[0] > recording.back().time_s)) {
                               const std::string least =
                                   recording.empty() ? "of 0 or more" : "above " + number_text(recording.back().time_s);
                               throw InputError(path, line, fields[0] + 1,
                                                "a time " + least + " in column " + stick_columns()[0],
                                                number_text(v[0]));
                             }
                             recording.push_back({v[0], {{v[1], v[2], v[3]}, v[4], {v[5], v[6], v[7]}}});
                           });
  return recording;
}

/// Writes a stick recording; the file appears whole or not at all, and gives the same bits back. Throws OutputError.
inline void write_sticks_csv(const std::string& path, const StickRecording& recording) {
  std::vector<std::vector<double>> rows;
  rows.reserve(recording.size());
  for (const detail::StickRow& row : recording) {
    const SetPoint<double>& p = row.set_point;
    rows.push_back({row.time_s, p.velocity_m_s[0], p.velocity_m_s[1], p.velocity_m_s[2], p.yaw_rate_rad_s,
                    p.stick_rad_s[0], p.stick_rad_s[1], p.stick_rad_s[2]});
  }
  write_csv(path, stick_columns(), rows);
}

/// Asks for what a recording says, linear between its rows; before the first row for what that one says, after the last
/// for a hover. At the time of a row its numbers come back bit for bit: a recording of every control tick flies the
/// same flight again.
class RecordedSticks {
 public:
  explicit RecordedSticks(StickRecording recording) : recording_(std::move(recording)) {}

  /// In time order; `state` plays no part: sticks are blind.
  SetPoint<double> operator()(const State<double>& /*state*/, double time_s) {
    if (recording_.empty() || time_s > recording_.back().time_s) return {};
    while (next_ < recording_.size() && recording_[next_].time_s <= time_s) ++next_;
    if (next_ == 0) return recording_.front().set_point;
    const detail::StickRow& before = recording_[next_ - 1];
    if (before.time_s == time_s || next_ == recording_.size()) return before.set_point;
    const detail::StickRow& after = recording_[next_];
    const double share = (time_s - before.time_s) / (after.time_s - before.time_s);
    const SetPoint<double>&a = before.set_point, &b = after.set_point;
    SetPoint<double> result;
    result.velocity_m_s = a.velocity_m_s + (b.velocity_m_s - a.velocity_m_s) * share;
    result.yaw_rate_rad_s = a.yaw_rate_rad_s + (b.yaw_rate_rad_s - a.yaw_rate_rad_s) * share;
    result.stick_rad_s = a.stick_rad_s + (b.stick_rad_s - a.stick_rad_s) * share;
    return result;
  }

  /// Time of the last row.
  double duration_s() const noexcept { return recording_.empty() ? 0 : recording_.back().time_s; }

 private:
  StickRecording recording_;
  std::size_t next_{0};
};

/// A pilot that asks for what `pilot` does and writes it down, at most every `interval_s` (0: at every tick).
/// `recording` must outlive the flight: the only reference a pilot holds, because fly() takes its pilot by copy.
template <class Pilot>
auto written_down(Pilot pilot, StickRecording& recording, double interval_s = 0) {
  static_assert(is_pilot<Pilot>, "pinnquad: this type is no pilot (simulation/pilot.hpp)");
  return [pilot = std::move(pilot), &recording, interval_s](const State<double>& state, double time_s) mutable {
    constexpr double early_s = 1e-6;  // times are sums of steps
    const SetPoint<double> asked = pilot(state, time_s);
    if (recording.empty() || time_s >= recording.back().time_s + interval_s - early_s) {
      recording.push_back({time_s, asked});
    }
    return asked;
  };
}

}  // namespace pinnquad
