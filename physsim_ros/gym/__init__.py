# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Environments of Gymnasium: an agent drives a robot of a world, for a reward.

Only a program that imports this folder imports Gymnasium (`pip install 'physsim_ros[gym]'`).
Start with `task`: what an agent is to do; `RobotEnv` is one world of it, `RobotVectorEnv` are many
in one process. docs/learning.md has an example.
"""

from physsim_ros.gym.robot_env import RobotEnv, SavedEpisode
from physsim_ros.gym.task import drive, observe_scan, Task
from physsim_ros.gym.vector_env import RobotVectorEnv

__all__ = ['RobotEnv', 'RobotVectorEnv', 'SavedEpisode', 'Task', 'drive', 'observe_scan']
