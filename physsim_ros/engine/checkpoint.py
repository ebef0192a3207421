# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Checkpoints: a space is read into immutable values, and another is built from these.

Two spaces built from one checkpoint go on alike to the bit. A space that has stepped and one that
is built from its checkpoint do not, since the engine has a past that cannot be read, such as the
order in which it has found contacts; that is why the live world goes on in a space rebuilt from
each checkpoint that is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
from physsim_ros.engine.bodies import BODY_STATE, RigidBody
from physsim_ros.engine.pymunk_bodies import build_body, scattered
from physsim_ros.engine.space import Space
from physsim_ros.engine.warm_start import read_impulses, write_impulses
from physsim_ros.model.checkpoint import Checkpoint
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.states import Records
from physsim_ros.runtime.garbage_collection import suspended_collection
from physsim_ros.runtime.slices import finish
import pymunk

_Entry = TypeVar('_Entry', Body, RigidBody, Joint)
# Pieces of bodies, or ends and guides of joints, in a slice of a rebuild: at most some 30 ms.
_SLICE = 500
# Pieces that are moved away from others before a step that clears contacts.
_CLEARED = 5000


def take_checkpoint(space: Space, step: int) -> Checkpoint:
    """
    Return the checkpoint of a space, which stays as it is.

    Sleeping bodies have no velocity in it; in a space that is built from it all bodies are awake.

    :param step: steps that the world has made
    """
    table, rigids = space.table, list(space.bodies.by_name.values())
    state, free, unsupported = space.core.read_state()
    return Checkpoint(
        step=step,
        scene=table.scene,
        state=state,
        free=free,
        thrown=table.thrown,
        wrenches=tuple(
            (table.columns.rows[rigid.body.name], rigid.wrench, rigid.wrench_until)
            for rigid in space.wrenched()
        ),
        memory=replace(
            read_impulses(
                space.shapes,
                sleeping=(rigid.pm_body for rigid in rigids if rigid.pm_body.is_sleeping),
                ids=[rigid.first_shape for rigid in rigids],
                walls=space.boundary.first_shape,
                without=[
                    number
                    for row in np.flatnonzero(unsupported).tolist()
                    for number in rigids[row].shape_numbers
                ],
                joints=space.joints.impulses(),
            ),
            totals=space.joints.totals(),
            pushes=table.pushes,
        ),
        field_leads=table.field_leads,
        grips=tuple(space.grips),
        unstepped=space.joints.unstepped(),
        commands=space.joints.all_commands,
        bounds=space.joints.bounds(),
        robots=table.robot_states,
        coming=tuple(
            (table.columns.rows[name], coming)
            for name, coming in space.commands.coming.in_order(space.bodies.by_name)
        ),
        actors=table.actor_states,
    )


@suspended_collection()
def restore_checkpoint(checkpoint: Checkpoint, dt: float) -> Space:
    """
    Return a space that is built from a checkpoint.

    :param dt: of a sub-step [s]
    """
    return finish(slices_of_restore(checkpoint, dt))


def slices_of_restore(
    checkpoint: Checkpoint, dt: float, *, pool: Mapping[str, RigidBody] | None = None
) -> Generator[None, None, Space]:
    """
    Build a space from a checkpoint; yield before each slice but the first, and return the space.

    :param dt: of a sub-step [s]
    :param pool: bodies built beforehand, by name, which are used up
    """
    slices, scene = _slices_of_restore(checkpoint, dt, pool or {}), checkpoint.scene
    if scene.piece_count + sum(map(_size, scene.joints)) <= _SLICE:
        return finish(slices)
    yield
    return (yield from slices)


def _slices_of_restore(
    checkpoint: Checkpoint, dt: float, pool: Mapping[str, RigidBody]
) -> Generator[None, None, Space]:
    scene, memory = checkpoint.scene, checkpoint.memory
    space = Space(scene.settings, dt, first_shape=memory.walls, lesson=scene.lesson)
    yield from _restore_bodies(space, checkpoint, pool)
    write_impulses(space.pm_space, space.shapes, memory, dt)
    space.core.write_state(checkpoint.state)
    yield
    yield from _restore_joints(space, checkpoint)
    for grip in checkpoint.grips:
        space.grips.put(grip)
    return space


