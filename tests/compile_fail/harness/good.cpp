// SPDX-License-Identifier: MIT
//
// Cases as they should be: two that break a rule of their own type, and two that break it with one type, of which the
// compiler says once what is wrong.
// CASE FIRST: the first rule
// CASE SECOND: the second rule
// CASE SHARED: the shared rule
// CASE SHARED_AGAIN: the shared rule
#include <type_traits>

template <class Type>
struct Ruled {
  static_assert(!std::is_same_v<Type, float>, "the shared rule");
};

int main() {
#if defined(FIRST)
  static_assert(sizeof(int) == 0, "the first rule");
#elif defined(SECOND)
  static_assert(sizeof(int) == 0, "the second rule");
#elif defined(SHARED) || defined(SHARED_AGAIN)
  return static_cast<int>(sizeof(Ruled<float>));
#endif
  return 0;
}
