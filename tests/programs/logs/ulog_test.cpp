// SPDX-License-Identifier: MIT
// ULog files made by hand, message by message: types, nesting, padding, instances, parameters, appended data.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "complaint.hpp"
#include "logs/ulog.hpp"
#include "ulog_bytes.hpp"

using namespace pinnquad::logs;
using pinnquad_test::Bytes;
using pinnquad_test::UlogBytes;
using Limits32 = std::numeric_limits<float>;
using Limits64 = std::numeric_limits<double>;

namespace {

const LogTopic& only_topic(const FlightLog& log) {
  REQUIRE(log.topics.size() == 1);
  return log.topics[0];
}

const std::vector<double>& values(const LogTopic& topic, const std::string& name) {
  INFO(name);
  REQUIRE(topic.column(name) != nullptr);
  REQUIRE(topic.column(name)->values.size() == topic.size());
  return topic.column(name)->values;
}

double only_value(const LogTopic& topic, const std::string& name) {
  REQUIRE(values(topic, name).size() == 1);
  return values(topic, name)[0];
}

/// The fault of a file.
std::string complaint(const std::string& bytes) {
  return pinnquad_test::complaint_of([&] { parse_ulog(bytes, "x.ulg"); });
}

const std::string simple = "a:uint64_t timestamp;float x;";

Bytes simple_row(std::uint64_t time_us, float x) { return Bytes().u64(time_us).f32(x); }

}  // namespace

TEST_CASE("every basic type, at its ends") {
  UlogBytes file(1, 2500000);
  file.format(
      "t:uint64_t timestamp;int8_t a;uint8_t b;int16_t c;uint16_t d;int32_t e;uint32_t f;int64_t g;uint64_t h;float "
      "i;double j;"
      "bool k;char[6] l;char m;");
  file.topic(0, 0, "t");
  Bytes low, high;
  low.u64(0).u8(0x80).u8(0).u16(0x8000).u16(0).u32(0x80000000).u32(0).u64(0x8000000000000000).u64(0);
  low.f32(-Limits32::infinity()).f64(Limits64::denorm_min()).u8(0).text(std::string("ab\0\0\0\0", 6)).text("x");
  high.u64(1500000).u8(0x7f).u8(0xff).u16(0x7fff).u16(0xffff).u32(0x7fffffff).u32(0xffffffff).u64(0x7fffffffffffffff);
  high.u64(0xffffffffffffffff).f32(Limits32::quiet_NaN()).f64(-Limits64::max()).u8(1).text("abcdef").text("y");
  file.data(0, low).data(0, high);
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(log.warnings.empty());
  const LogTopic& t = only_topic(log);
  CHECK(t.time_s == std::vector<double>{0, 1.5});
  CHECK(values(t, "timestamp") == std::vector<double>{0, 1500000});
  CHECK(values(t, "a") == std::vector<double>{-128, 127});
  CHECK(values(t, "b") == std::vector<double>{0, 255});
  CHECK(values(t, "c") == std::vector<double>{-32768, 32767});
  CHECK(values(t, "d") == std::vector<double>{0, 65535});
  CHECK(values(t, "e") == std::vector<double>{-2147483648.0, 2147483647.0});
  CHECK(values(t, "f") == std::vector<double>{0, 4294967295.0});
  CHECK(values(t, "g") == std::vector<double>{-9223372036854775808.0, 9223372036854775808.0});
  CHECK(values(t, "h") == std::vector<double>{0, 18446744073709551616.0});
  CHECK(values(t, "i")[0] == -Limits64::infinity());
  CHECK(std::isnan(values(t, "i")[1]));
  CHECK(values(t, "j") == std::vector<double>{Limits64::denorm_min(), -Limits64::max()});
  CHECK(values(t, "k") == std::vector<double>{0, 1});
  REQUIRE(t.text("l") != nullptr);
  CHECK(t.text("l")->values == std::vector<std::string>{"ab", "abcdef"});
  CHECK(t.text("m")->values == std::vector<std::string>{"x", "y"});
  CHECK(t.column("l") == nullptr);
  CHECK_FALSE(t.places_are_lines);
  CHECK(t.place == std::vector<std::uint64_t>{file.starts()[2], file.starts()[3]});
}

