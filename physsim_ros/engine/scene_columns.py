# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Columns that follow from the scene alone, made once until a body comes, goes or changes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.graph_search import reachable, Rows
from physsim_ros.engine.settings import COLLISION_SLOP
from physsim_ros.model.arrays import Flags, Floats, greatest, Ints
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.shapes import Chain, Convex, Form

# A pair that approaches by less than this share of the lesser inner radius in a step needs no time
# of impact: each keeps its centre well on the side it came from.
SAFE_SHARE = 0.25
# Corners of a polygon whose time of impact costs as much as that of a round shape, most of which
# does not depend on the corners (measured: a disc 36 us, a square 56 us).
ROUND_COST = 4


class SceneColumns(NamedTuple):
    """
    The columns of a scene, for n bodies.

    :ivar rows: name -> row
    :ivar moving: whether there is a body that is not anchored; else a step changes nothing
    :ivar most_elastic: greatest restitution of a pair that could collide
    :ivar dynamic: (n + 1,) bool: forces move it; never the background
    :ivar anchored: (n + 1,) bool: it does not move at all; always the background
    :ivar friction: (n + 1,) float64: the engine's coefficient, whose products are those of pairs
    :ivar elasticity: (n + 1,) float64: the same of restitution
    :ivar reach: (n,) float64: greatest distance of a point of it from the centre of mass [m]
    :ivar offsets: (n, 2) float64: the engine's origin in the body's frame [m]
    :ivar gravity_lead: (n, 3) float64: half a step of gravity [m/s, m/s, rad/s]
    :ivar solid: (n,) bool: neither anchored nor a sensor
    :ivar safe_depths: (n,) float64: how far it may be entered in a step unseen [m]
    :ivar turning_radii: (n,) float64: how far out its turning counts for continuous collision [m]
    :ivar corners: (n,) float64: of its pieces, the cost of continuous collision
    :ivar pieces: (n,) float64: count of the pieces of each body
    :ivar half_widths: (n,) float64: of the thinnest piece of each body [m]
    :ivar groups: (n,) int64: bodies of one group pass through each other; 0 is none
    :ivar joined: (j, 2) intp: rows of the two bodies of each joint
    :ivar not_colliding: (k, 2) intp: rows of bodies that a joint keeps from colliding
    :ivar sprung: (n,) bool: part of an island of joints that hangs on a spring and on something
        that forces do not move, so that its velocity has no half-step lead
    :ivar floor_friction: (n,) float64: coefficient of friction with the floor; 0 where none acts
    :ivar on_springs: (s,) intp: rows of the dynamic bodies that springs pull
    :ivar expiries: step -> names of the bodies that are removed at its end
    """

    rows: dict[str, int]
    moving: bool
    most_elastic: float
    dynamic: Flags
    anchored: Flags
    friction: Floats
    elasticity: Floats
    reach: Floats
    offsets: Floats
    gravity_lead: Floats
    solid: Flags
    safe_depths: Floats
    turning_radii: Floats
    corners: Floats
    pieces: Floats
    half_widths: Floats
    groups: Ints
    joined: Rows
    not_colliding: Rows
    sprung: Flags
    floor_friction: Floats
    on_springs: Rows
    expiries: dict[int, list[str]]


