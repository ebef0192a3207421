# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Topics of robots: commands in, odometry and readings of sensors out.

A robot has its topics below its namespace while its body is in the scene (`scene_robots`). Start
with `fleet`: all robots of the world; `commands` submits their commands, `robot_topics` has those
of one robot, `robot_messages` its messages, `timed_topic` a topic with a rate and a latency,
`drive_topic` its `cmd_vel`, `type_choice` the type of that, `motor_topics` those of its motors,
`lockstep` the wait for commands, `messages` a function for each kind of reading, `frames` the
names of its frames and their transforms, `description` its URDF. A new sensor is a function in
`messages` and a line in its table.
"""

from physsim_ros.ros.robots.fleet import Fleet

__all__ = ['Fleet']
