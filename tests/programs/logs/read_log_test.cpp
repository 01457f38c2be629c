// SPDX-License-Identifier: MIT
// Folders that ulog2csv wrote, and what a path is.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "complaint.hpp"
#include "pinnquad/logs/read_log.hpp"
#include "support/temporary_folder.hpp"
#include "ulog_bytes.hpp"

using namespace pinnquad::logs;
using pinnquad_test::Bytes;
using pinnquad_test::TemporaryFolder;
using pinnquad_test::UlogBytes;

namespace {

std::string complaint(const TemporaryFolder& folder, const std::string& name, const LogSelection& selection = {}) {
  const std::string path = folder.path(name);
  return pinnquad_test::complaint_of([&] { read_log(path, selection); }, path);
}

const std::string table = "timestamp,x\n2000000,1.5\n1000000,nan\n";

}  // namespace

TEST_CASE("a folder of ulog2csv: names are split on their last underscore, rows stay in their order") {
  const TemporaryFolder folder;
  folder.write("my_log_1_actuator_controls_0_0.csv", table);
  folder.write("my_log_1_vehicle_attitude_0.csv", "timestamp,q[0],note\n1,-inf,a\n1,1e-04,b\n");
  folder.write("my_log_1_battery_status_12.csv", table);
  folder.write("my_log_1_vehicle_status_0.csv", "timestamp,x\n");  // no row
  folder.write("README.md", "x");
  folder.write("other_sensor_baro_0.csv", table);
  folder.write("notes.csv", "a,b\n1,2\n");
  const FlightLog log = read_log(folder.path());
  REQUIRE(log.warnings.size() == 1);
  CHECK(log.warnings[0] == folder.path("other_sensor_baro_0.csv") + ": not of the log my_log_1_*: left out");
  REQUIRE(log.topics.size() == 3);
  const auto* controls = log.topic("actuator_controls_0");
  REQUIRE(controls != nullptr);
  CHECK(controls->time_s == std::vector<double>{2, 1});
  CHECK(controls->column("x")->values[0] == 1.5);
  CHECK(std::isnan(controls->column("x")->values[1]));
  CHECK(controls->file == folder.path("my_log_1_actuator_controls_0_0.csv"));
  CHECK(controls->place == std::vector<std::uint64_t>{2, 3});
  const auto* attitude = log.topic("vehicle_attitude");
  REQUIRE(attitude != nullptr);
  CHECK(attitude->time_s == std::vector<double>{1e-6, 1e-6});
  CHECK(attitude->column("q[0]")->values == std::vector<double>{-std::numeric_limits<double>::infinity(), 1e-4});
  CHECK(attitude->text("note")->values == std::vector<std::string>{"a", "b"});
  CHECK(log.topic("battery_status", 12) != nullptr);
  LogSelection selection;
  selection.topics = {"battery_status"};
  CHECK(read_log(folder.path(), selection).topics.size() == 1);
}

TEST_CASE("a folder of more than one log: one is chosen by its prefix, or all are named") {
  const TemporaryFolder folder;
  folder.write("a_vehicle_attitude_0.csv", table);
  folder.write("b_c_vehicle_attitude_0.csv", table);
  folder.write("b_c_sensor_baro_1.csv", table);
  CHECK(complaint(folder, "") == ": expected files of one log (choose one by its prefix), found 2: a b_c");
  LogSelection selection;
  selection.prefix = "b_c";
  FlightLog log = read_log(folder.path(), selection);
  REQUIRE(log.topics.size() == 2);
  CHECK(log.topic("sensor_baro", 1) != nullptr);
  CHECK(log.warnings.empty());
  selection.prefix = "a_";
  log = read_log(folder.path(), selection);
  REQUIRE(log.topics.size() == 1);
  CHECK(log.topics[0].file == folder.path("a_vehicle_attitude_0.csv"));
  selection.prefix = "d";
  CHECK(complaint(folder, "", selection) == ": expected files of ulog2csv that begin with d_, found none");
}

TEST_CASE("a topic that few logs have tells where a log's name ends only if it is wanted") {
  const TemporaryFolder folder;
  folder.write("x_esc_status_0.csv", table);
  CHECK(complaint(folder, "") ==
        ": expected files that ulog2csv wrote, such as <log>_vehicle_attitude_0.csv, found none");
  LogSelection selection;
  selection.topics = {"esc_status"};
  CHECK(read_log(folder.path(), selection).topics.size() == 1);
}

TEST_CASE("a table of the folder that cannot be read is named") {
  const TemporaryFolder folder;
  folder.write("x_vehicle_attitude_0.csv", "timestamp,x\n1,2\n1\n");
  CHECK(complaint(folder, "") == "/x_vehicle_attitude_0.csv:3:2: expected 2 cells as in the header, found 1");
  folder.write("x_vehicle_attitude_0.csv", "time,x\n1,2\n");
  CHECK(complaint(folder, "").find(":1: expected a column named timestamp, found none") != std::string::npos);
}

TEST_CASE("what a path is") {
  const TemporaryFolder folder;
  const std::string ulog =
      UlogBytes().format("a:uint64_t timestamp;float x;").topic(0, 0, "a").data(0, Bytes().u64(1).f32(1)).str();
  CHECK(kind_of_log(folder.write("log.bin", ulog)) == LogKind::ulog);
  CHECK(kind_of_log(folder.write("log.csv", table)) == LogKind::csv);
  CHECK(kind_of_log(folder.path()) == LogKind::ulog2csv_folder);
  CHECK(read_log(folder.path("log.bin")).topics.at(0).column("x")->values == std::vector<double>{1});
  CHECK(read_log(folder.path("log.csv")).topics.at(0).size() == 2);
  folder.write("log.ulg.xz", std::string("\xfd"
                                         "7zXZ\0rest",
                                         10));
  CHECK(complaint(folder, "log.ulg.xz") ==
        ": expected a log as it was written, found one compressed by xz (restore it with xz -d)");
  folder.write("log.ulg.gz", "\x1f\x8b\x08 rest");
  CHECK(complaint(folder, "log.ulg.gz").find("gzip -d") != std::string::npos);
  folder.write("text.ulg", table);
  CHECK(complaint(folder, "text.ulg").find("neither by its first bytes") != std::string::npos);
  folder.write("binary", std::string("\0\1\2", 3));
  CHECK(complaint(folder, "binary").find("neither by its first bytes") != std::string::npos);
  folder.write("empty.ulg", "");
  CHECK(complaint(folder, "empty.ulg").find("an empty file") != std::string::npos);
  CHECK(complaint(folder, "absent").find("expected a readable file") != std::string::npos);
}