TEST_CASE(
    "formats in formats, in arrays, used before they are defined; padding is skipped and need not be logged at the "
    "end") {
  UlogBytes file;
  file.format("outer:uint64_t timestamp;inner[2] esc;uint8_t[3] _padding0;pair one;float[2] q;uint8_t[5] _padding1;");
  file.format("inner:uint16_t rpm;uint8_t _padding0;pair[2] p;uint8_t[2] _padding1;");
  file.format("pair:uint8_t x;uint8_t _padding0;uint8_t y;");
  file.topic(0, 7, "outer");
  Bytes row;
  row.u64(2000000);
  for (unsigned i = 0; i < 2; ++i) {
    row.u16(1000 + i).u8(99);
    for (unsigned j = 0; j < 2; ++j) row.u8(10 * i + j).u8(99).u8(100 + 10 * i + j);
    row.u8(99).u8(99);
  }
  row.u8(99).u8(99).u8(99).u8(200).u8(99).u8(201).f32(0.5f).f32(-0.25f);
  file.data(7, row);                  // padding left out
  file.data(7, Bytes(row).zeros(5));  // padding written
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(log.warnings.empty());
  const LogTopic& t = only_topic(log);
  REQUIRE(t.size() == 2);
  std::string names;
  for (const auto& column : t.columns) names += column.name + " ";
  CHECK(names ==
        "timestamp esc[0].rpm esc[0].p[0].x esc[0].p[0].y esc[0].p[1].x esc[0].p[1].y esc[1].rpm esc[1].p[0].x "
        "esc[1].p[0].y "
        "esc[1].p[1].x esc[1].p[1].y one.x one.y q[0] q[1] ");
  for (const std::size_t row_index : {0u, 1u}) {
    CHECK(values(t, "esc[1].rpm")[row_index] == 1001);
    CHECK(values(t, "esc[0].p[1].x")[row_index] == 1);
    CHECK(values(t, "esc[1].p[0].y")[row_index] == 110);
    CHECK(values(t, "esc[1].p[1].y")[row_index] == 111);
    CHECK(values(t, "one.x")[row_index] == 200);
    CHECK(values(t, "one.y")[row_index] == 201);
    CHECK(values(t, "q[0]")[row_index] == 0.5);
    CHECK(values(t, "q[1]")[row_index] == -0.25);
  }
}

TEST_CASE("instances are topics of their own; what is not wanted is left out") {
  UlogBytes file;
  file.format(simple).format("b:uint64_t timestamp;float y;");
  file.topic(0, 0, "a").topic(1, 1, "a").topic(0, 2, "b").topic(2, 3, "a");
  file.data(1, simple_row(3, 1)).data(0, simple_row(2, 2)).data(2, simple_row(1, 3)).data(1, simple_row(4, 4));
  const FlightLog all = parse_ulog(file.str(), "x.ulg");
  REQUIRE(all.topics.size() == 3);  // instance 2 has no row
  CHECK(values(*all.topic("a", 1), "x") == std::vector<double>{1, 4});
  CHECK(values(*all.topic("a"), "x") == std::vector<double>{2});
  CHECK(values(*all.topic("b"), "y") == std::vector<double>{3});
  CHECK(all.topic("a", 2) == nullptr);
  CHECK(all.topic("a", 1)->time_s == std::vector<double>{3e-6, 4e-6});
  LogSelection selection;
  selection.topics = {"b", "c"};
  CHECK(only_topic(parse_ulog(file.str(), "x.ulg", selection)).name == "b");
}

TEST_CASE("parameters of the beginning, not those that were set later; information and words; dropouts") {
  UlogBytes file;
  file.format(simple);
  file.keyed('P', "int32_t SYS_AUTOSTART", Bytes().u32(0xffffffff)).keyed('P', "float SIH_MASS", Bytes().f32(1.2f));
  file.keyed('I', "char[3] sys_name", Bytes().text("PX4")).keyed('I', "uint32_t ver_data_format", Bytes().u32(2));
  file.keyed('I', "int32_t time_ref_utc", Bytes().u32(0xfffff1f0));
  file.message('Q', Bytes().u8(1).u8(14).text("float SIH_MASS").f32(1).str());
  file.message('M', Bytes().u8(0).u8(15).text("char[5] console").text("hello").str());
  file.topic(0, 0, "a").data(0, simple_row(5000000, 1)).data(0, simple_row(4000000, 1)).dropout(250);
  file.keyed('P', "float SIH_MASS", Bytes().f32(1.5f));
  file.said('6', 6000000, "armed").said('0', 7000000, "fire\t");
  file.message('C', Bytes().text("3").u16(9).u64(8000000).text("tagged").str());
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(log.warnings.empty());
  CHECK(log.parameters.size() == 2);
  CHECK(log.parameters.at("SYS_AUTOSTART") == -1);
  CHECK(log.parameters.at("SIH_MASS") == static_cast<double>(1.2f));
  CHECK(log.dropouts == 1);
}

