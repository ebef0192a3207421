# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The fields of the core's tables that follow from a scene alone.

A body, force, medium, attractor, robot or actor has a row each, in spawn order.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
import math
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.core import dtype_of, lib
from physsim_ros.engine.core_world import Table
from physsim_ros.engine.settings import COLLISION_SLOP, SLOP_SHARE
from physsim_ros.model.actors import Pedestrian
from physsim_ros.model.arrays import Floats
from physsim_ros.model.attraction import attracts
from physsim_ros.model.media import gust_waves
from physsim_ros.model.robots import Battery, MOST_DOCKS
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.settings import STANDARD_GRAVITY, WorldSettings
from physsim_ros.model.shapes import Chain, Convex, Form, hull_of, lever_of
from physsim_ros.model.transform import Point

_BODY, _ROBOT, _ACTOR = dtype_of('Body'), dtype_of('Robot'), dtype_of('Actor')
_FORCE, _REGION = dtype_of('AppliedForce'), dtype_of('Region')
_ATTRACTOR = dtype_of('Attractor')


class SceneColumns(NamedTuple):
    """
    The columns of a scene.

    Of n bodies, f applied forces, m media, k attractors, r robots and a actors.

    :ivar rows: name -> row
    :ivar moving: whether there is a body that is not anchored; else a step changes nothing
    :ivar expiries: step -> names of the bodies that are removed at its end
    :ivar bodies: (n + 1,) `Body`: the fields that follow from the scene; the last one is the
        background
    :ivar forces: (f,) `AppliedForce`, in the order of their bodies
    :ivar regions: (m,) `Region`, in the order of their bodies; the air comes last
    :ivar attractors: (k,) `Attractor`, in the order of their bodies
    :ivar robots: (r,) `Robot`: the same
    :ivar actors: (a,) `Actor`: the same
    :ivar tracks: their points, which the records refer to
    :ivar hulls: the hulls of bodies, the same
    """

    rows: dict[str, int]
    moving: bool
    expiries: dict[int, list[str]]
    bodies: Table
    forces: Table
    regions: Table
    attractors: Table
    robots: Table
    actors: Table
    tracks: tuple[Floats, ...]
    hulls: tuple[Floats, ...]


def check_columns(body: Body, settings: WorldSettings, dt: float) -> None:
    """
    Make the columns of one body, so that an error in them refuses its request, and ends no step.

    The columns of a body without a role follow from its form, which building it derives.

    :param settings: of its world
    :param dt: of a sub-step [s]
    """
    roles = body.robot, body.actor
    has_medium = body.medium is not None or settings.air.acts
    if roles != (None, None) or body.forces or has_medium or settings.floor_friction:
        _make_columns(Scene(bodies=(body,), settings=settings), dt)


def check_floor(scene: Scene, settings: WorldSettings, dt: float) -> None:
    """
    Make the columns of a scene on another floor, so that an error in them refuses the request.

    :param settings: with that floor
    :param dt: of a sub-step [s]
    """
    if settings.floor_friction not in (0.0, scene.settings.floor_friction):
        _make_columns(replace(scene, settings=settings), dt)


# A world is often built anew from the scene that it has, and then another one follows it.
@lru_cache(maxsize=2)
def columns_of(scene: Scene, dt: float) -> SceneColumns:
    """
    Return the columns of a scene.

    :param dt: of a sub-step [s]
    """
    return _make_columns(scene, dt)


def _make_columns(scene: Scene, dt: float) -> SceneColumns:
    rows = {name: row for row, name in enumerate(scene.names)}
    expiries: dict[int, list[str]] = {}
    for body in scene.bodies:
        if body.expires is not None:
            expiries.setdefault(body.expires, []).append(body.name)
    tracks = tuple(
        np.array(body.actor.track, np.float64) for body in scene.bodies if body.actor is not None
    )
    bodies, regions = _body_records(scene), _region_records(scene)
    return SceneColumns(
        rows=rows,
        moving=not all(body.anchored for body in scene.bodies),
        expiries=expiries,
        bodies=bodies,
        forces=_force_records(scene),
        regions=regions,
        attractors=_attractor_records(scene),
        robots=_robot_records(scene),
        actors=_actor_records(scene, rows, tracks, dt),
        tracks=tracks,
        hulls=_put_hulls(bodies, scene) if len(regions) else (),
    )


