// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cstddef>
#include <pinnquad/data/dataset.hpp>
#include <string>

using pinnquad::Sample;
using pinnquad::sample_field_names;

namespace {

Sample::Values counted_values() {
  Sample::Values values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 100.0 + static_cast<double>(i);
  return values;
}

}  // namespace

TEST_CASE("the columns are those of the recorded reference flights") {
  std::string header;
  for (const auto name : sample_field_names) header += (header.empty() ? "" : ",") + std::string(name);
  CHECK(
      header ==
      "t,vdot_bx,vdot_by,vdot_bz,wdot_x,wdot_y,wdot_z,v_bx,v_by,v_bz,w_x,w_y,w_z,roll,pitch,yaw,altitude,u1,u2,u3,u4");
}

TEST_CASE("every column lands in the field its name says") {
  const Sample::Values values = counted_values();
  const Sample sample = pinnquad::to_sample(values);
  const auto column = [&values](const std::string& name) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (sample_field_names[i] == name) return values[i];
    }
    return -1.0;
  };
  CHECK(sample.time_s == column("t"));
  const std::string axes = "xyz";
  for (int i = 0; i < 3; ++i) {
    const char axis = axes[static_cast<std::size_t>(i)];
    CHECK(sample.linear_acceleration_m_s2[i] == column(std::string("vdot_b") + axis));
    CHECK(sample.angular_acceleration_rad_s2[i] == column(std::string("wdot_") + axis));
    CHECK(sample.velocity_m_s[i] == column(std::string("v_b") + axis));
    CHECK(sample.body_rates_rad_s[i] == column(std::string("w_") + axis));
  }
  CHECK(sample.roll_rad == column("roll"));
  CHECK(sample.pitch_rad == column("pitch"));
  CHECK(sample.yaw_rad == column("yaw"));
  CHECK(sample.altitude_m == column("altitude"));
  for (std::size_t motor = 0; motor < 4; ++motor) {
    CHECK(sample.commands[motor] == column("u" + std::to_string(motor + 1)));
  }
}

TEST_CASE("flattening a sample and back changes nothing") {
  CHECK(pinnquad::to_values(pinnquad::to_sample(counted_values())) == counted_values());
  CHECK(pinnquad::to_values(Sample{}) == Sample::Values{});
}
