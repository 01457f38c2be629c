// SPDX-License-Identifier: MIT
// Its own translation unit: inlined, a replaced operator looks like a mistake to the compiler.
#include "counted_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

namespace pinnquad_test {
CountedMemory counted_memory;
}

void* operator new(std::size_t size) {
  pinnquad_test::counted_memory.total += size;
  pinnquad_test::counted_memory.largest = std::max(pinnquad_test::counted_memory.largest, size);
  if (void* const memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
