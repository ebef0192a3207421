# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The stages of a step, and how each is left out in this process.

The core leaves out the stages of a mask; the rest is done by functions and constants that are
replaced. The product never leaves out any.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
import math
from typing import Any, NamedTuple
from unittest import mock

import numpy as np
from physsim_ros.engine import settings, warm_start
from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.core import lib
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.model.transform import REST

Target = tuple[Any, str]


class Stage(NamedTuple):
    """
    A stage.

    :ivar name: of the stage
    :ivar mask: of the core, `STAGE_...` of `core.h`; 0 is no stage of the core
    :ivar replaced: functions and constants that are replaced, and by which
    """

    name: str
    mask: int
    replaced: tuple[tuple[Target, Any], ...] = ()


def _no_common_points(*_: object) -> Any:
    return np.empty(0, np.intp), np.empty(0, np.intp)


def _nothing(*_: object, **__: object) -> None:
    """Do nothing."""


STAGES = (
    Stage('half-step velocity', lib.STAGE_HALF_STEP, (((RigidBody, 'lead'), lambda *_: REST),)),
    Stage('support graph', lib.STAGE_SUPPORT),
    Stage('resting damping', lib.STAGE_RESTING_DAMPING),
    Stage('floor', lib.STAGE_FLOOR),
    Stage('continuous collision', lib.STAGE_CONTINUOUS),
    Stage('tight boxes', lib.STAGE_TIGHT_BOXES),
    Stage('false contacts', lib.STAGE_FALSE_CONTACTS),
    Stage('contact at impact', lib.STAGE_IMPACT),
    Stage('rest of the step', lib.STAGE_REST_OF_STEP),
    Stage('internal edges', lib.STAGE_EDGES),
    Stage('impact propagation', lib.STAGE_PROPAGATION),
    Stage('block solver', lib.STAGE_BLOCK_SOLVER),
    Stage('joint solver', lib.STAGE_JOINTS),
    Stage('impact loads', lib.STAGE_LOADS),
    Stage('order of contact points', lib.STAGE_ORDER),
    Stage('fields', lib.STAGE_FIELDS),
    Stage('steep friction', lib.STAGE_STEEP_FRICTION),
    Stage('sleeping', 0, (((settings, 'IDLE_TIME'), math.inf),)),
    Stage(
        'warm start',
        0,
        (((warm_start, '_same'), _no_common_points), ((JointSet, 'set_impulses'), _nothing)),
    ),
)


@contextmanager
def switched_off(stage: Stage | None) -> Iterator[None]:
    """Leave a stage out in worlds that are made in this context; None is none."""
    with ExitStack() as patches:
        if stage is not None:
            patches.enter_context(mock.patch.object(CoreWorld, 'left_out', stage.mask))
            for (owner, name), replacement in stage.replaced:
                patches.enter_context(mock.patch.object(owner, name, replacement))
        yield
