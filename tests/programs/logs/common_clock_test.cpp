// SPDX-License-Identifier: MIT
#include "logs/clock.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "logs/log_checks.hpp"

using namespace pinnquad::logs;

namespace {
std::vector<double> ticks(int rows, double period_s, double begin_s = 0) {
  std::vector<double> time_s;
  for (int row = 0; row < rows; ++row) time_s.push_back(begin_s + row * period_s);
  return time_s;
}
bool has(const std::vector<std::string>& findings, const std::string& words) {
  return std::any_of(findings.begin(), findings.end(),
                     [&](const std::string& one) { return one.find(words) != std::string::npos; });
}
}  // namespace

TEST_CASE("a shuffled log is the sorted one, every row at its time") {
  std::vector<double> time_s = ticks(100, 0.01, 5);
  std::mt19937 engine(1);
  std::shuffle(time_s.begin(), time_s.end(), engine);
  const CleanClock clock = clean_clock(time_s);
  REQUIRE(clock.size() == 100);
  for (std::size_t i = 0; i < clock.size(); ++i) {
    CHECK(clock.time_s[i] == doctest::Approx(5 + 0.01 * static_cast<double>(i)));
    CHECK(time_s[clock.row[i]] == clock.time_s[i]);
  }
  CHECK(clock.report.out_of_order > 50);
  CHECK(clock.report.nominal_period_s == doctest::Approx(0.01));
  CHECK(clock.report.restarts == 0);
}

TEST_CASE("a few wild stamps are left out wherever they stand; many are a second recording") {
  for (const std::size_t at : {0ul, 1ul, 500ul, 998ul, 999ul}) {
    for (const double wild_s : {9.2e12, -4.0, 1e5}) {
      std::vector<double> time_s = ticks(1000, 0.01, 100);
      time_s[at] = wild_s;
      const CleanClock clock = clean_clock(time_s);
      CHECK(clock.size() >= (at == 1 ? 998 : 999));  // of two rows nobody knows which is wild
      CHECK(clock.report.wild + clock.report.stale_first == 1000 - clock.size());
      CHECK(clock.report.restarts == 0);
      CHECK(clock.report.largest_step_s < 0.03);
    }
  }
  std::vector<double> time_s = ticks(1000, 0.01, 100);
  for (std::size_t row = 980; row < 1000; ++row) time_s[row] -= 50;
  CHECK(clean_clock(time_s).report.restarts == 1);
  CHECK(clean_clock(time_s).report.wild == 0);
  time_s = ticks(1000, 0.01, 100);
  for (std::size_t row = 500; row < 1000; ++row) time_s[row] += 50;  // a pause is none
  CHECK(clean_clock(time_s).size() == 1000);
}

TEST_CASE("of rows with one time the last stays; no time, no row; all is counted") {
  const CleanClock clock = clean_clock({0, 1, 1, 1, 2, std::nan(""), 3, HUGE_VAL, 2.5});
  REQUIRE(clock.size() == 5);
  CHECK(clock.row[1] == 3);
  CHECK(clock.row[3] == 8);
  CHECK(clock.report.rows_read == 9);
  CHECK(clock.report.same_time == 2);
  CHECK(clock.report.not_a_time == 2);
  CHECK(clock.report.out_of_order == 1);
  CHECK(clock.report.rows_kept == 5);
  CHECK(clock.report.rows_kept + clock.report.same_time + clock.report.not_a_time + clock.report.stale_first ==
        clock.report.rows_read);
  CHECK(clean_clock({}).size() == 0);
  CHECK(clean_clock({std::nan("")}).size() == 0);
}

TEST_CASE("first rows that were latched before the log began are stale") {
  std::vector<double> time_s = ticks(50, 0.02, 100);
  time_s.insert(time_s.begin(), 12.3);
  CleanClock clock = clean_clock(time_s);
  CHECK(clock.report.stale_first == 1);
  CHECK(clock.time_s.front() == doctest::Approx(100));
  CHECK(clock.report.gaps == 0);
}