def _restore_bodies(
    space: Space, checkpoint: Checkpoint, pool: Mapping[str, RigidBody]
) -> Iterator[None]:
    """Put the bodies of a checkpoint into a space, at rest; yield after each slice."""
    scene, memory = checkpoint.scene, checkpoint.memory
    rigids = []
    for bodies in _in_slices(scene.bodies, _SLICE):
        rigids += [_rigid_body(body, pool) for body in bodies]
        yield
    states = _body_states(checkpoint)
    for rigid, first_shape, state in zip(rigids, memory.ids.tolist(), states, strict=True):
        rigid.first_shape, rigid.state = first_shape, state
    for row, driven in zip(scene.robot_rows.tolist(), checkpoint.robots, strict=True):
        rigids[row].driven = driven
    for row, acting in zip(scene.actor_rows.tolist(), checkpoint.actors, strict=True):
        rigids[row].acting = acting
    for some in _in_slices(rigids, _SLICE):
        space.bodies.add_without_shapes(some)
        yield
    put_commands(space, rigids, checkpoint)
    space.tables.lay_out(scene)
    at_rest = checkpoint.state.copy()
    at_rest[:, 3:] = 0.0
    space.core.write_state(at_rest)
    yield
    order = sorted(range(len(rigids)), key=scattered)
    for some in _in_slices([rigids[row] for row in order], _SLICE):
        space.shapes.put_back((rigid.first_shape, rigid.pm_body.shapes) for rigid in some)
        yield


def put_commands(space: Space, rigids: Sequence[RigidBody], checkpoint: Checkpoint) -> None:
    """Put the wrenches that act, and the commands of drives that are on their way."""
    for row, wrench, until in checkpoint.wrenches:
        space.put_wrench(rigids[row], wrench, until)
    for row, coming in checkpoint.coming:
        space.commands.coming.put(rigids[row].body.name, coming)


def _restore_joints(space: Space, checkpoint: Checkpoint) -> Iterator[None]:
    """Put the joints of a checkpoint into a space that has its bodies; yield after each slice."""
    for joints in _in_slices(checkpoint.scene.joints, _SLICE):
        for joint in joints:
            space.joints.add(joint)
        yield
    space.joints.set_commands(checkpoint.commands, checkpoint.step)
    space.joints.set_unstepped(checkpoint.unstepped)
    space.joints.set_bounds(checkpoint.bounds)
    yield from space.joints.slices_of_table()
    space.tables.lay_out_joints()
    yield
    space.joints.set_impulses(checkpoint.memory.joints)
    space.joints.set_totals(checkpoint.memory.totals)


def _size(entry: Body | RigidBody | Joint) -> int:
    """Return the count of pieces of a body, or of ends and guides of a joint."""
    if isinstance(entry, Joint):
        return 2 + len(entry.guides)
    body = entry.body if isinstance(entry, RigidBody) else entry
    return len(body.shape.form.pieces)


def _in_slices(entries: Sequence[_Entry], most: int) -> Iterator[Sequence[_Entry]]:
    """Yield bodies or joints in order, some at once that together have about `most` pieces."""
    begin = size = 0
    for end, entry in enumerate(entries, 1):
        size += _size(entry)
        if size >= most or end == len(entries):
            yield entries[begin:end]
            begin, size = end, 0


def _body_states(checkpoint: Checkpoint) -> Records:
    """Return (n,) `BodyState`: the states with which bodies continue from a checkpoint."""
    states = np.zeros(len(checkpoint.scene.bodies), BODY_STATE)
    states['free'], states['thrown'], states['fresh'] = checkpoint.free, checkpoint.thrown, True
    if len(checkpoint.field_leads):
        known = ~np.isnan(checkpoint.field_leads[:, 0])
        states['field'][known], states['fresh'][known] = checkpoint.field_leads[known], False
    rows = np.flatnonzero(checkpoint.scene.floor_friction > 0.0)
    if len(checkpoint.memory.pushes) == len(rows):
        states['push'][rows] = checkpoint.memory.pushes
    return states


def _rigid_body(body: Body, pool: Mapping[str, RigidBody]) -> RigidBody:
    """Return the engine's objects of a body, from the pool if it has them."""
    rigid = pool.get(body.name)
    return rigid if rigid is not None and rigid.body is body else build_body(body)


