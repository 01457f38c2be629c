// SPDX-License-Identifier: MIT
#include "logs/bound_log.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "logs/attitude_numbers.hpp"
#include "logs/csv_head.hpp"
#include "logs/log_columns.hpp"
#include "logs/motor_count.hpp"
#include "logs/nearest_names.hpp"
#include "logs/rebuilt_commands.hpp"
#include "pinnquad/core/rotation.hpp"
#include "pinnquad/dynamics/rotor.hpp"
#include "pinnquad/io/decimal.hpp"

namespace pinnquad::logs {
namespace {

/// Row by row from the mapping's frames to NED and FRD.
void turn_attitude(const Source& source, std::vector<std::vector<double>>& values) {
  const AttitudeConvention convention = convention_of(source);
  const std::size_t rows = values[0].size();
  std::vector<std::vector<double>> turned(4, std::vector<double>(rows, std::nan("")));
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<double, 4> numbers{};
    if (source.euler) {
      const std::array<double, 3>& signs = source.euler_signs;
      const auto q = from_euler(
          EulerAngles<double>{signs[0] * values[0][row], signs[1] * values[1][row], signs[2] * values[2][row]});
      numbers = {q.w, q.x, q.y, q.z};
    } else {
      for (std::size_t i = 0; i < 4; ++i) numbers[i] = values[i][row];
    }
    const Quaternion<double> q = read_attitude(numbers, convention);
    turned[0][row] = q.w;
    turned[1][row] = q.x;
    turned[2][row] = q.y;
    turned[3][row] = q.z;
  }
  values = std::move(turned);
}

void turn_vector(bool flu, bool enu, std::vector<std::vector<double>>& values) {
  if (enu) std::swap(values[0], values[1]);
  if (flu) {
    for (double& v : values[1]) v = -v;
  }
  if (flu || enu) {
    for (double& v : values[2]) v = -v;
  }
}

/// The columns of a quantity in NED and FRD.
void to_our_frames(const Source& source, std::vector<std::vector<double>>& values) {
  const bool flu = source.body == BodyFrame::flu, enu = source.world == WorldFrame::enu;
  switch (source.quantity) {
    case Quantity::attitude: turn_attitude(source, values); break;
    case Quantity::body_rates:
    case Quantity::angular_acceleration:
    case Quantity::specific_force:
    case Quantity::torque_and_thrust: turn_vector(flu, false, values); break;
    case Quantity::acceleration:
    case Quantity::velocity:
      turn_vector(source.axes == Axes::body && flu, source.axes == Axes::world && enu, values);
      break;
    case Quantity::position: turn_vector(false, enu, values); break;
    case Quantity::altitude:
    case Quantity::motors:
    case Quantity::landed:
    case Quantity::extra: break;
  }
}

/// Index of the motor of a source's order that stands at the Sample's place.
std::size_t motor_at(const Source& source, std::size_t place) {
  for (std::size_t i = 0; i < rotor_count; ++i) {
    if (source.corners[i] == px4_motor_order.corners[place]) return i;
  }
  return place;
}

/// A motor's number: stopped or idle, and full.
struct MotorRange {
  double least = 0, most = 1;
};

double thrust_curve(const std::optional<NamedAirframe>& airframe, std::size_t rotor) {
  return airframe ? airframe->value.rotors[rotor].thrust_curve : 0.0;
}

/// Replaces the columns of `motors` by commands. A number below `least` is a stopped motor: 0; what is above `most` is
/// 1, and falls to the rule for saturated rows. `curve`: thrust = s ((1 - k) + k s) of a signal, where the log or the
/// mapping says so; the command is then the airframe's of that thrust, and without one the thrust's share.
void to_commands(const Source& source, const std::optional<NamedAirframe>& airframe, double curve,
                 const MotorRange& range, std::vector<std::vector<double>>& values) {
  std::vector<std::vector<double>> commands;
  for (std::size_t place = 0; place < rotor_count; ++place) {
    std::vector<double> u = values[motor_at(source, place)];
    for (double& value : u) {
      if (source.numbers == MotorNumbers::speed) {
        value = airframe ? command_from_speed(airframe->value, place, value) : std::nan("");
        continue;
      }
      const bool ranged = !detail::equal(range.least, 0.0) || !detail::equal(range.most, 1.0);
      value = (value - range.least) / (range.most - range.least);
      if (ranged && value < 0) value = 0;
      if (ranged && value > 1) value = 1;
      const bool straight = source.numbers == MotorNumbers::signal && !(curve > 0);
      if (straight) continue;
      const double share = source.numbers == MotorNumbers::thrust ? value : thrust_fraction(curve, value);
      value = command_of_fraction(thrust_curve(airframe, place), share);
    }
    commands.push_back(std::move(u));
  }
  values = std::move(commands);
}

/// A log that is one table has one topic, whatever it is called.
const LogTopic* topic_of(const FlightLog& log, const std::string& name, int instance) {
  if (name.empty()) return log.topics.empty() ? nullptr : &log.topics.front();
  return log.topic(name, instance);
}

bool has_number(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// Rows of `other` at the times of `time_s`: stamps of one sample, to half a microsecond. NaN where there is none.
std::vector<double> at_same_times(const std::vector<double>& time_s, const std::vector<double>& other_s,
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

/// Commands beyond 0..1 in more than a few rows are another unit than the mapping says.
void require_commands(const Signal& signal, const MotorRange& range) {
  constexpr double spare = 0.02;
  std::size_t numbers = 0, beyond = 0, first = 0, motor = 0;
  for (std::size_t place = 0; place < rotor_count; ++place) {
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
                   "motor commands from `least` to `most` of [motors] (" + number_text(range.least) + " to " +
                       number_text(range.most) + ")",
                   number_text(column_named(*signal.topic, column)->values[first]));
}

/// A row a message, other cells empty (PlotJuggler, joins of pandas): runs of a few filled rows between empty ones.
bool is_sparse(const std::vector<std::size_t>& filled, std::size_t rows) {
  constexpr double dense = 0.9;
  constexpr std::size_t usual_run = 4;
  if (filled.empty() || static_cast<double>(filled.size()) > dense * static_cast<double>(rows)) return false;
  std::size_t runs = 1;
  for (std::size_t i = 1; i < filled.size(); ++i) runs += filled[i] == filled[i - 1] + 1 ? 0 : 1;
  return filled.size() < usual_run * runs;
}

/// The clock of an earlier signal of the same topic and clock column; null where there is none.
std::shared_ptr<const CleanClock> shared_clock(const Signal& signal, const BoundLog& bound) {
  for (const Signal& other : bound.signals) {
    if (!other.present() || other.sparse) continue;
    const bool same = other.topic == signal.topic && other.source->time_column == signal.source->time_column;
    if (same && other.source->time_in_s == signal.source->time_in_s) return other.clock;
  }
  return nullptr;
}

/// The clock of the rows that the signal fills: of a sparse table its own.
template <class Times>
void set_clock(Signal& signal, const Times& times, const BoundLog& bound) {
  std::vector<std::size_t> filled;
  const std::size_t rows = signal.values[0].size();
  for (std::size_t row = 0; row < rows && signal.topic->places_are_lines; ++row) {
    const bool any = std::any_of(signal.values.begin(), signal.values.end(),
                                 [row](const std::vector<double>& column) { return std::isfinite(column[row]); });
    if (any) filled.push_back(row);
  }
  signal.sparse = is_sparse(filled, rows);
  if (!signal.sparse) {
    signal.clock = shared_clock(signal, bound);
    if (!signal.clock) signal.clock = std::make_shared<const CleanClock>(clean_clock(times()));
    return;
  }
  const std::vector<double> time_s = times();
  std::vector<double> own_s;
  for (const std::size_t row : filled) own_s.push_back(time_s[row]);
  CleanClock clock = clean_clock(own_s);
  for (std::size_t& row : clock.row) row = filled[row];
  signal.clock = std::make_shared<const CleanClock>(std::move(clock));
}

/// The quantity as this source has it; not present() where the log lacks it. With `why`, the reason is thrown, one
/// line.
Signal bind_source(const FlightLog& log, const Mapping& mapping, const Source& source,
                   const std::optional<NamedAirframe>& airframe, const BoundLog& bound, bool why) {
  Signal signal;
  const LogTopic* topic = topic_of(log, source.topic, source.instance);
  if (topic == nullptr) {
    if (!why) return signal;
    std::vector<std::string> known;
    for (const LogTopic& each : log.topics) known.push_back(each.name);
    throw InputError(mapping.file, source.place.line, source.place.column, "a topic of " + log.source,
                     "`" + printable(source.topic) + "`, which it has not; " + nearest_names(source.topic, known));
  }
  std::vector<NamedColumn> wanted = source.columns;
  const bool apart = source.quantity == Quantity::torque_and_thrust && source.thrust_topic != source.topic;
  if (apart) wanted.pop_back();
  std::vector<const LogColumn*> columns = columns_in(*topic, wanted, mapping.file, why);
  if (columns.empty()) return signal;
  if (!why && !source.time_column.empty() && !column_named(*topic, source.time_column)) return signal;
  const bool empty =
      std::any_of(columns.begin(), columns.end(), [](const LogColumn* column) { return !has_number(column->values); });
  if (empty && source.quantity != Quantity::motors) {
    if (!why) return signal;
    throw InputError(mapping.file, wanted[0].place.line, wanted[0].place.column,
                     "numbers in column " + wanted[0].name + " of " + topic->file, "none");
  }
  signal.source = &source;
  signal.topic = topic;
  signal.told = topic_words(source.topic, source.instance);
  signal.values = scaled_values(log, mapping, source, columns, why);
  if (signal.values.empty()) return {};
  const auto times = [&] { return times_of(*topic, source, mapping); };
  if (apart) {
    const LogTopic* thrust = topic_of(log, source.thrust_topic, source.instance);
    const std::vector<const LogColumn*> along =
        thrust ? columns_in(*thrust, {source.columns.back()}, mapping.file, why) : std::vector<const LogColumn*>();
    if (along.empty()) return {};
    const std::vector<double> scaled = scaled_values(log, mapping, source, along, why).front();
    signal.values.push_back(at_same_times(times(), times_of(*thrust, source, mapping), scaled));
    signal.told += " and " + topic_words(source.thrust_topic, source.instance);
  }
  if (source.wrench) {
    for (double& value : signal.values[3]) value *= source.thrust_in_si / source.in_si;
  }
  set_clock(signal, times, bound);
  if (source.quantity == Quantity::attitude && !source.euler) {
    const bool said = !source.scale.parameter.empty() || std::abs(source.scale.value - 1) > 0;
    if (!said && counts_to_32767(signal.values)) {
      for (std::vector<double>& column : signal.values) {
        for (double& value : column) value /= 32767;
      }
      signal.note = "attitude: a quaternion of whole numbers, taken as 32767 for 1 (scale = \"1/32767\")";
    }
    if (source.without_scalar) make_scalar(signal.values);
    require_unit(signal);
  }
  if (source.quantity == Quantity::attitude && source.euler) require_radians(signal);
  to_our_frames(source, signal.values);
  if (source.quantity == Quantity::motors) {
    const std::optional<double> least = number_in(log, source.least), most = number_in(log, source.most);
    if (!least || !most || !(*most > *least)) {
      if (!why) return {};
      throw InputError(
          mapping.file, source.place.line, source.place.column,
          "the parameters " + source.least.parameter + " and " + source.most.parameter + " in " + log.source,
          "none, or not one above the other");
    }
    const MotorRange range{*least, *most};
    require_four_motors(log, *topic, source, range.least, range.most, mapping.file);
    std::optional<double> curve = source.thrust_curve;
    const double logged = log.parameter(source.thrust_curve_parameter, std::nan(""));
    if (!std::isnan(logged)) curve = std::clamp(logged, 0.0, 1.0);
    if (source.numbers == MotorNumbers::speed && !airframe) {
      throw InputError(mapping.file, source.place.line, source.place.column,
                       "--airframe, which says what rotor speeds command", "none");
    }
    if (source.numbers == MotorNumbers::speed) curve = 0;
    signal.thrust_curve = curve;
    to_commands(source, airframe, curve.value_or(0), range, signal.values);
    require_commands(signal, range);
  }
  if (source.quantity == Quantity::torque_and_thrust) {
    if (!source.wrench && are_no_shares(signal.values)) {
      if (!why) return {};
      throw InputError(
          mapping.file, source.place.line, source.place.column,
          "torques and a thrust as shares of 1 (in N m? Then [torque_and_thrust] needs torque_unit = \"N m\" and "
          "thrust_unit = \"N\", and the import the airframe)",
          "torques of up to " + number_text(largest_torque(signal.values)) + " beside a thrust of up to " +
              number_text(largest(signal.values[3])));
    }
    if (source.wrench && !airframe) {
      throw InputError(mapping.file, source.place.line, source.place.column,
                       "--airframe, which says what a torque and a thrust command", "none");
    }
    rebuild_commands(source, airframe, signal.values);
  }
  return signal;
}

/// Of the sources that a log has the first that is fast enough, or else the fastest.
Signal best_signal(const FlightLog& log, const Mapping& mapping, const std::vector<const Source*>& sources,
                   const std::optional<NamedAirframe>& airframe, const BoundLog& bound) {
  Signal best;
  for (const Source* source : sources) {
    Signal signal = bind_source(log, mapping, *source, airframe, bound, false);
    if (!signal.present() || signal.clock->size() == 0) continue;
    const auto rate = [](const Signal& of) { return of.period_s() > 0 ? 1 / of.period_s() : 0.0; };
    if (best.present() && !(rate(signal) > rate(best) * 1.2)) continue;
    best = std::move(signal);
    if (rate(best) >= mapping.least_rate_hz) break;
  }
  return best;
}

/// How many sources of a mapping read a column of a topic.
std::size_t readers(const Mapping& mapping, const std::string& topic, const std::string& column) {
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
void let_go(FlightLog& log, const Mapping& mapping, const Source& source) {
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

}  // namespace

std::string topic_words(const std::string& topic, int instance) {
  return (topic.empty() ? "the table" : topic) + (instance > 0 ? " " + std::to_string(instance) : "");
}

InputError wrong_cell(const LogTopic& topic, std::size_t row, const std::string& column, const std::string& expected,
                      const std::string& found) {
  std::size_t line = 0, field = 0;
  std::string file = topic.file;
  if (topic.places_are_lines && row < topic.place.size()) {
    line = static_cast<std::size_t>(topic.place[row]);
    const std::vector<std::string> header = csv_head(file).names;
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (header[i] == column || header[i].rfind(column + " (", 0) == 0) field = i + 1;
    }
  } else if (row < topic.place.size()) {
    file += ", byte " + std::to_string(topic.place[row]);
  }
  return InputError(file, line, field, expected, found);
}

AttitudeConvention convention_of(const Source& source) {
  return {!source.euler && source.scalar_last, source.world_to_body, source.world == WorldFrame::enu,
          source.body == BodyFrame::flu};
}

LogSelection mapped_selection(const Mapping& mapping) {
  LogSelection selection;
  const auto add = [&](const std::string& topic, const Source& source) {
    if (topic.empty()) return;
    if (selection.columns.count(topic) == 0) selection.topics.push_back(topic);
    std::vector<std::string> names = {source.time_column, mapping.time_column.name};
    for (const NamedColumn& column : source.columns) names.push_back(column.name);
    if (source.quantity == Quantity::motors) {
      for (std::string& name : further_motor_names(source)) names.push_back(std::move(name));
    }
    for (const std::string& name : names) {
      selection.columns[topic].insert({name, name.substr(0, name.rfind(" ("))});  // with a unit behind it or without
    }
  };
  const auto add_source = [&add](const Source& source) {
    add(source.topic, source);
    add(source.thrust_topic, source);
  };
  for (const Source& source : mapping.sources) add_source(source);
  for (const ExtraSource& extra : mapping.extras) add_source(extra.source);
  for (const NamedColumn& label : {mapping.flight_column, mapping.trajectory_column}) {
    if (!label.name.empty()) selection.label_columns.push_back(label.name);
  }
  return selection;
}

std::vector<double> times_of(const LogTopic& topic, const Source& source, const Mapping& mapping) {
  constexpr double most_late_s = 1;  // from a sample to its message
  const bool own = !source.time_column.empty();
  const bool topic_has = has_number(topic.time_s);
  std::vector<double> time_s;
  if (!own && topic_has) {
    time_s = topic.time_s;
  } else if (!own && mapping.time_column.name.empty()) {
    throw InputError(mapping.file, source.place.line, source.place.column,
                     "a table [time] that names the clock of " + topic.file, "none");
  } else {
    NamedColumn clock = own ? NamedColumn{source.time_column, source.place} : mapping.time_column;
    const std::size_t unit = clock.name.rfind(" (");  // "time (us)" of Explorer's table is "time"
    if (column_named(topic, clock.name) == nullptr && unit != std::string::npos &&
        topic.column(clock.name.substr(0, unit)) != nullptr) {
      clock.name.erase(unit);
    }
    const LogColumn& column = *columns_in(topic, {clock}, mapping.file, true).front();
    const double in_s = own ? source.time_in_s : mapping.time_in_s;
    const double ticks_per_s = std::round(1 / own_unit(column, clock.name, Dimension::time, true).value_or(in_s));
    time_s = column.values;
    for (std::size_t row = 0; row < time_s.size(); ++row) {
      time_s[row] /= ticks_per_s;
      // a sample's time that is 0, or wild, is that of its message
      const bool right = time_s[row] > 0 && std::abs(time_s[row] - topic.time_s[row]) <= most_late_s;
      if (topic_has && !right) time_s[row] = topic.time_s[row];
    }
  }
  if (std::abs(mapping.time_scale - 1) > 0) {
    for (double& t : time_s) t *= mapping.time_scale;
  }
  return time_s;
}

BoundLog bind_log(FlightLog& log, const Mapping& mapping, const std::optional<NamedAirframe>& airframe) {
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
    signal = best_signal(log, mapping, sources, airframe, bound);
    if (signal.present()) {
      let_go(log, mapping, *signal.source);
      return;
    }
    const bool optional =
        std::any_of(sources.begin(), sources.end(), [](const Source* source) { return source->optional; });
    if (optional && !needed) return;
    static_cast<void>(bind_source(log, mapping, *sources.front(), airframe, bound, true));
    throw InputError(mapping.file, sources.front()->place.line, sources.front()->place.column,
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

}  // namespace pinnquad::logs
