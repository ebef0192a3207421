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

from physsim_ros.convert.content import BadContent, Content, numbers
from physsim_ros.convert.conversion import (
    clamped,
    Conversion,
    Line,
    line_shape,
    Piece,
    SEEN_FROM_ABOVE,
    shape_of,
)
from physsim_ros.model.checks import DENSITY, ELASTICITY, FRICTION
from physsim_ros.model.shapes import Circle, Convex
from physsim_ros.model.transform import composed, local_to_world, Pose

# Names and ranges here of properties of a footprint.
_MATERIAL = {
    'density': ('density', DENSITY),
    'friction': ('friction', FRICTION),
    'restitution': ('elasticity', ELASTICITY),
}
# Kinds of joints here.
_JOINTS = {'revolute': 'axle', 'weld': 'pin'}
# Kinds of drives here; flatland moves models by velocities, without wheels.
_DRIVES = {'DiffDrive': 'differential', 'TricycleDrive': 'car', 'Bicycle': 'car'}
# Rate of a laser that has none [Hz].
_RATE = 10.0
_ORIGIN = (0.0, 0.0, 0.0)


def convert(content: Content, folder: Path) -> Conversion:
    """Return the world of a file of flatland, whose other files lie in its folder."""
    conversion = Conversion(settings={**SEEN_FROM_ABOVE})
    # Iterations of the solver of Box2D.
    content.skip('properties')
    for layer in content.entries('layers'):
        layer.skip('name')
        _add_layer(conversion, layer, folder)
    for model in content.entries('models'):
        _add_model(conversion, model, folder)
    return conversion


def _add_layer(conversion: Conversion, layer: Content, folder: Path) -> None:
    name = layer.get('map')
    if not isinstance(name, str):
        conversion.leave_out(layer, 'a layer without a map')
        return
    image = layer.load(folder / name)
    if image.get('type') == 'line_segments':
        scale, origin = image.number('scale', 1.0), image.pose('origin', _ORIGIN)
        path = (folder / name).parent / image.text('data')
        for line in filter(str.strip, path.read_text('utf-8').splitlines()):
            found = numbers(line.split()[:4], path.name)
            if len(found) < 4:
                raise BadContent(f'{path.name} must have four numbers a line')
            a, b, c, d = (scale * each for each in found)
            conversion.add_body('wall', line_shape([(a, b), (c, d)]), origin, anchored=True)
    elif 'map' in conversion.settings:
        conversion.leave_out(image, 'a second map')
    else:
        # The map of a world file is the same file.
        image.settle()
        conversion.settings['map'] = name


def _add_model(conversion: Conversion, model: Content, folder: Path) -> None:
    content = model.load(folder / model.text('model'))
    pose = model.pose('pose', _ORIGIN)
    plugins, bodies = content.entries('plugins'), content.entries('bodies')
    robot = _robot_of(conversion, plugins, model) if len(bodies) == 1 else None
    if robot is None:
        for plugin in plugins:
            kind = plugin.text('type')
            conversion.leave_out(plugin, f'plugin {kind} of a model that is no robot')
    names: dict[str, tuple[str, Pose]] = {}
    for body in bodies:
        place = composed(pose, body.pose('pose', _ORIGIN))
        full = _add_body(conversion, body, place, model.text('name', 'model'), robot)
        names[body.text('name')] = full, place
    for joint in content.entries('joints'):
        _add_joint(conversion, joint, names)


