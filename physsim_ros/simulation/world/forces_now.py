# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The forces in a world that has made no step since it was opened or changed.

Contacts, joints, media and attraction have the forces of a copy of the world, which makes a few
steps; the world itself is not touched. Bodies that rest on each other are placed with a gap of
some micrometres, or overlap as much: in the first steps of the copy they come to rest, without a
bounce. The forces are those of the first step whose contacts are those of the step before, with
the same impulses; joints need a step, too.

Law: an impact is not a force at rest: what approaches has no contact before it touches.

Limit: loads of bodies that rest are those that later steps report to 0.1 %, in a stack of three
equal boxes to 0.2 %, of five to 0.5 %, of ten to 30 %: nine steps do not bring it to rest.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.model.transform import norms
from physsim_ros.simulation.world.world import World

# Bodies of a world whose forces are solved: a copy of 200 takes some milliseconds of the frame in
# which it is made, wherever its bodies are. The limit changes no motion: the forces of a larger
# world are known from its first step on.
MOST_BODIES = 200
# Steps in which what rests has fallen through its gap, of up to 0.3 mm; what touches later falls.
_TOUCHING = 2
# Steps in which bodies come to rest on each other.
_STEPS = 9
# Greatest change of the impulse of a contact from one step to the next while it rests, as a share.
_SETTLED = 1e-3
# Approach of two bodies above which their contact is an impact [m/s]; falling through a gap of
# 0.1 mm gives 0.04 m/s.
_IMPACT = 0.05


def forces_now(state: WorldState, physics_rate: float) -> tuple[Contacts, Snapshot] | None:
    """
    Return the contacts of a world at rest, as of one step, and a snapshot with its other forces.

    :param state: of the world
    :param physics_rate: steps a second of simulation time [Hz]
    :return: None where the world is too large, or loses a body or joint at once
    """
    if len(state.bodies) > MOST_BODIES:
        return None
    copy = World(physics_rate=physics_rate)
    copy.reports_contacts = True
    copy.begin(_without_bounce(state), 0)
    before = copy.snapshot()
    steps: list[Contacts] = []
    for _ in range(_STEPS):
        copy.step(1)
        after = copy.snapshot()
        if after.scene is not before.scene:
            # Something has broken, or was lost.
            return None
        steps.append(copy.contacts(after))
        if len(steps) > 1 and _is_settled(*steps[-2:]):
            break
    touching = np.vstack([each.pairs for each in steps[:_TOUCHING]])
    return _at_rest(steps[-1], touching, before), after


def _without_bounce(state: WorldState) -> WorldState:
    """Return a state whose bodies and walls have an elasticity of 0."""
    bodies = tuple(replace(each, body=replace(each.body, elasticity=0.0)) for each in state.bodies)
    return replace(state, bodies=bodies, settings=replace(state.settings, elasticity=0.0))


def _is_settled(last: Contacts, now: Contacts) -> bool:
    """Return whether two steps have the same contacts with nearly the same impulses."""
    if not np.array_equal(last.pairs, now.pairs):
        return False
    changes = norms(now.impulses - last.impulses)
    return bool((changes <= _SETTLED * norms(now.impulses)).all())


def _at_rest(contacts: Contacts, touching: Ints, before: Snapshot) -> Contacts:
    """
    Return the contacts of bodies that touch from the first steps on, and not by an impact.

    :param touching: (k, 2) int64: the pairs of the contacts of these steps
    :param before: the snapshot before them
    """
    one, other = (_velocities(contacts.points, rows, before) for rows in contacts.pairs.T)
    approach = ((one - other) * contacts.normals).sum(axis=1)
    kept = (contacts.pairs[:, None] == touching).all(axis=2).any(axis=1) & (approach < _IMPACT)
    return Contacts(
        pairs=contacts.pairs[kept],
        points=contacts.points[kept],
        normals=contacts.normals[kept],
        impulses=contacts.impulses[kept],
        steps=contacts.steps,
    )


def _velocities(points: Floats, rows: Ints, snapshot: Snapshot) -> Floats:
    """Return the velocities of points of bodies, (m, 2) [m/s]; walls stand still."""
    twists = np.vstack((snapshot.twists, np.zeros(3)))[rows]
    arms = points - np.vstack((snapshot.centers, np.zeros(2)))[rows]
    turn = np.column_stack((-arms[:, 1], arms[:, 0])) * twists[:, 2:]
    moving: Floats = np.where(rows[:, None] < 0, 0.0, twists[:, :2] + turn)
    return moving
