// SPDX-License-Identifier: MIT
#include "pinnquad/deploy/trust_writer.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <sstream>
#include <string>

using namespace pinnquad;

namespace {

FittedTrust small_trust() {
  FittedTrust trust;
  trust.distribution.mean = {0.5, -2};
  trust.distribution.whitening = {1, 0.25, 0.1};
  trust.squared_distance_limit = 30.5;
  trust.command_residual_factor = 0.2;
  trust.command_residual_limit = 0.05;
  trust.command_residual_cleared = 0.03;
  trust.update_period_s = 0.05;
  return trust;
}

}  // namespace

TEST_CASE("the limits stand beside the model as constants of its Scalar") {
  std::ostringstream out;
  write_trust<float>(out, "Model", small_trust(), 0xabcdefu);
  const std::string text = out.str();
  for (const char* line :
       {"struct ModelTrust {", "training_data_hash = 0x0000000000abcdef;",
        "std::array<float, 2> distribution_mean = {{0.5f, -2.0f}};",
        "std::array<float, 3> whitening = {{1.0f, 0.25f, 0.1f}};", "double squared_distance_limit = 30.5;",
        "double command_residual_factor = 0.2;", "double command_residual_limit = 0.05;",
        "double command_residual_cleared = 0.03;", "double update_period_s = 0.05;"}) {
    CAPTURE(line);
    CHECK(text.find(line) != std::string::npos);
  }
}

TEST_CASE("nothing is written of a name that is none, or of a number that the Scalar does not hold") {
  std::ostringstream out;
  CHECK_THROWS_AS(write_trust<float>(out, "no name", small_trust(), 1), std::invalid_argument);
  auto trust = small_trust();
  trust.distribution.whitening[1] = 1e39;
  CHECK_THROWS_AS(write_trust<float>(out, "Model", trust, 1), std::invalid_argument);
  trust = small_trust();
  trust.command_residual_limit = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(write_trust<float>(out, "Model", trust, 1), std::invalid_argument);
  CHECK(out.str().empty());
}
