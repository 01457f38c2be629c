// SPDX-License-Identifier: MIT
//
// The harness is tried on this source: each macro is one way in which a case can turn out.
int main() {
#if defined(GOOD)
  static_assert(sizeof(int) == 0, "the rule, in plain words");
#elif defined(COMPILES)
  static_assert(sizeof(int) > 0, "the rule, in plain words");
#elif defined(OTHER_REASON)
  return undeclared;  // the rule, in plain words: quoted by the compiler, but not its message
#endif
  return 0;
}
