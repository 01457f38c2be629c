// SPDX-License-Identifier: MIT
#include "logs/vehicle_check.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "logs/airframe_doubts.hpp"
#include "logs/command_lag.hpp"
#include "logs/log_checks.hpp"
#include "logs/motor_order_check.hpp"
#include "logs/parallel.hpp"
#include "logs/row_checks.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/regression/identification.hpp"

namespace pinnquad::logs {
namespace {

struct VehicleFinding {
  std::size_t flight = 0;    ///< the first it is of
  std::string sentence;      ///< begins with the flights' names
  bool contradicts = false;  ///< nothing should be learned from these flights
};

constexpr const char* another_range =
    ": another range of the commands (least and most of the mapping), a throttle, whose curve pinnquad identify "
    "--thrust-curve fit finds (thrust_curve of the mapping), or another vehicle";
constexpr double told_share = 0.15;  // of a number that is compared

bool is_told(const Estimate& estimate) {
  return estimate.half_width <= told_share * std::abs(estimate.value) && estimate.value != 0;
}

/// A number that flights of one vehicle have in common.
struct SharedNumber {
  const char* words;
  const char* unit;
  Estimate (*of)(const Identification&);
  double tolerance;  ///< of another flight's, over it
};
// clang-format off
constexpr std::array<SharedNumber, 4> shared_numbers = {{
    {"thrust of a rotor over mass", "m/s^2", [](const Identification& found) { return found.thrust_m_s2; }, 0.08},
    {"roll effectiveness", "rad/s^2", [](const Identification& found) { return found.effectiveness_rad_s2[0]; }, 0.3},
    {"pitch effectiveness", "rad/s^2", [](const Identification& found) { return found.effectiveness_rad_s2[1]; }, 0.3},
    {"yaw effectiveness", "rad/s^2", [](const Identification& found) { return found.effectiveness_rad_s2[2]; }, 0.3}}};
// clang-format on

struct Judged {
  std::string name;
  std::vector<Flight> aligned;  ///< by its own lag, where it has one
  Identification found;
  std::array<Identification, 2> halves;  ///< of its time
  double half_s = 0;                     ///< its time at the second one's begin
  double highest_command = 0;
  double lag_s = 0;  ///< from the commands as they were logged
  bool has_lag = false;
  bool lag_found = false;  ///< likely, see CommandLag
};

/// Within what motors and links make, unless commands that are off by much more explain roll and pitch far better.
CommandLag widest_lag(const std::vector<Flight>& segments, double period_s) {
  constexpr double far_better = 1.25, well = 0.3;
  const auto explained = [](const CommandLag& lag) {
    return lag.found ? lag.motions[0].explained + lag.motions[1].explained : 0;
  };
  const std::vector<CommandLag> found = estimate_command_lags(segments, period_s, {{}, {-0.4, 0.4}});
  const bool better = found[1].likely() && explained(found[1]) > std::max(well, far_better * explained(found[0]));
  return better ? found[1] : found[0];
}

/// `on_rows` is called with the rows of each identification that is finished: each row counts twice, among all and then
/// among its half.
template <class OnRows>
Judged judge(const Flight& flight, const Airframe<double>& airframe, double lag_removed_s, const OnRows& on_rows) {
  constexpr double most_s = 300;
  Judged judged;
  judged.name = flight.name;
  const double period_s = sample_period_s(RowSet(flight, {0, flight.size()}));
  if (!(period_s > 0)) return judged;
  const auto most = static_cast<std::size_t>(most_s / period_s);
  Flight begin = first_rows(flight, most);
  judged.half_s = (begin[0].time_s + begin[begin.size() - 1].time_s) / 2;
  judged.aligned = split_at_gaps(std::move(begin), 1.5 * period_s);
  IdentificationSettings settings;
  settings.thrust_curve = airframe.rotors[0].thrust_curve;
  settings.scope = IdentificationSettings::Scope::without_rise_and_fall;
  RowSet rows;
  std::array<RowSet, 2> half_rows;
  for (const Flight& segment : judged.aligned) {
    std::size_t middle = 0;
    while (middle < segment.size() && segment[middle].time_s < judged.half_s) ++middle;
    rows.add(segment, {0, segment.size()});
    half_rows[0].add(segment, {0, middle});
    half_rows[1].add(segment, {middle, segment.size()});
  }
  judged.found = identify(rows, axis_signs(airframe), settings);
  on_rows(rows.size());
  for (std::size_t half = 0; half < 2; ++half) {
    judged.halves[half] = identify(half_rows[half], axis_signs(airframe), settings);
    on_rows(half_rows[half].size());
  }
  for (std::size_t i = 0; i < flight.size(); ++i) {
    const auto& u = flight[i].commands;
    judged.highest_command = std::max(judged.highest_command, *std::max_element(u.begin(), u.end()));
  }
  const CommandLag lag = widest_lag(judged.aligned, period_s);
  judged.lag_found = lag.likely();
  judged.lag_s = lag.lag_s + lag_removed_s;
  for (Flight& segment : judged.aligned) segment = remove_lag(std::move(segment), period_s, lag.found ? lag.lag_s : 0);
  judged.has_lag = lag.found;
  return judged;
}

class VehicleCheck {
 public:
  VehicleCheck(std::vector<Judged> flights, const Airframe<double>& airframe, bool known)
      : flights_(std::move(flights)), airframe_(airframe), known_(known) {}