TEST_CASE("data that a crash dump appended, behind a log that stops in the middle of a message") {
  const auto file = [](const std::vector<std::uint64_t>& offsets, unsigned incompatible) {
    UlogBytes log;
    log.flags(0, incompatible, offsets).format(simple).topic(0, 0, "a").data(0, simple_row(1, 1));
    const std::uint64_t cut = log.str().size();
    log.raw(UlogBytes().data(0, simple_row(2, 2)).str().substr(16, 9));  // of 17 bytes
    const std::uint64_t first = log.str().size();
    log.data(0, simple_row(3, 3)).raw("\x20");
    const std::uint64_t second = log.str().size();
    log.data(0, simple_row(4, 4));
    return std::make_pair(log, std::vector<std::uint64_t>{first, second, cut});
  };
  const std::vector<std::uint64_t> offsets = file({}, 0).second;
  const std::string bytes = file({offsets[0], offsets[1]}, 1).first.str();
  const FlightLog log = parse_ulog(bytes, "x.ulg");
  CHECK(values(only_topic(log), "x") == std::vector<double>{1, 3, 4});
  REQUIRE(log.warnings.size() == 2);
  CHECK(log.warnings[0].find("x.ulg: byte " + std::to_string(offsets[2]) + ":") == 0);
  CHECK(log.warnings[1].find("x.ulg: byte " + std::to_string(offsets[1] - 1) + ":") == 0);
  // cut before the appended data: what was there is read
  const FlightLog shorter = parse_ulog(bytes.substr(0, offsets[0] - 2), "x.ulg");
  CHECK(values(only_topic(shorter), "x") == std::vector<double>{1});
  CHECK(shorter.warnings.size() == 2);
  // offsets that go backwards, or into the flags themselves
  CHECK(complaint(file({offsets[1], offsets[0]}, 1).first.str()).find("at byte 16") != std::string::npos);
  CHECK(complaint(file({20}, 1).first.str()).find("at byte 16") != std::string::npos);
}

TEST_CASE("flag bits: what an older reader may ignore, and what it must refuse") {
  const auto file = [](unsigned compatible, unsigned incompatible, std::size_t more) {
    return UlogBytes()
        .flags(compatible, incompatible, {}, more)
        .format(simple)
        .topic(0, 0, "a")
        .data(0, simple_row(1, 1))
        .str();
  };
  CHECK(parse_ulog(file(0xff, 0, 0), "x.ulg").topics.size() == 1);
  CHECK(parse_ulog(file(1, 0, 30), "x.ulg").topics.size() == 1);
  CHECK(complaint(file(0, 2, 0)) ==
        "x.ulg: expected a log that this reader can take in at byte 16, found one whose flag bits say that it needs a "
        "newer one");
  std::string late = file(0, 0, 0);
  late[16 + 3 + 15] = 1;
  CHECK(complaint(late).find("needs a newer one") != std::string::npos);
}

TEST_CASE("messages and versions of a newer logger are passed over, and said") {
  UlogBytes file(2);
  file.format(simple).topic(0, 0, "a").data(0, simple_row(1, 1)).message('Z', "new").data(0, simple_row(2, 2));
  file.message('Y', "newer").data(0, simple_row(3, 3)).data(5, simple_row(9, 9)).data(0, simple_row(4, 4));
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(values(only_topic(log), "x") == std::vector<double>{1, 2, 3, 4});
  REQUIRE(log.warnings.size() == 2);
  CHECK(log.warnings[0].find("version 2") != std::string::npos);
  CHECK(log.warnings[1].find("byte " + std::to_string(file.starts()[3]) + ": 3 messages of unknown type") !=
        std::string::npos);
}

TEST_CASE("a topic that was announced again, withdrawn, or goes on under another number") {
  UlogBytes file;
  file.format(simple).format("b:uint64_t timestamp;float y;").topic(0, 0, "a").topic(0, 0, "a");
  file.data(0, simple_row(1, 1)).message('R', Bytes().u16(0).str()).message('R', Bytes().u16(999).str());
  file.topic(0, 0, "b").topic(0, 1, "a").data(0, simple_row(2, 2)).data(1, simple_row(3, 3));
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(log.warnings.empty());
  CHECK(values(*log.topic("a"), "x") == std::vector<double>{1, 3});
  CHECK(values(*log.topic("b"), "y") == std::vector<double>{2});
}

TEST_CASE("a topic without a clock is left out, and said") {
  UlogBytes file;
  file.format("a:uint32_t timestamp;float x;")
      .format("b:uint64_t timestamp;float y;")
      .topic(0, 0, "a")
      .topic(0, 1, "b");
  file.data(0, Bytes().u32(1).f32(1)).data(1, simple_row(2, 2));
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(only_topic(log).name == "b");
  CHECK(only_value(only_topic(log), "y") == 2);
  REQUIRE(log.warnings.size() == 1);
  CHECK(log.warnings[0].find("a has no timestamp") != std::string::npos);
}

TEST_CASE("no ULog file") {
  CHECK(complaint("") ==
        "x.ulg: expected a ULog file, which begins with ULog 01 12 35 (hexadecimal), found only 0 bytes");
  CHECK(complaint("ULog") ==
        "x.ulg: expected a ULog file, which begins with ULog 01 12 35 (hexadecimal), found only 4 bytes");
  CHECK(complaint("timestamp,x\n1,2\n").find("found other bytes") != std::string::npos);
  CHECK(complaint(UlogBytes().str().substr(0, 12)) == "x.ulg: expected a header of 16 bytes, found only 12");
}

TEST_CASE("parameters that make no sense are left out, and said") {
  UlogBytes file;
  file.keyed('P', "double X", Bytes().f64(1)).keyed('P', "float[2] Z", Bytes().f32(1));
  file.message('I', Bytes().u8(200).text("char[3] z").str()).format(simple).topic(0, 0, "a").data(0, simple_row(1, 1));
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(log.parameters.empty());
  CHECK(only_topic(log).size() == 1);
  CHECK(log.warnings.size() == 2);
}
