// SPDX-License-Identifier: MIT
// CASE CHECK_RETURNS_A_BOOL: pinnquad: a policy's check.. must be
// CASE CHECK_TAKES_A_VALUE: pinnquad: a policy's check.. must be
// CASE CHECK_IS_NOT_CONST: pinnquad: a policy's check.. must be
#include "pinnquad/schedule/settings.hpp"

namespace {

struct Policy {
#if defined(CHECK_RETURNS_A_BOOL)
  bool check() const { return true; }
#elif defined(CHECK_TAKES_A_VALUE)
  void check(double) const {}
#elif defined(CHECK_IS_NOT_CONST)
  void check() {}
#else
  void check() const {}
#endif
};

}  // namespace

int main() { pinnquad::check_settings(Policy{}); }
