// SPDX-License-Identifier: MIT
//
// Two of three cases are wrong: each macro is one way in which a case can turn out.
// CASE GOOD: the rule, in plain words
// CASE COMPILES: the rule, in plain words
// CASE OTHER_REASON: the rule, in plain words
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
