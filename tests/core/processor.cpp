// SPDX-License-Identifier: MIT
#include "pinnquad/core/processor.hpp"

#include <doctest/doctest.h>

#include <string>

using pinnquad::runs_on_this_processor;
using pinnquad::detail::InstructionSetName;

TEST_CASE(
    "the name of an instruction set: a family, a letter per extension, and fast-math, which asks nothing of a "
    "processor") {
  const auto parts = [](const char* name) {
    const InstructionSetName found(name);
    return std::string(found.family) + "|" + std::string(found.letters);
  };
  CHECK(parts("avx512_vqw") == "avx512_|vqw");
  CHECK(parts("avx512_vqwfast_math") == "avx512_|vqw");
  CHECK(parts("portable_fma_8") == "portable_fma_|8");
  CHECK(parts("sse2_") == "sse2_|");
  CHECK(parts("sse2_fast_math") == "sse2_|");
}

TEST_CASE("what this program was compiled for runs here, with fast-math too; what nobody has does not") {
  const std::string own(pinnquad::detail::instruction_set);
  CHECK(runs_on_this_processor(own));
#if defined(__x86_64__)
  CHECK(runs_on_this_processor(own + "fast_math"));
  CHECK_FALSE(runs_on_this_processor("avx9000_"));
#endif
}
