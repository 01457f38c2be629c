// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <pinnquad/io/csv_table.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.hpp"

using pinnquad::InputError;
using pinnquad::OutputError;
using pinnquad::read_csv;
using pinnquad::write_csv;
using pinnquad_test::TemporaryFolder;
using Rows = std::vector<std::vector<double>>;

namespace {

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// The text of the InputError that reading columns a and b gives.
std::string complaint(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder.write("in.csv", text);
  try {
    read_csv(path, {"a", "b"});
  } catch (const InputError& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);
    CHECK(what.substr(0, path.size()) == path);
    return "in.csv" + what.substr(path.size());
  }
  return "accepted";
}

}  // namespace

TEST_CASE("any finite double survives writing and reading to the bit") {
  std::mt19937_64 engine(1);
  Rows rows = {{0.0, -0.0},
               {std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()},
               {std::numeric_limits<double>::min(), std::numeric_limits<double>::denorm_min()},
               {0.1, 1.0 / 3}};
  while (rows.size() < 5000) {
    double value[2] = {};
    const std::uint64_t words[2] = {engine(), engine()};
    std::memcpy(value, words, sizeof value);
    if (std::isfinite(value[0]) && std::isfinite(value[1])) rows.push_back({value[0], value[1]});
  }
  const TemporaryFolder folder;
  write_csv(folder.path("bits.csv"), {"a", "b"}, rows);
  const Rows read = read_csv(folder.path("bits.csv"), {"a", "b"});
  REQUIRE(read.size() == rows.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < 2; ++j) different += bits_of(rows[i][j]) != bits_of(read[i][j]) ? 1 : 0;
  }
  CHECK(different == 0);
}

TEST_CASE("a table is written with the shortest digits, one row a line") {
  const TemporaryFolder folder;
  write_csv(folder.path("out.csv"), {"first", "second"}, {{0.1, 1e300}, {-2, 0.30000000000000004}});
  CHECK(folder.read("out.csv") == "first,second\n0.1,1e+300\n-2,0.30000000000000004\n");
  write_csv(folder.path("nan.csv"), {"x"}, {{std::numeric_limits<double>::quiet_NaN()}});
  CHECK(folder.read("nan.csv") == "x\nnan\n");
}

TEST_CASE("columns are found by name, wherever they stand and whatever stands beside them") {
  const TemporaryFolder folder;
  const Rows expected = {{1, 2}, {3, 4}};
  const auto rows_of = [&folder](const std::string& text) {
    return read_csv(folder.write("in.csv", text), {"a", "b"});
  };
  CHECK(rows_of("a,b\n1,2\n3,4\n") == expected);
  CHECK(rows_of("a,b\n1,2\n3,4") == expected);                          // no line end at the end
  CHECK(rows_of("a,b\r\n1,2\r\n3,4\r\n\r\n") == expected);              // CRLF, empty last line
  CHECK(rows_of("b,a\n2,1\n4,3\n") == expected);                        // other order
  CHECK(rows_of("note,b,,a,note\nx,2,nan,1,\n,4,,3,?\n") == expected);  // strangers, even doubled or nameless
  CHECK(rows_of("\xef\xbb\xbf"
                "a , b\n +1 ,\t2\n3.0e0,.4e1\n") == expected);  // byte order mark, blanks, plus
}

TEST_CASE("quotation marks as in RFC 4180, in the header and around numbers") {
  const TemporaryFolder folder;
  const Rows expected = {{1, 2}, {3, 4}};
  const auto rows_of = [&folder](const std::string& text, const std::vector<std::string>& columns) {
    return read_csv(folder.write("in.csv", text), columns);
  };
  CHECK(rows_of("\"a\",b\n1,\"2\"\n \" 3\" ,\"+4\"\t\n", {"a", "b"}) == expected);
  CHECK(rows_of("\"x, y\",\"say \"\"b\"\"\"\r\n1,2\r\n3,4\r\n", {"x, y", "say \"b\""}) == expected);
  CHECK(rows_of("note,a,b\n\"one, two\",1,2\n\"a\nb\r\n\"\"c\"\", d\",3,4\n", {"a", "b"}) == expected);
  CHECK(rows_of("a,b,\" kept \"\n2,1,1\n4,3,3", {" kept ", "a"}) == expected);
  CHECK(rows_of("note,a,b\n5\" propeller,1,2\nhe said \"a, 3,4\n", {"a", "b"}).size() == 2);  // no quoted cells
  CHECK(rows_of("a,b,note\n1,2,\"\"\n3,4,\"x\" y\n", {"a", "b"}) == expected);
}

