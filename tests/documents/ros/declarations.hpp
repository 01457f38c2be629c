// SPDX-License-Identifier: MIT
// A stand-in of what docs/ros2.md uses of ROS 2, as its documentation has it: with it the document's node is compiled
// against pinnquad's own names and run (run.cpp). Nothing is said of rclcpp itself.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace std_msgs::msg {
struct Header {
  struct Stamp {
    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
  } stamp;
};
struct Float32MultiArray {
  std::vector<float> data;
};
}  // namespace std_msgs::msg

namespace geometry_msgs::msg {
struct Vector3 {
  double x = 0, y = 0, z = 0;
};
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
struct Accel {
  Vector3 linear, angular;
};
}  // namespace geometry_msgs::msg

namespace nav_msgs::msg {
struct Odometry {
  std_msgs::msg::Header header;
  struct {
    struct {
      geometry_msgs::msg::Quaternion orientation;
    } pose;
  } pose;
  struct {
    struct {
      geometry_msgs::msg::Vector3 linear, angular;
    } twist;
  } twist;
};
}  // namespace nav_msgs::msg

enum rcl_clock_type_t { RCL_ROS_TIME };

namespace rclcpp {
struct Duration {
  std::int64_t ns = 0;
  double seconds() const { return 1e-9 * static_cast<double>(ns); }
};
struct Time {
  std::int64_t ns = 0;
  Time(std::int32_t seconds, std::uint32_t nanoseconds, rcl_clock_type_t /*type*/)
      : ns(std::int64_t{1'000'000'000} * seconds + nanoseconds) {}
  Time(const std_msgs::msg::Header::Stamp& stamp, rcl_clock_type_t type) : Time(stamp.sec, stamp.nanosec, type) {}
  Duration operator-(const Time& other) const { return {ns - other.ns}; }
  std::int64_t nanoseconds() const { return ns; }
  rcl_clock_type_t get_clock_type() const { return RCL_ROS_TIME; }
};
struct Clock {
  rcl_clock_type_t get_clock_type() const { return RCL_ROS_TIME; }
};
struct SensorDataQoS {};

/// Messages and listeners, by topic; the time of all.
struct Graph {
  std::map<std::string, std::function<void(const void*)>> listens;
  std::map<std::string, int> sent;
  std::int64_t now_ns = 0;
};
inline Graph graph;

template <class Message>
struct Publisher {
  std::string topic;
  void publish(const Message& /*message*/) { ++graph.sent[topic]; }
};
struct Subscription {};
struct Node {
  explicit Node(const std::string& /*name*/) {}
  std::shared_ptr<Clock> get_clock() { return std::make_shared<Clock>(); }
  Time now() {
    Time time(0, 0, RCL_ROS_TIME);
    time.ns = graph.now_ns;
    return time;
  }
  template <class Message>
  std::shared_ptr<Publisher<Message>> create_publisher(const std::string& topic, const SensorDataQoS& /*qos*/) {
    return std::make_shared<Publisher<Message>>(Publisher<Message>{topic});
  }
  template <class Message>
  std::shared_ptr<Subscription> create_subscription(const std::string& topic, const SensorDataQoS& /*qos*/,
                                                    std::function<void(const Message&)> callback) {
    graph.listens[topic] = [callback](const void* message) { callback(*static_cast<const Message*>(message)); };
    return std::make_shared<Subscription>();
  }
};
inline void init(int /*argc*/, char** /*argv*/) {}
/// The messages of a flight, in run.cpp.
void spin(const std::shared_ptr<Node>& node);
}  // namespace rclcpp
