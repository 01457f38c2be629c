// SPDX-License-Identifier: MIT
// The mappings that the library brings: the files of examples/mappings, as CMake found them.
#pragma once

#include <vector>

namespace pinnquad::logs {

struct MappingText {
  const char* name;
  const char* toml;
};

extern const std::vector<MappingText> mapping_texts;

}  // namespace pinnquad::logs
