# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The stages of a step, and how each is put out of action in this process.

The product has no switches: a function of a stage is replaced by one that does nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
import math
from typing import Any, NamedTuple
from unittest import mock

import numpy as np
from physsim_ros.engine import body_table, checkpoint, pipeline, settings, warm_start
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.ccd.continuous import ContinuousCollision
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.engine.stages import first_touch, half_step
from physsim_ros.engine.stages.block_solver import BlockSolver
from physsim_ros.engine.stages.floor import Floor
from physsim_ros.engine.stages.half_step import HalfStep
from physsim_ros.engine.stages.impact_propagation import ImpactPropagation
from physsim_ros.engine.stages.resting_damping import RestingDamping
from physsim_ros.model.transform import REST

Target = tuple[Any, str]


class Stage(NamedTuple):
    """
    A stage.

    :ivar name: of the stage
    :ivar replaced: functions and constants that are replaced, and by which
    :ivar timed: functions whose time is the cost of the stage
    """

    name: str
    replaced: tuple[tuple[Target, Any], ...]
    timed: tuple[Target, ...]


def _nothing(*_: object, **__: object) -> None:
    """Do nothing."""


def _no_free_flight(context: Any) -> None:
    context.table.free = np.zeros(len(context.table.bodies), np.bool_)


def _no_unsupported(_space: Any, _io: Any, table: Any, _released: Any) -> Any:
    return np.zeros(len(table.bodies), np.bool_)


def _columns_without_lead(scene: Any, dt: float, _columns: Any = body_table.columns_of) -> Any:
    columns = _columns(scene, dt)
    return columns._replace(gravity_lead=np.zeros_like(columns.gravity_lead))


def _no_common_points(*_: object) -> Any:
    return np.empty(0, np.intp), np.empty(0, np.intp)


def _no_false(touches: Any) -> Any:
    return np.zeros(len(touches.arbiters), np.bool_)


def _no_bodies(*_: object) -> Any:
    return np.empty(0, np.int64)


STAGES = (
    Stage(
        'half-step velocity',
        (
            ((HalfStep, 'find_free'), staticmethod(_no_free_flight)),
            ((RigidBody, 'lead'), lambda *_: REST),
            ((body_table, 'columns_of'), _columns_without_lead),
        ),
        ((HalfStep, 'begin_step'), (HalfStep, 'find_free')),
    ),
    Stage(
        'support graph',
        (((half_step, 'find_unsupported'), _no_unsupported),),
        ((half_step, 'find_unsupported'),),
    ),
    Stage(
        'resting damping',
        (((RestingDamping, 'damp_resting'), _nothing),),
        ((RestingDamping, 'damp_resting'),),
    ),
    Stage(
        'floor',
        (((Floor, 'pull_bodies'), _nothing), ((Floor, 'end_step'), _nothing)),
        ((Floor, 'pull_bodies'), (Floor, 'end_step')),
    ),
    Stage(
        'continuous collision',
        (((ContinuousCollision, 'clamp_moves'), _nothing),),
        ((ContinuousCollision, 'clamp_moves'),),
    ),
    Stage(
        'tight boxes',
        (((pipeline, 'tighten_boxes'), _nothing),),
        ((pipeline, 'tighten_boxes'),),
    ),
    Stage(
        'false contacts',
        (((first_touch, 'find_false'), _no_false),),
        ((first_touch, 'find_false'),),
    ),
    Stage(
        'contact at impact',
        (((first_touch, 'move_to_impact'), _nothing),),
        ((first_touch, 'move_to_impact'),),
    ),
    Stage(
        'contact projection',
        (((first_touch, 'project_contacts'), _no_bodies),),
        ((first_touch, 'project_contacts'),),
    ),
    Stage(
        'internal edges',
        (((first_touch, 'slide_over_edges'), _nothing),),
        ((first_touch, 'slide_over_edges'),),
    ),
    Stage(
        'impact propagation',
        (((ImpactPropagation, 'defer_contacts'), _nothing),),
        ((ImpactPropagation, 'defer_contacts'),),
    ),
    Stage(
        'block solver',
        (((BlockSolver, '_solve'), _nothing),),
        ((BlockSolver, 'solve_impacts'),),
    ),
    Stage(
        'joint solver',
        (((JointSet, 'end_step'), _nothing),),
        ((JointSet, 'begin_step'), (JointSet, 'end_step')),
    ),
    Stage('sleeping', (((settings, 'IDLE_TIME'), math.inf),), ()),
    Stage(
        'warm start',
        (
            ((warm_start, '_same'), _no_common_points),
            ((JointSet, 'set_impulses'), _nothing),
        ),
        (
            (checkpoint, 'read_impulses'),
            (checkpoint, 'write_impulses'),
            (JointSet, 'impulses'),
            (JointSet, 'set_impulses'),
        ),
    ),
)


@contextmanager
def switched_off(stage: Stage | None) -> Iterator[None]:
    """Put a stage out of action; None is none."""
    with ExitStack() as patches:
        for (owner, name), replacement in () if stage is None else stage.replaced:
            patches.enter_context(mock.patch.object(owner, name, replacement))
        yield
