// SPDX-License-Identifier: MIT
// Messages to the node of docs/ros2.md, and when it may answer: with a state of the last 20 ms alone.
#include <cstdio>
#include <cstdlib>

#include "declarations.hpp"

namespace {

constexpr double none_s = -1;

struct Asked {
  const char* what;
  double state_s;  ///< its stamp; none_s: no new one
  double now_s;
  bool answers;
};

constexpr Asked asked[] = {
    {"no state ever", none_s, 10, false},
    {"no state ever, before the first tick of a simulated clock", none_s, 0, false},
    {"a state of time 0, before the first tick of a simulated clock", 0, 0, false},
    {"a state of now", 10, 10, true},
    {"the same 19 ms later", none_s, 10.019, true},
    {"the same 21 ms later", none_s, 10.021, false},
    {"a state of the future", 10.06, 10.05, false},
    {"a state of now again", 10.1, 10.1, true},
    {"the clock has begun anew", none_s, 3, false},
    {"a state of 5 ms ago", 3.005, 3.010, true},
};

std::int64_t ns(double time_s) { return static_cast<std::int64_t>(1e9 * time_s + 0.5); }

template <class Message>
void send(const char* topic, const Message& message) {
  const auto listens = rclcpp::graph.listens.find(topic);
  if (listens == rclcpp::graph.listens.end()) {
    std::printf("nobody listens to %s\n", topic);
    std::exit(1);
  }
  listens->second(&message);
}

}  // namespace

void rclcpp::spin(const std::shared_ptr<Node>& /*node*/) {
  bool as_expected = true;
  for (const Asked& now : asked) {
    graph.now_ns = ns(now.now_s);
    if (now.state_s > none_s) {
      nav_msgs::msg::Odometry state;
      state.header.stamp.sec = static_cast<std::int32_t>(ns(now.state_s) / 1'000'000'000);
      state.header.stamp.nanosec = static_cast<std::uint32_t>(ns(now.state_s) % 1'000'000'000);
      send("odometry", state);
    }
    const int before = graph.sent["motor_commands"];
    send("acceleration_wanted", geometry_msgs::msg::Accel{});
    const bool answered = graph.sent["motor_commands"] > before;
    if (answered == now.answers) continue;
    std::printf("%s: %s\n", now.what, answered ? "commands" : "no commands");
    as_expected = false;
  }
  if (!as_expected) std::exit(1);
}
