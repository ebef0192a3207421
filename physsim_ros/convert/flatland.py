# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Worlds of flatland: YAML with layers, which are maps, and models in files of their own.

A model with a drive and one body becomes a robot; other models become bodies with joints.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from pathlib import Path
from typing import Any

from physsim_ros.convert.conversion import (
    Circle,
    composed,
    Conversion,
    Line,
    line_shape,
    moved,
    Outline,
    Piece,
    pose_of,
    shape_of,
)
from physsim_ros.files import MOST_BYTES, read_bytes
from physsim_ros.model.transform import Pose
import yaml

Content = Mapping[str, Any]

# Properties of a footprint by their names here.
_MATERIAL = {'density': 'density', 'friction': 'friction', 'elasticity': 'restitution'}
_MOST = {'density': 1e12, 'friction': 10.0, 'elasticity': 1.0}
# Kinds of joints here.
_JOINTS = {'revolute': 'axle', 'weld': 'pin'}
_WORLD_KEYS = ('properties', 'layers', 'models')
_MODEL_KEYS = ('bodies', 'footprints', 'joints', 'plugins')
# Kinds of drives here; flatland moves models by velocities, without wheels.
_DRIVES = {'DiffDrive': 'differential', 'TricycleDrive': 'car', 'Bicycle': 'car'}


def convert(content: Content, folder: Path) -> Conversion:
    """Return the world of a file of flatland, whose other files lie in its folder."""
    conversion = Conversion(settings={'gravity': [0.0, 0.0], 'floor_friction': 0.6})
    conversion.leave_out_keys(content, _WORLD_KEYS, 'the world')
    for layer in content['layers'] or ():
        _add_layer(conversion, layer, folder)
    for model in content['models'] or ():
        _add_model(conversion, model, folder)
    return conversion


def _add_layer(conversion: Conversion, layer: Content, folder: Path) -> None:
    name = layer.get('map')
    if not isinstance(name, str):
        conversion.leave_out('left out: a layer without a map')
        return
    image = _load(folder / name)
    if image.get('type') == 'line_segments':
        scale, (x, y, *_) = float(image.get('scale', 1.0)), image.get('origin', (0.0, 0.0))
        text = ((folder / name).parent / image['data']).read_text('utf-8')
        for line in filter(str.strip, text.splitlines()):
            a, b, c, d = (scale * float(word) for word in line.split()[:4])
            shape = line_shape([(x + a, y + b), (x + c, y + d)])
            conversion.add_body('wall', shape, (0.0, 0.0, 0.0), anchored=True)
    elif 'map' in conversion.settings:
        conversion.leave_out('left out: a second map')
    else:
        conversion.settings['map'] = name


def _add_model(conversion: Conversion, model: Content, folder: Path) -> None:
    content = _load(folder / model['model'])
    conversion.leave_out_keys(content, _MODEL_KEYS, 'a model')
    pose = pose_of(model.get('pose', (0.0, 0.0, 0.0)))
    plugins: Sequence[Content] = content.get('plugins') or ()
    bodies: Sequence[Content] = content['bodies']
    robot = _robot_of(conversion, plugins, model) if len(bodies) == 1 else None
    if robot is None:
        for plugin in plugins:
            conversion.leave_out(f'left out: plugin {plugin["type"]} of a model that is no robot')
    names: dict[str, tuple[str, Pose]] = {}
    for body in bodies:
        place = composed(pose, body.get('pose', (0.0, 0.0, 0.0)))
        full = _add_body(conversion, body, place, str(model.get('name', 'model')), robot)
        names[body['name']] = full, place
    for joint in content.get('joints') or ():
        _add_joint(conversion, joint, names)


