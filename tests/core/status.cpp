// SPDX-License-Identifier: MIT
#include "pinnquad/core/status.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

using pinnquad::Status;

TEST_CASE("ok is zero, so that a Status can be tested like a return code") {
  static_assert(static_cast<int>(Status::ok) == 0);
  CHECK(std::string(pinnquad::to_string(Status::ok)) == "ok");
}

TEST_CASE("every Status has its own words and no other value has any") {
  std::set<std::string> words;
  const std::string unknown = "unknown status";
  int count = 0;
  while (pinnquad::to_string(static_cast<Status>(count)) != unknown) {
    words.insert(pinnquad::to_string(static_cast<Status>(count)));
    REQUIRE(++count < 256);
  }
  CHECK(static_cast<int>(words.size()) == count);
  CHECK(count == pinnquad::status_count);
  CHECK(pinnquad::to_string(static_cast<Status>(255)) == unknown);
}

TEST_CASE("words for logs say what is meant") {
  CHECK(std::string(pinnquad::to_string(Status::not_finite)) == "input not finite");
  CHECK(std::string(pinnquad::to_string(Status::not_unit_quaternion)) == "attitude is not a unit quaternion");
  CHECK(std::string(pinnquad::to_string(Status::outside_envelope)) == "outside the training envelope");
  CHECK(std::string(pinnquad::to_string(Status::output_not_finite)) == "output not finite");
  CHECK(std::string(pinnquad::to_string(Status::no_solution)) == "no solution");
  CHECK(std::string(pinnquad::to_string(Status::invalid_airframe)) == "invalid airframe");
  CHECK(std::string(pinnquad::to_string(Status::self_test_failed)) == "self test failed");
}

TEST_CASE("outputs are written under three Statuses and under no other") {
  int written = 0;
  for (int i = 0; i < pinnquad::status_count; ++i) written += pinnquad::has_output(static_cast<Status>(i)) ? 1 : 0;
  CHECK(written == 3);
  CHECK(pinnquad::has_output(Status::ok));
  CHECK(pinnquad::has_output(Status::limited));
  CHECK(pinnquad::has_output(Status::fell_back));
}
