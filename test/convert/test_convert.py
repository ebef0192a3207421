# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Worlds of other programs become world files, and what has no like here is told."""

from __future__ import annotations

import base64
import json
import math
import re
import struct
import zlib

import numpy as np
from physsim_ros.convert import __main__ as converting
from physsim_ros.convert import content as converted_content
from physsim_ros.convert.__main__ import main
from physsim_ros.convert.content import Content
from physsim_ros.files import load_world
from physsim_ros.model.errors import BadWorldFile, Refusal, WorldFull
import pytest
import yaml

FLATLAND = """
properties: {}
layers:
  - {name: ground, map: room.yaml}
models:
  - {name: burger, pose: [1.0, 2.0, 1.5707963], model: burger.model.yaml, namespace: tb}
  - {name: door, pose: [4.0, 0.0, 0.0], model: door.model.yaml}
"""
BURGER = """
bodies:
  - name: base
    type: dynamic
    color: [1, 1, 0, 0.5]
    footprints:
      - {type: circle, radius: 0.1, density: 2.0, friction: 1e6}
      - {type: polygon, sensor: true, points: [[0, 0], [0.1, 0], [0.1, 0.1]]}
plugins:
  - {type: DiffDrive, name: drive, body: base}
  - {type: Laser, name: laser, topic: scan, body: base, range: 8.0, update_rate: 20.0,
     angle: {min: -1.0, max: 1.0, increment: 0.02}, noise_std_dev: 0.01}
  - {type: ModelTfPublisher, name: tf}
"""
DOOR = """
bodies:
  - {name: frame, type: static,
     footprints: [{type: polygon, points: [[0, 0], [0.1, 0], [0.1, 1], [0, 1]]}]}
  - {name: leaf, type: dynamic, pose: [0.1, 0, 0],
     footprints: [{type: polygon, points: [[0, 0], [0.9, 0], [0.9, 0.05], [0, 0.05]], density: 5}]}
joints:
  - {type: revolute, name: hinge,
     bodies: [{name: frame, anchor: [0.1, 0]}, {name: leaf, anchor: [0, 0]}]}
plugins: [{type: Tween, name: swing, body: leaf}]
"""
ROOM = """
type: line_segments
data: room.dat
scale: 1.0
origin: [0, 0, 0]
"""
IRSIM = """
world: {height: 10, width: 12, step_time: 0.1}
robot:
  - kinematics: {name: diff}
    shape: {name: circle, radius: 0.2}
    state: [1, 1, 0]
    goal: [9, 9, 0]
    vel_max: [1.5, 2.0]
    behavior: {name: dash}
    sensors: [{type: lidar2d, range_min: 0, range_max: 5, angle_range: 3.14, number: 90}]
    plot: {show_trail: true}
    plot: {show_trail: false}
    keyboard: {}
obstacle:
  - shape: {name: linestring, vertices: [[5, 5], [4, 0]]}
    state: [0, 0, 0]
    unobstructed: true
  - shape: {name: polygon, random_shape: true}
  - number: 2
    distribution: {name: manual}
    shape: [{name: circle, radius: 1.0}, {name: rectangle, length: 2.0, width: 1.0}]
    state: [[5, 5, 0], [6, 8, 0.5]]
"""
TILED = {
    'orientation': 'orthogonal',
    'tilewidth': 32,
    'tileheight': 32,
    'width': 10,
    'height': 5,
    'tiledversion': '1.10',
    'layers': [
        {
            'type': 'tilelayer',
            'name': 'ground',
            'width': 10,
            'height': 5,
            'encoding': 'base64',
            'compression': 'zlib',
            'data': base64.b64encode(
                zlib.compress(struct.pack('<50I', *[0] * 40, *[7] * 10))
            ).decode(),
        },
        {
            'type': 'objectgroup',
            'name': 'things',
            'objects': [
                {'name': 'ramp', 'x': 64, 'y': 128, 'rotation': 0,
                 'polygon': [{'x': 0, 'y': 0}, {'x': 64, 'y': 0}, {'x': 64, 'y': -32}]},
                {'name': 'ball', 'x': 32, 'y': 0, 'width': 16, 'height': 16, 'ellipse': True,
                 'properties': [{'name': 'mass', 'value': 2.0}, {'name': 'hp', 'value': 3}]},
                {'name': 'start', 'x': 0, 'y': 0, 'point': True},
            ],
        },
    ],
}  # fmt: skip
RUBE = {
    'gravity': {'x': 0, 'y': -10},
    'body': [
        {'name': 'ground', 'type': 0, 'position': 0, 'angle': 0, 'fixture': [
            {'polygon': {'vertices': {'x': [-5, 5, 5, -5], 'y': [-1, -1, 0, 0]}}}]},
        {'name': 'bob', 'type': 2, 'position': {'x': 1, 'y': 3}, 'angle': 0,
         'linearVelocity': {'x': 2, 'y': 0}, 'linearDamping': 0.1, 'fixture': [
            {'density': 1, 'circle': {'radius': 0.5, 'center': 0}}]},
        {'name': 'cup', 'type': 2, 'position': {'x': -2, 'y': 4}, 'angle': 0, 'fixture': [
            {'density': 2, 'friction': 0.3, 'restitution': 0.2, 'filter-groupIndex': -4,
             'polygon': {'vertices': {'x': [0, 1, 1, 0], 'y': [0, 0, 1, 1]}}},
            {'density': 2, 'friction': 0.5, 'restitution': 0.1, 'filter-maskBits': 6,
             'polygon': {'vertices': {'x': [1, 2, 2, 1], 'y': [0, 0, 1, 1]}}}]},
        {'name': 'cart', 'type': 2, 'position': {'x': 3, 'y': 3}, 'angle': 0, 'bullet': True,
         'massData-mass': 7, 'massData-I': 2, 'massData-center': {'x': 0.1, 'y': 0}, 'fixture': [
            {'density': 1, 'circle': {'radius': 0.5, 'center': {'x': 0.1, 'y': 0}}},
            {'sensor': True, 'density': 3, 'circle': {'radius': 0.7, 'center': 0}}]},
    ],
    'joint': [
        {'type': 'distance', 'name': 'string', 'bodyA': 0, 'bodyB': 1, 'anchorA': {'x': 1, 'y': 6},
         'anchorB': 0, 'length': 3, 'frequency': 2, 'dampingRatio': 0.5},
        {'type': 'revolute', 'bodyA': 1, 'bodyB': 2, 'anchorA': 0, 'anchorB': 0,
         'enableMotor': True, 'motorSpeed': 3, 'maxMotorTorque': 40},
        {'type': 'wheel', 'bodyA': 1, 'bodyB': 2, 'anchorA': 0, 'anchorB': 0},
        {'type': 'prismatic', 'bodyA': 0, 'bodyB': 3, 'anchorA': {'x': 3, 'y': 3}, 'anchorB': 0,
         'localAxisA': {'x': 3, 'y': 4}, 'enableLimit': True, 'lowerLimit': -1, 'upperLimit': 2,
         'enableMotor': True, 'motorSpeed': 0.5, 'maxMotorForce': 30, 'refAngle': 0.1},
    ],
}  # fmt: skip


