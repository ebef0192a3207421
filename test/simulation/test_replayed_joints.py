# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints in replay: removed, broken, and loaded again."""

from physsim_ros.files import load_world, save_world
from physsim_ros.model.requests import Anchor, Command, Pin
from physsim_ros.simulation.world import World

from .driven import dropped, FLOOR, SECOND, told
from ..building import BOX, joining, spawning


def test_a_joint_that_broke_is_told_of_once():
    driven = dropped('b/0')
    points = ((0.0, 5.0), (0.0, 8.0))
    weak = {'stiffness': 20.0, 'break_force': 5.0}
    driven.ask(joining('spring', points, a='b/0', b='world', **weak))
    frames = driven.run(1.0, 2.0)
    assert len(told(frames, 'joint_broken')) == 1
    driven.simulation.seek(0)
    frames = driven.run(1.0, 1.5)
    driven.simulation.seek(SECOND)
    frames.append(driven.apply_requests())
    assert told(frames, 'joint_broken') == []


def test_a_checkpoint_keeps_the_force_of_a_joint_and_the_step_at_which_it_breaks():
    world = World()
    world.apply(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    points = ((0.0, 5.0), (0.0, 8.0))
    world.apply(joining('rod', points, a='b/0', b='world', break_force=100.0))
    world.step(240)
    held = world.snapshot().forces
    world.renew()
    assert held[0] > 1.0
    assert world.snapshot().forces == held
    world.apply(Command(names=('b/0',), wrenches=((0.0, -1000.0, 0.0),)))
    world.step(1)
    assert [name for name, _ in world.take_broken()] == ['joint/0']


def test_a_joint_whose_bodies_were_anchored_later_loads_again(tmp_path):
    driven = dropped('b/0')
    driven.ask(Pin(point=(0.0, 5.0)))
    driven.ask(Anchor(point=(0.0, 5.0)))
    driven.apply_requests()
    state = driven.simulation.save()
    path = save_world(state, 'it', world_dir=tmp_path, physics_rate=240.0)
    assert load_world(path, settings=FLOOR, physics_rate=240.0).joints == state.joints
