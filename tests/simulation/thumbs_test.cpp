// SPDX-License-Identifier: MIT
#include "pinnquad/simulation/pilot.hpp"

#include <doctest/doctest.h>

#include <random>

using namespace pinnquad;

TEST_CASE("a frame is due when its time has come, to a microsecond") {
  pinnquad::detail::ThumbStyle style;
  style.frame_s = 0.004;
  std::mt19937_64 engine(1);
  Vector3<double> stick = Vector3<double>::Zero();
  pinnquad::detail::Thumbs thumbs(style);
  const auto moves = [&](double time_s) {
    const Vector3<double> before = stick;
    thumbs.move(engine, time_s, stick);
    return stick != before;
  };
  CHECK(moves(0));
  CHECK_FALSE(moves(0.002));
  CHECK_FALSE(moves(0.004 - 1.5e-6));
  CHECK(moves(0.004 - 0.9e-6));
  CHECK_FALSE(moves(0.004));
  CHECK(moves(0.008));
}