def converted(tmp_path, name, text, capsys):
    """Return the world that a file becomes, and what is printed about it."""
    (tmp_path / name).write_text(text, encoding='utf-8')
    target = tmp_path / 'out.yaml'

    assert main([str(tmp_path / name), str(target)]) == 0
    world = load_world(target)
    return {each.body.name: each for each in world.bodies}, world, capsys.readouterr().out


def test_a_world_of_flatland_has_walls_a_robot_and_a_door(tmp_path, capsys):
    for name, text in {
        'room.yaml': ROOM,
        'room.dat': '0 0 5 0\n5 0 5 5\n',
        'burger.model.yaml': BURGER,
        'door.model.yaml': DOOR,
    }.items():
        (tmp_path / name).write_text(text)
    bodies, world, printed = converted(tmp_path, 'world.yaml', FLATLAND, capsys)

    assert sorted(bodies) == ['burger/0', 'door_frame/0', 'door_leaf/0', 'wall/0', 'wall/1']
    robot = bodies['burger/0'].body.robot
    assert bodies['burger/0'].pose == pytest.approx((1.0, 2.0, math.pi / 2), abs=1e-6)
    assert robot.namespace == 'tb'
    assert bodies['burger/0'].body.friction == 10.0
    (laser,) = robot.sensors
    assert (laser.beams, laser.range, laser.rate) == (101, (0.0, 8.0), 20.0)
    assert bodies['door_frame/0'].body.anchored
    (hinge,) = world.joints
    assert (hinge.a, hinge.b) == ('door_frame/0', 'door_leaf/0')
    assert 'left out: plugin ModelTfPublisher\n' in printed
    assert printed.count('of a model that is no robot') == 1
    assert 'left out: plugin Tween of a model that is no robot\n' in printed
    assert 'a drive has the default track, wheels and limits: set them' in printed


