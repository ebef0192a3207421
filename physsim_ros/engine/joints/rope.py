# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rope: two anchors are no further from each other than its length."""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.joints import rows
from physsim_ros.engine.joints.kind import Batch, Ends, Kind, Motion
from physsim_ros.engine.joints.rod import lengths
from physsim_ros.model.scene import Joint
import pymunk
from pymunk._chipmunk_cffi import lib

# Least excess of a taut rope over the greatest length that Chipmunk solves for, as a share of 1 m
# and its length: without an excess by rounding (1e-16) Chipmunk would skip the constraint.
_TAUT = 1e-12


def _constraints(joint: Joint, ends: Ends) -> list[pymunk.Constraint]:
    rope = pymunk.SlideJoint(ends.a, ends.b, ends.at_a, ends.at_b, 0.0, joint.rest_length)
    rope.error_bias = 0.0
    return [rope]


def _set_targets(batch: Batch, motion: Motion) -> None:
    """
    Have each taut `SlideJoint` solve for its rate: Chipmunk solves for `(max - |d|) / dt`.

    It only holds back: a rate at which the anchors part is none.
    """
    longest = batch.upper[:, 0]
    length, rate = lengths(batch, motion)
    taut = length - np.maximum(-rate * motion.dt, _TAUT * (1.0 + length))
    aimed = np.where(length > longest, taut, longest)
    for pointer, most in zip(batch.constraints, aimed.tolist(), strict=True):
        lib.cpSlideJointSetMax(pointer, most)


KIND = Kind(_constraints, lambda joint: [(0.0, joint.rest_length)], rows.distance, _set_targets)
