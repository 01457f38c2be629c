// SPDX-License-Identifier: MIT
// Blackbox logs byte by byte, as Betaflight's and INAV's loggers write them.
#include "logs/blackbox.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "complaint.hpp"
#include "logs/blackbox_bytes.hpp"
#include "pinnquad/logs/read_log.hpp"
#include "support/temporary_folder.hpp"
#include "ulog_bytes.hpp"

using namespace pinnquad::logs;
using pinnquad_test::Bytes;

namespace {

const std::string magic = "H Product:Blackbox flight data recorder by Nicholas Sherlock\n";

std::string unsigned_number(std::uint32_t value) {
  std::string text;
  for (; value > 127; value >>= 7) text += static_cast<char>(static_cast<unsigned char>(value | 128));
  return text + static_cast<char>(static_cast<unsigned char>(value));
}
std::string signed_number(std::int64_t value) {
  return unsigned_number(static_cast<std::uint32_t>(value < 0 ? -2 * value - 1 : 2 * value));
}

/// Fields as a header lists them: name, signed, and predictor and encoding in I and P frames.
struct Listed {
  std::string name;
  int is_signed, predictor_i, encoding_i, predictor_p, encoding_p;
};

std::string head(const std::vector<Listed>& fields, const std::string& more = "") {
  std::string lists[6];
  for (const Listed& field : fields) {
    const std::string parts[6] = {field.name,
                                  std::to_string(field.is_signed),
                                  std::to_string(field.predictor_i),
                                  std::to_string(field.encoding_i),
                                  std::to_string(field.predictor_p),
                                  std::to_string(field.encoding_p)};
    for (int i = 0; i < 6; ++i) lists[i] += (lists[i].empty() ? "" : ",") + parts[i];
  }
  return magic + "H Data version:2\nH Field I name:" + lists[0] + "\nH Field I signed:" + lists[1] +
         "\nH Field I predictor:" + lists[2] + "\nH Field I encoding:" + lists[3] +
         "\nH Field P predictor:" + lists[4] + "\nH Field P encoding:" + lists[5] +
         "\nH I interval:8\nH P interval:2\n" + more;
}

/// Iteration, time and one number; P frames count, go straight on, and add to the number before.
const std::vector<Listed> plain = {{"loopIteration", 0, 0, 1, 6, 9}, {"time", 0, 0, 1, 2, 0}, {"x", 1, 0, 0, 1, 0}};
std::string i_frame(unsigned iteration, std::uint32_t time_us, int x) {
  return "I" + unsigned_number(iteration) + unsigned_number(time_us) + signed_number(x);
}
std::string p_frame(int time_off_us, int x_more) { return "P" + signed_number(time_off_us) + signed_number(x_more); }
const std::string end_of_log = std::string("E\xff") + "End of log" + std::string(1, '\0');

FlightLog parsed(const std::string& bytes, std::size_t flight = 0) {
  LogSelection selection;
  selection.flight = flight;
  return parse_blackbox(bytes, "x.bbl", selection);
}
std::vector<double> column(const FlightLog& log, const std::string& name) {
  REQUIRE(!log.topics.empty());
  const auto* const found = log.topics[0].column(name);
  REQUIRE_MESSAGE(found != nullptr, name);
  return found->values;
}
using Values = std::vector<double>;

}  // namespace

TEST_CASE("frames: iterations count by the intervals, times go straight on, numbers add up; the end ends") {
  const std::string log = head(plain) + i_frame(0, 1000, 5) + p_frame(500, -7) + p_frame(-3, 2) + p_frame(0, 0) +
                          i_frame(8, 3000, 40) + end_of_log + i_frame(9, 4000, 1);
  const FlightLog read = parsed(log);
  CHECK(read.warnings.empty());
  REQUIRE(read.topics.size() == 1);
  CHECK(column(read, "loopIteration") == Values{0, 2, 4, 6, 8});
  CHECK(column(read, "time (us)") == Values{1000, 1500, 1997, 2494, 3000});
  CHECK(column(read, "x") == Values{5, -2, 0, 0, 40});
  CHECK(read.topics[0].time_s[1] == 0.0015);
  CHECK(read.topics[0].place[0] == head(plain).size());
}