# A world is often built anew from the scene that it has, and then another one follows it.
@lru_cache(maxsize=2)
def columns_of(scene: Scene, dt: float) -> SceneColumns:
    """
    Return the columns of a scene.

    :param dt: of a step [s]
    """
    bodies, count = scene.bodies, len(scene.bodies)
    forms = [body.shape.form for body in bodies]
    # Equal shapes share one form.
    by_form = {form: _numbers_of(form) for form in dict.fromkeys(forms)}
    numbers = np.array([by_form[form] for form in forms]).reshape(-1, 5)
    reach, half_widths, turning_radii, corners, pieces = numbers.T.copy()
    anchored = np.array([*(body.anchored for body in bodies), True], np.bool_)
    dynamic = np.array([*(body.dynamic for body in bodies), False], np.bool_)
    sensor = np.array([body.sensor for body in bodies], np.bool_)
    lead = (*(half * dt / 2 for half in scene.settings.gravity), 0.0)
    elasticity = np.sqrt([*(body.elasticity for body in bodies), scene.settings.elasticity])
    friction = [*(body.friction for body in bodies), scene.settings.friction]
    rows = {name: row for row, name in enumerate(scene.names)}
    ends = [(rows[joint.a], rows.get(joint.b, count)) for joint in scene.joints]
    joined = np.array(ends, np.intp).reshape(-1, 2)
    # With the background, which has no shape but walls, a jointed body collides.
    collide = np.array([joint.collide or joint.b not in rows for joint in scene.joints], np.bool_)
    springs = np.array([joint.kind is JointKind.SPRING for joint in scene.joints], np.bool_)
    expiries: dict[int, list[str]] = {}
    for body in bodies:
        if body.expires is not None:
            expiries.setdefault(body.expires, []).append(body.name)
    return SceneColumns(
        rows=rows,
        moving=bool((~anchored[:-1]).any()),
        most_elastic=greatest(elasticity[:-1]) * greatest(elasticity),
        dynamic=dynamic,
        anchored=anchored,
        friction=np.sqrt(friction),
        elasticity=elasticity,
        reach=reach,
        offsets=np.where(anchored[:-1, None], 0.0, scene.centroids),
        gravity_lead=np.where(dynamic[:-1, None], lead, 0.0),
        solid=~anchored[:-1] & ~sensor,
        safe_depths=_safe_depths(bodies, half_widths, anchored[:-1]),
        turning_radii=turning_radii,
        corners=corners,
        pieces=pieces,
        half_widths=half_widths,
        groups=np.array([body.group for body in bodies], np.int64),
        joined=joined,
        not_colliding=joined[~collide],
        sprung=_sprung(dynamic, joined, springs),
        floor_friction=scene.floor_friction,
        on_springs=np.unique(joined[springs][dynamic[joined[springs]]]),
        expiries=expiries,
    )


def _sprung(dynamic: Flags, joined: Rows, springs: Flags) -> Flags:
    """
    Return (n,) bool: dynamic bodies of islands that hang on a spring, and on what is not dynamic.

    :param dynamic: (n + 1,) bool
    :param joined: (j, 2) intp: rows of each joint
    :param springs: (j,) bool: which of the joints are springs
    """
    within: Flags = np.asarray(dynamic[joined].all(axis=1))

    def islands_with(joints: Flags) -> Flags:
        marked = np.zeros(len(dynamic), np.bool_)
        marked[joined[joints]] = True
        return reachable(marked & dynamic, joined[within])

    return (islands_with(~within) & islands_with(springs))[:-1]


def _safe_depths(bodies: Sequence[Body], half_widths: Floats, anchored: Flags) -> Floats:
    """
    Return how far each body may be entered in a step unseen, (n,) [m].

    An anchored chain does not count: what meets it keeps its own centre on its side.
    """
    inner = half_widths * SAFE_SHARE
    thin = np.array([isinstance(body.shape, Chain) for body in bodies], dtype=np.bool_)
    return np.where(anchored, np.where(thin, np.inf, np.maximum(inner, COLLISION_SLOP)), inner)


def _numbers_of(form: Form) -> tuple[float, float, float, int, int]:
    """Return reach, half width, turning radius, corners and count of pieces of a shape."""
    # A disc covers the same ground however it turns.
    turning_radius = 0.0 if form.inner >= form.outer else form.outer
    corners = sum(
        len(piece.vertices) if isinstance(piece, Convex) else ROUND_COST for piece in form.pieces
    )
    return form.outer, form.inner, turning_radius, corners, len(form.pieces)
