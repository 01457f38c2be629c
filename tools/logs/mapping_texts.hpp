// SPDX-License-Identifier: MIT
// The mappings that the library brings: the files of examples/mappings, as CMake found them.
#pragma once

#include <array>

namespace pinnquad::logs {

struct MappingText {
  const char* name;
  const char* toml;
};

extern const std::array<MappingText, 7> mapping_texts;

}  // namespace pinnquad::logs
