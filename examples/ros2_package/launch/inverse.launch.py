# SPDX-License-Identifier: MIT
"""The inverse in a container of its own; a flight's other components may be loaded beside it."""
from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    inverse = ComposableNode(
        package="pinnquad_ros2",
        plugin="pinnquad_ros2::InverseNode",
        name="pinnquad_inverse",
        parameters=[{
            "state_age_limit_s": 0.02,
            "request_age_limit_s": 0.02,
            "beyond_limits": "clip",
            "when_refused": "report",
        }],
        remappings=[("odometry", "/odometry"), ("acceleration_wanted", "/acceleration_wanted")],
        extra_arguments=[{"use_intra_process_comms": True}],
    )
    return LaunchDescription([
        ComposableNodeContainer(
            name="flight",
            namespace="",
            package="rclcpp_components",
            executable="component_container",
            composable_node_descriptions=[inverse],
            output="screen",
        ),
    ])
