// SPDX-License-Identifier: MIT
// Writes a log for examples/read_log.cpp: write_ulog FILE
#include <fstream>

#include "programs/logs/synthetic_ulog.hpp"

int main(int, char** argument) {
  std::ofstream file(argument[1], std::ios::binary);
  file << pinnquad_test::synthetic_ulog();
  return file.flush() ? 0 : 1;
}
