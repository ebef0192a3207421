# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Actors in a world: what is refused, and what world files keep of them."""

from physsim_ros.model.errors import BadProperty, UnknownBody
from physsim_ros.model.requests import Anchor, ChangeBody, Spawn
from physsim_ros.model.shapes import Disc
import pytest
import yaml

from .driven import (
    assert_refused,
    body_request,
    changing,
    put,
    refusal_of_file,
    seen_from_above,
    twins,
)

PATH = {'kind': 'path', 'points': [[0, 0], [2, 0]], 'speed': 1.0, 'repeat': 'to_and_fro'}


def test_an_actor_is_not_anchored():
    world = seen_from_above()
    spawn = body_request('a/0', actor=PATH, anchored=True)
    assert_refused(world, spawn, BadProperty, 'anchored')
    put(world, 'a/0', actor=PATH)
    assert_refused(world, changing('a/0', anchored=True), BadProperty, 'anchored')
    assert_refused(world, Anchor(point=(0.0, 0.0)), BadProperty, 'point')


def test_a_pedestrian_is_no_sensor_and_a_door_may_be():
    world = seen_from_above()
    walks = {'kind': 'orca', 'points': [[3, 0]]}
    assert_refused(world, body_request('a/0', actor=walks, sensor=True), BadProperty, 'sensor')
    put(world, 'a/0', actor=walks)
    assert_refused(world, changing('a/0', sensor=True), BadProperty, 'sensor')
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
    assert_refused(world, changing('a/0', actor=waits), UnknownBody, field)
    assert_refused(world, body_request('b/0', actor=waits), UnknownBody, field)
    second = f'{{name: b/0, circle: {{radius: 1}}, actor: {waits}}}'
    refusal = refusal_of_file(tmp_path, '{name: a/0, circle: {radius: 0.1}}', second)
    assert refusal.field == field
    assert 'there is no body' in str(refusal)


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
    _, again = twins(world, tmp_path)
    assert again.scene.key == world.scene.key
    (path,) = tmp_path.glob('*.yaml')
    assert not {'actor', 'acting'} & {*yaml.safe_load(path.read_text())['bodies'][0]}
    # Only now may it be anchored.
    world.apply(Anchor(point=world.snapshot().poses[0, :2].tolist()))


def test_an_actor_that_is_unset_by_a_spawn_may_be_one_again_and_starts_anew():
    world = seen_from_above()
    put(world, 'a/0', kinematic=True, actor=PATH)
    world.step(120)
    spawn = Spawn(name='a/0', shape=Disc(radius=0.2), unset=('actor', 'kinematic'))
    world.apply(spawn)
    assert (world.scene.bodies[0].actor, world.scene.bodies[0].kinematic) == (None, False)

    world.apply(changing('a/0', actor=PATH, kinematic=True))

    world.step(240)
    assert world.snapshot().poses[0, 0] == pytest.approx(1.0)
