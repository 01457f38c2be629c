// SPDX-License-Identifier: MIT
// Logs that are CSV tables: numbers, absent cells, labels; what is wrong with a table in one line.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "complaint.hpp"
#include "logs/csv_log.hpp"
#include "support/temporary_folder.hpp"

using pinnquad::logs::LogSelection;
using pinnquad::logs::LogTopic;
using pinnquad::logs::read_csv_log;
using pinnquad_test::TemporaryFolder;

namespace {

LogSelection by(const std::string& clock, double ticks_per_s = 1) {
  LogSelection selection;
  selection.clock_column = clock;
  selection.clock_ticks_per_s = ticks_per_s;
  return selection;
}

LogTopic read(const std::string& text, const LogSelection& selection = {}) {
  const TemporaryFolder folder;
  const auto log = read_csv_log(folder.write("log.csv", text), selection);
  REQUIRE(log.topics.size() == 1);
  CHECK(log.topics[0].name.empty());
  return log.topics[0];
}

std::string complaint(const std::string& text, const LogSelection& selection = {}) {
  const TemporaryFolder folder;
  const std::string path = folder.write("log.csv", text);
  return pinnquad_test::complaint_of([&] { read_csv_log(path, selection); }, path);
}

}  // namespace

TEST_CASE("numbers, absent cells, infinities; the clock in its own unit") {
  const LogTopic topic =
      read("\xef\xbb\xbft, x ,y,z\r\n1000000, 1.5 ,,nan\r\n2500000,-Inf,+2,NaN\r\n\r\n", by("t", 1e6));
  CHECK(topic.time_s == std::vector<double>{1, 2.5});
  CHECK(topic.texts.empty());
  REQUIRE(topic.columns.size() == 4);
  CHECK(topic.column("t")->values == std::vector<double>{1000000, 2500000});
  CHECK(topic.column("x")->values[0] == 1.5);
  CHECK(topic.column("x")->values[1] == -std::numeric_limits<double>::infinity());
  CHECK(std::isnan(topic.column("y")->values[0]));
  CHECK(topic.column("y")->values[1] == 2);
  CHECK(std::isnan(topic.column("z")->values[0]));
  CHECK(std::isnan(topic.column("z")->values[1]));
  CHECK(topic.place == std::vector<std::uint64_t>{2, 3});
  CHECK(topic.places_are_lines);
}

TEST_CASE("without a clock the times are NaN") {
  const LogTopic topic = read("x\n1\n2\n");
  REQUIRE(topic.size() == 2);
  CHECK(std::isnan(topic.time_s[0]));
}

TEST_CASE("labels: a column of text from the first row, from a later one, by name; quotation marks") {
  LogSelection selection = by("t");
  selection.label_columns = {"run"};
  const LogTopic topic =
      read("flight,t,note,run,x\na,1,,7,1\n\"b, \"\"c\"\"\",2,3.5,8,2\nd,3,\"two\nlines\",9,3\n", selection);
  REQUIRE(topic.size() == 3);
  REQUIRE(topic.texts.size() == 3);
  CHECK(topic.text("flight")->values == std::vector<std::string>{"a", "b, \"c\"", "d"});
  CHECK(topic.text("flight")->first_text == 0);
  CHECK(topic.text("note")->values == std::vector<std::string>{"", "3.5", "two\nlines"});
  CHECK(topic.text("note")->first_text == 2);
  CHECK(topic.text("run")->values == std::vector<std::string>{"7", "8", "9"});
  CHECK(topic.column("note") == nullptr);
  CHECK(topic.column("x")->values == std::vector<double>{1, 2, 3});
  CHECK(topic.time_s == std::vector<double>{1, 2, 3});
  CHECK(topic.place == std::vector<std::uint64_t>{2, 3, 4});
}

TEST_CASE("a table whose rows come in many blocks is read whole, and how far it is is told") {
  std::string text = "t,x\n";
  for (int i = 0; i < 60000; ++i) text += std::to_string(i) + "," + std::to_string(i % 7) + ".25\n";
  LogSelection selection = by("t");
  std::vector<double> shares;
  selection.on_progress = [&shares](double share) { shares.push_back(share); };
  const LogTopic topic = read(text, selection);
  REQUIRE(topic.size() == 60000);
  std::vector<double> times, values;
  for (int i = 0; i < 60000; ++i) {
    times.push_back(i);
    values.push_back(i % 7 + 0.25);
  }
  CHECK((topic.time_s == times && topic.column("x")->values == values));
  REQUIRE(shares.size() > 5);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() > 0.8);
  CHECK(shares.back() <= 1);
}

