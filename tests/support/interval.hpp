// SPDX-License-Identifier: MIT
// Interval arithmetic with directed rounding: every result encloses all real results of numbers in its operands. Each
// operation sets the processor's rounding, and its operands are volatile, so that no compiler works it out or moves it.
#pragma once

#include <algorithm>
#include <cfenv>

namespace pinnquad::test {

class Interval {
 public:
  Interval() = default;
  Interval(double value) : lower_(value), upper_(value) {}  // NOLINT: a number is an interval
  Interval(double lower, double upper) : lower_(lower), upper_(upper) {}

  double lower() const { return lower_; }
  double upper() const { return upper_; }
  bool contains(double value) const { return lower_ <= value && value <= upper_; }

  friend Interval operator+(const Interval& a, const Interval& b) {
    return {rounded<Add>(FE_DOWNWARD, a.lower_, b.lower_), rounded<Add>(FE_UPWARD, a.upper_, b.upper_)};
  }
  friend Interval operator-(const Interval& a) { return {-a.upper_, -a.lower_}; }
  friend Interval operator-(const Interval& a, const Interval& b) { return a + -b; }
  friend Interval operator*(const Interval& a, const Interval& b) { return over_corners<Multiply>(a, b); }
  /// `b` does not hold 0.
  friend Interval operator/(const Interval& a, const Interval& b) { return over_corners<Divide>(a, b); }

 private:
  struct Add {
    static double of(double a, double b) { return a + b; }
  };
  struct Multiply {
    static double of(double a, double b) { return a * b; }
  };
  struct Divide {
    static double of(double a, double b) { return a / b; }
  };
  template <class Operation>
  static double rounded(int mode, double a, double b) {
    const volatile double x = a, y = b;
    const int before = std::fegetround();
    std::fesetround(mode);
    const double first = x, second = y;
    const volatile double result = Operation::of(first, second);
    std::fesetround(before);
    return result;
  }
  template <class Operation>
  static Interval over_corners(const Interval& a, const Interval& b) {
    double lower = rounded<Operation>(FE_DOWNWARD, a.lower_, b.lower_),
           upper = rounded<Operation>(FE_UPWARD, a.lower_, b.lower_);
    for (const double x : {a.lower_, a.upper_}) {
      for (const double y : {b.lower_, b.upper_}) {
        lower = std::min(lower, rounded<Operation>(FE_DOWNWARD, x, y));
        upper = std::max(upper, rounded<Operation>(FE_UPWARD, x, y));
      }
    }
    return {lower, upper};
  }

  double lower_ = 0, upper_ = 0;
};

/// All values of max(0, v), and of v clipped to a range.
inline Interval clipped(const Interval& v, double lower, double upper) {
  return {std::min(std::max(v.lower(), lower), upper), std::min(std::max(v.upper(), lower), upper)};
}

}  // namespace pinnquad::test