TEST_CASE("a gap, a jump and a second recording are told apart") {
  std::vector<double> time_s = ticks(500, 0.01);
  CHECK(check_clock("gyro", clean_clock(time_s).report).empty());
  time_s.erase(time_s.begin() + 200, time_s.begin() + 210);
  CleanClock clock = clean_clock(time_s);
  CHECK(clock.report.gaps == 1);
  CHECK(clock.report.time_in_gaps_s == doctest::Approx(0.11));
  CHECK(check_clock("gyro", clock.report).empty());
  for (std::size_t row = 300; row < time_s.size(); ++row) time_s[row] += 1000;
  CHECK(has(check_clock("gyro", clean_clock(time_s).report), "time jumps by"));
  for (std::size_t row = 300; row < time_s.size(); ++row) time_s[row] -= 1003.1;
  const auto again = check_clock("gyro", clean_clock(time_s).report);
  CHECK(has(again, "time steps back by"));
  CHECK(clean_clock(time_s).report.largest_step_back_s == doctest::Approx(3.09).epsilon(0.02));
  std::vector<double> lossy;
  for (int row = 0; row < 1000; ++row) {
    if (row % 20 >= 5) lossy.push_back(0.01 * row);
  }
  CHECK(has(check_clock("gyro", clean_clock(lossy).report), " gaps, "));
  std::vector<double> twice = ticks(100, 0.01);
  twice.resize(110, 0.5);
  CHECK(has(check_clock("gyro", clean_clock(twice).report), "a time that another row has"));
}

TEST_CASE("a log too slow for motors is told, with the profile that helps") {
  const auto found = pinnquad::logs::check_log_rate("actuator_motors", 0.1, true);
  REQUIRE(found.has_value());
  CHECK(found->find("logged at 10 Hz") != std::string::npos);
  CHECK(found->find("SDLOG_PROFILE to 25") != std::string::npos);
  CHECK(pinnquad::logs::check_log_rate("u", 0.1, false)->find("SDLOG") == std::string::npos);
  CHECK_FALSE(pinnquad::logs::check_log_rate("u", 0.04, true).has_value());
}

TEST_CASE("the common clock spans what all topics have, on multiples of its period") {
  const CleanClock fast = clean_clock(ticks(1000, 0.004, 1.003)), slow = clean_clock(ticks(50, 0.1, 1.05));
  const UniformClock clock = common_clock({&fast, &slow}, 0.02);
  CHECK(clock.at(0) == doctest::Approx(1.06));
  CHECK(clock.at(clock.rows - 1) <= 1.003 + 999 * 0.004 + 1e-9);
  CHECK(clock.at(clock.rows) > 1.003 + 999 * 0.004);
  const CleanClock later = clean_clock(ticks(10, 0.1, 100)), none = clean_clock({});
  CHECK(common_clock({&fast, &later}, 0.02).rows == 0);
  CHECK(common_clock({&fast, &none}, 0.02).rows == 0);
  CHECK_THROWS_AS(common_clock({&fast}, 0), std::invalid_argument);
  CHECK_THROWS_AS(common_clock({}, 0.01), std::invalid_argument);
}

TEST_CASE("lines between rows are exact for a line, and end where the topic ends") {
  std::vector<double> time_s, values;
  for (int row = 0; row < 100; ++row) {
    time_s.push_back(0.01 * row + (row % 3) * 0.002);
    values.push_back(3 - 2 * time_s.back());
  }
  const CleanClock clock = clean_clock(time_s);
  const UniformClock to{-0.05, 0.007, 170};
  const auto got = resample(clock, values, to, Resampling::linear, bridged_gap_s(clock));
  for (std::size_t row = 0; row < to.rows; ++row) {
    const double t = to.at(row);
    const bool inside = t >= 0 && t <= time_s.back();
    CHECK(std::isfinite(got[row]) == inside);
    if (inside) CHECK(got[row] == doctest::Approx(3 - 2 * t));
  }
}

TEST_CASE("a step longer than what may be bridged stays a gap, and NaN makes one") {
  std::vector<double> time_s = ticks(100, 0.01), values(100, 1.0);
  for (std::size_t row = 50; row < 53; ++row) values[row] = std::nan("");
  for (std::size_t row = 70; row < 80; ++row) values[row] = std::nan("");
  const CleanClock clock = clean_clock(time_s);
  const UniformClock to{0, 0.01, 100};
  for (const Resampling kind : {Resampling::linear, Resampling::hold, Resampling::low_pass}) {
    const auto got = resample(clock, values, to, kind, 0.045);
    for (std::size_t row = 0; row < 98; ++row) {
      CAPTURE(row);
      CHECK(std::isfinite(got[row]) == (row < 70 || row > 79));
    }
  }
}

