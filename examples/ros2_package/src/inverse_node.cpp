// SPDX-License-Identifier: MIT
// The component pinnquad_ros2::InverseNode: accelerations wanted -> motor commands, for the motion that odometry says.
#include <cstdint>
#include <stdexcept>
#include <string>

#include <geometry_msgs/msg/accel_stamped.hpp>
#include <nav_msgs/msg/odometry.hpp>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>

#include "pinnquad_ros2/msg/motor_commands.hpp"

#include "inverse_core.hpp"
#include "model.hpp"  // written by pinnquad train, with trust.hpp where limits of trust were found
#if __has_include("trust.hpp")
#include "trust.hpp"
using Core = pinnquad_ros2::InverseCore<TrainedQuadModel, pinnquad::JointDistance<TrainedQuadModelTrust>>;
#else
using Core = pinnquad_ros2::InverseCore<TrainedQuadModel>;
#endif

namespace pinnquad_ros2 {
namespace {

pinnquad::Vector3<float> vector(const geometry_msgs::msg::Vector3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// rclcpp::Time would throw for a stamp before 0.
std::int64_t nanoseconds(const builtin_interfaces::msg::Time& stamp) {
  return std::int64_t{1'000'000'000} * stamp.sec + stamp.nanosec;
}

}  // namespace

class InverseNode : public rclcpp::Node {
 public:
  explicit InverseNode(const rclcpp::NodeOptions& options) : Node("pinnquad_inverse", options) {
    Settings settings;
    settings.state_age_limit_s = age_limit("state_age_limit_s", settings.state_age_limit_s, "of the odometry's stamp");
    settings.request_age_limit_s =
        age_limit("request_age_limit_s", settings.request_age_limit_s, "of the stamp of acceleration_wanted");
    settings.clips = choice("beyond_limits", "clip", "refuse", "Commands that the model puts beyond 0 to 1");
    reports_refusals_ = choice("when_refused", "report", "silence",
                               "Instead of commands: a message of NaN with the reason, or no message");
    core_ = Core(settings);
    const pinnquad::Status tested = core_.self_test();
    if (tested != pinnquad::Status::ok) {
      throw std::runtime_error(std::string("model.hpp fails its self test: ") + pinnquad::to_string(tested));
    }

    const rclcpp::QoS newest = rclcpp::SensorDataQoS().keep_last(1);  // best effort: late is worse than lost
    commands_ = create_publisher<msg::MotorCommands>("motor_commands", newest);
    odometry_ = create_subscription<nav_msgs::msg::Odometry>(
        "odometry", newest, [this](const nav_msgs::msg::Odometry& odometry) { take(odometry); });
    wanted_ = create_subscription<geometry_msgs::msg::AccelStamped>(
        "acceleration_wanted", newest, [this](const geometry_msgs::msg::AccelStamped& wanted) { answer(wanted); });
  }

 private:
  /// Read once: a limit that moves in flight is no limit.
  double age_limit(const std::string& name, double value_s, const std::string& what) {
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.description = "Greatest age " + what + ", s";
    descriptor.read_only = true;
    descriptor.floating_point_range.resize(1);
    descriptor.floating_point_range[0].from_value = 0.001;
    descriptor.floating_point_range[0].to_value = 1;
    return declare_parameter<double>(name, value_s, descriptor);
  }

  /// True for the first of two words, which is the default.
  bool choice(const std::string& name, const std::string& first, const std::string& second, const std::string& what) {
    rcl_interfaces::msg::ParameterDescriptor descriptor;
    descriptor.description = what;
    descriptor.additional_constraints = first + " or " + second;
    descriptor.read_only = true;
    const std::string value = declare_parameter<std::string>(name, first, descriptor);
    if (value != first && value != second) {
      throw std::invalid_argument(name + ": expected " + first + " or " + second + ", found '" + value + "'");
    }
    return value == first;
  }

  /// Both callbacks are of the node's own group: they never run at once.
  void take(const nav_msgs::msg::Odometry& odometry) {
    const auto& q = odometry.pose.pose.orientation;
    Motion motion;
    motion.attitude = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                       static_cast<float>(q.z)};
    motion.velocity_m_s = vector(odometry.twist.twist.linear);
    motion.body_rates_rad_s = vector(odometry.twist.twist.angular);
    core_.set_motion(motion, nanoseconds(odometry.header.stamp));
  }

  void answer(const geometry_msgs::msg::AccelStamped& wanted) {
    const Answer answer = core_.answer(vector(wanted.accel.linear), vector(wanted.accel.angular),
                                       nanoseconds(wanted.header.stamp), now().nanoseconds());
    if (!answer.has_commands) {
      RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 1000, "no commands: %s", answer.status);
      if (!reports_refusals_) return;
    }
    msg::MotorCommands out;
    out.header = wanted.header;
    out.commands = answer.commands;
    out.status = answer.status;
    out.beyond_envelope = answer.beyond_envelope;
    out.worst_feature = answer.worst_feature;
    out.squared_distance = answer.squared_distance;
    commands_->publish(out);
  }

  Core core_;
  bool reports_refusals_{true};
  rclcpp::Publisher<msg::MotorCommands>::SharedPtr commands_;
  rclcpp::Subscription<nav_msgs::msg::Odometry>::SharedPtr odometry_;
  rclcpp::Subscription<geometry_msgs::msg::AccelStamped>::SharedPtr wanted_;
};

}  // namespace pinnquad_ros2

RCLCPP_COMPONENTS_REGISTER_NODE(pinnquad_ros2::InverseNode)