def _add_body(
    conversion: Conversion,
    body: Content,
    place: Pose,
    model: str,
    robot: Mapping[str, object] | None,
) -> str:
    prints = body.entries('footprints')
    solid = conversion.solid_parts(prints, _is_sensor)
    prints = solid or prints
    shape, origin = shape_of([_piece_of(each) for each in prints], conversion)
    properties: dict[str, object] = {}
    first = prints[0]
    for key, (name, check) in _MATERIAL.items():
        if key in first:
            # Box2D has no greatest friction.
            properties[name] = clamped(conversion.of_first(prints, key), check)
    if first.get('density') == 0:
        del properties['density']
    if not solid and robot is None:
        properties['sensor'] = True
    kind = body.text('type', 'dynamic')
    if robot is not None:
        properties['robot'] = robot
        if kind != 'dynamic':
            conversion.tell(f'a robot is dynamic, not {kind}')
    elif kind != 'dynamic':
        properties['anchored' if kind == 'static' else 'kinematic'] = True
    if 'color' in body:
        properties['color'] = body.numbers('color')
    name = model if robot is not None else f'{model}_{body.text("name")}'
    return conversion.add_body(name, shape, composed(place, (*origin, 0.0)), **properties)


def _is_sensor(footprint: Content) -> bool:
    return footprint.is_set('sensor' if 'sensor' in footprint else 'is_sensor')


def _piece_of(footprint: Content) -> Piece:
    if footprint.text('type') == 'circle':
        return Circle(footprint.point('center', (0.0, 0.0)), footprint.number('radius'))
    points = tuple(footprint.points('points'))
    return Convex(points) if len(points) > 2 else Line(points)


def _add_joint(
    conversion: Conversion, joint: Content, names: Mapping[str, tuple[str, Pose]]
) -> None:
    kind = _JOINTS.get(joint.text('type'))
    if kind is None:
        conversion.leave_out(joint, f'a joint {joint.text("type")}')
        return
    bodies = joint.entries('bodies')
    unknown = [each.place('name') for each in bodies if each.text('name') not in names]
    if unknown or len(bodies) != 2:
        raise BadContent(f'{joint.place("bodies")} must be two bodies of the model')
    a, b = bodies
    (name_a, pose_a), (name_b, pose_b) = names[a.text('name')], names[b.text('name')]
    at_a, at_b = (
        local_to_world(each.point('anchor', (0.0, 0.0)), pose)
        for each, pose in ((a, pose_a), (b, pose_b))
    )
    conversion.add_joint(
        joint.text('name', ''),
        kind,
        [conversion.common_anchor(at_a, at_b)],
        a=name_a,
        b=name_b,
        collide=joint.is_set('collide_connected'),
    )


def _robot_of(
    conversion: Conversion, plugins: Sequence[Content], model: Content
) -> dict[str, object] | None:
    """Return the robot that plugins of a model make it; None without a drive."""
    kinds = [each.text('type') for each in plugins]
    drive = next((_DRIVES[kind] for kind in kinds if kind in _DRIVES), None)
    if drive is None:
        return None
    sensors: list[dict[str, object]] = []
    for kind, plugin in zip(kinds, plugins, strict=True):
        name = plugin.text('topic', plugin.text('name', '')).strip('/')
        plugin.skip('body')
        if kind == 'Laser':
            sensors.append(_laser_of(plugin, name or 'scan'))
        elif kind == 'Bumper':
            sensors.append({'kind': 'bumper', 'name': name or 'bumper', 'sector': 2 * math.pi})
        elif kind in _DRIVES:
            conversion.tell('a drive has the default track, wheels and limits: set them')
        else:
            conversion.leave_out(plugin, f'plugin {kind}')
    robot: dict[str, object] = {'drive': {'kind': drive}, 'sensors': sensors}
    if 'namespace' in model:
        robot['namespace'] = model.text('namespace')
    return robot


def _laser_of(plugin: Content, name: str) -> dict[str, object]:
    angle = plugin.entry('angle')
    low, high = angle.number('min'), angle.number('max')
    # Flatland's default is infinite: a scan in each of its steps.
    is_limited = plugin.get('update_rate') != math.inf
    return {
        'kind': 'laser',
        'name': name,
        'at': [*plugin.pose('origin', _ORIGIN)],
        'beams': round((high - low) / angle.divisor('increment')) + 1,
        'angle': [low, min(high, low + 2 * math.pi)],
        'range': [0.0, plugin.number('range')],
        'rate': plugin.number('update_rate', _RATE) if is_limited else _RATE,
        'noise': plugin.number('noise_std_dev', 0.0),
    }
