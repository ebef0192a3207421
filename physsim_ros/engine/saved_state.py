# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Saved states: what a world file keeps of a space, and the checkpoint at which a world begins.

`engine_pose` and `engine_motion` tell a reader of files whether a pose or a velocity was edited.
"""

from __future__ import annotations

from dataclasses import replace
import math
import operator
from typing import Any

import numpy as np
from physsim_ros.engine.bodies import lead_of, offset_of
from physsim_ros.engine.checkpoint import put_commands, restore_checkpoint, take_checkpoint
from physsim_ros.engine.scene_columns import columns_of
from physsim_ros.engine.space import Space
from physsim_ros.model.checkpoint import (
    BodyState,
    Checkpoint,
    ImpulseCache,
    Motion,
    TimedCommands,
    WorldState,
)
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.states import (
    ACTOR_STATE,
    ActorState,
    ROBOT_STATE,
    RobotState,
    SPAWNED,
    states_in,
    WAITING,
)
from physsim_ros.model.transform import local_to_world, NO_WRENCH, Point, Pose, Twist


def saved_state(checkpoint: Checkpoint, dt: float) -> WorldState:
    """
    Return the saved state of a checkpoint, whose times count from that; on any thread.

    :param dt: of a sub-step [s]
    """
    step, bodies = checkpoint.step, []
    # A contact may have ended as a stage moved a body, with its impulses still in the cache. A
    # rebuilt space does not find it, and what is loaded must be saved as it was. So must be which
    # bodies fly: one that is loaded in flight counts as thrown.
    space = restore_checkpoint(replace(checkpoint, thrown=checkpoint.free), dt)
    begun = take_checkpoint(space, step)
    robots, actors = checkpoint.scene.robot_rows.tolist(), checkpoint.scene.actor_rows.tolist()
    driven = dict(zip(robots, states_in(checkpoint.robots, RobotState), strict=True))
    acting = dict(zip(actors, states_in(checkpoint.actors, ActorState), strict=True))
    motions = zip(begun.state.tolist(), begun.free.tolist(), strict=True)
    leads, commands = _leads_of(checkpoint), space.commands.coming
    _, twists = space.core.observe()
    rigids = enumerate(space.bodies.by_name.values())
    for (row, rigid), (state, free) in zip(rigids, motions, strict=True):
        body, until = rigid.body, rigid.wrench_until
        if body.expires is not None:
            body = replace(body, expires=body.expires - step)
        bodies.append(
            BodyState(
                body=body,
                pose=rigid.pose,
                twist=tuple(twists[row].tolist()),
                motion=Motion._make((*state, free)),
                field_lead=leads[row],
                wrench=rigid.wrench,
                wrench_steps=None if until is None else until - step,
                driven=driven[row].shifted(-step) if row in driven else None,
                coming=tuple(each.shifted(-step) for each in commands.of(rigid.body.name)),
                acting=acting[row].shifted(-step) if row in acting else None,
            )
        )
    return WorldState(
        settings=checkpoint.scene.settings,
        bodies=tuple(bodies),
        joints=space.joints.drawn_now(),
        commands=_shifted(checkpoint.commands, -step),
        lesson=checkpoint.scene.lesson,
        memory=begun.memory,
    )


def checkpoint_of(state: WorldState, step: int, dt: float) -> Checkpoint:
    """
    Return the checkpoint at which a world begins with a state.

    :param step: steps that the world has made
    :param dt: of a sub-step [s]
    """
    motions = [
        saved.motion or engine_motion(saved, state.settings.gravity, dt) for saved in state.bodies
    ]
    free = np.array([motion.free for motion in motions], np.bool_)
    return Checkpoint(
        **_timed(state, step),
        scene=Scene(
            bodies=_bodies_at(state, step),
            settings=state.settings,
            joints=state.joints,
            lesson=state.lesson,
        ),
        state=np.array([motion[:6] for motion in motions], np.float64).reshape(-1, 6),
        free=free,
        thrown=free,
        field_leads=np.array(
            [saved.field_lead or (math.nan,) * 3 for saved in state.bodies], np.float64
        ).reshape(-1, 3),
        memory=state.memory or _no_impulses(state),
        unstepped=frozenset(joint.name for joint in state.joints),
    )


def engine_pose(state: BodyState) -> Pose:
    """Return the pose of the engine's body, whose origin is the centre of mass."""
    return *local_to_world(offset_of(state.body), state.pose), state.pose[2]


