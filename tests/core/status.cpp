// SPDX-License-Identifier: MIT
#include "pinnquad/core/status.hpp"

#include <doctest/doctest.h>

#include <iterator>
#include <set>
#include <string>

using pinnquad::Status;

TEST_CASE("ok is zero, so that a Status can be tested like a return code") {
  static_assert(static_cast<int>(Status::ok) == 0);
  CHECK(std::string(pinnquad::to_string(Status::ok)) == "ok");
}

TEST_CASE("every Status has its own word and no other value has any") {
  std::set<std::string> words;
  const std::string unknown = "unknown status";
  for (int i = 0; i < 256; ++i) {
    const std::string word = pinnquad::to_string(static_cast<Status>(i));
    CHECK((word == unknown) == (i == 15 || i >= pinnquad::status_count));
    if (word != unknown) CHECK(words.insert(word).second);
  }
}

#define PINNQUAD_NAMED(status) \
  Named { Status::status, #status }

TEST_CASE("a Status prints as the word that documents and code use: its enumerator") {
  struct Named {
    Status status;
    const char* name;
  };
  const Named all[] = {PINNQUAD_NAMED(ok),
                       PINNQUAD_NAMED(not_finite),
                       PINNQUAD_NAMED(out_of_range),
                       PINNQUAD_NAMED(not_unit_quaternion),
                       PINNQUAD_NAMED(outside_envelope),
                       PINNQUAD_NAMED(output_not_finite),
                       PINNQUAD_NAMED(no_solution),
                       PINNQUAD_NAMED(invalid_airframe),
                       PINNQUAD_NAMED(self_test_failed),
                       PINNQUAD_NAMED(outside_limits),
                       PINNQUAD_NAMED(limited),
                       PINNQUAD_NAMED(fell_back),
                       PINNQUAD_NAMED(block_truncated),
                       PINNQUAD_NAMED(block_incompatible),
                       PINNQUAD_NAMED(block_corrupt),
                       PINNQUAD_NAMED(warming_up),
                       PINNQUAD_NAMED(outside_distribution),
                       PINNQUAD_NAMED(distrusted)};
  CHECK(std::size(all) == static_cast<std::size_t>(pinnquad::status_count) - 1);  // no Status is 15
  for (const Named& each : all) CHECK(std::string(pinnquad::to_string(each.status)) == each.name);
}

TEST_CASE("outputs are written under three Statuses and under no other") {
  int written = 0;
  for (int i = 0; i < pinnquad::status_count; ++i) written += pinnquad::has_output(static_cast<Status>(i)) ? 1 : 0;
  CHECK(written == 3);
  CHECK(pinnquad::has_output(Status::ok));
  CHECK(pinnquad::has_output(Status::limited));
  CHECK(pinnquad::has_output(Status::fell_back));
}