TEST_CASE("every encoding that firmware writes") {
  using pinnquad::logs::blackbox::FrameBytes;
  std::vector<std::int64_t> values(8);
  const auto bytes = [](const std::vector<unsigned>& numbers) {
    std::string text;
    for (const unsigned one : numbers) text += static_cast<char>(static_cast<unsigned char>(one));
    return text;
  };
  const auto first = [&values](std::size_t count) {
    return std::vector<std::int64_t>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const auto read = [&](const std::string& text, const auto& how) {
    FrameBytes frame(text, 0);
    how(frame);
    CHECK(frame.at() == text.size());
    CHECK_FALSE(frame.ended());
  };
  using Numbers = std::vector<std::int64_t>;
  read(unsigned_number(4'000'000'000u), [](FrameBytes& f) { CHECK(f.unsigned_number() == 4'000'000'000u); });
  read(signed_number(-2'147'483'648), [](FrameBytes& f) { CHECK(f.signed_number() == -2'147'483'648); });
  read(unsigned_number(16383), [](FrameBytes& f) { CHECK(f.negative_14() == 1); });  // -1 in 14 bits, negated
  const auto three = [&](FrameBytes& f) { f.three_of_32(values); };
  read(bytes({0x1b}), three);  // 00 01 10 11
  CHECK(first(3) == Numbers{1, -2, -1});
  read(bytes({0x47, 0x8f}), three);  // 0100 0111, 1000 1111
  CHECK(first(3) == Numbers{7, -8, -1});
  read(bytes({0x9f, 0x20, 0x3f}), three);
  CHECK(first(3) == Numbers{31, -32, -1});
  read(bytes({0xc0 | 0x1 << 0 | 0x2 << 2 | 0x3 << 4, 0x00, 0x80, 0xff, 0xff, 0x7f, 0, 0, 0, 0x80}), three);
  CHECK(first(3) == Numbers{-32768, 8388607, -2147483648});
  const auto variable = [&](FrameBytes& f) { f.three_variable(values); };
  read(bytes({0x40 | 15 << 1 | 1, 0x0 << 4 | 0x7}), variable);  // 5, 5 and 4 bits: 01111 10000 0111
  CHECK(first(3) == Numbers{15, -16, 7});
  read(bytes({0x80 | 0x1f, 0xc0 | 0x20, 0x00 | 0x7f}), variable);  // 8, 7 and 7: 01111111 1000000 1111111
  CHECK(first(3) == Numbers{127, -64, -1});
  const auto four = [&](FrameBytes& f) { f.four_of_16(values, 2); };
  read(bytes({0xe4, 0x7f, 0xe8, 0x00, 0x10}), four);  // 0, 4 bits 7, 8 bits -2, 16 bits -32767, half a byte over
  CHECK(first(4) == Numbers{0, 7, -2, -32767});
  const auto four_old = [&](FrameBytes& f) { f.four_of_16(values, 1); };
  read(bytes({0xe5, 0x87, 0xfe, 0x01, 0x80}), four_old);  // a byte for two of 4 bits: 7, -8; 8 bits; 16 bits
  CHECK(first(4) == Numbers{7, -8, -2, -32767});
  const auto eight = [&](FrameBytes& f) { f.variable_8(values, 3); };
  read(bytes({0x05}) + signed_number(-300) + signed_number(9), eight);
  CHECK(first(3) == Numbers{-300, 0, 9});
  read(signed_number(77), [&](FrameBytes& f) { f.variable_8(values, 1); });
  CHECK(values[0] == 77);
}

TEST_CASE("predictors, groups, and the units of columns") {
  const std::vector<Listed> fields = {
      {"loopIteration", 0, 0, 1, 6, 9},  {"time", 0, 0, 1, 2, 0},       {"vbatLatest", 0, 9, 3, 1, 6},
      {"amperageLatest", 1, 0, 0, 1, 6}, {"gyroADC[0]", 1, 0, 0, 3, 0}, {"accSmooth[2]", 1, 0, 0, 3, 0},
      {"motor[0]", 0, 11, 1, 3, 0},      {"motor[1]", 0, 5, 0, 3, 0},   {"servo[0]", 1, 8, 0, 4, 0}};
  const std::string more =
      "H Firmware revision:Betaflight 4.5.1 (77d01ba3b) STM32F7X2\nH minthrottle:1070\nH motorOutput:158,2047\n"
      "H gyro_scale:0x3d800000\nH acc_1G:2048\nH vbatref:1600\n";
  std::string log = head(fields, more) + "I" + unsigned_number(0) + unsigned_number(50) + unsigned_number(10) +
                    signed_number(123) + signed_number(160) + signed_number(2048) + unsigned_number(42) +
                    signed_number(-3) + signed_number(100);
  log += "P" + signed_number(0) + std::string(1, '\2') + signed_number(7) + signed_number(16) + signed_number(0) +
         signed_number(1) + signed_number(-1) + signed_number(5);
  const FlightLog read = parsed(log + end_of_log);
  CHECK(column(read, "vbatLatest (V)")[0] == doctest::Approx(15.9));
  CHECK(column(read, "amperageLatest (A)")[1] == doctest::Approx(1.3));
  CHECK(column(read, "gyroADC[0] (deg/s)") == Values{10, 11});  // a sixteenth of 160, and of 176
  CHECK(column(read, "accSmooth[2] (m/s/s)")[0] == doctest::Approx(9.80665));
  CHECK(column(read, "motor[0]") == Values{200, 201});
  CHECK(column(read, "motor[1]") == Values{197, 196});
  CHECK(column(read, "servo[0]") == Values{1600, 1075});
  CHECK(read.parameters.at("motorOutput[0]") == 158);
  CHECK(read.parameters.at("motorOutput[1]") == 2047);
  CHECK(read.parameters.at("acc_1G") == 2048);
}

