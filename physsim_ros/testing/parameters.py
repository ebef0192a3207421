# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The parameters of a world by name and type, so that an editor completes them and mypy checks them.

They are those of the declarations (`ros.parameters.table`), which have meaning, default and range.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypedDict

# tools: made by `make tables`
Tool = Literal[
    'none',
    'circle',
    'circle_diameter',
    'rectangle',
    'polygon',
    'wall',
    'anchor',
    'release',
    'pin',
    'axle',
    'delete',
    'spring',
    'rod',
    'rope',
    'pulley',
    'chain',
    'slider',
    'gear',
    'rack',
    'velocity',
    'gravity',
    'force',
    'knife',
]
# end: made by `make tables`


class Parameters(TypedDict, total=False):
    """Parameters of `PhysSim`; those that are left out have their defaults."""

    # parameters: made by `make tables`
    frame_id: str
    world_file: str
    world_dir: str
    lesson_dir: str
    physics_rate: float
    publish_rate: float
    speed: float
    fast_speed: float
    tool: Tool
    history: float
    history_memory: float
    publish_clock: bool
    publish_tf: bool
    map_resolution: float
    robot_tf: Literal['prefixed', 'namespaced', 'none']
    robots_in_past: Literal['follow', 'freeze']
    drive_timeout: float
    laser_beams: int
    laser_angle: Sequence[float]
    lockstep: float
    viewer: Literal['none', 'spawn', 'web', 'connect', 'auto']
    viewer_url: str
    record_file: str
    sketchpad: Literal['none', 'serve']
    sketchpad_address: str
    sketchpad_port: int
    sketchpad_frozen: bool
    sketchpad_locked: str
    gravity: Sequence[float]
    damping: float
    iterations: int
    bounds: Sequence[float]
    density: float
    friction: float
    elasticity: float
    floor_friction: float
    seed: int
    air_density: float
    air_viscosity: float
    air_drag: float
    wind: Sequence[float]
    gusts: float
    gust_time: float
    gravitation: float
    coulomb: float
    attraction_power: float
    softening: float
    datum: Sequence[float]
    command_timeout: float
    drag_force: float
    max_bodies: int
    max_shapes: int
    max_overlaps: int
    max_joints: int
    snap: float
    sketch_confidence: float
    regroup: float
    beautify: float
    wall_thickness: float
    draw_velocity: Sequence[float]
    draw_color: str


# end: made by `make tables`
