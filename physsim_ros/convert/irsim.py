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

import numpy as np
from physsim_ros.convert.content import BadContent, Content, pose_of
from physsim_ros.convert.conversion import Conversion, line_shape, MOST_BODIES, SEEN_FROM_ABOVE
from physsim_ros.model.transform import Pose

_DRIVES = {'diff': 'differential', 'omni': 'omni', 'acker': 'car'}
# Greatest speed and turn rate, where a group does not set them.
_SPEEDS = (1.0, 1.0)
# Greatest steering angle [rad].
_MOST_STEERING = 1.5


def convert(content: Content, _folder: Path) -> Conversion:
    """Return the world of a file of ir-sim."""
    world = content.entry('world')
    conversion = Conversion(settings={**SEEN_FROM_ABOVE})
    world.skip('name', 'step_time', 'sample_time', 'plot')
    x, y = world.point('offset', (0.0, 0.0))
    width, height = world.number('width', 10.0), world.number('height', 10.0)
    conversion.settings['bounds'] = [x, y, x + width, y + height]
    for kind in ('robot', 'obstacle'):
        is_one = isinstance(content.get(kind), Mapping)
        for group in [content.entry(kind)] if is_one else content.entries(kind):
            group.skip('plot')
            _add_group(conversion, group, kind)
    return conversion


def _add_group(conversion: Conversion, group: Content, kind: str) -> None:
    number = group.whole('number', 1)
    if number > MOST_BODIES:
        raise BadContent(f'there are more than {MOST_BODIES:,} bodies')
    for i, pose in enumerate(_poses(conversion, group, number)):
        described = _shape_entry(group, i)
        properties: dict[str, object] = {'sensor': True} if group.is_set('unobstructed') else {}
        kinematics = _kinematics_of(group)
        actor = _actor_of(conversion, group, i, pose) if kinematics else None
        if described.is_set('random_shape'):
            conversion.leave_out(described, f'{kind} with a random shape')
            continue
        shape, radius = _shape_of(described)
        if kind == 'robot':
            properties['robot'] = _robot_of(conversion, group, kinematics or 'diff', radius)
            if actor is not None:
                properties['actor'] = actor
        elif actor is None:
            properties['anchored'] = True
        else:
            properties['actor'] = actor
            if actor['kind'] == 'path':
                properties['kinematic'] = True
        conversion.add_body(group.text('name', kind), shape, pose, **properties)


def _poses(conversion: Conversion, group: Content, number: int) -> list[Pose]:
    distribution = group.part(group.get('distribution') or {}, group.place('distribution'))
    match distribution.get('name', 'manual'):
        case 'circle':
            x, y = distribution.point('center', (5.0, 5.0))
            radius = distribution.number('radius', 4.0)
            angles = [math.tau * i / number for i in range(number)]
            return [
                (x + radius * math.cos(a), y + radius * math.sin(a), a + math.pi) for a in angles
            ]
        case 'random':
            conversion.tell('random places are drawn once, with seed 0')
            low = distribution.pose('range_low', (0.0, 0.0, -math.pi))
            high = distribution.pose('range_high', (10.0, 10.0, math.pi))
            places = np.random.default_rng(0).uniform(
                np.minimum(low, high), np.maximum(low, high), (number, 3)
            )
            return [(x, y, yaw) for x, y, yaw in places.tolist()]
    states = group.get('state', (1.0, 1.0, 0.0))
    return [pose_of(_nth(states, i), group.place('state')) for i in range(number)]


def _shape_entry(group: Content, i: int) -> Content:
    """Return the entry of the shape of a body of a group."""
    shapes = group.get('shape', {'name': 'circle', 'radius': 0.2})
    return group.part(_nth(shapes, i), group.place('shape'))


def _kinematics_of(group: Content) -> str:
    """Return the kind of kinematics of a group; '' for none."""
    if not group.is_set('kinematics'):
        return ''
    return group.entry('kinematics').text('name', 'diff')