  /// Flights whose numbers are not those of most others.
  const std::vector<std::size_t>& unlike() const { return unlike_; }

  std::vector<VehicleFinding> run() {
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      if (check_force(i) || check_signs(i)) continue;
      check_lag(i);
      check_range(i);
      check_halves(i);
    }
    check_highest();
    check_voltages();
    check_slopes();
    compare();
    for (VehicleFinding& finding : findings_) shorten(finding.sentence);
    return std::move(findings_);
  }

 private:
  /// "a, b, c, d, e: ..." to "5 flights, a, b ... e: ...".
  static void shorten(std::string& sentence) {
    constexpr std::size_t most_named = 4;
    const std::size_t end = sentence.find(": ");
    std::vector<std::string> names;
    for (std::size_t begin = 0; begin < end;) {
      const std::size_t comma = std::min(sentence.find(", ", begin), end);
      names.push_back(sentence.substr(begin, comma - begin));
      begin = comma + 2;
    }
    if (names.size() > most_named) sentence.replace(0, end, many_flights(names));
  }

  void say(std::size_t flight, const std::string& what, bool contradicts = false) {
    for (VehicleFinding& finding : findings_) {
      const std::size_t colon = finding.sentence.find(": ");
      if (finding.sentence.substr(colon + 2) != what) continue;
      finding.sentence.insert(colon, ", " + flights_[flight].name);
      return;
    }
    findings_.push_back({flight, flights_[flight].name + ": " + what, contradicts});
  }

  /// True where the specific force points against the rotors.
  bool check_force(std::size_t i) {
    const Estimate& thrust = flights_[i].found.thrust_m_s2;
    if (!(thrust.high() < 0)) return false;
    say(i,
        "column vdot_bz: thrust of a rotor over mass is " + with_interval(thrust, "m/s^2") +
            ": the specific force points along +z of the body: that is x forward, y left, z up (FLU), or the force is "
            "negated",
        true);
    wrong_.push_back(i);
    return true;
  }

