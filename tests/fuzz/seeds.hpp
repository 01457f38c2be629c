// SPDX-License-Identifier: MIT
// The main of <target>_seeds: writes what a fuzzer begins with into a folder, each a file.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace pinnquad_test {

inline int write_seeds(int argument_count, char** arguments, const std::vector<std::string>& seeds) {
  bool written = argument_count == 2;
  for (std::size_t i = 0; written && i < seeds.size(); ++i) {
    std::ofstream out(std::string(arguments[1]) + "/seed" + std::to_string(i), std::ios::binary);
    written = (out << seeds[i]).flush().good();
  }
  return written ? 0 : 2;
}

inline std::string as_text(const std::vector<unsigned char>& bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace pinnquad_test
