# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Extents of bodies for continuous collision: safe depths, turning radii, corners."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.engine.ccd.time_of_impact import ROUND_COST, SAFE_SHARE
from physsim_ros.engine.tolerances import COLLISION_SLOP
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Chain, Convex


def safe_depths(bodies: Sequence[Body]) -> Floats:
    """
    Return how far each body may be entered in a step unseen, (n,) [m].

    An anchored chain does not count: what meets it keeps its own centre on its side.
    """
    inner = np.array([body.shape.form.inner * SAFE_SHARE for body in bodies])
    anchored = np.array([body.anchored for body in bodies], dtype=np.bool_)
    thin = np.array([isinstance(body.shape, Chain) for body in bodies], dtype=np.bool_)
    return np.where(anchored, np.where(thin, np.inf, np.maximum(inner, COLLISION_SLOP)), inner)


def turning_radius(body: Body) -> float:
    """Return how far out a body's turning counts [m]: a disc covers the same ground anyway."""
    form = body.shape.form
    return 0.0 if form.inner >= form.outer else form.outer


def corner_count(body: Body) -> float:
    """Return the corners of a body's pieces; a round one costs as much as `ROUND_COST`."""
    return float(
        sum(
            len(piece.vertices) if isinstance(piece, Convex) else ROUND_COST
            for piece in body.shape.form.pieces
        )
    )
