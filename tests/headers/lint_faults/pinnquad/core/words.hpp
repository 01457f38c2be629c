// SPDX-License-Identifier: MIT
#pragma once
// To throw in a comment is no fault, nor is a static_assert or a deleted function.
// FAULT says 'virtual'
// FAULT says 'assert'
struct Planted {
  virtual int value(int number) {
    static_assert(sizeof(int) > 1, "nothing to throw here");
    assert(number > 0);
    return number;
  }
  Planted(const Planted&) = delete;
};
