// SPDX-License-Identifier: MIT
// The conditions of the command `beyond`; a further one is an entry of flown_conditions().
#include "study/beyond_conditions.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>

#include "command_line/listed.hpp"
#include "flight/choice.hpp"
#include "pinnquad/simulation/recorder.hpp"

namespace study {

namespace {

using pinnquad::Flight;
using pinnquad::RowSplit;
using ToldAirframe = pinnquad::GivenAirframe;
using OfFlights = std::vector<const Flight*>;

constexpr double payload_share = 0.2;  ///< of the airframe's mass, at its centre
constexpr double wrong_share = 0.1;    ///< by which an airframe is told wrong
constexpr double test_share = 0.2;     ///< the end of each flight, whatever else is left out

pinnquad::Airframe<double> the_vehicle() { return pinnquad::airframe_value<Airframe, double>(); }

pinnquad::Airframe<double> with_payload() {
  pinnquad::Airframe<double> airframe = the_vehicle();
  airframe.mass_kg *= 1 + payload_share;
  return airframe;
}

/// Mass and inertia this much too large, thrust this much too small.
ToldAirframe told_wrong(double share) {
  pinnquad::Airframe<double> airframe = the_vehicle();
  airframe.mass_kg *= 1 + share;
  for (double& inertia : airframe.inertia_kg_m2) inertia *= 1 + share;
  for (double& inertia : airframe.inertia_products_kg_m2) inertia *= 1 + share;
  airframe.thrust_coefficient *= 1 - share;
  return {Airframe::name, airframe};
}

ToldAirframe the_truth() { return {Airframe::name, the_vehicle()}; }

/// The first `share` of the rows trains, a third as many behind them validate, the last fifth of the flight tests.
RowSplit beginning(const Flight& flight, double share) {
  const auto whole = pinnquad::split_contiguous(flight.size(), {1 - test_share, 0, test_share});
  const double validates = share / 3, rest = 1 - share - validates;
  const auto blocks = pinnquad::split_contiguous(flight.size(), {share, validates, rest});
  RowSplit split;
  split.train.add(flight, blocks.train);
  split.validation.add(flight, {blocks.validation.begin, std::min(blocks.validation.end, whole.test.begin)});
  split.test.add(flight, whole.test);
  return split;
}

RowSplit usual(const OfFlights& flights) { return beginning(*flights.front(), 0.6); }

bool is_slow(const pinnquad::Sample& sample) { return sample.velocity_m_s.norm() < slow_m_s; }

RowSplit by_speed(const OfFlights& flights) {
  const Flight& flight = *flights.front();
  const auto blocks = pinnquad::split_contiguous(flight.size());
  RowSplit split;
  split.train = rows_where(flight, blocks.train, is_slow);
  split.validation = rows_where(flight, blocks.validation, is_slow);
  split.test = rows_where(flight, blocks.test, [](const pinnquad::Sample& sample) { return !is_slow(sample); });
  return split;
}

/// Trained on the first flight, judged on the end of the second.
RowSplit end_of_second(const OfFlights& flights) {
  RowSplit split = usual(flights);
  split.test = usual({flights.back()}).test;
  return split;
}

void require_completed(const programs::StudyFlight& id, const pinnquad::FlightReport& report) {
  if (report.end == pinnquad::FlightEnd::completed) return;
  throw std::invalid_argument("flight " + id.name + " of seed " + std::to_string(id.seed) + " ended after " +
                              std::to_string(report.rows) + " rows: choose another --flight-seed");
}

/// `name` without `ending`. False if it does not end so.
bool ends_with(const std::string& name, const std::string& ending, std::string& without) {
  if (name.size() <= ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0) {
    return false;
  }
  without = name.substr(0, name.size() - ending.size());
  return true;
}

}  // namespace

pinnquad::RowSet rows_where(const Flight& flight, const pinnquad::IndexRange& range,
                            const std::function<bool(const pinnquad::Sample&)>& takes) {
  pinnquad::RowSet rows;
  std::size_t begin = range.begin;
  for (std::size_t row = range.begin; row <= range.end; ++row) {
    if (row < range.end && takes(flight[row])) continue;
    if (row - begin >= pinnquad::minimum_block_rows) rows.add(flight, {begin, row});
    begin = row + 1;
  }
  return rows;
}

std::vector<Condition> flown_conditions() {
  std::vector<Condition> all;
  const auto share = [](double of_rows) {
    return [of_rows](const OfFlights& flights) { return beginning(*flights.front(), of_rows); };
  };
  for (const std::string flight : {"d1", "d2", "d3"}) {
    // the loop is flown at 20 m, where nothing of d2 was flown
    const auto in_loop = flight == "d2" ? std::optional<pinnquad::Airframe<double>>() : the_vehicle();
    all.push_back({flight, "60 % of the rows train", Told::the_truth, the_truth(), {flight}, usual, in_loop});
    all.push_back(
        {flight + "_20", "20 % of the rows train", Told::the_truth, the_truth(), {flight}, share(0.2), in_loop});
    all.push_back(
        {flight + "_5", "5 % of the rows train", Told::the_truth, the_truth(), {flight}, share(0.05), in_loop});
    all.push_back({flight + "_noisy",
                   "gyro noise 0.05 rad/s, commands up to 10 ms late",
                   Told::the_truth,
                   the_truth(),
                   {flight + "_noisy"},
                   usual,
                   in_loop});
  }
  all.push_back(
      {"d1_speed", "trained below 5 m/s, judged above", Told::the_truth, the_truth(), {"d1"}, by_speed, the_vehicle()});
  all.push_back({"d1_payload",
                 "judged on a vehicle 20 % heavier",
                 Told::the_truth,
                 the_truth(),
                 {"d1", "d1_payload"},
                 end_of_second,
                 with_payload()});
  all.push_back({"d1_told_heavy",
                 "told mass and inertia 10 % too large, thrust 10 % too small",
                 Told::something_wrong,
                 told_wrong(wrong_share),
                 {"d1"},
                 usual,
                 the_vehicle()});
  all.push_back({"d1_told_light",
                 "told mass and inertia 10 % too small, thrust 10 % too large",
                 Told::something_wrong,
                 told_wrong(-wrong_share),
                 {"d1"},
                 usual,
                 the_vehicle()});
  return all;
}

Condition given_condition(const std::string& name, const ToldAirframe& airframe) {
  return {name, "recorded; 60 % of the rows train", Told::the_truth, airframe, {name}, usual};
}

std::vector<Condition> chosen_conditions(const std::vector<Condition>& all, const std::vector<std::string>& names) {
  return programs::chosen_by_name(
      all, names, [](const Condition& condition) { return condition.name; }, "--conditions", "condition");
}

Flight fly_for_beyond(const programs::StudyFlight& id) {
  pinnquad::Airframe<double> airframe = the_vehicle();
  pinnquad::RecorderErrors errors;
  std::string base = id.name;
  if (ends_with(id.name, "_noisy", base)) errors = pinnquad::noisy_gyro_errors();
  if (ends_with(id.name, "_payload", base)) airframe = with_payload();
  if (base == id.name) return flown(id);
  const programs::NamedFlight& flight = programs::flight_named(base);
  const auto vehicle = flight.vehicle(airframe, flight.ground_effect, {});
  // the noise is drawn from a stream of its own: the flight is that of the same seed
  constexpr std::uint64_t noise_stream = 0x9e3779b97f4a7c15u;
  const pinnquad::NoisyRecorder<std::mt19937_64> recorder(std::mt19937_64(id.seed ^ noise_stream), errors);
  pinnquad::RecordedFlight recorded = pinnquad::fly(
      vehicle, flight.pilot(vehicle, id.seed, {}), flight.plan, [](const auto&) {}, recorder);
  require_completed(id, recorded.report);
  return std::move(recorded.flight);
}

}  // namespace study