class BodyPool:
    """
    Pymunk's bodies for the next rebuild of the world, made a few in each frame.

    They are outside any space, at rest and without contacts. To make a thousand bodies at once and
    to free as many takes three times as long as the rest of a checkpoint. Bodies of the space
    before this one are used again.

    :param retired: a space that is not used any more; None if there is none

    :ivar bodies: that are made, by name
    """

    def __init__(self, retired: Space | None = None) -> None:
        self.bodies: dict[str, RigidBody] = {}
        self._retired = retired
        self._clearing = iter(()) if retired is None else _slices_of_clearing(retired)
        self._has_contacts = retired is not None
        # The scene of the next rebuild, and the row of the next body to make.
        self._scene: Scene | None = None
        self._row = 0

    def is_complete(self, scene: Scene) -> bool:
        """Return whether all bodies of a scene are made, and those of the retired space used."""
        return self._scene is scene and self._row == len(scene.bodies)

    def slices_of_freeing(self) -> Iterator[None]:
        """Free the bodies and the retired space; yield after each slice."""
        yield from _slices_of_emptying(self.bodies, lambda: self.bodies.popitem()[1])
        if self._retired is not None:
            yield from _slices_of_freeing(self._retired)

    def build_bodies(self, scene: Scene, count: int) -> None:
        """Make further bodies of a scene, of about a number of pieces."""
        if self._retired is not None and self._retired.joints.by_name:
            self._retired.joints.take_out(count)
            return
        if self._has_contacts and self._retired is not None:
            # Not in the frame of the checkpoint, which takes long.
            self._has_contacts = next(self._clearing, self) is not self
            return
        while count > 0 and self._retired is not None and self._retired.bodies.by_name:
            rigid = _extract_body(self._retired)
            self.bodies[rigid.body.name] = rigid
            count -= _size(rigid)
        if scene is not self._scene:
            self._scene, self._row = scene, 0
        while count > 0 and self._row < len(scene.bodies):
            body = scene.bodies[self._row]
            spare = self.bodies.get(body.name)
            if spare is None or spare.body is not body:
                self.bodies[body.name] = build_body(body)
                count -= _size(body)
            self._row += 1


def slices_of_freeing(space: Space, pool: BodyPool) -> Iterator[None]:
    """
    Free a space that is not used any more, and its pool; yield after each slice.

    A small one is freed with the last reference to it, at once.
    """
    pieces = sum(map(_size, (*space.bodies.by_name.values(), *pool.bodies.values())))
    if pieces + len(space.joints.by_name) > _SLICE:
        yield from _slices_of_freeing(space)
        yield from pool.slices_of_freeing()


def _slices_of_freeing(space: Space) -> Iterator[None]:
    """Remove the joints and bodies of a space, and free them; yield after each slice."""
    while space.joints.by_name:
        space.joints.take_out(_SLICE)
        yield
    yield from _slices_of_clearing(space)
    for _ in _slices_of_emptying(space.bodies.by_name, lambda: _extract_body(space)):
        # Pymunk keeps shapes that were removed up to the next step.
        space.pm_space.step(space.dt)
        yield


def _slices_of_emptying(
    bodies: Mapping[str, RigidBody], take: Callable[[], RigidBody]
) -> Iterator[None]:
    """Take all bodies, one by one; yield after each slice."""
    size = 0
    while bodies:
        size += _size(take())
        if size >= _SLICE or not bodies:
            yield
            size = 0


def _slices_of_clearing(space: Space) -> Iterator[None]:
    """
    Clear the engine's contacts, by steps after each of which more bodies are far from all others.

    For each shape that is removed, Chipmunk searches all contacts that it caches. Yield after each
    slice; a world of few pieces has one.
    """
    rigids = list(space.bodies.by_name.values())
    places = iter(sorted(range(1, len(rigids) + 1), key=scattered))
    for some in _in_slices(rigids, _CLEARED):
        for rigid in some:
            rigid.pm_body.position = next(places) * 1e6, 0.0
            rigid.pm_body.velocity, rigid.pm_body.angular_velocity = (0.0, 0.0), 0.0
        space.pm_space.step(space.dt)
        yield


def _extract_body(space: Space) -> RigidBody:
    """Remove a body from a retired space and return it, at rest and without a wrench."""
    # The table holds all bodies.
    space.tables.drop()
    _, rigid = space.bodies.by_name.popitem()
    space.bodies.take_out(rigid)
    # The last step left a bias velocity, by which the next one would push overlaps apart.
    pymunk.Body.update_position(rigid.pm_body, 0.0)
    return RigidBody(rigid.body, rigid.pm_body, rigid.handles)
