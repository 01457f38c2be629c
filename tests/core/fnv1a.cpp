// SPDX-License-Identifier: MIT
// Against hashes that the authors publish (Fowler, Noll, Vo: draft-eastlake-fnv, test vectors of 64 bit).
#include "pinnquad/core/fnv1a.hpp"

#include <doctest/doctest.h>

using pinnquad::detail::Fnv1a;

TEST_CASE("the published hashes of bytes; texts that follow each other keep their ends") {
  Fnv1a hash;
  CHECK(hash.hash == 0xcbf29ce484222325u);
  hash.absorb('a');
  CHECK(hash.hash == 0xaf63dc4c8601ec8cu);
  Fnv1a foobar;
  for (const char c : {'f', 'o', 'o', 'b', 'a', 'r'}) foobar.absorb(static_cast<unsigned char>(c));
  CHECK(foobar.hash == 0x85944171f73967e8u);

  const auto of = [](std::string_view first, std::string_view second) {
    Fnv1a texts;
    texts.absorb_text(first);
    texts.absorb_text(second);
    return texts.hash;
  };
  CHECK(of("ab", "c") != of("a", "bc"));
  CHECK(of("ab", "") != of("", "ab"));
  CHECK(of("a b", "c") == of("ab", "c"));
}