TEST_CASE("a record of several lines is told by its first; one without end by where it begins") {
  const TemporaryFolder folder;
  const auto check = [&folder](const std::string& text, const std::string& line) {
    CHECK(complaint(folder, text) == line);
  };
  check("a,b,n\n1,2,\"x\ny\"\n3,z,\"\n\"\n", "in.csv:4:2: expected a finite number in column b, found \"z\"");
  check("a,b\n1,2\n\"3,4\n5,6\n", "in.csv:3: expected a closing quotation mark, found the end of the file");
  check("a,b\n1,\"2,5\"\n", "in.csv:2:2: expected a finite number in column b, found \"2,5\"");
  check("a,b\n1,\"2\" 5\n", "in.csv:2:2: expected a finite number in column b, found \"\"2\" 5\"");
  check("a,b\n1,\"\"\n", "in.csv:2:2: expected a finite number in column b, found an empty cell");
  check("a,b\n1,2,\"3,4\"\n", "in.csv:2:3: expected 2 fields as in the header, found 3");
}

TEST_CASE("column names that need quotation marks are written with them, and read back") {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"plain", "a,b", "say \"c\"", " blank", "two\nlines"};
  write_csv(folder.path("out.csv"), names, {{1, 2, 3, 4, 5}});
  CHECK(folder.read("out.csv") == "plain,\"a,b\",\"say \"\"c\"\"\",\" blank\",\"two\nlines\"\n1,2,3,4,5\n");
  CHECK(read_csv(folder.path("out.csv"), names) == Rows{{1, 2, 3, 4, 5}});
}

TEST_CASE("records are whole wherever a block ends, and a file without line ends is not read into memory") {
  const TemporaryFolder folder;
  for (const std::size_t note : {std::size_t{0}, pinnquad::detail::read_block - 20, pinnquad::detail::read_block,
                                 3 * pinnquad::detail::read_block}) {
    std::string text = "a,n\r\n";
    for (int row = 0; row < 30; ++row) {
      const std::string filling(note + static_cast<std::size_t>(row), 'x');
      text +=
          std::to_string(row) + (row % 2 == 0 ? "," + filling : ",\"" + filling + "\n\"\"" + filling + "\"") + "\r\n";
    }
    const Rows rows = read_csv(folder.write("in.csv", text), {"a"});
    REQUIRE(rows.size() == 30);
    for (std::size_t row = 0; row < 30; ++row) CHECK(rows[row][0] == static_cast<double>(row));
  }
  CHECK(complaint(folder, "a,b\n1,2\n" + std::string(std::size_t{17} << 20, 'x')) ==
        "in.csv:3: expected a record of at most 16 MiB, found a longer one");
}

