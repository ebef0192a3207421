# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Preparation of contacts for the solver, as `cpArbiterPreStep` makes it.

Chipmunk makes it before the stages in the middle of a step can change a contact.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import chipmunk_memory as memory
from physsim_ros.model.arrays import Ints
from physsim_ros.model.transform import cross, dots
import pymunk


def prepare_contacts(space: pymunk.Space, arbiters: Ints) -> None:
    """
    Make effective masses, bias and bounce of contacts anew.

    :param arbiters: (k,) places of `cpArbiter`
    """
    words = memory.read_words(arbiters, memory.ARBITER_WORDS)
    # All points, contact after contact.
    counts = memory.point_counts(arbiters)
    each = np.repeat(np.arange(len(arbiters)), counts)
    words, second = words[each], np.append(False, each[1:] == each[:-1])[: len(each)]
    points = memory.places_in(words[:, memory.ARBITER_CONTACTS]) + memory.CONTACT_SIZE * second
    arms = memory.read_numbers(points, memory.CONTACT_ARMS)
    bodies = memory.places_in(words[:, memory.ARBITER_BODIES].T)
    a, b = memory.read_numbers(bodies, memory.BODY_WORDS)
    numbers = words.view(np.float64)
    normals = numbers[:, memory.ARBITER_NORMAL]
    tangents = normals[:, ::-1] * (-1.0, 1.0)
    gaps, parting = np.zeros((2, len(each)))
    inverse = np.zeros((2, len(each)))
    for body, arm, sign in ((a, arms[:, :2], -1.0), (b, arms[:, 2:], 1.0)):
        levers = np.stack((cross(arm, normals), cross(arm, tangents)))
        turns = body[:, memory.BODY_INVERSE_MOMENT] * levers**2
        inverse += body[:, memory.BODY_INVERSE_MASS] + turns
        gaps += sign * dots(body[:, memory.BODY_POSITION] + arm, normals)
        speed = dots(body[:, memory.BODY_VELOCITY], normals)
        parting += sign * (speed + body[:, memory.BODY_SPIN] * levers[0])
    share = 1.0 - space.collision_bias**space.current_time_step
    push = share / space.current_time_step
    bias = -push * np.minimum(gaps + space.collision_slop, 0.0)
    bounce = parting * numbers[:, memory.ARBITER_ELASTICITY]
    found = (1.0 / inverse[0], 1.0 / inverse[1], bounce, np.zeros(len(each)), bias)
    memory.write_numbers(points, memory.CONTACT_PREPARED, np.column_stack(found))
