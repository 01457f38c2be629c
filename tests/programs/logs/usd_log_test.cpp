// SPDX-License-Identifier: MIT
// A Crazyflie's log byte by byte, as its deck's driver writes it.
#include "logs/usd_log.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "complaint.hpp"
#include "pinnquad/logs/read_log.hpp"
#include "support/temporary_folder.hpp"
#include "ulog_bytes.hpp"

using pinnquad::logs::FlightLog;
using pinnquad::logs::read_usd_log;
using pinnquad_test::Bytes;
using pinnquad_test::TemporaryFolder;

namespace {

/// One kind of event, `pose` of x and n, and one of them at 1.5 s.
std::string log_of_version_2() {
  Bytes bytes;
  bytes.u8(0xbc).u16(2).u16(1);
  bytes.u16(7).text("pose").zeros(1).u16(2).text("x(f)").zeros(1).text("n(H)").zeros(1);
  return bytes.u16(7).u64(1'500'000).f32(1.5f).u16(65535).str();
}

std::string with_checksum(const std::string& bytes, std::uint64_t checksum) {
  return bytes + Bytes().u32(checksum).str();
}
constexpr std::uint32_t zlib_crc32 = 0x8e9c932e;  // of log_of_version_2(), by Python's zlib

}  // namespace

TEST_CASE("events of a uSD log are topics, their variables columns; a checksum that does not hold is told") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& bytes) { return read_usd_log(folder.write("log00", bytes)); };
  const auto is_whole = [](const FlightLog& log) {
    REQUIRE(log.topics.size() == 1);
    CHECK(log.topics[0].name == "pose");
    CHECK(log.topics[0].time_s == std::vector<double>{1.5});
    CHECK(log.topics[0].column("x")->values == std::vector<double>{1.5});
    CHECK(log.topics[0].column("n")->values == std::vector<double>{65535});
  };
  const FlightLog closed = read(with_checksum(log_of_version_2(), zlib_crc32));
  is_whole(closed);
  CHECK(closed.warnings.empty());
  CHECK(pinnquad::logs::kind_of_log(folder.path("log00")) == pinnquad::logs::LogKind::usd);

  for (const std::string& bytes : {with_checksum(log_of_version_2(), zlib_crc32 ^ 1), log_of_version_2()}) {
    const FlightLog open = read(bytes);
    is_whole(open);
    REQUIRE(open.warnings.size() == 1);
    CHECK(open.warnings[0].find("log00: its checksum does not hold") != std::string::npos);
  }
  std::string damaged = with_checksum(log_of_version_2(), zlib_crc32);
  damaged[38] = '\0';  // the lower byte of n
  const FlightLog other = read(damaged);
  CHECK(other.warnings.size() == 1);
  CHECK(other.topics.at(0).column("n")->values == std::vector<double>{0xff00});
}

TEST_CASE("version 1 counts milliseconds; an event that ends early is left out, one that no head names is refused") {
  const TemporaryFolder folder;
  const std::string head = Bytes().u8(0xbc).u16(1).u16(1).u16(3).text("a").zeros(1).u16(1).text("v(h)").zeros(1).str();
  const std::string event = Bytes().u16(3).u32(250).u16(0xfffe).str();
  const FlightLog log = read_usd_log(folder.write("log01", head + event + event.substr(0, 7)));
  CHECK(log.topics.at(0).time_s == std::vector<double>{0.25});
  CHECK(log.topics.at(0).column("v")->values == std::vector<double>{-2});
  CHECK(log.warnings.size() == 1);
  const std::string path = folder.write("log02", head + Bytes().u16(4).u32(250).u16(0).str());
  CHECK(pinnquad_test::complaint_of([&] { read_usd_log(path); }, path).find("byte 18") != std::string::npos);
}