TEST_CASE("what is damaged costs the frames that build on it; events, other frames and pauses do not") {
  const std::string start = head(plain,
                                 "H Field S name:flags\nH Field S signed:0\nH Field S predictor:0\n"
                                 "H Field S encoding:1\n") +
                            i_frame(0, 1000, 5);
  const std::string mode = "E" + std::string(1, '\x1e') + unsigned_number(3) + unsigned_number(1);
  const FlightLog whole =
      parsed(start + mode + p_frame(500, 1) + "S" + unsigned_number(9) + p_frame(0, 1) + end_of_log);
  CHECK(column(whole, "x") == Values{5, 6, 7});
  REQUIRE(whole.topic("slow") != nullptr);
  CHECK(whole.topic("slow")->time_s == Values{0.0015});
  const FlightLog damaged =
      parsed(start + "Z" + p_frame(500, 1) + p_frame(0, 1) + i_frame(8, 3000, 40) + p_frame(0, 1) + end_of_log);
  CHECK(column(damaged, "x") == Values{40, 41});  // the frame before a byte that begins none is in doubt too
  REQUIRE(damaged.warnings.size() == 1);
  CHECK(damaged.warnings[0].find("x.bbl: byte " +
                                 std::to_string(start.find("I" + unsigned_number(0) + unsigned_number(1000)))) == 0);
  const std::string resumed = "E" + std::string(1, '\x0e') + unsigned_number(90000) + unsigned_number(60'000'000);
  const FlightLog pause = parsed(start + resumed + i_frame(90000, 60'000'100, 6) + end_of_log);
  CHECK(column(pause, "x") == Values{5, 6});
  CHECK(parsed(start + i_frame(90000, 60'000'100, 6) + end_of_log).topics[0].size() == 1);       // a jump unannounced
  CHECK(column(parsed(start + "G" + "H" + p_frame(500, 1) + end_of_log), "x") == Values{5, 6});  // frames of no fields
  const FlightLog wrapped = parsed(head(plain) + i_frame(0, 4'294'967'000u, 1) + i_frame(8, 1000, 2) + end_of_log);
  CHECK(column(wrapped, "time (us)") == Values{4'294'967'000.0, 4'294'968'296.0});
}

TEST_CASE("flights of one file, one after the other; told by content") {
  const pinnquad_test::TemporaryFolder folder;
  const std::string two = std::string(40, '\xff') + head(plain) + i_frame(0, 1000, 1) + end_of_log +
                          std::string(9, '\xff') + head(plain) + i_frame(0, 9000, 2) + end_of_log;
  CHECK(column(parsed(two), "x") == Values{1});
  CHECK(column(parsed(two, 1), "x") == Values{2});
  CHECK((parsed(two).warnings.empty() && parsed(two, 1).warnings.empty()));  // flash is filled behind an end
  const std::string one = head(plain) + i_frame(0, 1000, 1);
  CHECK(column(parsed(one + end_of_log + std::string(2, '\0') + i_frame(8, 2000, 2)), "x") == Values{1});
  CHECK(column(parsed(one + end_of_log.substr(0, 9) + i_frame(8, 2000, 2) + i_frame(16, 3000, 3)), "x").back() == 3);
  CHECK(pinnquad::logs::kind_of_log(folder.write("flight.csv", two)) == pinnquad::logs::LogKind::blackbox);
  CHECK(pinnquad_test::complaint_of([&] { parsed(two, 2); }, "x.bbl").find("found 2 flights") != std::string::npos);
}

TEST_CASE("hostile heads are one line with the byte; every cut of a log is read or refused") {
  const auto refusal = [](const std::string& bytes) {
    return pinnquad_test::complaint_of([&] { parsed(bytes); }, "x.bbl");
  };
  CHECK(refusal(magic).find("found none") != std::string::npos);
  CHECK(refusal(magic + "H Field I name:a,b\nI").find("at byte") != std::string::npos);
  CHECK(refusal(magic + "H Field I name:loopIteration,time\nH Field I encoding:1\n").find("found 1") !=
        std::string::npos);
  CHECK(refusal(magic + "H Field I name:loopIteration,time\nH Field I encoding:1,99\n").find("\"99\"") !=
        std::string::npos);
  CHECK(refusal(magic + "H Field I name:loopIteration,time\nH Field P predictor:6,77\n").find("predictors 0 to 11") !=
        std::string::npos);
  CHECK(refusal(magic + "H Field I name:" + std::string(2000, ',') + "\n").find("1 to 512 fields") !=
        std::string::npos);
  const std::string log =
      head(plain, "H I interval:2147483647\nH P interval:0/-5\n") + i_frame(0, 1000, 5) + p_frame(500, -7) + end_of_log;
  for (std::size_t size = magic.size(); size <= log.size(); ++size) {
    static_cast<void>(pinnquad_test::complaint_of([&] { parsed(log.substr(0, size)); }, "x.bbl"));
  }
}