def test_a_map_of_flatland_is_that_of_the_world_file(tmp_path, capsys):
    image = 'P2 2 2 255\n0 255\n255 255\n'
    (tmp_path / 'room.pgm').write_text(image)
    (tmp_path / 'room.yaml').write_text(
        '{image: room.pgm, resolution: 0.5, origin: [0, 0, 0], negate: 0, '
        'occupied_thresh: 0.65, free_thresh: 0.2}'
    )
    text = 'properties: {}\nlayers: [{name: a, map: room.yaml}]\nmodels: []\n'
    bodies, _, _ = converted(tmp_path, 'world.yaml', text, capsys)

    assert list(bodies) == ['map/0']
    assert bodies['map/0'].pose == pytest.approx((0.25, 0.75, 0.0))


def test_a_world_of_irsim_has_a_robot_that_goes_and_obstacles(tmp_path, capsys):
    bodies, world, printed = converted(tmp_path, 'robot_world.yaml', IRSIM, capsys)

    assert sorted(bodies) == ['obstacle/0', 'obstacle/1', 'obstacle/2', 'robot/0']
    assert world.settings.bounds == (0.0, 0.0, 12.0, 10.0)
    robot = bodies['robot/0'].body
    assert (robot.robot.drive.max_speed, robot.robot.drive.max_turn) == (1.5, 2.0)
    assert robot.robot.sensors[0].angle == pytest.approx((-1.57, 1.57))
    assert robot.actor.points == ((1.0, 1.0), (9.0, 9.0))
    assert bodies['obstacle/2'].body.anchored
    assert bodies['obstacle/0'].body.sensor
    assert bodies['obstacle/2'].pose == (6.0, 8.0, 0.5)
    assert 'left out: robot[].keyboard' in printed


def test_robots_of_irsim_on_a_circle_are_evenly_apart_and_face_its_centre(tmp_path, capsys):
    circle = '{name: circle, center: [5, 6], radius: 4}'
    text = f'world: {{}}\nrobot: [{{number: 5, distribution: {circle}}}]'
    bodies, *_ = converted(tmp_path, 'robot_world.yaml', text, capsys)

    poses = [each.pose for each in bodies.values()]
    for (x, y, yaw), other in zip(poses, (*poses[1:], poses[0]), strict=True):
        ahead = (x + 4.0 * math.cos(yaw), y + 4.0 * math.sin(yaw))
        assert ahead == pytest.approx((5.0, 6.0))
        assert math.dist((x, y), other[:2]) == pytest.approx(8.0 * math.sin(math.pi / 5))


def test_a_map_of_tiled_has_tiles_and_objects_a_tile_wide_a_metre(tmp_path, capsys):
    bodies, _, printed = converted(tmp_path, 'level.tmj', json.dumps(TILED), capsys)

    # The lowest row of five is full.
    assert bodies['ground/0'].pose == (5.0, 0.5, 0.0)
    assert bodies['ground/0'].body.shape.entry() == {'width': 10.0, 'height': 1.0}
    assert bodies['ramp/0'].pose == (2.0, 1.0, 0.0)
    assert bodies['ramp/0'].body.anchored
    assert bodies['ball/0'].pose == pytest.approx((1.25, 4.75, 0.0))
    assert bodies['ball/0'].body.mass == 2.0
    assert not bodies['ball/0'].body.anchored
    assert 'left out: property hp' in printed
    assert 'left out: a point' in printed


