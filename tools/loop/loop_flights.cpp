// SPDX-License-Identifier: MIT
#include "loop/loop_flights.hpp"

#include <atomic>
#include <filesystem>
#include <system_error>

#include "command_line/build_facts.hpp"
#include "command_line/listed.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/exported/contents_hash.hpp"
#include "pinnquad/io/decimal.hpp"
#include "pinnquad/io/text_file.hpp"

namespace programs {

namespace {

/// Tells a flight from the others of a journal.
std::string key_of(const LoopFlight& flight) {
  return flight.controller + ' ' + flight.condition + ' ' + flight.trajectory + ' ' + flight.gains + ' ' +
         std::to_string(flight.seed);
}

}  // namespace

LoopJournal::LoopJournal(const std::string& folder, const nlohmann::json& plan)
    : lock_(folder), path_(folder + "/loop.journal") {
  const std::size_t kept = read(plan);
  std::error_code error;
  if (kept > 0) std::filesystem::resize_file(path_, kept, error);
  if (error) throw pinnquad::OutputError(path_, error.message());
  out_.open(path_, kept > 0 ? std::ios::app : std::ios::trunc);
  if (kept == 0) write(plan);
}

const nlohmann::json* LoopJournal::row(const LoopFlight& flight) const {
  const auto found = rows_.find(key_of(flight));
  return found == rows_.end() ? nullptr : &found->second;
}

void LoopJournal::add(const nlohmann::json& value) {
  const std::lock_guard<std::mutex> lock(mutex_);
  file(value);
  write(value);
}

/// Length of the lines that are whole; 0: none.
std::size_t LoopJournal::read(const nlohmann::json& plan) {
  std::ifstream in(path_);
  std::string line;
  std::size_t length = 0;
  while (std::getline(in, line) && !in.eof()) {
    const nlohmann::json value = nlohmann::json::parse(line, nullptr, false);
    if (length == 0 && value != plan) refuse(value, plan);
    if (value.is_discarded()) break;
    if (length > 0) file(value);
    length += line.size() + 1;
  }
  return length;
}

void LoopJournal::refuse(const nlohmann::json& found, const nlohmann::json& plan) const {
  std::string others;
  nlohmann::json both = found.is_object() ? found : nlohmann::json::object();
  both.update(plan);
  for (const auto& [name, value] : both.items()) {
    if (!found.contains(name) || !plan.contains(name) || found[name] != plan[name]) add_to_list(others, name);
  }
  throw pinnquad::OutputError(
      path_, "flights of another plan (" + others + "): give --out another folder, or delete this file");
}

void LoopJournal::file(const nlohmann::json& value) {
  if (value.contains("tuned")) {
    tuned_[value["tuned"]] = value;
  } else {
    rows_[key_of({value["controller"], value["condition"], value.value("trajectory", ""), value.value("gains", ""),
                  value[value.contains("vehicle") ? "vehicle" : "seed"]})] = value;
  }
}

void LoopJournal::write(const nlohmann::json& value) {
  out_ << value.dump() << '\n' << std::flush;
  if (!out_) throw pinnquad::OutputError(path_, "the disk does not take it");
}

nlohmann::json plan_of(const LoopSetting& setting, const std::string& airframe) {
  const LoopSensors& sensors = setting.sensors;
  nlohmann::json plan = {
      {"format", 1},
      {"program", pinnquad::hexadecimal(program_hash())},
      {"model", setting.model.path()},
      {"contents", pinnquad::hexadecimal(setting.model.checksum())},
      {"airframe", airframe},
      {"airframe_numbers", pinnquad::hexadecimal(pinnquad::detail::constant_hash("airframe", setting.airframe))},
      {"columns", setting.columns},
      {"duration_s", setting.duration_s},
      {"noise",
       {{"position_m", sensors.position_m},
        {"velocity_m_s", sensors.velocity_m_s},
        {"attitude_rad", sensors.attitude_rad},
        {"body_rates_rad_s", sensors.body_rates_rad_s}}},
      {"delay_s", sensors.delay_s}};
  if (!setting.waypoints.empty()) plan["waypoints"] = pinnquad::file_text(setting.waypoints);
  if (!setting.battery) return plan;
  plan["battery"] = {setting.battery->cells, setting.battery->capacity_Ah, setting.battery->start_charge};
  return plan;
}

std::vector<nlohmann::json> rows_of(const std::vector<LoopFlight>& flights, LoopJournal* journal, std::size_t threads,
                                    const std::function<nlohmann::json(const LoopFlight&)>& fly) {
  std::vector<nlohmann::json> rows(flights.size());
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    const nlohmann::json* const flown = journal == nullptr ? nullptr : journal->row(flights[i]);
    if (flown == nullptr) missing.push_back(i);
    if (flown != nullptr) rows[i] = *flown;
  }
  std::atomic<std::size_t> finished{0};
  run_parallel(
      std::to_string(missing.size()) + " flights", missing.size(), threads,
      [&] { return static_cast<double>(finished.load()) / static_cast<double>(missing.size()); },
      [&](std::size_t i) {
        stop_if_interrupted();
        rows[missing[i]] = fly(flights[missing[i]]);
        if (journal != nullptr) journal->add(rows[missing[i]]);
        ++finished;
      });
  if (interrupted() && journal != nullptr) {
    throw Interrupted{std::to_string(finished) + " flights are kept: the same command goes on"};
  }
  stop_if_interrupted();
  return rows;
}

}  // namespace programs