def engine_motion(state: BodyState, gravity: Point, dt: float) -> Motion:
    """
    Return the engine's numbers of a body by its pose and twist.

    It is in free flight unless it has a motion that says otherwise.

    :param gravity: of the world [m/s²]
    :param dt: of a sub-step [s]
    """
    twist = state.twist
    free = state.motion is None or state.motion.free
    if free:
        twist = _sum(twist, lead_of(state.body, state.wrench, state.pose[2], gravity, dt))
        twist = twist if state.field_lead is None else _sum(twist, state.field_lead)
    return Motion(*engine_pose(state), *twist, free=free)


def _sum(one: Twist, other: Twist) -> Twist:
    x, y, turn = map(operator.add, one, other)
    return x, y, turn


def begin_at(space: Space, checkpoint: Checkpoint, state: WorldState, step: int) -> Checkpoint:
    """
    Have a space that was built for a step, and has made none, begin at another one.

    :param checkpoint: from which it was built
    :param state: of which that is the checkpoint
    :param step: steps that the world has made
    :return: the checkpoint of the state at that step
    """
    scene, rigids = checkpoint.scene, tuple(space.bodies.by_name.values())
    if columns_of(scene, space.dt).expiries:
        scene = replace(scene, bodies=_bodies_at(state, step))
        for rigid, body in zip(rigids, scene.bodies, strict=True):
            rigid.body = body
        space.tables.lay_out(scene)
    checkpoint = replace(checkpoint, scene=scene, **_timed(state, step))
    put_commands(space, rigids, checkpoint)
    space.table.robots['state'], space.table.actors['state'] = checkpoint.robots, checkpoint.actors
    space.joints.set_commands(checkpoint.commands, checkpoint.step)
    return checkpoint


def _bodies_at(state: WorldState, step: int) -> tuple[Body, ...]:
    """Return the bodies of a state in a world that has made a number of steps."""
    bodies = (saved.body for saved in state.bodies)
    return tuple(
        body if body.expires is None else replace(body, expires=body.expires + step)
        for body in bodies
    )


def _timed(state: WorldState, step: int) -> dict[str, Any]:
    """Return the fields of the checkpoint of a state that count steps, without its bodies."""
    return {
        'step': step,
        'wrenches': tuple(
            (row, saved.wrench, None if steps is None else step + steps)
            for row, saved in enumerate(state.bodies)
            for steps in (saved.wrench_steps,)
            if saved.wrench != NO_WRENCH
        ),
        'commands': _shifted(state.commands, step),
        'robots': np.array(
            [
                (saved.driven or SPAWNED).shifted(step)
                for saved in state.bodies
                if saved.body.robot is not None
            ],
            ROBOT_STATE,
        ),
        'coming': tuple(
            (row, tuple(command.shifted(step) for command in saved.coming))
            for row, saved in enumerate(state.bodies)
            if saved.coming
        ),
        'actors': np.array(
            [
                (saved.acting or WAITING).shifted(step)
                for saved in state.bodies
                if saved.body.actor is not None
            ],
            ACTOR_STATE,
        ),
    }


def _shifted(commands: TimedCommands, steps: int) -> TimedCommands:
    """Return commands with their steps counted from a beginning that is earlier."""
    return tuple(each._replace(begun=each.begun + steps) for each in commands)


def _leads_of(checkpoint: Checkpoint) -> list[Twist | None]:
    """Return the leads of velocities by fields; None where one is to be found."""
    if not len(checkpoint.field_leads):
        return [None] * len(checkpoint.scene.bodies)
    rows = checkpoint.field_leads.tolist()
    return [None if math.isnan(x) else (x, y, turn) for x, y, turn in rows]


def _no_impulses(state: WorldState) -> ImpulseCache:
    """Return the impulse cache of a space that has not stepped."""
    counts = [len(saved.body.shape.form.pieces) for saved in state.bodies]
    ends = np.cumsum([state.settings.wall_count, *counts], dtype=np.int64)
    return ImpulseCache(
        ids=ends[:-1],
        walls=0,
        following=int(ends[-1]),
        pairs=np.empty((0, 2), np.int64),
        hashes=np.empty(0, np.uint64),
        impulses=np.empty((0, 2)),
        joints=np.empty((0, 2)),
    )