  /// Order of the motors, and the way that the propellers turn.
  bool check_signs(std::size_t i) {
    const Judged& flight = flights_[i];
    const std::string columns = "columns u1 to u4: ";
    const MotorOrderCheck order = check_motor_order(flight.aligned, airframe_);
    if (order.finding && flight.has_lag) {
      const Estimate& yaw = flight.found.effectiveness_rad_s2[2];
      const bool measured = order.yaw_reversed && yaw.high() < 0;
      say(i,
          columns + *order.finding +
              (measured ? "; yaw effectiveness " + with_interval(yaw, "rad/s^2") + " in column w_z" : ""),
          true);
      wrong_.push_back(i);
      return true;
    }
    constexpr std::array<const char*, 3> turns = {"roll", "pitch", "yaw"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Estimate& estimate = flight.found.effectiveness_rad_s2[axis];
      if (!(estimate.high() < 0) || !order.turns_against[axis]) continue;
      say(i,
          columns + turns[axis] + " turns against the commands, " + with_interval(estimate, "rad/s^2") +
              " in column w_" + "xyz"[axis] +
              (axis == 2 ? ": the propellers turn the other way than the airframe says (spin), or motors are exchanged"
                         : ": motors are exchanged, or the rate is negated"),
          true);
      wrong_.push_back(i);
      return true;
    }
    return false;
  }

  /// The median of a number of the other flights, NaN where one has it not; none where no other has it.
  template <class Of>
  std::optional<double> usual_of_others(std::size_t i, const Of& of) const {
    std::vector<double> others;
    for (std::size_t k = 0; k < flights_.size(); ++k) {
      if (k != i && !std::isnan(of(flights_[k]))) others.push_back(of(flights_[k]));
    }
    return others.empty() ? std::nullopt : std::optional(detail::median_of(std::move(others)));
  }

  void check_lag(std::size_t i) {
    constexpr double longest_s = 0.12, apart_s = 0.06;
    const Judged& flight = flights_[i];
    if (!flight.lag_found) return;
    const auto usual_s =
        usual_of_others(i, [](const Judged& other) { return other.lag_found ? other.lag_s : std::nan(""); });
    const auto ms = [](double seconds) { return std::to_string(std::lround(1e3 * seconds)) + " ms"; };
    std::string than;
    if (usual_s && std::abs(flight.lag_s - *usual_s) > apart_s) than = ", in the other flights " + ms(*usual_s);
    if (than.empty() && std::abs(flight.lag_s) < longest_s) return;
    say(i, "columns u1 to u4: the motion comes " + ms(std::abs(flight.lag_s)) +
               (flight.lag_s < 0 ? " before" : " after") + " the commands" + than +
               ": rotors and filters take 0 to 120 ms, and the same in each flight; a topic's clock is off");
  }

  /// Numbers that are not the airframe's, where it is known.
  void check_range(std::size_t i) {
    constexpr double factor = 1.4;
    std::string off;
    for (std::size_t number = 0; known_ && number < shared_numbers.size() - 1; ++number) {
      const SharedNumber& shared = shared_numbers[number];
      const Estimate estimate = shared.of(flights_[i].found);
      const double has = rotor_effects(airframe_)[number];
      if (!is_told(estimate) || (estimate.high() > has / factor && estimate.low() < has * factor)) continue;
      off += (off.empty() ? "" : ", ") + (shared.words + (" is " + with_interval(estimate, shared.unit))) +
             " where the airframe has " + short_number(has);
    }
    if (!off.empty()) say(i, "columns u1 to u4: " + off + another_range);
  }

  /// Numbers of the second half of a flight that are not those of the first.
  void check_halves(std::size_t i) {
    const Judged& flight = flights_[i];
    std::string off;
    for (const SharedNumber& shared : shared_numbers) {
      const Estimate first = shared.of(flight.halves[0]), second = shared.of(flight.halves[1]);
      if (!is_told(first) || !is_told(second) || agree(flight.halves[0], flight.halves[1], shared)) continue;
      const double share = second.value / first.value - 1;
      off += (off.empty() ? "" : ", ") + (shared.words + (" is " + with_interval(second, shared.unit))) + ", " +
             percent(std::abs(share)) + (share < 0 ? " less" : " more") + " than before (" +
             with_interval(first, shared.unit) + ")";
    }
    if (off.empty()) return;
    say(i, "columns u1 to u4: from " + short_number(flight.half_s) + " s on, half of the flight, " + off +
               ": other propellers, another battery or payload within a flight");
  }

