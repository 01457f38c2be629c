// SPDX-License-Identifier: MIT
// DataFlash logs byte by byte, as ArduPilot's logger writes them.
#include "logs/dataflash.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "complaint.hpp"
#include "pinnquad/logs/read_log.hpp"
#include "support/temporary_folder.hpp"
#include "ulog_bytes.hpp"

using pinnquad::logs::FlightLog;
using pinnquad::logs::LogSelection;
using pinnquad::logs::parse_dataflash;
using pinnquad_test::Bytes;

namespace {

std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}
std::string message(unsigned type, const std::string& content) {
  return Bytes().u8(0xa3).u8(0x95).u8(type).text(content).str();
}
std::string format(unsigned type, unsigned size, const std::string& name, const std::string& letters,
                   const std::string& names) {
  return message(
      128, Bytes().u8(type).u8(size).text(padded(name, 4)).text(padded(letters, 16)).text(padded(names, 64)).str());
}
const std::string formats = format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
std::string parameter(const std::string& name, float value) {
  return message(2, Bytes().u64(1).text(padded(name, 16)).f32(value).str());
}
const std::string parameters = format(2, 31, "PARM", "QNf", "TimeUS,Name,Value");

FlightLog parsed(const std::string& bytes) { return parse_dataflash(bytes, "x.bin"); }
using Values = std::vector<double>;

}  // namespace

TEST_CASE("each letter of a format is the number that it stands for; text and arrays are no columns of numbers") {
  std::string log = formats + format(9, 3 + 8 + 1 + 1 + 2 + 2 + 4 + 4 + 4, "A", "QbBcCeEf", "TimeUS,b,B,c,C,e,E,f");
  log += message(
      9, Bytes().u64(1'500'000).u8(255).u8(255).u16(65436).u16(65436).u32(4294967196u).u32(150).f32(2.5f).str());
  log += format(10, 3 + 8 + 2 + 4 + 8 + 4 + 64 + 1, "B", "QgLqnaM", "TimeUS,g,L,q,n,a,M");
  log += message(
      10, Bytes().u64(2'000'000).u16(0xc100).u32(4294967295u - 9'999'999).u64(7).text("abc").zeros(1 + 64).u8(4).str());
  const FlightLog read = parsed(log);
  CHECK(read.warnings.empty());
  const auto* a = read.topic("A");
  REQUIRE(a != nullptr);
  CHECK(a->time_s == Values{1.5});
  const auto value = [](const pinnquad::logs::LogTopic* topic, const char* name) {
    return topic->column(name)->values.at(0);
  };
  CHECK(value(a, "b") == -1);
  CHECK(value(a, "B") == 255);
  CHECK(value(a, "c") == -1);
  CHECK(value(a, "C") == 654.36);
  CHECK(value(a, "e") == -1);
  CHECK(value(a, "E") == 1.5);
  CHECK(value(a, "f") == 2.5);
  const auto* b = read.topic("B");
  REQUIRE(b != nullptr);
  CHECK(value(b, "g") == -2.5);
  CHECK(value(b, "L") == -1);
  CHECK(value(b, "q") == 7);
  CHECK(value(b, "M") == 4);
  CHECK(b->column("a") == nullptr);
  CHECK(b->text("n")->values == std::vector<std::string>{"abc"});
}

TEST_CASE("instances by FMTU, parameters, and motors by SERVOn_FUNCTION") {
  std::string log = formats + parameters + format(3, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds") +
                    format(7, 16, "IMU", "QBf", "TimeUS,I,GyrX") + format(8, 17, "RCOU", "QHHH", "TimeUS,C1,C2,C3");
  log += message(3, Bytes().u64(0).u8(7).text(padded("s#E", 16)).text(padded("F--", 16)).str());
  for (unsigned i = 0; i < 4; ++i) log += message(7, Bytes().u64(1000 * i).u8(i % 2).f32(static_cast<float>(i)).str());
  log += message(8, Bytes().u64(5).u16(1500).u16(1200).u16(1300).str());
  log += parameter("MOT_SPIN_MIN", 0.25f) + parameter("SERVO2_FUNCTION", 34) + parameter("SERVO3_FUNCTION", 33);
  const FlightLog read = parsed(log);
  REQUIRE(read.topic("IMU", 1) != nullptr);
  CHECK(read.topic("IMU", 0)->column("GyrX")->values == Values{0, 2});
  CHECK(read.topic("IMU", 1)->column("GyrX")->values == Values{1, 3});
  CHECK(read.parameters.at("motorOutput[0]") == 1250);
  CHECK(read.parameters.at("motorOutput[1]") == 2000);
  CHECK(read.topic("RCOU")->column("Motor1")->values == Values{1300});
  CHECK(read.topic("RCOU")->column("Motor2")->values == Values{1200});
  CHECK(read.topic("RCOU")->column("Motor3") == nullptr);
}

TEST_CASE("before 3.5 the first outputs are motors: Ch1 to Ch4, of the throttle stick's pulses from THR_MIN on") {
  std::string log = formats + parameters + format(8, 19, "RCOU", "QHHHH", "TimeUS,Ch1,Ch2,Ch3,Ch4");
  log += message(8, Bytes().u64(5).u16(1500).u16(1200).u16(1300).u16(1400).str());
  log += parameter("THR_MIN", 130) + parameter("MOT_THST_MAX", 0.95f) + parameter("RC3_MIN", 1100);
  log += parameter("RC3_MAX", 1900);
  const FlightLog read = parsed(log);
  REQUIRE(read.topic("RCOU") != nullptr);
  CHECK(read.topic("RCOU")->column("Motor1")->values == Values{1500});
  CHECK(read.topic("RCOU")->column("Motor4")->values == Values{1400});
  CHECK(read.parameters.at("motorOutput[0]") == 1204);
  CHECK(read.parameters.at("motorOutput[1]") == doctest::Approx(1860));
}

TEST_CASE("bytes that are no message are left out and told; a format of wrong length leaves its messages out") {
  const std::string a = format(9, 12, "A", "QB", "TimeUS,v");
  const auto row = [](unsigned v) { return message(9, Bytes().u64(1000 * v).u8(v).str()); };
  const FlightLog read = parsed(formats + a + row(1) + "rubbish" + row(2) + row(3).substr(0, 5));
  CHECK(read.topic("A")->column("v")->values == Values{1, 2});
  REQUIRE(read.warnings.size() == 1);
  CHECK(read.warnings[0].find("12 bytes in 2 places") != std::string::npos);
  const FlightLog other =
      parsed(formats + a + format(5, 13, "B", "QB?", "TimeUS,v,w") + message(5, std::string(10, 'x')) + row(1));
  CHECK(other.topic("A")->column("v")->values == Values{1});
  CHECK(other.topic("B") == nullptr);
  REQUIRE(other.warnings.size() == 1);
  CHECK(other.warnings[0].find("QB?") != std::string::npos);
  const std::string log = formats + a + row(1) + parameters + parameter("X", 1);
  for (std::size_t size = 0; size <= log.size(); ++size) {
    const std::string said = pinnquad_test::complaint_of([&] { parsed(log.substr(0, size)); }, "x.bin");
    CHECK((said == "accepted") == (size >= 8));
  }
  const pinnquad_test::TemporaryFolder folder;
  CHECK(pinnquad::logs::kind_of_log(folder.write("flight.csv", log)) == pinnquad::logs::LogKind::dataflash);
}
