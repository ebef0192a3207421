# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Worlds of ir-sim: YAML with a world, robots and obstacles, each a group of a number of bodies.

An obstacle without kinematics is anchored; one that moves, and a robot with a behaviour, becomes
an actor. A robot without a behaviour keeps its drive alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.convert.conversion import Conversion, line_shape, MOST_BODIES, pose_of
from physsim_ros.model.transform import Pose

Content = Mapping[str, Any]

_DRIVES = {'diff': 'differential', 'omni': 'omni', 'acker': 'car'}
_GROUP_KEYS = (
    *('number', 'distribution', 'kinematics', 'shape', 'state', 'goal', 'vel_max', 'behavior'),
    *('sensors', 'name', 'color', 'unobstructed', 'plot'),
)
_WORLD_KEYS = (
    *('name', 'width', 'height', 'offset', 'step_time', 'sample_time', 'collision_mode'),
    *('control_mode', 'mdownsample', 'plot'),
)
# Greatest speed and turn rate, where a group does not set them.
_SPEEDS = (1.0, 1.0)
_MOST_POINTS = 3


def convert(content: Content, _folder: Path) -> Conversion:
    """Return the world of a file of ir-sim."""
    world = content['world']
    conversion = Conversion(settings={'gravity': [0.0, 0.0], 'floor_friction': 0.6})
    conversion.leave_out_keys(world, _WORLD_KEYS, 'the world')
    x, y = (float(value) for value in world.get('offset', (0.0, 0.0)))
    width, height = float(world.get('width', 10.0)), float(world.get('height', 10.0))
    conversion.settings['bounds'] = [x, y, x + width, y + height]
    for kind in ('robot', 'obstacle'):
        groups = content.get(kind) or ()
        for group in [groups] if isinstance(groups, Mapping) else groups:
            conversion.leave_out_keys(group, _GROUP_KEYS, f'a {kind}')
            _add_group(conversion, group, kind)
    return conversion


def _add_group(conversion: Conversion, group: Content, kind: str) -> None:
    number = int(group.get('number', 1))
    if number > MOST_BODIES:
        raise ValueError(f'more than {MOST_BODIES:,} bodies')
    poses = _poses(conversion, group, number)
    for i, pose in enumerate(poses):
        described = _nth(group.get('shape', {'name': 'circle', 'radius': 0.2}), i)
        if described.get('random_shape'):
            conversion.leave_out(f'left out: a {kind} with a random shape')
            continue
        shape, radius = _shape_of(described)
        properties: dict[str, object] = {'sensor': True} if group.get('unobstructed') else {}
        kinematics = group.get('kinematics')
        actor = _actor_of(conversion, group, i, pose) if kinematics else None
        if kind == 'robot':
            properties['robot'] = _robot_of(conversion, group, kinematics, radius)
            if actor is not None:
                properties['actor'] = actor
        elif actor is None:
            properties['anchored'] = True
        else:
            properties['actor'] = actor
            if actor['kind'] == 'path':
                properties['kinematic'] = True
        conversion.add_body(str(group.get('name', kind)), shape, pose, **properties)


def _poses(conversion: Conversion, group: Content, number: int) -> list[Pose]:
    distribution = group.get('distribution') or {}
    match distribution.get('name', 'manual'):
        case 'circle':
            x, y, *_ = distribution.get('center', (5.0, 5.0))
            radius = float(distribution.get('radius', 4.0))
            angles = [math.tau * i / number for i in range(number)]
            return [
                (x + radius * math.cos(a), y + radius * math.sin(a), a + math.pi) for a in angles
            ]
        case 'random':
            conversion.leave_out('random places are drawn once, with seed 0')
            low = distribution.get('range_low', (0.0, 0.0, -math.pi))
            high = distribution.get('range_high', (10.0, 10.0, math.pi))
            places = np.random.default_rng(0).uniform(low, high, (number, 3))
            return [pose_of(place) for place in places.tolist()]
    states = group.get('state', (1.0, 1.0, 0.0))
    return [pose_of(_nth(states, i)[:_MOST_POINTS]) for i in range(number)]


