// SPDX-License-Identifier: MIT
// Whom a module that gives up asks to take over (examples/px4_module/takeover.hpp).
#include "px4_module/takeover.hpp"

#include <doctest/doctest.h>

using pinnquad_px4::FailsafeFlags;
using pinnquad_px4::Takeover;

namespace {

constexpr std::uint32_t bit(std::uint8_t mode) { return std::uint32_t{1} << mode; }

FailsafeFlags needs() {
  FailsafeFlags flags;
  flags.mode_req_local_position = bit(Takeover::hold) | bit(Takeover::position);
  flags.mode_req_local_alt = flags.mode_req_local_position | bit(Takeover::altitude);
  flags.mode_req_manual_control = bit(Takeover::altitude) | bit(Takeover::position);
  return flags;
}

std::uint8_t first(const FailsafeFlags& flags, bool position_stale) {
  Takeover takeover;
  return takeover.ask(1'000'000, flags, position_stale);
}

}  // namespace

TEST_CASE("the best mode whose needs are met; Descend where nothing else is") {
  FailsafeFlags flags = needs();
  CHECK(first(flags, false) == Takeover::hold);
  CHECK(first(flags, true) == Takeover::altitude);
  flags.local_position_invalid = true;
  CHECK(first(flags, false) == Takeover::altitude);
  flags.manual_control_signal_lost = true;
  CHECK(first(flags, false) == Takeover::descend);
  flags = needs();
  flags.local_altitude_invalid = true;
  CHECK(first(flags, false) == Takeover::descend);
  flags = needs();
  flags.manual_control_signal_lost = true;
  CHECK(first(flags, false) == Takeover::hold);
  CHECK(first(flags, true) == Takeover::descend);
}

TEST_CASE("not heard: each mode for a while, then the next, Descend for ever; heard, it begins anew") {
  const FailsafeFlags flags = needs();
  Takeover takeover;
  std::uint64_t now_us = 5'000'000;
  const std::uint8_t expected[] = {Takeover::hold, Takeover::position, Takeover::altitude, Takeover::descend};
  for (const std::uint8_t mode : expected) {
    for (std::uint64_t waited_us = 0; waited_us <= Takeover::patience_us; waited_us += 1000, now_us += 1000) {
      REQUIRE(takeover.ask(now_us, flags, false) == mode);
    }
  }
  now_us += 10'000'000;
  CHECK(takeover.ask(now_us, flags, false) == Takeover::descend);
  takeover.heard();
  CHECK_FALSE(takeover.asking());
  CHECK(takeover.ask(now_us, flags, false) == Takeover::hold);
}