def _shape_of(shape: Content) -> tuple[dict[str, object], float]:
    """Return a shape, and half its width [m]."""
    match shape.get('name'):
        case 'circle':
            radius = shape.number('radius', 0.2)
            return {'circle': {'radius': radius}}, radius
        case 'rectangle':
            length, width = shape.number('length', 0.2), shape.number('width', 0.1)
            if not shape.is_set('wheelbase'):
                return {'box': {'width': length, 'height': width}}, width / 2
            # The origin of a car is its rear axle.
            back = -(length - shape.number('wheelbase')) / 2
            xs, y = (back, back + length), width / 2
            return {'polygon': [[xs[0], -y], [xs[1], -y], [xs[1], y], [xs[0], y]]}, y
        case 'polygon':
            points = shape.points('vertices')
            half = max((abs(y) for _, y in points), default=0.0)
            return {'polygon': [[x, y] for x, y in points]}, half
        case 'linestring':
            return line_shape(shape.points('vertices')), 0.1
        case other:
            raise BadContent(f'{shape.place("name")} is of no known shape: {other}')


def _actor_of(
    conversion: Conversion, group: Content, i: int, pose: Pose
) -> dict[str, object] | None:
    goal, behaviors = group.get('goal'), _nth(group.get('behavior'), i)
    if not goal or not behaviors:
        if goal or behaviors:
            conversion.tell('left out: a goal without a behaviour, or one without a goal')
        return None
    x, y, _ = pose_of(_nth(goal, i), group.place('goal'))
    behavior = group.part(behaviors, group.place('behavior'))
    name = behavior.text('name', 'dash')
    if name not in ('dash', 'rvo', 'orca'):
        conversion.tell(f'behaviour {name} becomes a straight path')
    speed, _ = _greatest_speeds(group)
    repeat = 'to_and_fro' if behavior.is_set('loop') else 'once'
    here, there = [pose[0], pose[1]], [x, y]
    if name in ('rvo', 'orca') and _kinematics_of(group) == 'omni':
        return {'kind': 'orca', 'points': [there], 'speed': speed}
    return {'kind': 'path', 'points': [here, there], 'speed': speed, 'repeat': repeat}


def _robot_of(
    conversion: Conversion, group: Content, kinematics: str, radius: float
) -> dict[str, object]:
    if kinematics not in _DRIVES:
        raise BadContent(f'{group.place("kinematics")} is of no known kind: {kinematics}')
    drive: dict[str, object] = {'kind': _DRIVES[kinematics], 'track': 2 * radius}
    drive['max_speed'], turn = _greatest_speeds(group)
    if kinematics == 'diff':
        drive['max_turn'] = turn
    elif kinematics == 'acker':
        drive['steering'] = min(turn, _MOST_STEERING)
        shape = _shape_entry(group, 0)
        if shape.is_set('wheelbase'):
            drive['wheelbase'] = shape.number('wheelbase')
    lasers: list[dict[str, object]] = []
    for sensor in group.entries('sensors'):
        kind = sensor.text('name', sensor.text('type', ''))
        if kind in ('lidar2d', 'lidar'):
            name = 'scan' if not lasers else f'scan_{len(lasers)}'
            lasers.append(_laser_of(sensor, name))
        else:
            conversion.leave_out(sensor, f'sensor {kind}')
    return {'drive': drive, 'sensors': lasers}


def _laser_of(sensor: Content, name: str) -> dict[str, object]:
    angle = min(sensor.number('angle_range', math.pi), math.tau)
    laser: dict[str, object] = {
        'kind': 'laser',
        'name': name,
        'beams': sensor.whole('number', 100),
        'angle': [-angle / 2, angle / 2],
        'range': [sensor.number('range_min', 0.0), sensor.number('range_max', 10.0)],
        'noise': sensor.number('std', 0.2) if sensor.is_set('noise') else 0.0,
    }
    if 'offset' in sensor:
        laser['at'] = sensor.numbers('offset')
    return laser


def _greatest_speeds(group: Content) -> tuple[float, float]:
    """Return the greatest speed [m/s] and turn rate [rad/s] of a group."""
    speed, turn, *_ = (*group.numbers('vel_max', _SPEEDS), *_SPEEDS)
    return speed, turn


def _nth(values: object, i: int) -> object:
    """Return the value of the body i of a group: one for all, or a list whose last is repeated."""
    if isinstance(values, Sequence) and values and isinstance(values[0], Sequence | Mapping):
        return values[min(i, len(values) - 1)]
    return values