  /// Commands of all flights that may be tenths of what they should be.
  void check_highest() {
    constexpr double least = 0.15;
    double highest = 0;
    for (const Judged& flight : flights_) highest = std::max(highest, flight.highest_command);
    if (highest >= least || known_) return;
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      say(i, "columns u1 to u4: no command is above " + short_number(highest) +
                 ", where 1 is a rotor's most and quadrotors hover at 0.2 to 0.7" + another_range);
    }
  }

  /// A cell has 2.5 to 4.4 V: flights of one vehicle are no further apart.
  void check_voltages() {
    constexpr double empty_V = 2.5, full_V = 4.4, most_cells = 14;
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      const double volts = flights_[i].found.mean_voltage_V;
      if (!(volts > 0)) continue;
      const auto voltage = [](const Judged& other) {
        return other.found.mean_voltage_V > 0 ? other.found.mean_voltage_V : std::nan("");
      };
      const double usual = usual_of_others(i, voltage).value_or(volts);
      const std::string is = "column battery_voltage: " + short_number(volts) + " V on average";
      if (volts < empty_V || volts > most_cells * full_V) {
        say(i, is + ", where batteries of 1 to 14 cells have 2.5 to 61.6 V: another unit");
      } else if (volts * empty_V > usual * full_V || usual * empty_V > volts * full_V) {
        say(i, is + ", in the other flights " + short_number(usual) +
                   " V, where a cell has 2.5 to 4.4 V: another unit, or another battery");
      }
    }
  }

  /// By how much the slope of the thrust over the commands is off its level; empty where a flight does not tell.
  std::optional<double> bent(std::size_t i) const {
    constexpr double loose = 0.5;
    const Estimate &level = flights_[i].found.thrust_m_s2, &slope = flights_[i].found.thrust_slope_m_s2;
    if (!is_told(level) || !(slope.half_width < loose * std::abs(slope.value))) return std::nullopt;
    if (slope.high() < 0) return -1;
    return std::max({1.0, slope.low() / level.value, level.value / slope.high()});
  }

  /// A thrust that goes against the commands; one of another slope in most flights: rotors that saturate bend it too.
  void check_slopes() {
    constexpr double most_bent = 1.6;
    std::size_t telling = 0, off = 0;
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      if (bent(i)) ++telling;
      if (bent(i).value_or(1) > most_bent) ++off;
    }
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      const double by = bent(i).value_or(1);
      const bool against = by < 0 && flights_[i].found.thrust_m_s2.value > 0;
      if (!against && !(by > most_bent && 2 * off > telling)) continue;
      say(i,
          "columns u1 to u4: thrust of a rotor over mass is " + with_interval(flights_[i].found.thrust_m_s2, "m/s^2") +
              " by its level and " + with_interval(flights_[i].found.thrust_slope_m_s2, "m/s^2") + " by its slope" +
              (against ? ": a velocity along down, or the specific force, is negated (column vdot_bz)" : another_range),
          against);
    }
  }

  /// A higher voltage makes more thrust, up to twice its own share, and never less.
  static bool agree(const Identification& a, const Identification& b, const SharedNumber& number) {
    const Estimate of_a = number.of(a), of_b = number.of(b);
    const double scale = std::min(std::abs(of_a.value), std::abs(of_b.value));
    const bool has_volts = a.mean_voltage_V > 0 && b.mean_voltage_V > 0;
    const double by_volts = has_volts ? 2 * scale * (a.mean_voltage_V / b.mean_voltage_V - 1) : 0;
    const double apart = of_a.value - of_b.value;
    const double unexplained = apart - std::clamp(apart, std::min(0.0, by_volts), std::max(0.0, by_volts));
    return std::abs(unexplained) <= number.tolerance * scale + std::hypot(of_a.half_width, of_b.half_width);
  }

  /// The flights whose number agrees with that of most others; empty where none tells it.
  std::vector<std::size_t> agreeing(const std::vector<std::size_t>& flights, std::size_t number) const {
    std::vector<std::size_t> group;
    for (const std::size_t pivot : flights) {
      std::vector<std::size_t> with;
      for (const std::size_t other : flights) {
        if (agree(flights_[pivot].found, flights_[other].found, shared_numbers[number])) with.push_back(other);
      }
      if (with.size() > group.size()) group = with;
    }
    return group;
  }

  /// Says each number that is off that of most flights.
  void compare() {
    constexpr std::size_t fewest = 3;  // of two that disagree nobody knows which is right
    std::vector<std::string> off(flights_.size());
    bool none_agree = false;
    for (std::size_t number = 0; number < shared_numbers.size(); ++number) {
      const SharedNumber& shared = shared_numbers[number];
      std::vector<std::size_t> telling;
      for (std::size_t i = 0; i < flights_.size(); ++i) {
        const bool wrong = std::find(wrong_.begin(), wrong_.end(), i) != wrong_.end();
        if (!wrong && is_told(shared.of(flights_[i].found))) telling.push_back(i);
      }
      const std::vector<std::size_t> group = agreeing(telling, number);
      double usual = 0;
      for (const std::size_t i : group) {
        usual += shared.of(flights_[i].found).value / static_cast<double>(group.size());
      }
      none_agree = none_agree || (group.size() == 1 && telling.size() >= fewest);
      for (const std::size_t i : telling) {
        if (std::find(group.begin(), group.end(), i) != group.end()) continue;
        const Estimate estimate = shared.of(flights_[i].found);
        const double share = estimate.value / usual - 1;
        off[i] += (off[i].empty() ? "" : ", ") + (shared.words + (" is " + with_interval(estimate, shared.unit))) +
                  ", " + percent(std::abs(share)) + (share < 0 ? " less" : " more") + " than in " +
                  (group.size() == 1 ? flights_[group.front()].name : std::to_string(group.size()) + " other flights") +
                  " (" + short_number(usual) + ")";
      }
    }
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      if (off[i].empty()) continue;
      unlike_.push_back(i);
      say(i,
          "columns u1 to u4: " + off[i] + (none_agree ? ", and no two flights agree" : "") +
              ": a payload, another battery or propeller, or another range of the commands",
          none_agree);
    }
  }

  std::vector<Judged> flights_;
  const Airframe<double>& airframe_;
  bool known_;
  std::vector<std::size_t> wrong_, unlike_;
  std::vector<VehicleFinding> findings_;
};

}  // namespace

