// SPDX-License-Identifier: MIT
/// \file
#pragma once

namespace pinnquad {

struct Bare {
  int value;
};

/// A type with a comment.
struct Commented {};

int bare(Bare);

/// A function with a comment.
int commented(Commented);

int commented(Bare);

namespace detail {
int inner(Bare);
}
}  // namespace pinnquad
