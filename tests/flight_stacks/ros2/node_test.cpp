// SPDX-License-Identifier: MIT
// The component of examples/ros2_package against declarations.hpp: its topics, its parameters, and its message.
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "declarations.hpp"
#include "pinnquad/version.hpp"

namespace {

using Commands = pinnquad_ros2::msg::MotorCommands;

struct Flown {
  std::shared_ptr<rclcpp::Node> node;

  explicit Flown(const rclcpp::NodeOptions& options = {}) {
    rclcpp::graph = {};
    rclcpp::graph.now_ns = 5'000'000'000;
    node = rclcpp::make_component(options);
  }
  template <class Message>
  void send(const char* topic, const Message& message) {
    REQUIRE(rclcpp::graph.listens.count(topic) == 1);
    rclcpp::graph.listens[topic](&message);
  }
  /// Odometry, then a request, both of now unless `stamp_s` says another second of the odometry.
  const std::vector<Commands>& ask(double roll_acceleration_rad_s2, std::int32_t stamp_s = 5) {
    nav_msgs::msg::Odometry odometry;
    odometry.header.stamp.sec = stamp_s;
    send("odometry", odometry);
    geometry_msgs::msg::AccelStamped wanted;
    wanted.header.stamp.sec = 5;
    wanted.header.frame_id = "base_link";
    wanted.accel.angular.x = roll_acceleration_rad_s2;
    send("acceleration_wanted", wanted);
    return rclcpp::graph.sent["motor_commands"];
  }
};

TEST_CASE("ros2: a request is answered with the stamp of the request") {
  Flown flown;
  const std::vector<Commands>& sent = flown.ask(5);
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].status == "ok");
  CHECK(sent[0].header.stamp.sec == 5);
  CHECK(sent[0].header.frame_id == "base_link");
  // the quickstart's roll: facing east in place of north is the same to the rotors
  CHECK(sent[0].commands[1] > sent[0].commands[0] + 0.01f);
  CHECK(sent[0].commands[2] > sent[0].commands[3] + 0.01f);
  CHECK(rclcpp::graph.warned.empty());
}

TEST_CASE("ros2: a refusal is a message of NaN, or silence, and a warning") {
  Flown flown;
  const std::vector<Commands>& sent = flown.ask(5, -7);  // rclcpp::Time would throw for it
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].status == "stale_state");
  CHECK(std::isnan(sent[0].commands[0]));
  CHECK(rclcpp::graph.warned == std::vector<std::string>{"stale_state"});
  rclcpp::NodeOptions silent;
  silent.words["when_refused"] = "silence";
  Flown silence(silent);
  CHECK(silence.ask(1e4).empty());
  CHECK(rclcpp::graph.warned == std::vector<std::string>{"outside_envelope"});
  CHECK(silence.ask(5).size() == 1);
}

TEST_CASE("ros2: parameters are described, read only, and refused beyond their range") {
  Flown flown;
  CHECK(rclcpp::graph.described.size() == 4);
  for (const auto& described : rclcpp::graph.described) {
    CAPTURE(described.first);
    const rcl_interfaces::msg::ParameterDescriptor& descriptor = described.second;
    CHECK(!descriptor.description.empty());
    CHECK(descriptor.read_only);
    CHECK(descriptor.floating_point_range.empty() != descriptor.additional_constraints.empty());
  }
  rclcpp::NodeOptions options;
  options.numbers["state_age_limit_s"] = 0;
  CHECK_THROWS(Flown{options});
  options = {};
  options.words["beyond_limits"] = "ignore";
  CHECK_THROWS_WITH(Flown{options}, "beyond_limits: expected clip or refuse, found 'ignore'");
}

TEST_CASE("ros2: the package has the library's version") {
  std::ifstream file(PINNQUAD_ROS2_PACKAGE "/package.xml");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  CHECK(text.find("<version>" PINNQUAD_VERSION "</version>") != std::string::npos);
}

TEST_CASE("ros2: the stand-in has the fields of the message") {
  std::ifstream file(PINNQUAD_ROS2_PACKAGE "/msg/MotorCommands.msg");
  std::vector<std::string> fields;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') fields.push_back(line);
  }
  CHECK(fields == std::vector<std::string>{"std_msgs/Header header", "float32[4] commands", "string status",
                                           "float32 beyond_envelope", "string worst_feature",
                                           "float32 squared_distance"});
}

}  // namespace
