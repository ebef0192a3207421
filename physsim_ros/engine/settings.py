# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Settings of the world in the engine: gravity, damping, iterations, and the walls of `bounds`.

Under another gravity bodies wake and true velocities stay; a pile presses otherwise, and with the
cached impulses of the old gravity the solver would throw it up.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from physsim_ros.engine.stages.sleeping import enable_sleeping, wake_bodies
from physsim_ros.engine.tolerances import COLLISION_SLOP
from physsim_ros.engine.warm_start import scale_impulses
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.transform import Point
import pymunk

if TYPE_CHECKING:
    from physsim_ros.engine.space import Space


def make_engine() -> pymunk.Space:
    """Return an empty space of Pymunk."""
    engine = pymunk.Space()
    # Pymunk's own 0.1 is 10 cm in a metre world.
    engine.collision_slop = COLLISION_SLOP
    # Contacts of the last step only are listed, and those that parted are forgotten at once.
    engine.collision_persistence = 1
    enable_sleeping(engine)
    return engine


def apply_settings(space: Space, old: WorldSettings, new: WorldSettings) -> None:
    """Let a space go on under other settings."""
    if old.gravity != new.gravity:
        _change_gravity(space, old.gravity, new.gravity)
    space.engine.damping = 1.0 - new.damping
    space.engine.iterations = new.iterations
    walls = (new.bounds, new.friction, new.elasticity)
    if walls != (old.bounds, old.friction, old.elasticity):
        # A rebuilt wall has no cached impulses; bodies on it would lose their warm start.
        _rebuild_boundary(space, new)


def _change_gravity(space: Space, old: Point, new: Point) -> None:
    rigids = list(space.bodies.by_name.values())
    wake_bodies(rigid.engine for rigid in rigids)
    share = _pressing_share(old, new)
    if share < 1.0:
        scale_impulses(space.shapes, share)
    for rigid in rigids:
        # If no share is left, nothing rests on anything any more.
        if rigid.free or not (share or space.joints.has_joints(rigid.body.name)):
            rigid.set_twist(rigid.twist(old, space.dt, free=rigid.free), new, space.dt)
    space.engine.gravity = new


def _rebuild_boundary(space: Space, settings: WorldSettings) -> None:
    background = space.engine.static_body
    touching = space.bodies.touching(background)
    space.boundary.rebuild(settings)
    space.pipeline.forget_body(background.id)
    space.pipeline.half_step.release_bodies(touching)


def _pressing_share(old: Point, new: Point) -> float:
    """Return the share of the impulses under one gravity that bodies press with under another."""
    before = math.hypot(*old)
    if before == 0.0:
        return 1.0
    along = old[0] / before * new[0] + old[1] / before * new[1]
    # No more than all of it: the pull of springs, and impacts, do not grow with gravity.
    return min(max(along / before, 0.0), 1.0)