void check_vehicle(ImportedDataset& dataset, const Airframe<double>& airframe, bool known,
                   const OnProgress& on_progress) {
  const auto& flights = dataset.flights.flights();
  std::vector<Judged> judged(flights.size());
  std::atomic<std::size_t> rows_done{0};
  const auto meanwhile = [&] {
    const double rows = static_cast<double>(std::max(std::size_t{1}, dataset.flights.rows()));
    const double share = std::min(1.0, static_cast<double>(rows_done.load()) / (2 * rows));
    if (on_progress) on_progress("comparing the flights", share);
  };
  each_in_parallel(flights.size(), std::max(1u, std::thread::hardware_concurrency()), meanwhile, [&](std::size_t i) {
    judged[i] =
        judge(flights[i], airframe, dataset.lag_removed_s, [&](std::size_t rows) { rows_done.fetch_add(rows); });
  });
  VehicleCheck check(std::move(judged), airframe, known);
  const std::vector<VehicleFinding> findings = check.run();
  dataset.unlike.clear();
  for (const std::size_t i : check.unlike()) dataset.unlike.push_back(flights[i].name);
  for (const VehicleFinding& finding : findings) {
    if (std::find(dataset.warnings.begin(), dataset.warnings.end(), finding.sentence) == dataset.warnings.end()) {
      dataset.warnings.push_back(finding.sentence);  // an import may have found it
    }
    if (!finding.contradicts) continue;
    dataset.contradictions.push_back(
        dataset.sources[finding.flight] +
        ": expected commands and motion of one vehicle, with the airframe's motor order and spins, found " +
        finding.sentence);
  }
}

void require_one_vehicle(const ImportedDataset& dataset) {
  if (!dataset.contradictions.empty()) throw std::invalid_argument(dataset.contradictions.front());
}

}  // namespace pinnquad::logs
