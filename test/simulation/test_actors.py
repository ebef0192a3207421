# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Actors in a world: what is refused, and what world files keep of them."""

from physsim_ros.files import load_world, save_world
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadProperty, Refusal, UnknownBody
from physsim_ros.model.requests import Anchor, ChangeBody, Delete, Restore, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
import pytest
import yaml

from .driven import assert_refused, body_request, put, seen_from_above

PATH = {'kind': 'path', 'points': [[0, 0], [2, 0]], 'speed': 1.0, 'repeat': 'to_and_fro'}


def test_an_actor_is_not_anchored():
    world = seen_from_above()
    spawn = body_request('a/0', actor=PATH, anchored=True)
    assert_refused(world, spawn, BadProperty, 'anchored')
    put(world, 'a/0', actor=PATH)
    assert_refused(
        world,
        ChangeBody(name='a/0', properties=Properties(anchored=True)),
        BadProperty,
        'anchored',
    )
    assert_refused(world, Anchor(point=(0.0, 0.0)), BadProperty, 'point')


def test_a_pedestrian_is_no_sensor_and_a_door_may_be():
    world = seen_from_above()
    walks = {'kind': 'orca', 'points': [[3, 0]]}
    assert_refused(world, body_request('a/0', actor=walks, sensor=True), BadProperty, 'sensor')
    put(world, 'a/0', actor=walks)
    assert_refused(
        world, ChangeBody(name='a/0', properties=Properties(sensor=True)), BadProperty, 'sensor'
    )
    put(world, 'b/0', actor=PATH, sensor=True, kinematic=True)
    world.step(240)
    assert world.snapshot().poses[1, 0] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ('start', 'field'),
    [
        ({'gate': 'door'}, 'gate'),
        ({'gate': 'a/0', 'by': 'tb'}, 'by'),
        ({'near': 'tb', 'distance': 1.0}, 'near'),
    ],
)
def test_an_actor_does_not_wait_for_a_body_that_there_is_not(tmp_path, start, field):
    world = seen_from_above()
    put(world, 'a/0')
    waits = {**PATH, 'start': start}
    assert_refused(
        world, ChangeBody(name='a/0', properties=Properties(actor=waits)), UnknownBody, field
    )
    spawn = Spawn(name='b/0', shape=Disc(radius=0.1), properties=Properties(actor=waits))
    assert_refused(world, spawn, UnknownBody, field)
    path = tmp_path / 'world.yaml'
    first = '{name: a/0, circle: {radius: 0.1}}'
    path.write_text(
        f'format: 1\nbodies: [{first}, {{name: b/0, circle: {{radius: 1}}, actor: {waits}}}]'
    )
    with pytest.raises(Refusal, match='there is no body') as caught:
        load_world(path, settings=WorldSettings(), physics_rate=240.0)
    assert (caught.value.code, caught.value.field) == ('bad_world_file', field)


def test_actors_under_way_are_saved_and_loaded_to_the_bit(tmp_path):
    world = seen_from_above()
    put(world, 'a/0', kinematic=True, actor=PATH)
    put(world, 'b/0', x=1.0, mass=70.0, actor={'kind': 'orca', 'points': [[3, 0], [-1, 0]]})
    force = {'kind': 'social_force', 'points': [[-1, 0], [3, 0]], 'repeat': 'loop'}
    put(world, 'c/0', x=3.0, kinematic=True, actor=force)
    put(
        world, 'd/0', x=5.0, shape=Box(width=0.2, height=0.4), actor={**PATH, 'start': {'time': 3}}
    )
    gate = {'gate': 'gate/0', 'by': 'a/0'}
    put(world, 'gate/0', x=1.9, sensor=True, anchored=True)
    put(world, 'e/0', x=8.0, kinematic=True, actor={**PATH, 'start': gate})
    world.step(100)
    # It is in no file then, and the actor waits for ever.
    world.apply(Delete(name='gate/0'))

    path = save_world(world.save(), 'actors', world_dir=tmp_path, physics_rate=240.0)
    loaded = load_world(path, settings=WorldSettings(), physics_rate=240.0)
    one, other = seen_from_above(), seen_from_above()
    one.apply(Restore(state=world.save()))
    other.apply(Restore(state=loaded))

    for _ in range(8):
        assert one.digest() == other.digest()
        one.step(120)
        other.step(120)
    assert one.space.table.actor_states['reached'].any()


