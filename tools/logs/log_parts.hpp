// SPDX-License-Identifier: MIT
// The logs that a path means, the flights that one table holds, and their names.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "logs/mapping.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/logs/read_log.hpp"

namespace pinnquad::logs {

/// A trajectory's name out of a flight's: "*_(*)_*" makes lissajous of B10_lissajous_fast_rep1. One pair of brackets,
/// and at most six stars: each may stand for any letters, as few as will do.
bool is_name_pattern(std::string_view pattern);

/// A log to read.
struct LogPlace {
  std::string path;
  std::string prefix;  ///< which log of a folder of ulog2csv
  std::string name;    ///< "test_circle"; "LOG00001.02" of a blackbox log of several flights
  std::size_t flight = 0;
};

/// A file that a vehicle's logger wrote, by its content: no table.
bool is_vehicles_log(const std::string& path);

/// Files as they are, each flight of a blackbox log; of a folder its logs by their content, or its CSV tables where the
/// mapping says which column is their clock, or the logs that ulog2csv wrote into it. Throws InputError: a folder
/// without.
std::vector<LogPlace> logs_at(const std::string& path, const LogSelection& selection, bool tables_have_clock);

/// Logs of one name, as cards number them anew (00000001.BIN), get the nearest folder's that differs before it:
/// monday_00000001.
void tell_apart(std::vector<LogPlace>& places);

/// True for what blackbox_decode writes beside a log, by its name: *.gps.csv, *.gps.gpx, *.headers.csv, *.event.
bool stands_beside_log(const std::string& path);

/// A flight's log and what it is called.
struct LogPart {
  FlightLog log;
  std::string name;
  std::string trajectory;
};

/// A table by its labels, in the order in which they first occur; every other log is one flight.
std::vector<LogPart> parts_of(FlightLog log, const std::string& name, const Mapping& mapping);

/// The name, or that with the part's number or a higher one where a flight of the dataset has it: "a.csv (2)".
std::string free_name(const Dataset& dataset, const std::string& name, int part = 1);

}  // namespace pinnquad::logs
