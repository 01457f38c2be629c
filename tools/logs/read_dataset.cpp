// SPDX-License-Identifier: MIT
#include "pinnquad/logs/read_dataset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "logs/attitude_convention.hpp"
#include "logs/bound_log.hpp"
#include "logs/clock.hpp"
#include "logs/command_curve.hpp"
#include "logs/command_lag.hpp"
#include "logs/common_rows.hpp"
#include "logs/derived_motion.hpp"
#include "logs/log_checks.hpp"
#include "logs/log_parts.hpp"
#include "logs/mapping.hpp"
#include "logs/mapping_texts.hpp"
#include "logs/offered_mapping.hpp"
#include "logs/row_checks.hpp"
#include "logs/sensor_check.hpp"
#include "logs/standing_columns.hpp"
#include "logs/tilt_check.hpp"
#include "logs/tumbling.hpp"
#include "logs/vehicle_check.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {
namespace {

/// The mapping of that name or file. Throws InputError (the file) and std::invalid_argument (no such name), one line.
Mapping chosen_mapping(const std::string& name_or_file) {
  if (std::filesystem::path(name_or_file).extension() == ".toml") return read_mapping_file(name_or_file);
  for (const MappingText& ready : mapping_texts) {
    if (name_or_file != ready.name) continue;
    Mapping mapping = parse_mapping(ready.toml, name_or_file + ".toml");
    mapping.name = ready.name;
    return mapping;
  }
  throw std::invalid_argument("no mapping named '" + printable(name_or_file) + "'; known: " + mapping_names() +
                              ", or a file whose name ends in .toml");
}

/// Throws InputError where the content asks for none.
OfferedMapping required_offer(const std::string& path) {
  if (const auto offered = offered_mapping(path)) return *offered;
  const bool is_folder = std::filesystem::is_directory(path);
  throw InputError(
      path, 0, 0, "a flight, a dataset, or a --mapping of the log's columns (" + mapping_names() + ", or a .toml file)",
      is_folder
          ? "a folder without logs"
          : "columns that none of these names; write mine.toml (docs/import.md, A table of your own), then: pinnquad "
            "import " +
                printable(path) + " --mapping mine.toml --out dataset");
}

/// Fewest rows of a flight: a batch of training.
constexpr std::size_t fewest_flight_rows = 64;

/// Rows that the steps cost, summed over logs.
class Steps {
 public:
  explicit Steps(std::vector<ImportStep>& steps) : steps_(steps) {}

  void add(const std::string& name, std::size_t before, std::size_t after, const std::string& told) {
    for (ImportStep& step : steps_) {
      if (step.name != name) continue;
      step.rows_before += before;
      step.rows_after += after;
      return;
    }
    steps_.push_back({name, before, after, told});
  }

 private:
  std::vector<ImportStep>& steps_;
};

/// A flight on its way: segments of rows without a gap.
struct Passage {
  std::string name, trajectory, source;
  std::size_t mapping = 0;  ///< which of the import's
  bool force_of_velocity = false;
  std::vector<Flight> segments;

  std::size_t rows() const {
    std::size_t sum = 0;
    for (const Flight& segment : segments) sum += segment.size();
    return sum;
  }
};

std::size_t rows_in(const std::vector<Passage>& passages) {
  std::size_t sum = 0;
  for (const Passage& passage : passages) sum += passage.rows();
  return sum;
}

class Import {
 public:
  Import(const std::vector<std::string>& logs, const LogSettings& settings)
      : logs_(logs), settings_(settings), steps_(dataset_.steps) {
    choose_mappings();
    if (settings.rate_hz) period_s_ = 1 / *settings.rate_hz;
    if (settings.airframe.empty()) require_one_airframe();
    const std::string& name = settings.airframe.empty() ? mapping_.airframe : settings.airframe;
    if (!name.empty()) airframe_ = chosen_airframe(name);
    for (const Mapping& mapping : mappings_) dataset_.mapping += (dataset_.mapping.empty() ? "" : ", ") + mapping.name;
    dataset_.airframe = airframe_ ? airframe_->name : "";
  }

