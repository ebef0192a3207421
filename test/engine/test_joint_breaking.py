# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints break under their own load, in the step in which it comes, and that is told."""

import numpy as np
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from .jointed import joints
from ..building import BOX, command, DISC, DT, G, join, joining, spawn


def test_a_joint_breaks_where_it_is_loaded_too_much_and_that_is_told():
    sim = Simulation()
    spawn(sim.world, 'a/0', BOX, mass=1.0)
    sim.perform(joining('axle', [(0.0, 0.0)], break_force=5.0))
    answers = [answer for _ in range(3) for answer in sim.advance_frame().answers]
    (broken,) = [answer for answer in answers if answer.code == 'joint_broken']
    assert broken.subject == 'joint/0'
    assert joints(sim.world) == ()


def test_a_joint_that_is_strong_enough_does_not_break():
    world = World()
    spawn(world, 'a/0', BOX, mass=1.0)
    join(world, 'axle', [(0.0, 0.0)], break_force=15.0)
    world.step(480)
    assert world.take_broken() == []
    assert len(joints(world)) == 1


def test_a_joint_that_is_held_apart_breaks_under_its_load():
    world = World()
    spawn(world, 'plate/0', Box(width=4.0, height=0.2), (0.0, 1.0, 0.0), anchored=True)
    spawn(world, 'a/0', DISC, mass=1.0)
    # Too short by 1.7 m when the disc has come up to the plate.
    said = {'length': 2.0, 'break_force': 0.5 * G}
    join(world, 'rope', [(0.0, 0.0), (0.0, 4.0)], a='a/0', b='world', **said)
    world.step(240)
    assert [name for name, _ in world.take_broken()] == ['joint/0']


def test_a_commanded_velocity_does_not_load_a_joint_by_itself():
    world = World()
    spawn(world, 'a/0', DISC, mass=1.0)
    join(world, 'axle', [(0.0, 0.0)], break_force=1.01 * G)
    world.step(240)
    command(world, 'a/0', twist=(0.0, 0.0, 1.0))
    world.step(1)
    assert world.snapshot().forces == pytest.approx([G], rel=1e-6)
    assert world.take_broken() == []


@pytest.mark.parametrize('height', [0.3, 5.1])
def test_what_breaks_lets_go_alike_however_steps_are_counted_out(height):
    worlds = []
    for _ in range(2):
        world = World(settings=WorldSettings(bounds=(-40.0, 0.0, 40.0, 90.0)))
        spawn(world, 'a/0', BOX, (0.0, 10.0, 0.0), velocity=(4.0, 0.0))
        spawn(world, 'a/1', BOX, (3.0, height, 0.3))
        ends = [(0.0, 10.0), (3.0, height)]
        join(world, 'rope', ends, length=4.0, break_force=10.0, a='a/0', b='a/1')
        worlds.append(world)

    worlds[0].step(480)
    for _ in range(480):
        worlds[1].step(1)

    assert np.array_equal(*(world.snapshot().poses for world in worlds))
    assert worlds[0].take_broken() == worlds[1].take_broken() != []


def come(world: World, number: int) -> None:
    join(world, 'axle', [(50.0, 0.0)], f'far/{number}', a='far/0', b='world')


def expire(world: World, number: int) -> None:
    if number == 0:
        for each in range(1, 4):
            spawn(world, f'brief/{each}', DISC, (50.0, 2.0 * each, 0.0), lifetime=each * DT)
            join(world, 'pin', [(50.0, 2.0 * each)], f'brief/{each}')


@pytest.mark.parametrize('change', [come, expire, lambda world, _: world.renew()])
def test_joints_that_come_and_go_and_checkpoints_change_no_break(change):
    world = World()
    spawn(world, 'far/0', DISC, (50.0, 0.0, 0.0))
    spawn(world, 'a/0', BOX, mass=1.0)
    join(world, 'axle', [(0.0, 0.0)], break_force=9.0)
    told = []
    for number in range(3):
        change(world, number)
        world.step(1)
        told += [(number, name) for name, _ in world.take_broken()]

    # In its first step a joint does not break.
    assert told == [(1, 'joint/0')]


def test_a_joint_whose_first_step_is_to_come_is_new_in_a_checkpoint_too():
    world = World()
    # In free flight its velocity leads by half a step, which the joint takes back: 14.7 N.
    spawn(world, 'a/0', BOX, mass=1.0)
    join(world, 'axle', [(0.0, 0.0)], break_force=12.0)
    key = world.renew()
    world.step(3)
    digest = world.digest()

    world.resume(key)
    world.step(3)

    assert len(joints(world)) == 1
    assert world.digest() == digest
