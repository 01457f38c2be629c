// SPDX-License-Identifier: MIT
// How much memory a test's subject asks for.
#pragma once

#include <cstddef>

namespace pinnquad_test {

/// Bytes that were asked for since reset(), in all and at most at once.
struct CountedMemory {
  std::size_t total = 0;
  std::size_t largest = 0;
  void reset() { *this = {}; }
};
extern CountedMemory counted_memory;

}  // namespace pinnquad_test
