# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
World files, drawing files, and the files that ship with the package.

Not here: ROS and Rerun; the state of a world (`model.checkpoint`); the recognition of strokes
(`drawing`). Start with `world_file`, then `world_reader` and `world_writer`.
"""

from physsim_ros.files.directory_lock import DirectoryLock
from physsim_ros.files.drawing_file import BadDrawing, drawings, load_drawing
from physsim_ros.files.foreign import advice_on_xml, CONVERTED, kind_of
from physsim_ros.files.own_worlds import check_world_name, OwnWorlds
from physsim_ros.files.reading import finish_before_end, finish_files, fulfil, on_thread
from physsim_ros.files.regular_file import make_directory, read_bytes, read_parts, write_file
from physsim_ros.files.resources import shipped, title_of, user_directory
from physsim_ros.files.robot_files import shipped_robot, shipped_robots, with_shipped_robot
from physsim_ros.files.world_file import (
    find_world,
    hides_shipped,
    load_world,
    MOST_BYTES,
    save_world,
    shipped_lessons,
    shipped_worlds,
    user_lessons,
    user_worlds,
    worlds_in,
)
from physsim_ros.files.world_reader import robot_spawn, spawn_from, state_from
from physsim_ros.files.world_schema import BODY_KEYS, PROPERTIES, SETTINGS
from physsim_ros.files.world_writer import text_of, yaml_line
from physsim_ros.files.yaml12 import load_mapping

__all__ = [
    'BODY_KEYS',
    'CONVERTED',
    'MOST_BYTES',
    'PROPERTIES',
    'SETTINGS',
    'BadDrawing',
    'DirectoryLock',
    'OwnWorlds',
    'advice_on_xml',
    'check_world_name',
    'drawings',
    'find_world',
    'finish_before_end',
    'finish_files',
    'fulfil',
    'hides_shipped',
    'kind_of',
    'load_drawing',
    'load_mapping',
    'load_world',
    'make_directory',
    'on_thread',
    'read_bytes',
    'read_parts',
    'robot_spawn',
    'save_world',
    'shipped',
    'shipped_lessons',
    'shipped_robot',
    'shipped_robots',
    'shipped_worlds',
    'spawn_from',
    'state_from',
    'text_of',
    'title_of',
    'user_directory',
    'user_lessons',
    'user_worlds',
    'with_shipped_robot',
    'worlds_in',
    'write_file',
    'yaml_line',
]