TEST_CASE("what is wrong with a table: one line that says where") {
  CHECK(complaint("") == ":1: expected a header that names the columns, found an empty file");
  CHECK(complaint("\nt,x\n") == ":1: expected a header that names the columns, found an empty line");
  CHECK(complaint("1,2\n3,4\n") == ":1: expected a header that names the columns, found numbers");
  CHECK(complaint("t,x\n") == ":2: expected a row of data, found none");
  CHECK(complaint("t,x,t\n1,2,3\n") ==
        ":1:3: expected columns of different names, found \"t\" again (the first is column 1)");
  CHECK(complaint("t,x\n1,2\n3\n") == ":3:2: expected 2 cells as in the header, found 1");
  CHECK(complaint("t,x\n1,2,3\n") == ":2:3: expected 2 cells as in the header, found 3");
  CHECK(complaint("t,x\n1,2\n\n3,4\n") == ":3: expected a row, found an empty line");
  CHECK(complaint("t,x\n1,a\n", by("x")) == ":2:2: expected a number in column x, found \"a\"");
  CHECK(complaint("t,x\n1,\n2,3\n4,a\n", by("x")) == ":4:2: expected a number in column x, found \"a\"");
  CHECK(complaint("t,x\n1,2\n", by("time")) ==
        ":1: expected a column named time, found none of that name among 2 columns");
  CHECK(complaint("t,x\n\"1,2\n").find("a closing quotation mark") != std::string::npos);
  std::string wide = "a";
  for (int i = 0; i < 10000; ++i) wide += ",";
  CHECK(complaint(wide + "\n") == ":1: expected at most 10000 columns, found 10001");
}

TEST_CASE("semicolons, with decimal commas or points, and tabs") {
  for (const char* text :
       {"t;x;y\n1;2;3\n2;0,035;3\n", "t;x;y\n1;2;3\n2;0.035;3\n", "t\tx\ty\n1\t2\t3\n2\t0.035\t3\n"}) {
    const LogTopic topic = read(text, by("t"));
    REQUIRE(topic.size() == 2);
    CHECK(topic.column("x")->values == std::vector<double>{2, 0.035});
  }
}

TEST_CASE("the table below comments, keys and values, and above a row of units") {
  const TemporaryFolder folder;
  const std::string path = folder.write("log.csv",
                                        "\"Product\",\"of, somebody\"\n\"acc_1G\",2048\n\"motorOutput\",\"158,2047\"\n"
                                        "# a comment, of two cells\n\"t\",\"x\",\"y\",\"z\"\ns,m,[deg],-\n1,2,3,4\n");
  const auto log = read_csv_log(path, by("t"));
  CHECK(log.parameters.at("acc_1G") == 2048);
  CHECK(log.parameters.at("motorOutput[1]") == 2047);
  REQUIRE(log.topics[0].size() == 1);
  CHECK(log.topics[0].column("y")->values == std::vector<double>{3});
  CHECK(log.topics[0].column("y")->unit == "deg");
  CHECK(log.topics[0].place == std::vector<std::uint64_t>{7});
  CHECK(read("# t x\n# t, x\n1,2\n", by("t")).column("x")->values == std::vector<double>{2});
  CHECK(complaint("# t\n# x\n") == ":1: expected a header that names the columns, found comments alone");
  // a table of labels has no row of units
  CHECK(read("t,flight\n1,a\n2,b\n").text("flight")->values == std::vector<std::string>{"a", "b"});
}

TEST_CASE("a last row without a line end may be cut: left out with a warning") {
  const TemporaryFolder folder;
  for (const std::string end : {"", "3,", "3,15", "3,1.2e"}) {
    const auto log = read_csv_log(folder.write("log.csv", "t,x\n1,1532\n2,1533\n" + end), by("t"));
    CHECK(log.topics[0].column("x")->values == std::vector<double>{1532, 1533});
    REQUIRE(log.warnings.size() == (end.empty() ? 0 : 1));
    if (!end.empty()) CHECK(log.warnings[0].find("log: line 4, the last, has no line end") == 0);
  }
  CHECK(read("t,x\n1,2\n3,4\r").size() == 2);
}

TEST_CASE("lists of one length are columns of numbers, others text") {
  const LogTopic topic = read("t,p,q,r\n1,\"[1,2]\",\"[3,4]\",[]\n2,[5 6],[7],[]\n", by("t"));
  CHECK(topic.column("p[1]")->values == std::vector<double>{2, 6});
  CHECK(topic.column("q[0]") == nullptr);
  CHECK(topic.text("q")->values == std::vector<std::string>{"[3,4]", "[7]"});
  CHECK((topic.text("q")->first_text == 1 && topic.text("r")->first_text == 0));
}

TEST_CASE("decimal commas between commas: what to do about them") {
  const std::string numbers =
      ": expected numbers with a decimal point, or semicolons between the cells (export the table so), found ";
  CHECK(complaint("t,x\n\"1\",\"-0,5e-3\"\n") == ":2:2" + numbers + "\"-0,5e-3\"");
  CHECK(complaint("t,x\n0,1,2,5\n") == ":2:3: expected 2 cells as in the header, found 4 (are there decimal commas?)");
  // a label may hold a comma between digits
  LogSelection selection;
  selection.label_columns = {"x"};
  CHECK(complaint("t,x\n1,\"2,5\"\n", selection) == "accepted");
}
