// SPDX-License-Identifier: MIT
#include "pinnquad/schedule/settings.hpp"

#define CHECKED(...) \
  struct Policy {    \
    __VA_ARGS__      \
  };                 \
  void checked() { pinnquad::check_settings(Policy{}); }

// SOUND
CHECKED(void check() const {})

// CASE CHECK_RETURNS_A_BOOL: pinnquad: a policy's check.. must be
CHECKED(bool check() const { return true; })
// CASE CHECK_TAKES_A_VALUE: pinnquad: a policy's check.. must be
CHECKED(void check(double) const {})
// CASE CHECK_IS_NOT_CONST: pinnquad: a policy's check.. must be
CHECKED(void check(){})