TEST_CASE("every bad input is one line with file, line, column, what was expected and what was found") {
  const TemporaryFolder folder;
  const auto check = [&folder](const std::string& text, const std::string& line) {
    CHECK(complaint(folder, text) == line);
  };
  check("", "in.csv:1: expected a header that names the columns, found an empty file");
  check("\r\n \n", "in.csv:1: expected a header that names the columns, found an empty file");
  check("a,c\n1,2\n", "in.csv:1: expected a column named b, found none of that name among 2 columns");
  check("a,b,c,a\n1,2,3,4\n", "in.csv:1:4: expected one column named a, found a second one (the first is column 1)");
  check("a,b\n", "in.csv:1: expected at least 1 rows of data, found 0");
  check("a,b\n1,2\n3,x7\n", "in.csv:3:2: expected a finite number in column b, found \"x7\"");
  check("a,b\n1,2\n3 4,5\n", "in.csv:3:1: expected a finite number in column a, found \"3 4\"");
  check("b,n,a\n1,,2\n3,,0x10\n", "in.csv:3:3: expected a finite number in column a, found \"0x10\"");
  check("a,b\n1,nan\n", "in.csv:2:2: expected a finite number in column b, found \"nan\"");
  check("a,b\n-inf,2\n", "in.csv:2:1: expected a finite number in column a, found \"-inf\"");
  check("a,b\n1e999,2\n", "in.csv:2:1: expected a finite number in column a, found \"1e999\"");
  check("a,b\n1,\n", "in.csv:2:2: expected a finite number in column b, found an empty cell");
  check("a,b\n1, \t\n", "in.csv:2:2: expected a finite number in column b, found an empty cell");
  check("a,b\n+,1\n", "in.csv:2:1: expected a finite number in column a, found \"+\"");
  check("a,b\n+-1,1\n", "in.csv:2:1: expected a finite number in column a, found \"+-1\"");
  check("a;b\n1;2\n", "in.csv:1: expected commas between the cells (export the table with them), found semicolons");
  check("a\tb\n1\t2\n", "in.csv:1: expected commas between the cells (export the table with them), found tabs");
  check("a,b\n1;2\n", "in.csv:2:2: expected 2 fields as in the header, found 1");
  check("a,b\n1,2\n3\n", "in.csv:3:2: expected 2 fields as in the header, found 1");
  check("a,b\n1,2,3,4\n", "in.csv:2:3: expected 2 fields as in the header, found 4");
  check("a,b\n1,2\n\n3,4\n", "in.csv:3: expected 2 fields as in the header, found an empty line");
  check("a,b\n1," + std::string(50, 'z') + "\n",
        "in.csv:2:2: expected a finite number in column b, found \"" + std::string(40, 'z') + "...\"");
  check(std::string("a,b\n1,\0\x1b\xff\x7f\n", 11), "in.csv:2:2: expected a finite number in column b, found \"????\"");
}

TEST_CASE("a file that cannot be read is named without a line") {
  const TemporaryFolder folder;
  const std::string missing = folder.path("missing.csv");
  CHECK_THROWS_WITH_AS(read_csv(missing, {"a"}),
                       (missing + ": expected a readable file, found none (No such file or directory)").c_str(),
                       InputError);
  CHECK_THROWS_WITH_AS(read_csv(folder.path(), {"a"}),
                       (folder.path() + ": expected a readable file, found a folder").c_str(), InputError);
}

TEST_CASE("the caller says how many rows are enough") {
  const TemporaryFolder folder;
  const std::string path = folder.write("in.csv", "a\n1\n2\n");
  CHECK(read_csv(path, {"a"}, 2).size() == 2);
  CHECK_THROWS_WITH_AS(read_csv(path, {"a"}, 3), (path + ":3: expected at least 3 rows of data, found 2").c_str(),
                       InputError);
  CHECK(read_csv(folder.write("in.csv", "a\n"), {"a"}, 0).empty());
}

TEST_CASE("a table that is no table is refused before a file is made") {
  const TemporaryFolder folder;
  const std::string path = folder.path("out.csv");
  CHECK_THROWS_WITH_AS(write_csv(path, {"a", "b"}, {{1, 2}, {3}}),
                       "write_csv: expected rows of 2 numbers as in the header, found 1", std::invalid_argument);
  CHECK_THROWS_WITH_AS(write_csv(path, {""}, {{1}}), "write_csv: expected a column name, found an empty one",
                       std::invalid_argument);
  CHECK(folder.listing().empty());

  const std::string unwritable = folder.path("missing/out.csv");
  CHECK_THROWS_WITH_AS(write_csv(unwritable, {"a"}, {{1}}),
                       ("cannot write " + unwritable + ": No such file or directory").c_str(), OutputError);
}
