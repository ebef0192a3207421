# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Body pool: engine bodies made ready for the next rebuild of the world, a few in every frame.

To build a thousand bodies at once, and to throw as many away, takes three times as long as all the
rest of a checkpoint. The bodies of the space before this one are used again.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import body as rigid_body
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.engine.stages.sleeping import wake_bodies
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import NO_WRENCH
import pymunk


class BodyPool:
    """
    Bodies outside any space, at rest and without contacts.

    :param retired: a space that is used no more; None is none
    """

    def __init__(self, retired: Space | None = None) -> None:
        self.bodies: dict[str, RigidBody] = {}
        self._retired = retired
        if retired is not None:
            _clear_contacts(retired)
        # The scene that is being built, and the row of the next body to look for.
        self._scene: Scene | None = None
        self._row = 0

    def build_bodies(self, scene: Scene, count: int) -> None:
        """Build up to a number of further bodies of a scene."""
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
                self.bodies[body.name] = rigid_body.build(body, self._row)
                count -= 1
            self._row += 1


def _clear_contacts(space: Space) -> None:
    """
    Clear the contacts of the engine, by a step with all bodies far from each other.

    For each shape that is removed it goes through all contacts that it remembers.
    """
    space.joints.clear()
    rigids = space.bodies.by_name.values()
    wake_bodies(rigid.engine for rigid in rigids)
    state = np.zeros((len(rigids), 6))
    # In an order at random, since those in ascending order make the engine's tree as deep as there
    # are bodies: 20,000 took 4 s.
    state[:, 0] = np.random.default_rng(0).permutation(len(rigids)) * 1e6
    space.table.write_state(state)
    space.engine.step(space.dt)


def _extract_body(space: Space) -> RigidBody:
    """Remove a body from a retired space and return it, at rest and without a wrench."""
    rigid = space.bodies.by_name.popitem()[1]
    space.shapes.remove(rigid.engine.shapes)
    space.engine.remove(rigid.engine)
    # The last step has left a velocity by which the next one pushes overlaps apart.
    pymunk.Body.update_position(rigid.engine, 0.0)
    rigid.wrench, rigid.wrench_until, rigid.free = NO_WRENCH, None, True
    return rigid
