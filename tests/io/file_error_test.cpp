// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <pinnquad/io/file_error.hpp>
#include <string>

using pinnquad::InputError;
using pinnquad::OutputError;

TEST_CASE("an input error names file, line and column, and leaves out what there is not") {
  const InputError error("a.csv", 17, 5, "a number", "none");
  CHECK(std::string(error.what()) == "a.csv:17:5: expected a number, found none");
  CHECK(error.path == "a.csv");
  CHECK(error.line == 17);
  CHECK(error.column == 5);
  CHECK(std::string(InputError("a.csv", 17, 0, "x", "y").what()) == "a.csv:17: expected x, found y");
  CHECK(std::string(InputError("a.csv", 0, 0, "x", "y").what()) == "a.csv: expected x, found y");
}

TEST_CASE("an output error names file and reason") {
  const OutputError error("b.csv", "disk full");
  CHECK(std::string(error.what()) == "cannot write b.csv: disk full");
  CHECK(error.path == "b.csv");
}
