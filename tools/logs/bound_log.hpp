// SPDX-License-Identifier: MIT
// A log whose columns have their meaning: each quantity from the first source that the log has.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "airframe/file.hpp"
#include "command_line/nearest_names.hpp"
#include "logs/motor_commands.hpp"
#include "logs/signal.hpp"
#include "pinnquad/io/decimal.hpp"

namespace programs {

struct BoundExtra {
  const ExtraSource* extra = nullptr;
  Signal signal;
};

struct BoundLog {
  std::array<Signal, quantities.size()> signals;  ///< by Quantity; `motors` also where they were rebuilt
  std::vector<BoundExtra> extras;                 ///< those that the log has

  Signal& of(Quantity quantity) { return signals[static_cast<std::size_t>(quantity)]; }
  const Signal& of(Quantity quantity) const { return signals[static_cast<std::size_t>(quantity)]; }
};

/// The topics that a mapping looks at: none are named by one of a table.
inline std::vector<std::string> mapped_topics(const Mapping& mapping) {
  std::vector<std::string> topics;
  const auto add = [&topics](const std::string& topic) {
    if (!topic.empty() && std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
  };
  for (const Source& source : mapping.sources) {
    add(source.topic);
    add(source.thrust_topic);
  }
  for (const ExtraSource& extra : mapping.extras) add(extra.source.topic);
  return topics;
}

namespace detail {

/// A log that is one table has one topic, whatever it is called.
inline const LogTopic* topic_of(const FlightLog& log, const std::string& name, int instance) {
  if (name.empty()) return log.topics.empty() ? nullptr : &log.topics.front();
  return log.topic(name, instance);
}

inline bool has_number(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// The columns of a topic that a source names; with `why`, the reason is thrown where one is missing or holds text.
inline std::vector<const LogColumn*> columns_in(const LogTopic& topic, const std::vector<NamedColumn>& wanted,
                                                const std::string& mapping_file, bool why) {
  std::vector<const LogColumn*> found;
  for (const NamedColumn& one : wanted) {
    if (const LogColumn* column = topic.column(one.name)) {
      found.push_back(column);
      continue;
    }
    if (!why) return {};
    if (const LogText* text = topic.text(one.name)) {
      throw wrong_cell(topic, text->first_text, one.name, "a number in column " + one.name,
                       pinnquad::quoted_cell(text->values[text->first_text]));
    }
    std::vector<std::string> known;
    for (const LogColumn& column : topic.columns) known.push_back(column.name);
    throw pinnquad::InputError(
        mapping_file, one.place.line, one.place.column,
        "a column of " + topic_words(topic.name, topic.instance) + " in " + topic.file,
        "`" + pinnquad::printable(one.name) + "`, which it has not; " + nearest_names(one.name, known));
  }
  return found;
}

/// By the source's own column, or the topic's clock, or the one that [time] names for a table.
inline std::vector<double> times_of(const LogTopic& topic, const Source& source, const Mapping& mapping) {
  const bool own = !source.time_column.empty();
  if (!own && has_number(topic.time_s)) return topic.time_s;
  if (!own && mapping.time_column.name.empty()) {
    throw pinnquad::InputError(mapping.file, source.place.line, source.place.column,
                               "a table [time] that names the clock of " + topic.file, "none");
  }
  const NamedColumn clock = own ? NamedColumn{source.time_column, source.place} : mapping.time_column;
  const std::vector<const LogColumn*> column = columns_in(topic, {clock}, mapping.file, true);
  const double ticks_per_s = std::round(1 / (own ? source.time_in_s : mapping.time_in_s));
  std::vector<double> time_s = column[0]->values;
  for (double& t : time_s) t /= ticks_per_s;
  return time_s;
}

/// Rows of `other` at the times of `time_s`: stamps of one sample, to half a microsecond. NaN where there is none.
inline std::vector<double> at_same_times(const std::vector<double>& time_s, const std::vector<double>& other_s,
                                         const std::vector<double>& other) {
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = 0; i < other.size(); ++i) {
    if (std::isfinite(other_s[i])) rows.emplace_back(other_s[i], other[i]);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<double> matched(time_s.size(), std::nan(""));
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    constexpr double same_s = 0.5e-6;
    const auto after = std::lower_bound(rows.begin(), rows.end(), time_s[i] - same_s,
                                        [](const auto& row, double t) { return row.first < t; });
    if (after != rows.end() && after->first <= time_s[i] + same_s) matched[i] = after->second;
  }
  return matched;
}

/// Throws for a row whose numbers are no unit quaternion; zeros are a row without attitude.
inline void require_unit(const Signal& signal) {
  constexpr double tolerance = 0.05;
  for (std::size_t row = 0; row < signal.topic->size(); ++row) {
    const auto& v = signal.values;
    const double square = v[0][row] * v[0][row] + v[1][row] * v[1][row] + v[2][row] * v[2][row] + v[3][row] * v[3][row];
    if (!std::isfinite(square) || square < 1e-12 || std::abs(std::sqrt(square) - 1) <= tolerance) continue;
    throw wrong_cell(*signal.topic, row, signal.source->columns[0].name,
                     "a unit quaternion in " + topic_words(signal.topic->name, signal.topic->instance),
                     "one of length " + pinnquad::number_text(std::sqrt(square)));
  }
}

/// Commands beyond 0..1 in more than a few rows are another unit than the mapping says.
inline void require_commands(const Signal& signal) {
  constexpr double spare = 0.02;
  std::size_t numbers = 0, beyond = 0, first = 0, motor = 0;
  for (std::size_t place = 0; place < pinnquad::rotor_count; ++place) {
    for (std::size_t row = 0; row < signal.values[place].size(); ++row) {
      const double u = signal.values[place][row];
      if (!std::isfinite(u)) continue;
      ++numbers;
      if (u >= -spare && u <= 1 + spare) continue;
      if (beyond++ == 0) {
        first = row;
        motor = place;
      }
    }
  }
  if (beyond * 100 <= numbers) return;
  const Source& source = *signal.source;
  const std::string column = source.columns[motor_at(source, motor)].name;
  throw wrong_cell(*signal.topic, first, column,
                   "motor commands from `least` to `most` of [motors] (" + pinnquad::number_text(source.least) +
                       " to " + pinnquad::number_text(source.most) + ")",
                   pinnquad::number_text(signal.topic->column(column)->values[first]));
}

/// A vehicle of another number of motors: a column of the four without a number, or one more of the same array with
/// numbers.
inline void require_four_motors(const Signal& signal, const Mapping& mapping) {
  const Source& source = *signal.source;
  for (const NamedColumn& one : source.columns) {
    if (has_number(signal.topic->column(one.name)->values)) continue;
    throw pinnquad::InputError(mapping.file, one.place.line, one.place.column, "four motors with commands",
                               "no number in column " + one.name + " of " + signal.topic->file);
  }
  const std::string& last = source.columns.back().name;
  if (last.size() < 3 || last.compare(last.size() - 3, 3, "[3]") != 0) return;
  const LogColumn* fifth = signal.topic->column(last.substr(0, last.size() - 3) + "[4]");
  if (fifth == nullptr || source.numbers != MotorNumbers::thrust || !has_number(fifth->values)) return;
  throw pinnquad::InputError(mapping.file, source.columns.back().place.line, source.columns.back().place.column,
                             "a vehicle of four motors",
                             "commands of a fifth in column " + fifth->name + " of " + signal.topic->file);
}

}  // namespace detail

/// The quantity as this source has it; not present() where the log lacks it. With `why`, the reason is thrown, one
/// line.
inline Signal bind_source(const FlightLog& log, const Mapping& mapping, const Source& source,
                          const std::optional<NamedAirframe>& airframe, bool why) {
  Signal signal;
  const LogTopic* topic = detail::topic_of(log, source.topic, source.instance);
  if (topic == nullptr) {
    if (!why) return signal;
    std::vector<std::string> known;
    for (const LogTopic& each : log.topics) known.push_back(each.name);
    throw pinnquad::InputError(
        mapping.file, source.place.line, source.place.column, "a topic of " + log.source,
        "`" + pinnquad::printable(source.topic) + "`, which it has not; " + nearest_names(source.topic, known));
  }
  std::vector<NamedColumn> wanted = source.columns;
  const bool apart = source.quantity == Quantity::torque_and_thrust && source.thrust_topic != source.topic;
  if (apart) wanted.pop_back();
  std::vector<const LogColumn*> columns = detail::columns_in(*topic, wanted, mapping.file, why);
  if (columns.empty()) return signal;
  if (!why && !source.time_column.empty() && !topic->column(source.time_column)) return signal;
  const bool empty = std::any_of(columns.begin(), columns.end(),
                                 [](const LogColumn* column) { return !detail::has_number(column->values); });
  if (empty && source.quantity != Quantity::motors) {
    if (!why) return signal;
    throw pinnquad::InputError(mapping.file, wanted[0].place.line, wanted[0].place.column,
                               "numbers in column " + wanted[0].name + " of " + topic->file, "none");
  }
  signal.source = &source;
  signal.topic = topic;
  signal.told = topic_words(source.topic, source.instance);
  for (const LogColumn* column : columns) signal.values.push_back(column->values);
  const std::vector<double> time_s = detail::times_of(*topic, source, mapping);
  if (apart) {
    const LogTopic* thrust = detail::topic_of(log, source.thrust_topic, source.instance);
    const std::vector<const LogColumn*> along =
        thrust ? detail::columns_in(*thrust, {source.columns.back()}, mapping.file, why)
               : std::vector<const LogColumn*>();
    if (along.empty()) return {};
    signal.values.push_back(
        detail::at_same_times(time_s, detail::times_of(*thrust, source, mapping), along[0]->values));
    signal.told += " and " + topic_words(source.thrust_topic, source.instance);
  }
  for (std::vector<double>& column : signal.values) {
    for (double& value : column) value *= source.in_si;
  }
  signal.clock = std::make_shared<const CleanClock>(clean_clock(time_s));
  if (source.quantity == Quantity::attitude && !source.euler) detail::require_unit(signal);
  to_our_frames(source, signal.values);
  if (source.quantity == Quantity::motors) {
    detail::require_four_motors(signal, mapping);
    double curve = source.thrust_curve;
    const auto logged = log.parameters.find(source.thrust_curve_parameter);
    if (logged != log.parameters.end()) curve = std::clamp(logged->second, 0.0, 1.0);
    if (source.numbers == MotorNumbers::speed && !airframe) {
      throw pinnquad::InputError(mapping.file, source.place.line, source.place.column,
                                 "--airframe, which says what rotor speeds command", "none");
    }
    to_commands(source, airframe, curve, signal.values);
    detail::require_commands(signal);
  }
  if (source.quantity == Quantity::torque_and_thrust) rebuild_commands(source, airframe, signal.values);
  return signal;
}

namespace detail {

/// Of the sources that a log has the first that is fast enough, or else the fastest.
inline Signal best_signal(const FlightLog& log, const Mapping& mapping, const std::vector<const Source*>& sources,
                          const std::optional<NamedAirframe>& airframe) {
  Signal best;
  for (const Source* source : sources) {
    Signal signal = bind_source(log, mapping, *source, airframe, false);
    if (!signal.present() || signal.clock->size() == 0) continue;
    const auto rate = [](const Signal& of) { return of.period_s() > 0 ? 1 / of.period_s() : 0.0; };
    if (best.present() && !(rate(signal) > rate(best) * 1.2)) continue;
    best = std::move(signal);
    if (rate(best) >= mapping.least_rate_hz) break;
  }
  return best;
}

}  // namespace detail

namespace detail {

/// How many sources of a mapping read a column of a topic.
inline std::size_t readers(const Mapping& mapping, const std::string& topic, const std::string& column) {
  std::size_t count = column == mapping.time_column.name ? 1 : 0;
  const auto add = [&](const Source& source) {
    if (source.topic != topic && source.thrust_topic != topic) return;
    for (const NamedColumn& one : source.columns) count += one.name == column ? 1 : 0;
    count += source.time_column == column ? 1 : 0;
  };
  for (const Source& source : mapping.sources) add(source);
  for (const ExtraSource& extra : mapping.extras) add(extra.source);
  return count;
}

/// Lets go of a log's columns that nobody reads but this source, which has copies: a long log is not held twice.
inline void let_go(FlightLog& log, const Mapping& mapping, const Source& source) {
  for (LogTopic& topic : log.topics) {
    const std::string name = log.topics.size() == 1 && source.topic.empty() ? "" : topic.name;
    if (name != source.topic) continue;
    for (LogColumn& column : topic.columns) {
      const bool its = std::any_of(source.columns.begin(), source.columns.end(),
                                   [&column](const NamedColumn& one) { return one.name == column.name; });
      if (its && readers(mapping, name, column.name) == 1) column.values = std::vector<double>();
    }
  }
}

/// Gives a signal the clock of an earlier one of the same topic and clock column.
inline void share_clock(Signal& signal, const BoundLog& bound) {
  for (const Signal& other : bound.signals) {
    if (!other.present() || &other == &signal) continue;
    const bool same = other.topic == signal.topic && other.source->time_column == signal.source->time_column;
    if (same && other.source->time_in_s == signal.source->time_in_s) signal.clock = other.clock;
  }
}

}  // namespace detail

/// Throws InputError, one line: a source that is not optional and not there, cells that are no numbers, quaternions
/// that are no unit, another number of motors. Columns of the log that one source alone reads are empty afterwards.
inline BoundLog bind_log(FlightLog& log, const Mapping& mapping, const std::optional<NamedAirframe>& airframe) {
  BoundLog bound;
  const auto sources_of = [&mapping](std::initializer_list<Quantity> any) {
    std::vector<const Source*> found;
    for (const Quantity quantity : any) {
      for (const Source& source : mapping.sources) {
        if (source.quantity == quantity) found.push_back(&source);
      }
    }
    return found;
  };
  const auto bind = [&](Signal& signal, const std::vector<const Source*>& sources, bool needed) {
    if (sources.empty()) return;
    signal = detail::best_signal(log, mapping, sources, airframe);
    if (signal.present()) {
      detail::share_clock(signal, bound);
      detail::let_go(log, mapping, *signal.source);
      return;
    }
    const bool optional =
        std::any_of(sources.begin(), sources.end(), [](const Source* source) { return source->optional; });
    if (optional && !needed) return;
    static_cast<void>(bind_source(log, mapping, *sources.front(), airframe, true));
    throw pinnquad::InputError(mapping.file, sources.front()->place.line, sources.front()->place.column,
                               "a topic with rows in " + log.source, "none");
  };
  for (const QuantityFacts& facts : quantities) {
    if (facts.quantity == Quantity::motors) {  // rebuilt ones where there are none, or too slow
      bind(bound.of(Quantity::motors), sources_of({Quantity::motors, Quantity::torque_and_thrust}), true);
    } else if (facts.quantity != Quantity::torque_and_thrust) {
      const bool needed = facts.quantity == Quantity::attitude || facts.quantity == Quantity::body_rates;
      bind(bound.of(facts.quantity), sources_of({facts.quantity}), needed);
    }
  }
  for (const ExtraSource& extra : mapping.extras) {
    const bool there = std::any_of(bound.extras.begin(), bound.extras.end(),
                                   [&](const BoundExtra& other) { return other.extra->name == extra.name; });
    if (there) continue;
    Signal signal;
    bind(signal, {&extra.source}, false);
    if (signal.present()) bound.extras.push_back({&extra, std::move(signal)});
  }
  return bound;
}

}  // namespace programs
