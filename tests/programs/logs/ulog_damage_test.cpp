// SPDX-License-Identifier: MIT
// ULog files that were cut, damaged, or made to do harm: what is whole is read, what is lost is said, and a small file
// asks for little memory.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "complaint.hpp"
#include "counted_memory.hpp"
#include "logs/ulog.hpp"
#include "support/temporary_folder.hpp"
#include "ulog_bytes.hpp"

using pinnquad::logs::FlightLog;
using pinnquad::logs::parse_ulog;
using pinnquad::logs::read_ulog;
using pinnquad_test::Bytes;
using pinnquad_test::counted_memory;
using pinnquad_test::TemporaryFolder;
using pinnquad_test::UlogBytes;

namespace {

const std::string simple = "a:uint64_t timestamp;float x;";

std::string complaint(const std::string& bytes) {
  return pinnquad_test::complaint_of([&] { parse_ulog(bytes, "x.ulg"); });
}

/// Two topics, a sync message behind every fourth row, something of every kind between.
UlogBytes log_of_many_messages() {
  UlogBytes file;
  file.flags(0, 0).format(simple).format("b:uint64_t timestamp;pair[2] p;").format("pair:uint8_t l;uint8_t r;");
  file.keyed('P', "float MASS", Bytes().f32(1)).keyed('I', "char[2] sys", Bytes().text("ok"));
  file.topic(0, 0, "a").topic(3, 1, "b");
  for (unsigned i = 0; i < 24; ++i) {
    if (i % 3 == 0) {
      file.data(1, Bytes().u64(1000 + i).u8(i).u8(1).u8(2).u8(3));
    } else {
      file.data(0, Bytes().u64(1000 + i).f32(static_cast<float>(i)));
    }
    if (i % 4 == 3) file.sync();
    if (i == 5) file.said('4', 5, "careful");
    if (i == 9) file.dropout(20);
    if (i == 14) file.keyed('P', "float MASS", Bytes().f32(2));
  }
  return file;
}

/// Where each row of either topic stands, in the file's order.
std::vector<std::uint64_t> rows_of(const FlightLog& log) {
  std::vector<std::uint64_t> places;
  for (const auto& topic : log.topics) places.insert(places.end(), topic.place.begin(), topic.place.end());
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace

TEST_CASE("a log that is cut at any byte: every whole message is read, and where it ends is said") {
  const UlogBytes file = log_of_many_messages();
  const std::string& bytes = file.str();
  const FlightLog whole = parse_ulog(bytes, "x.ulg");
  REQUIRE(whole.warnings.empty());
  const std::vector<std::uint64_t> rows = rows_of(whole);
  REQUIRE(rows.size() == 24);
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    INFO("the first " << size << " bytes");
    const std::string cut = bytes.substr(0, size);
    if (size < 16) {
      CHECK(complaint(cut) != "accepted");
      continue;
    }
    const FlightLog log = parse_ulog(cut, "x.ulg");
    std::vector<std::uint64_t> expected;
    std::size_t last_start = 16;
    for (const std::size_t start : file.starts()) {
      if (start <= size) last_start = start;
    }
    for (const std::uint64_t row : rows) {
      const std::size_t end = static_cast<std::size_t>(row) + 3 + static_cast<unsigned char>(bytes[row]);
      if (end <= size) expected.push_back(row);
    }
    CHECK(rows_of(log) == expected);
    const bool between = size == bytes.size() || std::count(file.starts().begin(), file.starts().end(), size) == 1;
    REQUIRE(log.warnings.size() == (between ? 0 : 1));
    if (!between) CHECK(log.warnings[0].find("x.ulg: byte " + std::to_string(last_start) + ": ") == 0);
  }
}

TEST_CASE("a byte of the data that is wrong: every row behind the next sync message is read as it was") {
  const UlogBytes file = log_of_many_messages();
  const FlightLog whole = parse_ulog(file.str(), "x.ulg");
  const std::vector<std::uint64_t> rows = rows_of(whole);
  const std::size_t first_data = static_cast<std::size_t>(rows[1]);  // behind one row
  std::vector<std::size_t> syncs;
  for (const std::size_t start : file.starts()) {
    if (file.str()[start + 2] == 'S') syncs.push_back(start);
  }
  std::size_t silent = 0;
  for (std::size_t place = first_data; place < file.str().size(); ++place) {
    for (const unsigned flip : {0x01u, 0x05u, 0x80u, 0xffu}) {
      std::string bytes = file.str();
      bytes[place] = static_cast<char>(static_cast<unsigned char>(bytes[place]) ^ flip);
      INFO("byte " << place << " by " << flip);
      const FlightLog log = parse_ulog(bytes, "x.ulg");
      const auto next = std::find_if(syncs.begin(), syncs.end(), [place](std::size_t sync) { return sync > place; });
      const std::size_t from = next == syncs.end() ? bytes.size() : *next;
      const std::vector<std::uint64_t> read = rows_of(log);
      std::size_t same = 0, behind = 0;
      for (const std::uint64_t row : rows) {
        if (row < from) continue;
        ++behind;
        same += static_cast<std::size_t>(std::count(read.begin(), read.end(), row));
      }
      CHECK(same == behind);
      CHECK(read.size() <= rows.size());
      if (read.size() < rows.size() && log.warnings.empty()) ++silent;
    }
  }
  CHECK(silent == 0);
}

TEST_CASE("a file of several blocks is read as its bytes are, wherever it is damaged or cut") {
  constexpr unsigned rows = 120000;
  UlogBytes file;
  file.format(simple).topic(0, 0, "a");
  for (unsigned i = 0; i < rows; ++i) {
    file.data(0, Bytes().u64(i).f32(static_cast<float>(i)));
    if (i % 1000 == 0) file.sync().said('4', i, std::string(i % 60000, 'x'));
  }
  const TemporaryFolder folder;
  std::minstd_rand engine(1);
  for (std::size_t way = 0; way < 12; ++way) {
    std::string bytes = file.str();
    if (way % 3 == 1) bytes.replace(bytes.size() / 4, 300000 * way, 300000 * way, '\0');
    for (std::size_t flip = 0; flip < way; ++flip) {
      const std::size_t place = 100 + engine() % (bytes.size() - 100);
      bytes[place] = static_cast<char>(bytes[place] ^ static_cast<char>(1 + engine() % 255));
    }
    if (way % 2 == 1) bytes.resize(bytes.size() - engine() % (bytes.size() / 2));
    const std::string path = folder.write("x.ulg", bytes);
    const FlightLog log = read_ulog(path), same = parse_ulog(bytes, path);
    INFO("way " << way);
    CHECK(log.warnings == same.warnings);
    REQUIRE(log.topics.size() == 1);
    CHECK(rows_of(log) == rows_of(same));
    CHECK(log.topics[0].column("x")->values == same.topics[0].column("x")->values);
  }
}

TEST_CASE("a region of rubbish is left out, with its bytes; many are counted") {
  UlogBytes file;
  file.format(simple).topic(0, 0, "a").data(0, Bytes().u64(1).f32(1));
  const std::size_t place = file.str().size();
  file.raw(std::string(40, '\xee')).sync().data(0, Bytes().u64(2).f32(2));
  const FlightLog log = parse_ulog(file.str(), "x.ulg");
  CHECK(log.topics.at(0).column("x")->values == std::vector<double>{1, 2});
  REQUIRE(log.warnings.size() == 1);
  CHECK(log.warnings[0] ==
        "x.ulg: byte " + std::to_string(place) +
            ": expected a message that ends before the next sync message, found a longer one: 40 bytes left "
            "out, up to the next sync message");
  for (int i = 0; i < 50; ++i) file.raw(std::string(5, '\0')).sync();
  const FlightLog bad = parse_ulog(file.str(), "x.ulg");
  CHECK(bad.warnings.size() == 21);
  CHECK(bad.warnings.back() == "x.ulg: 31 more places like these");
  // a file system that filled the end with zeros
  file.raw(std::string(500, '\0'));
  CHECK(parse_ulog(file.str(), "x.ulg").topics.at(0).size() == 2);
}

TEST_CASE("definitions that make no sense are refused, in one line with the byte") {
  const auto said = [](const std::string& format) {
    return complaint(UlogBytes().format(format).topic(0, 0, "a").str());
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(has(said("abcd"), "at byte 16, found \"abcd\""));
  CHECK(has(said(":float x;"), "at byte 16"));
  CHECK(has(said("float:float x;"), "at byte 16"));
  CHECK(has(said("a b:float x;"), "at byte 16"));
  CHECK(has(said("a:;;"), "none in a"));
  CHECK(has(said("a:float;"), "a field with type and name"));
  CHECK(has(said("a:float x y;"), "letters, digits and underscores"));
  CHECK(has(said("a:float \n;"), "found \"float ?\""));
  CHECK(has(said("a:float[] x;"), "an array of 1 to 65535"));
  CHECK(has(said("a:float[0] x;"), "an array of 1 to 65535"));
  CHECK(has(said("a:float[-1] x;"), "an array of 1 to 65535"));
  CHECK(has(said("a:float[3 x;"), "an array of 1 to 65535"));
  CHECK(has(said("a:float[65536] x;"), "an array of 1 to 65535"));
  CHECK(has(said("a:float[99999999999999999999999] x;"), "an array of 1 to 65535"));
  CHECK(has(said("a:" + std::string(300, 'x') + " y;"), "letters, digits and underscores"));
  CHECK(has(said("a:float[65535] x;"), "at most 65535 bytes"));
  CHECK(has(said("a:b x;"), "expected a format named b at byte 25, found none"));
  CHECK(has(said("a:a x;"), "a deeper, or in itself"));
  CHECK(has(complaint(UlogBytes().format("a:b x;").format("b:a y;").topic(0, 0, "a").str()), "deeper, or in itself"));
  CHECK(has(complaint(UlogBytes().format(simple).format("a:float x;").str()), "one format named a"));
  CHECK(has(complaint(UlogBytes().format(simple).topic(0, 0, "b").str()), "a topic whose format stands before it"));
  CHECK(has(complaint(UlogBytes().format(simple).topic(0, 0, "a").topic(1, 0, "a").str()),
            "one topic with the number 0"));
  CHECK(has(complaint(UlogBytes().format(simple).topic(0, 0, "a").data(0, Bytes().u8(1)).str()), "3 bytes"));
  CHECK(has(complaint(UlogBytes().format(simple).flags(0, 0).str()), "at byte 48"));
  CHECK(has(complaint(UlogBytes().message('B', "short").str()), "flag bits of 40 bytes at byte 16"));
}

TEST_CASE("a small file asks for little memory, whatever it says") {
  const auto asked_for = [](const std::string& bytes) {
    counted_memory.reset();
    complaint(bytes);
    return counted_memory.total;
  };
  constexpr std::size_t little = 100000;
  // sizes that grow by a factor per format, and rows that are never there
  UlogBytes growing;
  std::string type = "uint8_t";
  for (char name = 'a'; name <= 'l'; ++name) {
    growing.format(std::string(1, name) + ":" + type + "[60000] x;");
    type = name;
  }
  CHECK(asked_for(growing.topic(0, 0, "l").str()) < little);
  // the widest topic there can be, announced under many numbers
  UlogBytes wide;
  wide.format("a:uint64_t timestamp;uint8_t[65000] x;");
  for (unsigned id = 0; id < 20; ++id) wide.topic(id, 65000 + id, "a");
  wide.data(65000, Bytes().u64(1));
  CHECK(asked_for(wide.str()) < little);
  // names in names
  UlogBytes names;
  const std::string longest(255, 'n');
  names.format("a:uint64_t timestamp;b[1] " + longest + ";").format("b:uint8_t[200] " + longest + ";").topic(0, 0, "a");
  names.data(0, Bytes().u64(1).zeros(200));
  CHECK(complaint(names.str()).find("at most 255 letters") != std::string::npos);
  CHECK(asked_for(names.str()) < little);
  // a message that says it is long
  CHECK(asked_for(UlogBytes()
                      .raw("\xff\xff"
                           "F"
                           "a:float x;")
                      .str()) < little);
  CHECK(asked_for(UlogBytes().flags(0, 1, {0xffffffffffffffffu}).str()) < little);
  CHECK(counted_memory.largest < 10000);
}