def test_the_offset_of_a_layer_of_tiled_moves_its_tiles_and_objects(tmp_path, capsys):
    moved = [layer | {'offsetx': 64, 'offsety': -32} for layer in TILED['layers']]
    before, *_ = converted(tmp_path, 'level.tmj', json.dumps(TILED), capsys)
    (tmp_path / 'out.yaml').unlink()
    after, *_ = converted(tmp_path, 'level.tmj', json.dumps(TILED | {'layers': moved}), capsys)

    for name, each in before.items():
        assert after[name].pose == pytest.approx(np.add(each.pose, (2.0, 1.0, 0.0)))


def test_an_object_of_tiled_turns_about_its_corner(tmp_path, capsys):
    box = {'name': 'box', 'x': 32, 'y': 128, 'width': 64, 'height': 32, 'rotation': 90}
    layer = {'type': 'objectgroup', 'name': 'things', 'objects': [box]}
    text = json.dumps({**TILED, 'layers': [layer]})
    bodies, _, _ = converted(tmp_path, 'level.json', text, capsys)

    # From its corner at (1, 1) two metres down, and one to the left.
    assert bodies['box/0'].pose == pytest.approx((0.5, 0.0, -math.pi / 2))


def test_a_scene_of_rube_has_masses_motion_and_joints(tmp_path, capsys):
    bodies, world, printed = converted(tmp_path, 'scene.json', json.dumps(RUBE), capsys)

    assert world.settings.gravity == (0.0, -10.0)
    assert bodies['ground/0'].body.anchored
    assert bodies['bob/0'].body.mass == pytest.approx(math.pi / 4)
    assert bodies['bob/0'].twist[:2] == (2.0, 0.0)
    assert bodies['cup/0'].body.mass == pytest.approx(4.0)
    joints = {each.name: each for each in world.joints}
    mass = math.pi / 4
    spring = joints['string/0']
    assert spring.number('stiffness') == pytest.approx(mass * (4.0 * math.pi) ** 2)
    assert spring.number('damping') == pytest.approx(mass * 4.0 * math.pi)
    assert joints['motor/0'].number('rate') == 3.0
    assert (joints['motor/0'].a, joints['motor/0'].b) == ('cup/0', 'bob/0')
    rail = joints['slider/0']
    assert [rail.number(key) for key in ('rate', 'max_force', 'upper')] == [0.5, 30.0, 2.0]
    assert bodies['cart/0'].body.mass == 7.0
    assert 'left out: body[].massData-I' in printed
    assert 'left out: body[].fixture[].filter-maskBits' in printed
    for key in ('friction', 'restitution', 'filter-groupIndex'):
        assert f'parts of a body differ in {key}: that of the first one counts' in printed
    assert 'left out: a joint wheel' in printed
    assert 'left out: body[].linearDamping' in printed


def turned(scene, angle):
    """Return a scene of R.U.B.E. that is turned about the origin."""
    c, s = math.cos(angle), math.sin(angle)

    def around(vector):
        x, y = vector['x'], vector['y']
        return {'x': c * x - s * y, 'y': s * x + c * y}

    moved = [
        {**body, 'position': around(body['position']), 'angle': body['angle'] + angle}
        for body in scene['body']
    ]
    return {**scene, 'body': moved}


@pytest.mark.parametrize('angle', [0.3, -1.2])
def test_joints_of_a_scene_of_rube_that_is_turned_keep_their_limits(tmp_path, capsys, angle):
    disc = [{'density': 1, 'circle': {'radius': 0.5, 'center': 0}}]
    of_both = {'bodyA': 0, 'bodyB': 1, 'enableLimit': True, 'anchorA': 0, 'anchorB': 0}
    joints = [
        {'type': 'revolute', 'name': 'hinge', 'refAngle': 0.2, 'lowerLimit': -0.7,
         'upperLimit': 1},
        {'type': 'prismatic', 'name': 'rail', 'localAxisA': {'x': 3, 'y': 4}, 'lowerLimit': -3,
         'upperLimit': 4},
    ]  # fmt: skip
    scene = {
        'gravity': 0,
        'body': [
            {'type': 2, 'position': {'x': 1, 'y': 2}, 'angle': 0.5, 'fixture': disc},
            {'type': 2, 'position': {'x': 2, 'y': 3}, 'angle': 0.9, 'fixture': disc},
        ],
        'joint': [of_both | joint for joint in joints],
    }

    def limits(name, scene):
        _, world, _ = converted(tmp_path, f'{name}.json', json.dumps(scene), capsys)
        (tmp_path / 'out.yaml').unlink()
        return {each.name: (each.number('lower'), each.number('upper')) for each in world.joints}

    found = limits('as it is', scene)
    assert found['hinge/0'] == pytest.approx((-0.7 - 0.2, 1.0 - 0.2))
    # The second body is farther on the axis, whose direction is that of the first.
    along = math.sqrt(2.0) * math.cos(math.atan2(4.0, 3.0) + 0.5 - math.pi / 4)
    assert found['rail/0'] == pytest.approx((-3.0 - along, 4.0 - along))
    for name, each in limits('turned', turned(scene, angle)).items():
        assert each == pytest.approx(found[name])


