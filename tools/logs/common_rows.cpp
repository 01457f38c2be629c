// SPDX-License-Identifier: MIT
#include "logs/common_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pinnquad::logs {
namespace {

/// The last value not after each time, the first before it: of flags, which are told when they change.
std::vector<double> latest(const Signal& signal, const std::vector<double>& time_s) {
  std::vector<double> values(time_s.size(), std::nan(""));
  std::size_t at = 0;
  for (std::size_t row = 0; row < time_s.size() && signal.clock->size() > 0; ++row) {
    while (at + 1 < signal.clock->size() && signal.clock->time_s[at + 1] <= time_s[row]) ++at;
    values[row] = signal.values[0][signal.clock->row[at]];
  }
  return values;
}

/// Values before the first and after the last number: those, for slow signals whose first message is late.
void extend_ends(std::vector<double>& values) {
  const auto number = [](double value) { return std::isfinite(value); };
  const auto first = std::find_if(values.begin(), values.end(), number);
  if (first == values.end()) return;
  std::fill(values.begin(), first, *first);
  const auto last = std::find_if(values.rbegin(), values.rend(), number);
  std::fill(values.rbegin(), last, *last);
}

bool on_one_clock(const BoundLog& log) {
  const Signal& first = log.of(Quantity::body_rates);
  const auto same = [&first](const Signal& other) {
    return !other.present() || (other.topic == first.topic && other.source->time_column == first.source->time_column);
  };
  const bool sparse = std::any_of(log.signals.begin(), log.signals.end(), [](const Signal& signal) {
    return signal.sparse && signal.source->quantity != Quantity::landed;
  });
  return !sparse && std::all_of(log.signals.begin(), log.signals.end(), same) &&
         std::all_of(log.extras.begin(), log.extras.end(), [&](const BoundExtra& extra) { return same(extra.signal); });
}

/// Nearly all steps are the usual one, but for gaps.
bool has_even_steps(const CleanClock& clock) {
  constexpr double even = 0.1, most_uneven = 0.01;
  const double period_s = clock.report.nominal_period_s;
  std::size_t uneven = 0;
  for (std::size_t i = 1; i < clock.size(); ++i) {
    if (std::abs(clock.time_s[i] - clock.time_s[i - 1] - period_s) > even * period_s) ++uneven;
  }
  return period_s > 0 && static_cast<double>(uneven) <= most_uneven * static_cast<double>(clock.size());
}

/// Puts signals on the clock of the rows.
class CommonClock {
 public:
  explicit CommonClock(bool hold_commands) : hold_commands_(hold_commands) {}

  void own(const CleanClock& clock) {
    own_ = &clock;
    period_s_ = clock.report.nominal_period_s;
  }
  void uniform(const UniformClock& clock) {
    uniform_ = clock;
    period_s_ = clock.period_s;
  }
  std::vector<double> times() const {
    if (own_) return own_->time_s;
    std::vector<double> time_s(uniform_.rows);
    for (std::size_t row = 0; row < time_s.size(); ++row) time_s[row] = uniform_.at(row);
    return time_s;
  }
  /// The signal's values are gone afterwards.
  std::vector<double> values(Signal& signal, std::size_t component) const {
    const std::vector<double> all = std::move(signal.values[component]);
    if (own_) {
      std::vector<double> values;
      values.reserve(own_->size());
      for (const std::size_t row : own_->row) values.push_back(all[row]);
      return values;
    }
    const Quantity quantity = signal.source->quantity;
    const bool command = quantity == Quantity::motors || quantity == Quantity::torque_and_thrust;
    const bool held = signal.source->held || (command && hold_commands_);
    return resample(*signal.clock, all, uniform_, resampling_of(signal.period_s(), period_s_, held),
                    bridged_gap_s(*signal.clock));
  }
  template <std::size_t Count>
  void take(Signal& signal, std::array<std::vector<double>, Count>& to) const {
    if (!signal.present()) return;
    if (!own_ && signal.source->quantity == Quantity::attitude) {
      if constexpr (Count == 4) {
        const auto& v = signal.values;
        to = resample_attitude(*signal.clock, {&v[0], &v[1], &v[2], &v[3]}, uniform_, bridged_gap_s(*signal.clock));
      }
      return;
    }
    for (std::size_t i = 0; i < Count; ++i) to[i] = values(signal, i);
  }

