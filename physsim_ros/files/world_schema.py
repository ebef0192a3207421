# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Keys of world files."""

from __future__ import annotations

from dataclasses import fields

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import SHAPES

FORMAT = 1
# Limits protect the node, whatever files say.
LIMITS = ('max_bodies', 'max_shapes', 'max_overlaps', 'max_joints')
SETTINGS = [each.name for each in fields(WorldSettings) if each.name not in LIMITS]
PROPERTIES = [each.name for each in fields(Properties)]
WORLD_KEYS = ['format', 'bodies', 'joints', 'memory', *SETTINGS]
BODY_KEYS = ['name', *SHAPES, 'at', 'color', 'lifetime', *PROPERTIES, 'motion', 'wrench']
# Keys of a joint that the text of a marker does not have.
OWN_JOINT_KEYS = ['name', 'points', 'seat']
# Parameters of the node that are no settings of a world.
PARAMETERS = frozenset(
    {
        'beautify',
        'draw_color',
        'draw_velocity',
        'fast_speed',
        'frame_id',
        'history',
        'history_memory',
        *LIMITS,
        'physics_rate',
        'publish_clock',
        'publish_rate',
        'publish_tf',
        'record_file',
        'regroup',
        'sketch_confidence',
        'sketchpad',
        'sketchpad_address',
        'sketchpad_port',
        'snap',
        'speed',
        'tool',
        'viewer',
        'trace',
        'viewer_url',
        'wall_thickness',
        'world_dir',
        'world_file',
    }
)