def test_a_file_that_is_there_is_not_written_over(tmp_path, capsys):
    source = tmp_path / 'scene.json'
    source.write_text(json.dumps(RUBE))
    (tmp_path / 'scene-world.yaml').write_text('mine')

    assert main([str(source)]) == 1
    assert 'File exists' in capsys.readouterr().err
    assert (tmp_path / 'scene-world.yaml').read_text() == 'mine'


def tiled_of(width, data):
    """Return a map of Tiled with one row of tiles."""
    layer = {'type': 'tilelayer', 'name': 'a', 'height': 1, 'width': width}
    packed = {'compression': 'zlib', 'data': data}
    return json.dumps({'tilewidth': 1, 'tileheight': 1, 'layers': [layer | packed]})


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        ('<?xml version="1.0"?><sdf version="1.9"/>', 'SDF'),
        ('format: 1\nbodies: []\n', 'no world of flatland, ir-sim, Tiled, R.U.B.E.'),
        ('layers: [{map: nowhere.yaml}]\nmodels: []\n', 'nowhere.yaml'),
        ('layers: [{map: /dev/zero}]\nmodels: []\n', 'not a regular file'),
        ('layers: 3\nmodels: []\n', 'no valid world of flatland'),
        ('[' * 2000, 'no valid YAML'),
        ('a: 2001-13-45', 'month must be in 1..12'),
        (f'a: {"9" * 5000}', 'Exceeds the limit'),
        ('world: {width: 9}\nrobot: {number: 1000000000}', 'more than 20,000 bodies'),
        ('world: {width: 9}\nrobot: {number: .inf}', 'robot.number must be a whole number'),
        (tiled_of(1, 'AAAA'), 'no valid world of Tiled'),
        (tiled_of(10**9, 'AAAA'), 'more than 16,000,000 tiles'),
        (tiled_of(1, base64.b64encode(zlib.compress(bytes(10**6))).decode()), 'no 1 x 1 tiles'),
    ],
)
def test_what_cannot_be_converted_is_told(tmp_path, capsys, text, told):
    source = tmp_path / 'it.yaml'
    source.write_text(text)

    assert main([str(source)]) == 1
    assert told in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [source]


# Values of which each is wrong somewhere.
ODD = (None, True, -1, 0, 2.5, 1e300, math.nan, math.inf, 'x', '', [], [1.0], [[]], {}, {'x': 1})
FILES = {'burger.model.yaml': BURGER, 'door.model.yaml': DOOR, 'room.yaml': ROOM}
SAMPLES = {
    **FILES,
    'flatland': FLATLAND,
    'ir-sim': IRSIM,
    'Tiled': json.dumps(TILED),
    'R.U.B.E.': json.dumps(RUBE),
}


def places_in(content, place=''):
    """Yield the mapping or list, the key or index, and the place of each value at any depth."""
    for key in list(content) if isinstance(content, dict) else range(len(content)):
        here = f'{place}.{key}'.strip('.') if isinstance(content, dict) else f'{place}[]'
        yield content, key, here
        if isinstance(content[key], dict | list):
            yield from places_in(content[key], here)


def contents_of(tmp_path, monkeypatch, sample):
    """Return the content of a sample, which `converting.convert` reads as it is then."""
    world = FLATLAND if sample in FILES else SAMPLES[sample]
    texts = {**FILES, 'room.dat': '0 0 5 0\n', 'world.yaml': world}
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    contents = {name: yaml.safe_load(text) for name, text in texts.items()}
    for module in (converting, converted_content):
        monkeypatch.setattr(module, 'parsed', lambda _, name: contents[name])
    return contents[sample if sample in FILES else 'world.yaml']