def _body_records(scene: Scene) -> Table:
    bodies, count = scene.bodies, len(scene.bodies)
    records = np.zeros(count + 1, _BODY)
    own = records[:-1]
    anchored = np.array([body.anchored for body in bodies], np.bool_)
    own['anchored'] = anchored
    own['dynamic'] = [body.dynamic for body in bodies]
    own['sensor'] = [body.sensor for body in bodies]
    own['group'] = [body.group for body in bodies]
    # The engine's origin of an anchored body is its own.
    own['offset'][:] = np.where(anchored[:, None], 0.0, scene.centroids)
    # Equal shapes share one form.
    forms = [body.shape.form for body in bodies]
    by_form = {form: _numbers_of(form) for form in dict.fromkeys(forms)}
    numbers = np.array([by_form[form] for form in forms]).reshape(-1, 5)
    names = 'reach', 'inner', 'turning_radius', 'corners', 'pieces'
    for name, values in zip(names, numbers.T, strict=True):
        own[name] = values
    own['reach'] += np.hypot(*(scene.centroids - own['offset']).T)
    own['area'] = [form.area for form in forms]
    own['safe_depth'] = [_safe_depth(body) for body in bodies]
    own['slop'] = [_slop(body) for body in bodies]
    own['braking'] = scene.floor_friction * STANDARD_GRAVITY
    for row in np.flatnonzero(own['braking']).tolist():
        wheels = bodies[row].wheels
        own[row]['lever'] = lever_of(forms[row]) if wheels is None else wheels.lever
    own['towed'] = [body.towed is not None for body in bodies]
    own['belt'] = [body.belt for body in bodies]
    own['one_way'][:] = [_unit(body.one_way) for body in bodies] or np.empty((0, 2))
    own['closed_sides'] = [body.closed_sides for body in bodies]
    own['rolling'] = [body.rolling_resistance for body in bodies]
    own['surface'][:] = [body.surface_velocity for body in bodies] or np.empty((0, 2))
    # The background has no inner radius: what meets its walls counts alone.
    records[-1]['anchored'], records[-1]['safe_depth'] = True, math.inf
    records[-1]['slop'] = COLLISION_SLOP
    return records


def _unit(direction: Point) -> Point:
    """Return a vector of length 1, or 0 of none."""
    length = math.hypot(*direction)
    return (direction[0] / length, direction[1] / length) if length else (0.0, 0.0)


def _safe_depth(body: Body) -> float:
    """
    Return how far a body may be entered in a step unseen [m].

    An anchored chain does not count: what meets it keeps its own centre on its side.
    """
    if body.anchored and isinstance(body.shape, Chain):
        return math.inf
    return body.shape.form.inner / int(lib.SAFE_DEPTHS)


def _slop(body: Body) -> float:
    """Return how far a body may overlap others at rest [m]."""
    return min(COLLISION_SLOP, body.shape.form.inner * SLOP_SHARE)


def _numbers_of(form: Form) -> tuple[float, float, float, int, int]:
    """Return outer and inner radius, turning radius, corners and piece count of a shape."""
    # A disc covers the same ground however it turns.
    turning_radius = 0.0 if form.inner >= form.outer else form.outer
    corners = sum(
        len(piece.vertices) if isinstance(piece, Convex) else lib.ROUND_COST
        for piece in form.pieces
    )
    return form.outer, form.inner, turning_radius, corners, len(form.pieces)


def _force_records(scene: Scene) -> Table:
    found = [
        (row, each.axes == 'body', each.force, each.arm(body.shape.form.centroid))
        for row, body in enumerate(scene.bodies)
        for each in body.forces
        if body.dynamic and any(each.force)
    ]
    return np.array(found, _FORCE)