  ImportedDataset run() {
    std::vector<LogPlace> places;
    std::vector<std::size_t> mappings;  // of the places
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      use(mapping_of_log_[i]);
      for (LogPlace& place : logs_at(logs_[i], mapped_selection(mapping_), !mapping_.time_column.name.empty())) {
        if (stands_beside_log(place.path)) {
          add(dataset_.notes, place.path + ": written beside a blackbox log by blackbox_decode: skipped");
        } else {
          places.push_back(std::move(place));
          mappings.push_back(mapping_of_log_[i]);
        }
      }
    }
    tell_apart(places);
    if (places.empty()) refuse_without_log();
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double done = static_cast<double>(i), all = static_cast<double>(places.size());
      use(mappings[i]);
      LogSelection selected = mapped_selection(mapping_);
      selected.prefix = places[i].prefix;
      selected.flight = places[i].flight;
      selected.on_progress = [&](double share) { report("reading " + places[i].name, (done + share) / all); };
      FlightLog log = read_log(places[i].path, selected);
      dataset_.warnings.insert(dataset_.warnings.end(), log.warnings.begin(), log.warnings.end());
      const bool is_one_of_several =
          log.topics.empty() && places.size() > 1;  // a flight of a blackbox that has no frame
      if (is_one_of_several) {
        warn(places[i].name + ": no row in it: left out");
        continue;
      }
      for (LogPart& part : parts_of(std::move(log), places[i].name, mapping_)) {
        take(part, places[i]);
        part.log = {};
      }
    }
    settle_absent();
    remove_lag();
    drop_rows();
    make_flights();
    if (settings_.on_flights) settings_.on_flights(dataset_);
    Airframe<double> airframe = airframe_ ? airframe_->value : airframe_value<PaperQuadrotor, double>();
    if (!airframe_) {
      report("fitting the thrust curve", 0);
      dataset_.curve = command_curve(dataset_.flights, stated_curve_);
      set_thrust_curve(airframe, dataset_.curve.k);
    }
    check_vehicle(dataset_, airframe, !settings_.airframe.empty(), settings_.on_progress);
    return std::move(dataset_);
  }

 private:
  [[noreturn]] void refuse_without_log() const {
    throw InputError(logs_.front(), 0, 0, "a flight log, such as LOG00001.01.csv",
                     "what blackbox_decode writes beside one");
  }

  void report(const std::string& job, double share) const {
    if (settings_.on_progress) settings_.on_progress(job, share);
  }
  /// The one that the settings name, or of each log the one that its content asks for.
  void choose_mappings() {
    mapping_of_log_.assign(logs_.size(), 0);
    if (!settings_.mapping.empty()) mappings_.push_back(chosen_mapping(settings_.mapping));
    for (std::size_t i = 0; i < logs_.size() && settings_.mapping.empty(); ++i) {
      if (stands_beside_log(logs_[i])) continue;  // run() says that it is skipped
      const OfferedMapping offered = required_offer(logs_[i]);
      const auto known = std::find_if(mappings_.begin(), mappings_.end(),
                                      [&offered](const Mapping& mapping) { return mapping.name == offered.name; });
      mapping_of_log_[i] = static_cast<std::size_t>(known - mappings_.begin());
      if (known == mappings_.end()) mappings_.push_back(chosen_mapping(offered.name));
      add(dataset_.taken, "mapping " + offered.name + " taken: " + offered.why);
    }
    if (mappings_.empty()) refuse_without_log();
    if (settings_.thrust_curve) state_curve(*settings_.thrust_curve);
    use(0);
  }

  /// Not the first log's for all.
  void require_one_airframe() const {
    for (const Mapping& mapping : mappings_) {
      if (mapping.airframe == mappings_.front().airframe) continue;
      const auto words = [](const Mapping& of) {
        return "the mapping " + of.name + " is of " + (of.airframe.empty() ? "no one airframe" : of.airframe);
      };
      throw std::invalid_argument("logs of several vehicles: " + words(mappings_.front()) + ", " + words(mapping) +
                                  ": --airframe gives one for all, or each is imported alone");
    }
  }

  /// As if each mapping said so.
  void state_curve(double k) {
    bool taken = false;
    for (Mapping& mapping : mappings_) {
      for (Source& source : mapping.sources) {
        if (source.quantity != Quantity::motors || source.numbers == MotorNumbers::speed) continue;
        source.thrust_curve = k;
        source.thrust_curve_parameter.clear();
        taken = true;
      }
    }
    if (!taken) throw std::invalid_argument("--thrust-curve goes with motor values: the mapping's are rotor speeds");
  }

  void use(std::size_t mapping) {
    current_ = mapping;
    mapping_ = mappings_[mapping];
  }

  /// Each sentence once.
  static void add(std::vector<std::string>& sentences, const std::string& one) {
    if (std::find(sentences.begin(), sentences.end(), one) == sentences.end()) sentences.push_back(one);
  }
  void warn(const std::string& what) { add(dataset_.warnings, what); }
  void warn(const std::string& of, const std::optional<std::string>& finding) {
    if (finding) warn(of + ": " + *finding);
  }

  /// Optional topics whose clock begins again, or is that of another time, are none afterwards.
  void count_topics(BoundLog& bound, const std::string& name) {
    std::vector<const LogTopic*> counted, restarted;
    const auto count = [&](Signal& signal) {
      if (!signal.present()) return;
      if (!signal.note.empty()) add(dataset_.notes, signal.note);
      const bool known = std::find(counted.begin(), counted.end(), signal.topic) != counted.end();
      if (known && !signal.sparse) return;
      if (!signal.sparse) counted.push_back(signal.topic);
      const ClockReport& report = signal.clock->report;
      std::string of = topic_words(signal.topic->name, signal.topic->instance);
      if (signal.sparse) of += ", rows with " + signal.source->columns.front().name;
      steps_.add("read: " + of, report.rows_read, report.rows_kept,
                 "one time a row: no time, a wild one, a second row of one time and stale first rows are left out");
      const std::string topic = name + ", " + of;
      if (report.wild > 0) {
        warn(topic + ": " + std::to_string(report.wild) + (report.wild > 1 ? " rows have stamps" : " row has a stamp") +
             " that the rows around it do not have, first " + short_number(report.first_wild_s) + " s: left out");
      }
      if (report.out_of_order > 0) {
        warn(topic + ": " + std::to_string(report.out_of_order) + " rows were not in time's order and were sorted");
      }
      if (report.same_time > 0) {
        warn(topic + ": " + std::to_string(report.same_time) +
             " rows had the time of another; the last of the file stays");
      }
      for (const std::string& finding : check_clock(topic, report)) warn(finding);
      if (report.restarts > 0) restarted.push_back(signal.topic);
    };
    for (Signal& signal : bound.signals) count(signal);
    for (BoundExtra& extra : bound.extras) count(extra.signal);
    const CleanClock flown = *bound.of(Quantity::body_rates).clock;
    const auto is_left_out = [&](Signal& signal) {
      if (!signal.present()) return false;
      const bool restarts = std::find(restarted.begin(), restarted.end(), signal.topic) != restarted.end();
      if (restarts && !signal.source->optional) refuse_restart(signal);
      const bool apart = signal.source->optional && !meet(*signal.clock, flown);
      if (!restarts && !apart) return false;
      warn(name + ", " + topic_words(signal.topic->name, signal.topic->instance) + ": left out, for its time " +
           (restarts ? "begins again" : "is none of the flight's"));
      signal = {};
      return true;
    };
    for (Signal& signal : bound.signals) is_left_out(signal);
    bound.extras.erase(std::remove_if(bound.extras.begin(), bound.extras.end(),
                                      [&](BoundExtra& extra) { return is_left_out(extra.signal); }),
                       bound.extras.end());
  }

  /// True where one has a row within the time of the other.
  static bool meet(const CleanClock& a, const CleanClock& b) {
    if (a.size() == 0 || b.size() == 0) return false;
    return a.time_s.front() <= b.time_s.back() && b.time_s.front() <= a.time_s.back();
  }

  /// Two recordings in one table would be mixed by sorting.
  void refuse_restart(const Signal& signal) const {
    const LogTopic& topic = *signal.topic;
    const std::vector<double> time_s = times_of(topic, *signal.source, mapping_);
    for (std::size_t row = 1; row < time_s.size(); ++row) {
      const double step_s = time_s[row] - time_s[row - 1];
      if (!(step_s < -restart_step_s)) continue;
      throw wrong_cell(topic, row, mapping_.time_column.name,
                       "time that goes on (a mapping's [flights] column parts a table of several flights)",
                       "a step back of " + number_text(std::round(-step_s * 1000) / 1000) + " s");
    }
  }

  /// The part's columns are gone afterwards.
  void take(LogPart& part, const LogPlace& place) {
    require_accelerometer(part.log);
    BoundLog bound = bind_log(part.log, mapping_, airframe_);
    count_topics(bound, part.name);
    take_curve(bound);
    const std::size_t base = bound.of(Quantity::body_rates).clock->size();
    const double own_period_s = own_rows_period_s(bound);
    CommonRows rows = common_rows(bound, period_s_, settings_.hold_commands);
    if (!period_s_) period_s_ = rows.period_s;
    tell_other_rate(own_period_s, part.name);
    check_signals(bound, rows, part);
    const std::size_t all = rows.rows();
    steps_.add("one clock", base, all,
               rows.own_rows ? "the table's own rows, every " + number_text(rows.period_s) + " s"
                             : "all topics at " + number_text(std::round(1e3 / rows.period_s) / 1e3) + " Hz");
    let_go(part.log, bound);
    const double begin_s = all > 0 ? rows.time_s.front() : 0;
    const std::size_t left_out = leave_out_rows(rows, part.name);
    LogRows log_rows = rows_of_log(std::move(rows), bound, mapping_, part.log.source);
    for (const std::string& told : log_rows.told) add(dataset_.notes, told);
    const std::size_t whole = all - log_rows.incomplete;
    steps_.add("incomplete rows", all - left_out, whole,
               "a cell without a number, a gap in a topic, rebuilt commands beyond 0..1");
    steps_.add("ends of derivatives", whole, log_rows.flight.size(),
               "Savitzky-Golay windows that reach beyond the rows");
    const RowMask out = on_the_ground(log_rows, mapping_, *period_s_);
    const std::size_t before = log_rows.flight.size();
    Passage passage;
    passage.name = part.name;
    passage.trajectory = part.trajectory;
    passage.source = place.path;
    passage.mapping = current_;
    passage.force_of_velocity = log_rows.force_of_velocity;
    Flight airborne = without(std::move(log_rows.flight), out);
    steps_.add("on the ground", before, airborne.size(),
               "landed by the log, lower than the mapping's [ground] says, borne by something");
    airborne =
        without_standing(std::move(airborne), {log_rows.has_velocity, log_rows.has_altitude}, part.name, begin_s);
    passage.segments = split_at_gaps(std::move(airborne), 1.5 * *period_s_);
    has_velocity_.push_back(log_rows.has_velocity);
    has_altitude_.push_back(log_rows.has_altitude);
    passages_.push_back(std::move(passage));
  }

  /// Attitude and force of a blackbox log are the accelerometer's.
  void require_accelerometer(const FlightLog& log) const {
    if (log.parameter("acc_1G", 1) > 0 || (mapping_.name != "betaflight" && mapping_.name != "inav")) return;
    throw InputError(log.source, 0, 0, "a craft with an accelerometer, which attitude and force are made of",
                     "one that flew without (acc_1G 0 in the log's head)");
  }

  /// The first log's rate is that of all, unless one was asked for.
  void tell_other_rate(double own_period_s, const std::string& name) {
    constexpr double alike = 0.1;
    if (first_period_s_ <= 0) first_period_s_ = own_period_s;
    const double ratio = own_period_s / first_period_s_;
    if (settings_.rate_hz || (ratio < 1 + alike && ratio > 1 - alike)) return;
    warn(name + ": logged at " + short_number(1 / own_period_s) + " Hz, the first log at " +
         short_number(1 / first_period_s_) + " Hz: all have rows at " + short_number(1 / *period_s_) +
         " Hz; --rate says another");
  }

  /// Logs of one vehicle have one curve: commands are what its motors are given.
  void take_curve(const BoundLog& bound) {
    const Signal& motors = bound.of(Quantity::motors);
    const std::optional<double> curve = motors.present() ? motors.thrust_curve : std::nullopt;
    const bool first = passages_.empty();
    const bool same = curve.has_value() == stated_curve_.has_value() &&
                      std::abs(curve.value_or(0) - stated_curve_.value_or(0)) < 1e-9;
    if (first) stated_curve_ = curve;
    if (first || same || airframe_) return;
    throw std::invalid_argument("logs with several thrust curves: --airframe says which commands they become");
  }

  /// Leaves out the rows that are not asked for, and crashes. How many.
  std::size_t leave_out_rows(CommonRows& rows, const std::string& name) {
    std::size_t left = rows.rows();
    RowMask outside(left, false);
    for (std::size_t row = 0; row < outside.size(); ++row) {
      const double at_s = rows.time_s[row] - rows.time_s.front();
      outside[row] = at_s < settings_.from_s || at_s > settings_.to_s.value_or(at_s);
    }
    const auto leave = [&](const std::string& step, const RowMask& out, const std::string& told) {
      const std::size_t before = left;
      left -= static_cast<std::size_t>(std::count(out.begin(), out.end(), true));
      steps_.add(step, before, left, told);
      leave_out(rows, out);
    };
    if (settings_.from_s > 0 || settings_.to_s)
      leave("another part of the log", outside, "before --from or after --to");
    const Tumbling tumbling = find_tumbling(rows);
    for (const std::string& told : tumbling.told) warn(name + ": " + told + " left out");
    leave("tumbling", tumbling.out, "a gyro at the end of its range, a force that no rotor makes");
    return rows.rows() - left;
  }

  Flight without_standing(Flight flight, const HasQuantities& has, const std::string& name, double begin_s) {
    const StandingRows standing = standing_rows(flight, has, *period_s_, begin_s);
    for (const std::string& told : standing.told) warn(name + ": " + told);
    const std::size_t before = flight.size();
    flight = without(std::move(flight), standing.out);
    steps_.add("standing still", before, flight.size(),
               "a column that repeats its value while what goes with it moves");
    return flight;
  }

  /// The contents of the common rows: of a long log nothing is held twice.
  static void let_go(FlightLog& log, BoundLog& bound) {
    for (LogTopic& topic : log.topics) {
      topic.time_s = std::vector<double>();
      topic.place = std::vector<std::uint64_t>();
      for (LogColumn& column : topic.columns) column.values = std::vector<double>();
      for (LogText& text : topic.texts) text.values = std::vector<std::string>();
    }
    const auto forget = [](Signal& signal) {
      signal.values = std::vector<std::vector<double>>();
      signal.clock.reset();
    };
    for (Signal& signal : bound.signals) forget(signal);
    for (BoundExtra& extra : bound.extras) forget(extra.signal);
  }

  /// Calls `use` with the segments of all flights in one list.
  template <class Use>
  void with_all_segments(const Use& use) {
    std::vector<Flight> segments;
    for (Passage& passage : passages_) {
      std::move(passage.segments.begin(), passage.segments.end(), std::back_inserter(segments));
    }
    use(std::as_const(segments));
    auto segment = segments.begin();
    for (Passage& passage : passages_) {
      for (Flight& own : passage.segments) own = std::move(*segment++);
    }
  }

  /// True where PX4's logger is told to log faster already: bits 3 and 4.
  static bool has_profile(const FlightLog& log) {
    return (static_cast<std::int64_t>(log.parameter("SDLOG_PROFILE", 0)) & 24) == 24;
  }

  void check_signals(const BoundLog& bound, const CommonRows& rows, const LogPart& part) {
    const std::string& name = part.name;
    const bool px4 = mapping_.name == "px4" && !has_profile(part.log);
    for (const Quantity quantity : {Quantity::motors, Quantity::body_rates}) {
      const Signal& signal = bound.of(quantity);
      if (const auto slow = check_log_rate(signal.told, signal.period_s(), px4)) warn(name, slow);
    }
    if (!rows.specific_force[0].empty()) {
      const auto& q = rows.attitude;
      const auto& w = rows.body_rates;
      const auto& f = rows.specific_force;
      const Signal& force = bound.of(Quantity::specific_force);
      warn(name, check_thrust_direction(f[2], force.present() && force.source->body == BodyFrame::flu));
      const auto misread = check_attitude(rows.period_s, convention_of(*bound.of(Quantity::attitude).source),
                                          {&q[0], &q[1], &q[2], &q[3]}, {&w[0], &w[1], &w[2]}, {&f[0], &f[1], &f[2]});
      warn(name, misread);
      if (misread) misread_[name] = *misread;
    }
  }

  void settle_absent() {
    const auto lacks = [](const std::vector<bool>& has) {
      return std::find(has.begin(), has.end(), false) != has.end();
    };
    if (lacks(has_velocity_)) dataset_.absent.push_back("velocity");
    if (lacks(has_altitude_)) dataset_.absent.push_back("altitude");
    for (Passage& passage : passages_) {
      for (Flight& segment : passage.segments) {
        for (Sample& sample : segment) {
          if (dataset_.lacks("altitude")) sample.altitude_m = 0;
          if (!dataset_.lacks("velocity")) continue;
          sample.linear_acceleration_m_s2 += cross<double>(sample.body_rates_rad_s, sample.velocity_m_s);
          sample.velocity_m_s.setZero();
        }
      }
    }
  }

  /// The lag to remove where the flights do not tell it, and why.
  std::pair<double, std::string> usual_lag() const {
    constexpr double usual_s = 0.03;
    const bool speeds = std::any_of(mapping_.sources.begin(), mapping_.sources.end(), [](const Source& source) {
      return source.quantity == Quantity::motors && source.numbers == MotorNumbers::speed;
    });
    if (speeds) return {0, "of rotor speeds none"};
    if (airframe_) return {airframe_->value.rotor_time_constant_s, "the rotor lag of " + airframe_->name};
    return {usual_s, "as usual for quadrotors"};
  }

  void remove_lag() {
    std::optional<double> lag_s = settings_.lag_s ? settings_.lag_s : mapping_.lag_s;
    std::string told = lag_s ? "as given" : "";
    const std::size_t before = rows_in(passages_);
    if (!lag_s) {
      report("estimating the lag", 0);
      CommandLag lag;
      with_all_segments([&](const std::vector<Flight>& segments) { lag = estimate_command_lag(segments, *period_s_); });
      if (lag.known()) {
        if (!lag.warning.empty()) warn("lag: " + lag.warning);
        lag_s = lag.lag_s;
        told = "estimated, confidence " + number_text(std::round(lag.confidence * 100) / 100);
      } else {
        if (lag.likely() && lag.lag_s > 0) {  // motion before its commands is less likely than any guess
          lag_s = lag.lag_s;
          told = "as it looks";
        } else {
          std::tie(lag_s, told) = usual_lag();
        }
        warn("lag not known: " + lag.warning + "; " + number_text(std::round(*lag_s * 1e3)) + " ms are removed, " +
             told +
             ": give --lag SECONDS, or log quick small rolls and pitches in still air, rows less than 50 ms apart");
      }
    }
    dataset_.lag_removed_s = std::round(*lag_s * 1e6) / 1e6;
    if (dataset_.lag_removed_s < -CommandLag::known_s) {  // less may be chance
      dataset_.warnings.push_back(
          "lag: the commands stand " + number_text(std::round(-dataset_.lag_removed_s * 1e4) / 10) +
          " ms behind the motion that they make: the log's clocks or filters are off by more than the rotors lag; the "
          "rows are aligned by it, and what is trained on them knows no lag of the rotors");
    }
    for (Passage& passage : passages_) {
      for (Flight& segment : passage.segments) {
        segment = logs::remove_lag(std::move(segment), *period_s_, dataset_.lag_removed_s);
        to_motor_values(segment);
      }
    }
    steps_.add(
        "lag", before, rows_in(passages_),
        number_text(std::round(dataset_.lag_removed_s * 1e4) / 10) + " ms from command to motion removed, " + told);
  }

  /// Commands by a curve that is said are shares of thrust until here: between a log's rows thrusts have a mean, motor
  /// values have none.
  void to_motor_values(Flight& segment) const {
    if (airframe_ || !(stated_curve_.value_or(0) > 0)) return;
    for (Sample& sample : segment) {
      for (double& command : sample.commands) command = command_of_fraction(*stated_curve_, command);
    }
  }

  /// Rows by `mask(flight)` of each flight as a whole.
  template <class Mask>
  void drop(const std::string& name, const std::string& told, const Mask& mask) {
    const std::size_t before = rows_in(passages_);
    for (Passage& passage : passages_) {
      use(passage.mapping);
      Flight whole = joined(std::move(passage.segments));
      const RowMask out = mask(whole);
      passage.segments.clear();
      passage.segments.push_back(without(std::move(whole), out));
    }
    steps_.add(name, before, rows_in(passages_), told);
  }

  void drop_rows() {
    const auto text = [](double value) { return number_text(value); };
    drop("idle", "all four commands below " + text(mapping_.idle_below), [this](const Flight& flight) {
      RowMask out;
      for (const Sample& sample : flight) out.push_back(is_idle(sample, mapping_));
      return out;
    });
    if (settings_.keep_saturated) return drop_outliers();
    drop("saturated",
         "a command at its limit, " + text(mapping_.lowest_command) + " or " + text(mapping_.highest_command) +
             " or one it is held at",
         [this](const Flight& flight) {
           return saturated_rows(flight, mapping_.lowest_command, mapping_.highest_command);
         });
    drop_outliers();
  }

  void drop_outliers() {
    drop("outliers", "a value like none of its neighbours", [](const Flight& flight) { return outlier_rows(flight); });
  }

  std::vector<Flight> cut_flights(std::vector<Flight> segments) const {
    std::vector<Flight> flights = split_at_gaps(joined(std::move(segments)), mapping_.split_gap_s);
    if (!settings_.cut_s) return flights;
    std::vector<Flight> parts;
    for (Flight& flight : flights) {
      if (flight.size() == 0) continue;
      for (Flight& part : cut(std::move(flight), *settings_.cut_s)) parts.push_back(std::move(part));
    }
    return parts;
  }

  void make_flights() {
    const std::size_t before = rows_in(passages_);
    std::size_t longest = 0;
    for (Passage& passage : passages_) {
      use(passage.mapping);
      const auto misread = misread_.find(passage.name);
      std::vector<Flight> flights = cut_flights(std::move(passage.segments));
      for (const Flight& flight : flights) longest = std::max(longest, flight.size());
      flights.erase(std::remove_if(flights.begin(), flights.end(),
                                   [](const Flight& flight) { return flight.size() < fewest_flight_rows; }),
                    flights.end());
      const bool is_cut = settings_.cut_s && flights.size() > 1;
      int part = 0;
      for (Flight& flight : flights) {
        ++part;
        flight.name = is_cut ? free_name(dataset_.flights, passage.name + "_" + std::to_string(part))
                             : free_name(dataset_.flights, passage.name, part);
        flight.trajectory = settings_.cut_s && passage.trajectory == passage.name ? flight.name : passage.trajectory;
        std::string cause = misread == misread_.end() ? "" : misread->second;
        if (cause.empty()) {
          for (const SensorFinding& finding :
               check_sensors(flight, !dataset_.lacks("velocity"), !dataset_.lacks("altitude"))) {
            warn(flight.name + ": " + finding.words);
            if (finding.may_be_heading && cause.empty()) cause = finding.words;
          }
        }
        require_plausible_flight(flight, passage, cause);
        const std::string unchecked = motion_not_checked(flight);
        if (!unchecked.empty()) add(dataset_.notes, flight.name + ": not checked: too little motion: " + unchecked);
        dataset_.flights.add(std::move(flight));
        dataset_.sources.push_back(passage.source);
      }
    }
    steps_.add("short flights", before, dataset_.flights.rows(),
               "fewer than " + std::to_string(fewest_flight_rows) + " rows");
    dataset_.sample_period_s = *period_s_;
    if (dataset_.flights.size() == 0) refuse_without_flight(longest);
    require_different_flights(dataset_.flights);
  }

  /// The step of the rows on one clock that cost most; fewer rows for a slower clock are no loss.
  [[noreturn]] void refuse_without_flight(std::size_t longest) const {
    const auto lost = [](const ImportStep& step) {
      return step.rows_before - std::min(step.rows_before, step.rows_after);
    };
    const auto first = std::find_if(dataset_.steps.begin(), dataset_.steps.end(),
                                    [](const ImportStep& step) { return step.name == "incomplete rows"; });
    const auto worst = std::max_element(
        first, dataset_.steps.end(), [&lost](const ImportStep& a, const ImportStep& b) { return lost(a) < lost(b); });
    std::string found = std::to_string(longest);
    if (worst != dataset_.steps.end()) found += "; most were lost to '" + worst->name + "' (" + worst->told + ")";
    for (const std::string& warning : dataset_.warnings) found += "; " + warning;
    throw InputError(logs_.front(), 0, 0, "a flight of at least " + std::to_string(fewest_flight_rows) + " rows",
                     found);
  }

  /// With its cause: an attitude in another order makes rates that do not turn it, and accelerations that fit no
  /// velocity.
  void require_plausible_flight(const Flight& flight, const Passage& passage, const std::string& cause) const {
    auto found = find_implausible(flight);
    if (!found) found = find_standing_column(flight, {!dataset_.lacks("velocity"), !dataset_.lacks("altitude")});
    if (!found) found = find_wrong_gravity(flight);
    if (!found) found = find_turning_of_other_size(flight);
    if (!found && passage.force_of_velocity) found = find_velocity_off_tilt(flight, !dataset_.lacks("altitude"));
    if (!found) return;
    throw InputError(passage.source, 0, 0, found->expected,
                     (cause.empty() ? "" : cause + "; ") + found->found + " at " +
                         number_text(flight[found->row].time_s) + " s of flight " + flight.name);
  }

  const std::vector<std::string>& logs_;
  const LogSettings& settings_;
  std::vector<Mapping> mappings_;
  std::vector<std::size_t> mapping_of_log_;
  std::size_t current_ = 0;
  Mapping mapping_;  ///< the current one
  std::optional<NamedAirframe> airframe_;
  ImportedDataset dataset_;
  Steps steps_;
  std::optional<double> period_s_, stated_curve_;
  double first_period_s_ = 0;  ///< own rows of the first log
  std::vector<Passage> passages_;
  std::map<std::string, std::string> misread_;  ///< by a passage's name: how its attitude is not as it was read
  std::vector<bool> has_velocity_, has_altitude_;
};

}  // namespace

std::vector<ReadyMapping> ready_mappings() {
  std::vector<ReadyMapping> ready;
  for (const MappingText& one : mapping_texts) ready.push_back({one.name, chosen_mapping(one.name).about});
  return ready;
}

std::string mapping_names() {
  std::string names;
  for (const MappingText& one : mapping_texts) names += (names.empty() ? "" : ", ") + std::string(one.name);
  return names;
}

ImportedDataset read_dataset(const std::vector<std::string>& logs, const LogSettings& settings) {
  if (logs.empty()) throw std::invalid_argument("expected a log: a .ulg file, a .csv table, a folder of ulog2csv");
  return Import(logs, settings).run();
}

}  // namespace pinnquad::logs