def _shape_of(shape: Content) -> tuple[dict[str, object], float]:
    """Return a shape, and half its width [m]."""
    match shape['name']:
        case 'circle':
            radius = float(shape.get('radius', 0.2))
            return {'circle': {'radius': radius}}, radius
        case 'rectangle':
            length, width = float(shape.get('length', 0.2)), float(shape.get('width', 0.1))
            if not shape.get('wheelbase'):
                return {'box': {'width': length, 'height': width}}, width / 2
            # The origin of a car is its rear axle.
            back = -(length - float(shape['wheelbase'])) / 2
            xs, y = (back, back + length), width / 2
            return {'polygon': [[xs[0], -y], [xs[1], -y], [xs[1], y], [xs[0], y]]}, y
        case 'polygon':
            points = [[float(x), float(y)] for x, y in shape['vertices']]
            return {'polygon': points}, max(abs(y) for _, y in points)
        case 'linestring':
            return line_shape([(float(x), float(y)) for x, y in shape['vertices']]), 0.1
    raise ValueError(f'shape {shape["name"]}')


def _actor_of(
    conversion: Conversion, group: Content, i: int, pose: Pose
) -> dict[str, object] | None:
    goal, behavior = group.get('goal'), _nth(group.get('behavior'), i)
    if not goal or not behavior:
        if goal or behavior:
            conversion.leave_out('left out: a goal without a behaviour, or one without a goal')
        return None
    x, y, *_ = (float(value) for value in _nth(goal, i))
    name = behavior.get('name', 'dash')
    if name not in ('dash', 'rvo', 'orca'):
        conversion.leave_out(f'behaviour {name} becomes a straight path')
    speed = float(group.get('vel_max', _SPEEDS)[0])
    repeat = 'to_and_fro' if behavior.get('loop') else 'once'
    here, there = [pose[0], pose[1]], [x, y]
    if name in ('rvo', 'orca') and group.get('kinematics', {}).get('name') == 'omni':
        return {'kind': 'orca', 'points': [there], 'speed': speed}
    return {'kind': 'path', 'points': [here, there], 'speed': speed, 'repeat': repeat}


def _robot_of(
    conversion: Conversion, group: Content, kinematics: Content | None, radius: float
) -> dict[str, object]:
    name = (kinematics or {}).get('name', 'diff')
    drive: dict[str, object] = {'kind': _DRIVES[name], 'track': 2 * radius}
    speed, turn = (float(value) for value in group.get('vel_max', _SPEEDS))
    drive['max_speed'] = speed
    drive |= {'diff': {'max_turn': turn}, 'acker': {'steering': min(turn, 1.5)}}.get(name, {})
    shape = _nth(group.get('shape', {}), 0)
    if name == 'acker' and shape.get('wheelbase'):
        drive['wheelbase'] = float(shape['wheelbase'])
    sensors: list[dict[str, object]] = []
    for sensor in group.get('sensors') or ():
        if sensor.get('name', sensor.get('type')) not in ('lidar2d', 'lidar'):
            conversion.leave_out(f'left out: sensor {sensor.get("name", sensor.get("type"))}')
            continue
        angle = min(float(sensor.get('angle_range', math.pi)), math.tau)
        laser: dict[str, object] = {
            'kind': 'laser',
            'name': 'scan' if not sensors else f'scan_{len(sensors)}',
            'beams': int(sensor.get('number', 100)),
            'angle': [-angle / 2, angle / 2],
            'range': [float(sensor.get('range_min', 0.0)), float(sensor.get('range_max', 10.0))],
            'noise': float(sensor.get('std', 0.2)) if sensor.get('noise') else 0.0,
        }
        if 'offset' in sensor:
            laser['at'] = [float(value) for value in sensor['offset']]
        sensors.append(laser)
    return {'drive': drive, 'sensors': sensors}


def _nth(values: Any, i: int) -> Any:
    """Return the value of the body i of a group: one for all, or a list whose last is repeated."""
    if isinstance(values, Sequence) and values and isinstance(values[0], Sequence | Mapping):
        return values[min(i, len(values) - 1)]
    return values
