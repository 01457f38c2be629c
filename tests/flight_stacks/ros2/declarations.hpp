// SPDX-License-Identifier: MIT
// A stand-in of what examples/ros2_package uses of ROS 2, as its documentation has it: with it the node is compiled and
// run. Nothing is said of rclcpp itself.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace builtin_interfaces::msg {
struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
}  // namespace builtin_interfaces::msg

namespace std_msgs::msg {
struct Header {
  builtin_interfaces::msg::Time stamp;
  std::string frame_id;
};
}  // namespace std_msgs::msg

namespace geometry_msgs::msg {
struct Vector3 {
  double x = 0, y = 0, z = 0;
};
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
struct AccelStamped {
  std_msgs::msg::Header header;
  struct {
    Vector3 linear, angular;
  } accel;
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

/// The message that rosidl makes of examples/ros2_package/msg/MotorCommands.msg.
namespace pinnquad_ros2::msg {
struct MotorCommands {
  std_msgs::msg::Header header;
  std::array<float, 4> commands{};
  std::string status;
  float beyond_envelope = 0;
  std::string worst_feature;
  float squared_distance = 0;
};
}  // namespace pinnquad_ros2::msg

namespace rcl_interfaces::msg {
struct ParameterDescriptor {
  struct Range {
    double from_value = 0, to_value = 0, step = 0;
  };
  std::string description, additional_constraints;
  bool read_only = false;
  std::vector<Range> floating_point_range;
};
}  // namespace rcl_interfaces::msg

namespace rclcpp {
/// Messages and listeners, by topic; the time of all; what was logged, and described of parameters.
struct Graph {
  std::map<std::string, std::function<void(const void*)>> listens;
  std::map<std::string, std::vector<pinnquad_ros2::msg::MotorCommands>> sent;
  std::map<std::string, rcl_interfaces::msg::ParameterDescriptor> described;
  std::vector<std::string> warned;
  std::int64_t now_ns = 0;
};
inline Graph graph;

struct Time {
  std::int64_t ns = 0;
  std::int64_t nanoseconds() const { return ns; }
};
struct Clock {};
struct Logger {};
struct QoS {
  std::size_t depth = 5;
  bool reliable = false;
  QoS& keep_last(std::size_t wanted) {
    depth = wanted;
    return *this;
  }
};
struct SensorDataQoS : QoS {};

template <class Message>
struct Publisher {
  using SharedPtr = std::shared_ptr<Publisher>;
  std::string topic;
  void publish(const Message& message) { graph.sent[topic].push_back(message); }
};
template <class Message>
struct Subscription {
  using SharedPtr = std::shared_ptr<Subscription>;
};

struct NodeOptions {
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> words;
};

class Node {
 public:
  Node(const std::string& /*name*/, const NodeOptions& options) : options_(options) {}
  virtual ~Node() = default;
  Time now() const { return {graph.now_ns}; }
  Logger get_logger() const { return {}; }
  std::shared_ptr<Clock> get_clock() { return std::make_shared<Clock>(); }

  template <class Value>
  Value declare_parameter(const std::string& name, const Value& value,
                          const rcl_interfaces::msg::ParameterDescriptor& descriptor) {
    graph.described[name] = descriptor;
    if constexpr (std::is_same_v<Value, std::string>) {
      const auto found = options_.words.find(name);
      return found == options_.words.end() ? value : found->second;
    } else {
      const auto found = options_.numbers.find(name);
      const Value set = found == options_.numbers.end() ? value : found->second;
      for (const auto& range : descriptor.floating_point_range) {
        if (set < range.from_value || set > range.to_value) throw std::runtime_error(name + " is out of its range");
      }
      return set;
    }
  }
  template <class Message>
  std::shared_ptr<Publisher<Message>> create_publisher(const std::string& topic, const QoS& qos) {
    if (qos.reliable || qos.depth != 1) throw std::logic_error(topic + ": expected the newest, best effort");
    return std::make_shared<Publisher<Message>>(Publisher<Message>{topic});
  }
  template <class Message>
  std::shared_ptr<Subscription<Message>> create_subscription(const std::string& topic, const QoS& qos,
                                                             std::function<void(const Message&)> callback) {
    if (qos.reliable || qos.depth != 1) throw std::logic_error(topic + ": expected the newest, best effort");
    graph.listens[topic] = [callback](const void* message) { callback(*static_cast<const Message*>(message)); };
    return std::make_shared<Subscription<Message>>();
  }

 private:
  NodeOptions options_;
};

/// The registered component.
std::shared_ptr<Node> make_component(const NodeOptions& options);

inline void warn(const Logger& /*logger*/, const Clock& /*clock*/, const char* why) { graph.warned.push_back(why); }
}  // namespace rclcpp

#define RCLCPP_WARN_THROTTLE(logger, clock, period_ms, format, why) rclcpp::warn(logger, clock, why)
#define RCLCPP_COMPONENTS_REGISTER_NODE(Type)                                        \
  std::shared_ptr<rclcpp::Node> rclcpp::make_component(const NodeOptions& options) { \
    return std::make_shared<Type>(options);                                          \
  }
