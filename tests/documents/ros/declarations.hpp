// SPDX-License-Identifier: MIT
// Declarations of what docs/ros2.md uses of ROS 2, as its documentation has them: with them the document's node is compiled
// against pinnquad's own names. Nothing is defined here, and nothing is said of rclcpp itself.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace std_msgs::msg {
struct Header {
  struct Stamp {
  } stamp;
};
struct Float32MultiArray {
  std::vector<float> data;
};
}  // namespace std_msgs::msg

namespace geometry_msgs::msg {
struct Vector3 {
  double x, y, z;
};
struct Quaternion {
  double x, y, z, w;
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
  double seconds() const;
};
struct Time {
  Time(int seconds, unsigned nanoseconds, rcl_clock_type_t type);
  Time(const std_msgs::msg::Header::Stamp& stamp, rcl_clock_type_t type);
  Duration operator-(const Time& other) const;
  rcl_clock_type_t get_clock_type() const;
};
struct Clock {
  rcl_clock_type_t get_clock_type() const;
};
struct SensorDataQoS {};
template <class Message>
struct Publisher {
  void publish(const Message& message);
};
struct Subscription {};
struct Node {
  explicit Node(const std::string& name);
  std::shared_ptr<Clock> get_clock();
  Time now();
  template <class Message>
  std::shared_ptr<Publisher<Message>> create_publisher(const std::string& topic, const SensorDataQoS& qos);
  template <class Message>
  std::shared_ptr<Subscription> create_subscription(const std::string& topic, const SensorDataQoS& qos,
                                                    std::function<void(const Message&)> callback);
};
void init(int argc, char** argv);
void spin(const std::shared_ptr<Node>& node);
}  // namespace rclcpp