 private:
  const CleanClock* own_ = nullptr;
  UniformClock uniform_;
  double period_s_ = 0;
  bool hold_commands_;
};

/// Signals without which a row is none: their common time is that of the rows.
std::vector<const Signal*> needed_signals(const BoundLog& log) {
  std::vector<const Signal*> needed;
  for (const Quantity quantity : {Quantity::attitude, Quantity::body_rates, Quantity::motors, Quantity::specific_force,
                                  Quantity::acceleration, Quantity::velocity, Quantity::position, Quantity::altitude}) {
    if (log.of(quantity).present()) needed.push_back(&log.of(quantity));
  }
  return needed;
}

/// The period of the log's own rows, at most 100 Hz: a usual one where it is within a tenth of it
/// (loggers whose rate is 50 Hz drop a row now and then), else a whole number of microseconds.
double usual_period_s(const BoundLog& log) {
  constexpr double shortest_s = 0.01, near = 0.1;
  const double period_s = std::max(shortest_s, own_rows_period_s(log));
  for (const double usual_s : {0.01, 0.02, 0.04, 0.05, 0.1}) {
    if (std::abs(period_s - usual_s) <= near * usual_s) return usual_s;
  }
  return std::round(period_s * 1e6) / 1e6;
}

}  // namespace

double own_rows_period_s(const BoundLog& log) {
  double period_s = 0;
  for (const Quantity quantity :
       {Quantity::motors, Quantity::body_rates, Quantity::specific_force, Quantity::acceleration}) {
    if (log.of(quantity).present()) period_s = std::max(period_s, log.of(quantity).period_s());
  }
  return period_s;
}

CommonRows common_rows(BoundLog& log, const std::optional<double>& period_s, bool hold_commands) {
  CommonRows rows;
  CommonClock clock(hold_commands);
  const CleanClock& own = *log.of(Quantity::body_rates).clock;
  const double own_period_s = own.report.nominal_period_s;
  rows.own_rows = on_one_clock(log) && has_even_steps(own) &&
                  (!period_s || std::abs(*period_s - own_period_s) < 1e-3 * own_period_s);
  if (rows.own_rows) {
    rows.period_s = std::round(own_period_s * 1e6) / 1e6;
    clock.own(own);
  } else {
    rows.period_s = period_s ? *period_s : usual_period_s(log);
    std::vector<const CleanClock*> clocks;
    for (const Signal* signal : needed_signals(log)) clocks.push_back(signal->clock.get());
    clock.uniform(common_clock(clocks, rows.period_s));
  }
  rows.time_s = clock.times();
  clock.take(log.of(Quantity::attitude), rows.attitude);
  clock.take(log.of(Quantity::motors), rows.commands);
  clock.take(log.of(Quantity::body_rates), rows.body_rates);
  clock.take(log.of(Quantity::angular_acceleration), rows.angular_acceleration);
  clock.take(log.of(Quantity::specific_force), rows.specific_force);
  clock.take(log.of(Quantity::acceleration), rows.acceleration);
  clock.take(log.of(Quantity::velocity), rows.velocity);
  clock.take(log.of(Quantity::position), rows.position);
  if (log.of(Quantity::altitude).present()) rows.altitude = clock.values(log.of(Quantity::altitude), 0);
  if (log.of(Quantity::landed).present()) rows.landed = latest(log.of(Quantity::landed), rows.time_s);
  for (BoundExtra& extra : log.extras) {
    const bool by_own_rows = rows.own_rows && extra.signal.sparse;
    std::vector<double> values = by_own_rows ? latest(extra.signal, rows.time_s) : clock.values(extra.signal, 0);
    if (!rows.own_rows || by_own_rows) extend_ends(values);
    rows.extras.push_back(std::move(values));
  }
  return rows;
}

}  // namespace pinnquad::logs
