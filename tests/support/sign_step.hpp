// SPDX-License-Identifier: MIT
// The sign as step function of local monotonicity: the paper's footnote 2 is stated with it.
#pragma once

namespace pinnquad {
namespace test {

/// Its slope is zero, so it can't train.
struct SignStep {
  template <class Array>
  void apply(Array& differences) const {
    differences = differences.sign();
  }
  template <class Array>
  Array slope(const Array& steps) const {
    return Array::Zero(steps.size());
  }
};

}  // namespace test
}  // namespace pinnquad
