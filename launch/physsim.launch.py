# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A convenience for those who start everything by `ros2 launch`; nothing else needs it.

ros2 launch physsim_ros physsim.launch.py world_file:=car rviz:=true
ros2 launch physsim_ros physsim.launch.py namespace:=second sketchpad_port:=8766
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

# Parameters of the node that are arguments of the launch file: their defaults there, and meanings.
PARAMETERS = {
    'world_file': ('demo', 'a world, by name or path; physsim --help tells which there are'),
    'sketchpad': ('serve', 'the page, whose address is printed: serve or none'),
    'sketchpad_port': (8765, 'port of the page; if it is taken, one of the next 20'),
    'viewer': ('auto', 'Rerun: none, spawn, web, connect or auto'),
    'record_file': ('', 'a .rrd file to record into'),
}


def generate_launch_description() -> LaunchDescription:
    """Start a world, and RViz on it where argument `rviz` is true."""
    config = PathJoinSubstitution([FindPackageShare('physsim_ros'), 'config'])
    arguments = [
        DeclareLaunchArgument(name, default_value=str(default), description=meaning)
        for name, (default, meaning) in PARAMETERS.items()
    ]
    arguments += [
        DeclareLaunchArgument(
            'params_file',
            default_value=PathJoinSubstitution([config, 'physsim.yaml']),
            description='file of parameters; the arguments above override it',
        ),
        DeclareLaunchArgument('rviz', default_value='false', description='whether to start RViz'),
        DeclareLaunchArgument(
            'use_sim_time',
            default_value='true',
            description='whether RViz uses simulation time, which goes back in a rewind',
        ),
        DeclareLaunchArgument(
            'namespace',
            default_value='',
            description='namespace of the node and its topics; a second world needs another one',
        ),
    ]
    given = {
        name: ParameterValue(LaunchConfiguration(name), value_type=type(default))
        for name, (default, _) in PARAMETERS.items()
    }
    world = Node(
        package='physsim_ros',
        executable='physsim',
        namespace=LaunchConfiguration('namespace'),
        parameters=[LaunchConfiguration('params_file'), given],
        output='screen',
        emulate_tty=True,
    )
    rviz = Node(
        package='rviz2',
        executable='rviz2',
        arguments=['-d', PathJoinSubstitution([config, 'physsim.rviz'])],
        parameters=[{'use_sim_time': LaunchConfiguration('use_sim_time')}],
        condition=IfCondition(LaunchConfiguration('rviz')),
    )
    return LaunchDescription([*arguments, world, rviz])
