// SPDX-License-Identifier: MIT
// The mappings that the program brings: the files of examples/mappings, as CMake found them.
#pragma once

#include <array>

namespace programs {

struct ReadyMapping {
  const char* name;
  const char* toml;
};

extern const std::array<ReadyMapping, 3> ready_mappings;

}  // namespace programs
