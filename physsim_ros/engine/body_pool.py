# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Body pool: Pymunk's bodies for the next rebuild of the world, made a few in each frame.

To make a thousand bodies at once and to free as many takes three times as long as the rest of a
checkpoint. Bodies of the space before this one are used again.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import body as rigid_body
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_set import wake_bodies
from physsim_ros.engine.space import Space
from physsim_ros.model.scene import Scene
import pymunk


class BodyPool:
    """
    Bodies outside any space, at rest and without contacts.

    :param retired: a space that is not used any more; None if there is none
    """

    def __init__(self, retired: Space | None = None) -> None:
        self.bodies: dict[str, RigidBody] = {}
        self._retired = retired
        self._has_contacts = retired is not None
        # The scene of the next rebuild, and the row of the next body to make.
        self._scene: Scene | None = None
        self._row = 0

    def is_complete(self, scene: Scene) -> bool:
        """Return whether all bodies of a scene are made, and those of the retired space used."""
        return self._scene is scene and self._row == len(scene.bodies)

    def build_bodies(self, scene: Scene, count: int) -> None:
        """Make up to a number of further bodies of a scene."""
        if self._retired is not None and self._retired.joints.by_name:
            self._retired.joints.take_out(count)
            return
        if self._has_contacts and self._retired is not None:
            # Not in the frame of the checkpoint, which takes long.
            _clear_contacts(self._retired)
            self._has_contacts = False
            return
        while count and self._retired is not None and self._retired.bodies.by_name:
            rigid = _extract_body(self._retired)
            self.bodies[rigid.body.name] = rigid
            count -= 1
        if scene is not self._scene:
            self._scene, self._row = scene, 0
        while count and self._row < len(scene.bodies):
            body = scene.bodies[self._row]
            spare = self.bodies.get(body.name)
            if spare is None or spare.body is not body:
                self.bodies[body.name] = rigid_body.build(body)
                count -= 1
            self._row += 1


def _clear_contacts(space: Space) -> None:
    """
    Clear the engine's contacts, by a step with all bodies far from each other.

    For each shape that is removed, Chipmunk searches all contacts that it caches.
    """
    rigids = space.bodies.by_name.values()
    wake_bodies(rigid.pm_body for rigid in rigids)
    state = np.zeros((len(rigids), 6))
    # In random order: in ascending order the engine's tree is as deep as there are bodies, and
    # 20,000 took 4 s.
    state[:, 0] = np.random.default_rng(0).permutation(len(rigids)) * 1e6
    space.core.write_state(state)
    space.pm_space.step(space.dt)


def _extract_body(space: Space) -> RigidBody:
    """Remove a body from a retired space and return it, at rest and without a wrench."""
    rigid = space.bodies.by_name.popitem()[1]
    space.shapes.remove(rigid.pm_body.shapes)
    space.pm_space.remove(rigid.pm_body)
    # The last step left a bias velocity, by which the next one would push overlaps apart.
    pymunk.Body.update_position(rigid.pm_body, 0.0)
    return RigidBody(rigid.body, rigid.pm_body)