def outcome_of(path):
    """Return the world file that a file becomes, with what is told; or why it is refused."""
    try:
        conversion = converting.convert(path)
    except Refusal as refusal:
        return str(refusal)
    return conversion.text(), *conversion.told()


@pytest.mark.parametrize('sample', SAMPLES)
def test_each_key_of_a_file_is_carried_over_or_told(tmp_path, monkeypatch, sample):
    content, path = contents_of(tmp_path, monkeypatch, sample), tmp_path / 'world.yaml'
    content['unheard_of'] = 1
    # Keys without effect, and those of a thing that is left out whole, are told as any other.
    monkeypatch.setattr(Content, 'skip', lambda *_: None)
    monkeypatch.setattr(Content, 'settle', lambda _: None)
    before = outcome_of(path)
    silent = []
    for holder, key, place in [*places_in(content, sample if sample in FILES else '')]:
        kept = holder[key]
        if isinstance(kept, dict):
            holder[key] = kept | {'unheard_of': 1}
        elif isinstance(kept, bool):
            holder[key] = not kept
        elif isinstance(kept, int | float):
            holder[key] = 1.25 * kept + 1.0
        if holder[key] is not kept and outcome_of(path) == before:
            silent.append(place)
        holder[key] = kept
    told = [re.sub(r'left out: | \(.*', '', sentence) for sentence in before[1:]]
    # A path ends at a goal, at whatever heading. Of what differs, the name is told.
    known = (*told, 'robot[].goal', *re.findall(r'differ in ([\w-]+)', ''.join(told)))
    assert [each for each in silent if not any(key in each for key in known)] == []


@pytest.mark.parametrize('sample', SAMPLES)
def test_a_value_that_is_wrong_is_a_mistake_of_the_file_and_no_error_of_ours(
    tmp_path, monkeypatch, sample
):
    content, path = contents_of(tmp_path, monkeypatch, sample), tmp_path / 'world.yaml'
    refused = 0
    converting.convert(path)
    for holder, key, _ in [*places_in(content)]:
        kept = holder[key]
        for odd in ODD:
            holder[key] = odd
            try:
                converting.convert(path)
            except (Refusal, OSError):
                refused += 1
        holder[key] = kept
    assert refused > len(ODD)


@pytest.mark.parametrize(
    ('text', 'told'),
    [
        ('<?xml version="1.0"?>\n<!-- a robot -->\n<robot name="r"/>', 'this is URDF'),
        ('<sdf version="1.9"><world/></sdf>', 'this is SDF, of Gazebo'),
        ('<html/>', 'this is XML'),
        # Declarations without end take no time without end.
        ('<!>' * 3000 + 'x', 'must be a YAML mapping'),
        ('{image: a.pgm, resolution: 0.1, origin: [0, 0, 0]}', 'name it as `map:`'),
        (FLATLAND, 'a world of flatland: python -m physsim_ros.convert'),
        (IRSIM.replace('plot: {show_trail: false}', ''), 'a world of ir-sim'),
        (json.dumps(TILED), 'a world of Tiled'),
        (json.dumps(RUBE), 'a world of R.U.B.E.'),
        ('strokes: []', 'a drawing'),
    ],
)
def test_a_file_of_another_kind_is_named_where_a_world_is_loaded(tmp_path, text, told):
    path = tmp_path / 'it.yaml'
    path.write_text(text)

    with pytest.raises(BadWorldFile) as refused:
        load_world(path)
    assert told in str(refused.value)


@pytest.mark.parametrize('refusal', [BadWorldFile, WorldFull])
def test_a_world_file_that_is_refused_is_there_to_be_edited(
    tmp_path, capsys, monkeypatch, refusal
):
    def refused(_):
        raise refusal('too much')

    monkeypatch.setattr(converting, 'load_world', refused)
    source, target = tmp_path / 'map.json', tmp_path / 'map-world.yaml'
    source.write_text(json.dumps(TILED), 'utf-8')

    assert main([str(source)]) == 1

    assert target.exists()
    assert capsys.readouterr().err == f'{target} is written, but too much\n'
