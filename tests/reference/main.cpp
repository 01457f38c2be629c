// SPDX-License-Identifier: MIT
// Own main: without all rows of the independent simulator only the test suite "shipped rows" has something to test; 77
// says "skipped" to CTest.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdio>
#include <fstream>

#include "reference/reference_rows.hpp"

int main(int argc, char** argv) {
  const bool asks_for_shipped_alone = argc == 2 && std::string(argv[1]) == "--test-suite=shipped rows";
  const std::string first = pinnquad::test::reference_folder() + "/airlib/points/points_ge0.csv";
  if (!asks_for_shipped_alone && !std::ifstream(first)) {
    std::printf("skipped: no reference rows, %s does not exist\n", first.c_str());
    return 77;
  }
  doctest::Context context(argc, argv);
  return context.run();
}