def _region_records(scene: Scene) -> Table:
    air, seed = scene.settings.air, scene.settings.seed
    media = [
        (row, body.medium) for row, body in enumerate(scene.bodies) if body.medium is not None
    ]
    if air.acts:
        media.append((-1, air))
    records = np.zeros(len(media), _REGION)
    for record, (row, medium) in zip(records, media, strict=True):
        record['body'], record['gusty'] = row, medium.gusts > 0.0
        for field in ('density', 'viscosity', 'drag', 'flow'):
            record[field] = getattr(medium, field)
        if medium.gusts:
            record['waves'] = gust_waves(medium, seed)
    return records


def _attractor_records(scene: Scene) -> Table:
    settings = scene.settings
    found = [
        (row, offset, body.total_mass * (not body.sensor), body.charge)
        for row, body in enumerate(scene.bodies)
        if attracts(body, settings)
        for offset in (body.shape.form.centroid if body.anchored else (0.0, 0.0),)
    ]
    return np.array(found, _ATTRACTOR)


def _put_hulls(records: Table, scene: Scene) -> tuple[Floats, ...]:
    """Set the hulls of the bodies of several pieces that forces move, and return them."""
    hulls = []
    for record, body in zip(records[:-1], scene.bodies, strict=True):
        if body.dynamic and len(body.shape.form.pieces) > 1:
            hull = hull_of(body.shape.form)
            record['hull'], record['hull_count'] = hull.ctypes.data, len(hull)
            hulls.append(hull)
    return tuple(hulls)


def _robot_records(scene: Scene) -> Table:
    found = [(row, body) for row, body in enumerate(scene.bodies) if body.robot is not None]
    records = np.zeros(len(found), _ROBOT)
    for number, (row, body) in enumerate(found):
        robot, record = body.robot, records[number]
        assert robot is not None  # noqa: S101 - by the list above
        record['body'], record['center'] = row, body.shape.form.centroid
        if robot.drive is None:
            continue
        rims = np.array([*robot.drive.wheels.values()], np.float64).reshape(-1, 3)
        record['wheel_count'] = len(rims)
        record['wheels'][: len(rims)] = rims
        record['acceleration'] = robot.drive.acceleration
        record['curvature'] = robot.drive.most_curved
        record['slip'] = robot.odometry.slip
        if robot.battery is not None:
            record['battery'] = _battery_record(robot.battery, scene)
    return records


def _battery_record(battery: Battery, scene: Scene) -> tuple[object, ...]:
    docks = [row for name in battery.docks if (row := scene.row_of.get(name, -1)) >= 0]
    capacity = battery.capacity * 3600.0
    currents = battery.idle, battery.moving, battery.charging
    docked = len(docks), [*docks, *[0] * (MOST_DOCKS - len(docks))]
    return capacity, battery.level * capacity, *currents, *docked


def _actor_records(
    scene: Scene, rows: dict[str, int], tracks: tuple[Floats, ...], dt: float
) -> Table:
    records = np.zeros(len(tracks), _ACTOR)
    robots = {row: number for number, row in enumerate(scene.robot_rows.tolist())}
    for record, row, track in zip(records, scene.actor_rows.tolist(), tracks, strict=True):
        body = scene.bodies[row]
        actor, start = body.actor, body.actor.start
        record['body'], record['robot'] = row, robots.get(row, -1)
        record['kind'] = getattr(lib, f'ACTOR_{actor.KIND.upper()}')
        record['repeat'] = getattr(lib, actor.repeat.upper())
        for name in ('gate', 'by', 'near'):
            record[name] = rows.get(getattr(start, name), -1)
        record['waits'] = start.gate is not None or start.near is not None
        record['distance'] = start.distance or 0.0
        record['delay'] = round((start.time or 0.0) / (dt * lib.SUB_STEPS))
        record['points'], record['point_count'] = track.ctypes.data, len(track)
        record[actor.KIND] = actor.parameters
        if isinstance(actor, Pedestrian):
            record['pace'] = actor.pace
        if body.robot is not None and (drive := body.robot.drive) is not None:
            record['holonomic'] = drive.holonomic
            record['ahead'] = 0.0 if drive.holonomic else body.shape.form.outer
            record['most'] = drive.max_speed, 0.0, drive.max_turn
    return records