def _add_body(
    conversion: Conversion, body: Content, place: Pose, model: str, robot: Content | None
) -> str:
    prints: Sequence[Content] = body.get('footprints') or ()
    solid = [each for each in prints if not _is_sensor(each)]
    if solid and len(solid) < len(prints):
        conversion.leave_out('left out: a footprint that is a sensor of a solid body')
    prints = solid or prints
    shape, origin = shape_of([_piece_of(each) for each in prints], conversion)
    properties: dict[str, object] = {}
    first = prints[0]
    for ours, theirs in _MATERIAL.items():
        if theirs in first:
            # Box2D has no greatest friction.
            properties[ours] = min(float(first[theirs]), _MOST[ours])
    if properties.get('density') == 0.0:
        del properties['density']
    if not solid and robot is None:
        properties['sensor'] = True
    if robot is not None:
        properties = {**properties, 'robot': robot}
    elif body.get('type', 'dynamic') != 'dynamic':
        properties['anchored' if body['type'] == 'static' else 'kinematic'] = True
    if 'color' in body:
        properties['color'] = [float(value) for value in body['color']]
    name = model if robot is not None else f'{model}_{body["name"]}'
    return conversion.add_body(name, shape, composed(place, origin), **properties)


def _is_sensor(footprint: Content) -> bool:
    return bool(footprint.get('sensor', footprint.get('is_sensor')))


def _piece_of(footprint: Content) -> Piece:
    if footprint['type'] == 'circle':
        x, y = footprint.get('center', (0.0, 0.0))
        return Circle(float(footprint['radius']), (float(x), float(y)))
    points = tuple((float(x), float(y)) for x, y in footprint['points'])
    return Outline(points) if len(points) > 2 else Line(points)


def _add_joint(
    conversion: Conversion, joint: Content, names: Mapping[str, tuple[str, Pose]]
) -> None:
    kind = _JOINTS.get(joint['type'])
    if kind is None:
        conversion.leave_out(f'left out: a joint {joint["type"]}')
        return
    a, b = joint['bodies']
    (name_a, pose_a), (name_b, _) = names[a['name']], names[b['name']]
    x, y = a.get('anchor', (0.0, 0.0))
    point = moved(pose_a, (float(x), float(y)))
    conversion.add_joint(
        str(joint.get('name', '')),
        kind,
        [point],
        a=name_a,
        b=name_b,
        collide=bool(joint.get('collide_connected', False)),
    )


def _robot_of(
    conversion: Conversion, plugins: Sequence[Content], model: Content
) -> dict[str, object] | None:
    """Return the robot that plugins of a model make it; None without a drive."""
    drive = next((_DRIVES[each['type']] for each in plugins if each['type'] in _DRIVES), None)
    if drive is None:
        return None
    sensors: list[dict[str, object]] = []
    for plugin in plugins:
        kind, name = plugin['type'], str(plugin.get('topic', plugin.get('name', ''))).strip('/')
        if kind == 'Laser':
            sensors.append(_laser_of(plugin, name or 'scan'))
        elif kind == 'Bumper':
            sensors.append({'kind': 'bumper', 'name': name or 'bumper', 'sector': 2 * math.pi})
        elif kind in _DRIVES:
            conversion.leave_out('a drive has the default track, wheels and limits: set them')
        else:
            conversion.leave_out(f'left out: plugin {kind}')
    robot: dict[str, object] = {'drive': {'kind': drive}, 'sensors': sensors}
    if 'namespace' in model:
        robot['namespace'] = str(model['namespace'])
    return robot


def _laser_of(plugin: Content, name: str) -> dict[str, object]:
    angle = plugin['angle']
    low, high, step = (float(angle[key]) for key in ('min', 'max', 'increment'))
    rate = float(plugin.get('update_rate', 10.0))
    return {
        'kind': 'laser',
        'name': name,
        'at': [float(value) for value in plugin.get('origin', (0.0, 0.0, 0.0))],
        'beams': round((high - low) / step) + 1,
        'angle': [low, min(high, low + 2 * math.pi)],
        'range': [0.0, float(plugin['range'])],
        'rate': rate if math.isfinite(rate) else 10.0,
        'noise': float(plugin.get('noise_std_dev', 0.0)),
    }


def _load(path: Path) -> Content:
    content: Content = yaml.safe_load(read_bytes(path, MOST_BYTES))
    return content