TEST_CASE("a held value is the last one before") {
  const CleanClock clock = clean_clock({0, 0.1, 0.2, 0.3});
  const auto got = resample(clock, {1, 2, 3, 4}, {0, 0.05, 8}, Resampling::hold, 0.15);
  const std::vector<double> expected = {1, 1, 2, 2, 3, 3, 4, 4};
  for (std::size_t row = 0; row < expected.size(); ++row) CHECK(got[row] == expected[row]);
}

TEST_CASE("a held value holds beyond the last row as long as a gap may be bridged, and no longer") {
  const CleanClock clock = clean_clock({0, 0.1, 0.2, 0.3});
  const UniformClock to{0.3, 0.05, 10};
  const auto got = resample(clock, {1, 2, 3, 4}, to, Resampling::hold, 0.12);
  for (std::size_t row = 0; row < to.rows; ++row) {
    CAPTURE(row);
    CHECK(std::isfinite(got[row]) == (row <= 2));  // 0.4 s is 0.1 s after the last one
    if (row <= 2) CHECK(got[row] == 4);
  }
}

TEST_CASE("a fast signal is low-passed before its rows are thinned: what is above half the new rate does not fold") {
  const double period_s = 0.004;
  std::vector<double> time_s = ticks(5000, period_s), slow, fast;
  for (const double t : time_s) {
    slow.push_back(std::sin(6.2832 * 2 * t));
    fast.push_back(std::sin(6.2832 * 48 * t));
  }
  const CleanClock clock = clean_clock(time_s);
  const UniformClock to{1, 0.02, 900};
  CHECK(pinnquad::logs::resampling_of(period_s, 0.02, false) == Resampling::low_pass);
  CHECK(pinnquad::logs::resampling_of(0.02, 0.02, true) == Resampling::hold);
  CHECK(pinnquad::logs::resampling_of(0.02, 0.004, false) == Resampling::linear);
  const auto kept = resample(clock, slow, to, Resampling::low_pass, 0.02);
  const auto gone = resample(clock, fast, to, Resampling::low_pass, 0.02);
  const auto folded = resample(clock, fast, to, Resampling::linear, 0.02);
  double worst_kept = 0, worst_gone = 0, worst_folded = 0;
  for (std::size_t row = 0; row < to.rows; ++row) {
    worst_kept = std::max(worst_kept, std::abs(kept[row] - std::sin(6.2832 * 2 * to.at(row))));
    worst_gone = std::max(worst_gone, std::abs(gone[row]));
    worst_folded = std::max(worst_folded, std::abs(folded[row]));
  }
  CHECK(worst_kept < 0.02);
  CHECK(worst_gone < 0.1);
  CHECK(worst_folded > 0.9);
}

TEST_CASE("attitudes go along the arc at a constant rate, whatever the sign that was logged") {
  const std::vector<double> time_s = ticks(40, 0.1);
  std::array<std::vector<double>, 4> q;
  for (std::size_t row = 0; row < time_s.size(); ++row) {
    const double half = 0.5 * 3.0 * time_s[row], sign = row % 2 == 0 ? 1 : -1;
    const double values[4] = {std::cos(half), 0.6 * std::sin(half), 0, 0.8 * std::sin(half)};
    for (std::size_t i = 0; i < 4; ++i) q[i].push_back(sign * 1.01 * values[i]);
  }
  q[0][20] = 0.1;  // no unit quaternion
  const CleanClock clock = clean_clock(time_s);
  const UniformClock to{0, 0.013, 299};
  const auto got = pinnquad::logs::resample_attitude(clock, {&q[0], &q[1], &q[2], &q[3]}, to, 0.35);
  for (std::size_t row = 0; row < to.rows; ++row) {
    const double half = 0.5 * 3.0 * to.at(row);
    CHECK(got[0][row] == doctest::Approx(std::cos(half)).epsilon(1e-9));
    CHECK(got[1][row] == doctest::Approx(0.6 * std::sin(half)).epsilon(1e-9));
    CHECK(got[3][row] == doctest::Approx(0.8 * std::sin(half)).epsilon(1e-9));
  }
  const auto gap = pinnquad::logs::resample_attitude(clock, {&q[0], &q[1], &q[2], &q[3]}, to, 0.15);
  CHECK(std::isnan(gap[0][150]));
}
