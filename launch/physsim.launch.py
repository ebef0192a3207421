# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A convenience for those who start everything by `ros2 launch`; nothing else needs it.

ros2 launch physsim_ros physsim.launch.py world_file:=car rviz:=true
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

# Parameters of the node that are arguments of the launch file, their defaults there, and meanings.
PARAMETERS = {
    'world_file': ('demo', 'a world, by name or path; physsim --help tells which there are'),
    'sketchpad': ('serve', 'serve: the page in the browser, whose address is printed; or none'),
    'viewer': ('auto', 'Rerun: none, spawn, web, connect or auto'),
}


def generate_launch_description() -> LaunchDescription:
    """Start a world, and RViz on it where argument `rviz` is true."""
    config = PathJoinSubstitution([FindPackageShare('physsim_ros'), 'config'])
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=meaning)
        for name, (default, meaning) in PARAMETERS.items()
    ]
    arguments += [
        DeclareLaunchArgument(
            'params_file',
            default_value=PathJoinSubstitution([config, 'physsim.yaml']),
            description='a file of all parameters, which the arguments above replace',
        ),
        DeclareLaunchArgument(
            'rviz', default_value='false', description='whether RViz is started'
        ),
    ]
    given = {
        name: ParameterValue(LaunchConfiguration(name), value_type=str) for name in PARAMETERS
    }
    world = Node(
        package='physsim_ros',
        executable='physsim',
        parameters=[LaunchConfiguration('params_file'), given],
        output='screen',
        emulate_tty=True,
    )
    rviz = Node(
        package='rviz2',
        executable='rviz2',
        arguments=['-d', PathJoinSubstitution([config, 'physsim.rviz'])],
        condition=IfCondition(LaunchConfiguration('rviz')),
    )
    return LaunchDescription([*arguments, world, rviz])