@pytest.mark.parametrize(
    ('body', 'code', 'field'),
    [
        ('{name: b/0, circle: {radius: 1}, acting: {}}', 'bad_property', 'acting'),
        ('{name: b/0, circle: {radius: 1}, actor: PATH, acting: [1]}', 'bad_property', 'acting'),
        (
            '{name: b/0, circle: {radius: 1}, actor: PATH, acting: {seconds: a}}',
            'bad_property',
            'seconds',
        ),
        (
            '{name: b/0, circle: {radius: 1}, actor: PATH, acting: {reached: -1}}',
            'bad_property',
            'reached',
        ),
        (
            '{name: b/0, circle: {radius: 1}, actor: PATH, acting: {begun: 1}}',
            'unknown_property',
            'begun',
        ),
        ('{name: b/0, circle: {radius: 1}, actor: {kind: walk}}', 'bad_property', 'kind'),
        (
            '{name: b/0, circle: {radius: 1}, actor: PATH, anchored: true}',
            'bad_property',
            'anchored',
        ),
    ],
)
def test_a_file_with_an_actor_that_cannot_be_is_refused(tmp_path, body, code, field):
    path = tmp_path / 'world.yaml'
    path.write_text(f'format: 1\nbodies:\n  - {body.replace("PATH", str(PATH))}\n')
    with pytest.raises(Refusal) as caught:
        load_world(path, settings=WorldSettings(), physics_rate=240.0)
    assert caught.value.code == 'bad_world_file'
    assert (caught.value.cause, caught.value.field) == (code, field)


@pytest.mark.parametrize('kinematic', [True, False])
@pytest.mark.parametrize('actor', [PATH, {'kind': 'orca', 'points': [[9, 0]]}])
def test_a_body_that_is_no_actor_any_more_goes_on_by_itself(tmp_path, actor, kinematic):
    world, twin = seen_from_above(), seen_from_above()
    put(world, 'a/0', actor=actor, kinematic=kinematic)
    world.step(60)
    before = world.snapshot()
    put(twin, 'a/0', velocity=before.twists[0, :2].tolist(), kinematic=kinematic)

    world.apply(ChangeBody(name='a/0', unset=('actor',)))

    assert world.scene.bodies[0].actor is None
    assert world.snapshot().twists == pytest.approx(before.twists)
    world.step(60)
    twin.step(60)
    way = world.snapshot().poses - before.poses
    assert way == pytest.approx(twin.snapshot().poses, abs=1e-9)
    path = save_world(world.save(), 'w', world_dir=tmp_path, physics_rate=240.0)
    assert not {'actor', 'acting'} & {*yaml.safe_load(path.read_text())['bodies'][0]}
    again = seen_from_above()
    again.apply(Restore(state=load_world(path)))
    assert again.scene.key == world.scene.key
    # Only now may it be anchored.
    world.apply(Anchor(point=world.snapshot().poses[0, :2].tolist()))


def test_an_actor_that_is_unset_by_a_spawn_may_be_one_again_and_starts_anew():
    world = seen_from_above()
    put(world, 'a/0', kinematic=True, actor=PATH)
    world.step(120)
    spawn = Spawn(name='a/0', shape=Disc(radius=0.2), unset=('actor', 'kinematic'))
    world.apply(spawn)
    assert (world.scene.bodies[0].actor, world.scene.bodies[0].kinematic) == (None, False)

    world.apply(ChangeBody(name='a/0', properties=Properties(actor=PATH, kinematic=True)))

    world.step(240)
    assert world.snapshot().poses[0, 0] == pytest.approx(1.0)
