# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
After any requests in any order, every step of the past is as it was, by any way, to the bit.

That is law 26 of `docs/laws.md`. HISTORIES says how many histories are played, 20 where it does
not; `histories` has the oracle.
"""

import os

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import MoveBodies, Spawn
from physsim_ros.model.shapes import Disc
import pytest

from .histories import check, play
from .random_history import history_of, ROBOTS, SHAPES
from ..outside import run_python

SEEDS = range(int(os.environ.get('HISTORIES', '20')))


def asked_discs(count, height):
    """Return operations that add a leaning column of discs from a height on [m]."""
    poses = [(0.1 * row, height + 0.7 * row, 0.0) for row in range(count)]
    shape = Disc(radius=0.3)
    return [
        ('ask', Spawn(name=f'a/{row}', shape=shape, pose=pose)) for row, pose in enumerate(poses)
    ]


@pytest.mark.parametrize('seed', SEEDS)
def test_a_history_shows_what_its_requests_show_when_they_are_played_from_nothing(seed):
    check(seed)


def test_a_world_is_loaded_as_it_was_saved_where_a_first_touch_has_moved_a_body():
    # Found by seed 200290: the contact is over, and its impulses are in the cache.
    box, polygon = SHAPES[2:4]
    fast = Properties(mass=0.1, velocity=(117.26, -157.1), spin=-100.0)
    slow = Properties(density=2.0, velocity=(1.01, 1.34), spin=-0.46)
    robot = Properties(robot=ROBOTS[0])
    play(
        [
            ('begin', 240.0, 60.0, 0.1, False),
            ('ask', Spawn(name='a/1', shape=box, pose=(-2.62, 0.13, 0.23), properties=fast)),
            ('ask', Spawn(name='a/3', shape=polygon, pose=(1.56, 1.71, 1.71), properties=slow)),
            ('ask', Spawn(name='a/1', shape=Disc(radius=0.2), pose=(-0.36, 4.7, -0.5),
                          properties=robot)),
            ('ask_running', Spawn(name='a/1', shape=polygon, pose=(0.0, 9.0, 0.0),
                                  properties=Properties(sensor=True))),
            ('save',),
        ]
    )  # fmt: skip


def test_a_world_is_loaded_as_it_was_saved_where_a_body_flies_though_it_touches_another():
    # Found by seed 1017: a body that is loaded in flight counts as thrown.
    falling = Properties(velocity=(-0.12, -0.95), spin=0.34)
    disc = Spawn(name='a/0', shape=Disc(radius=0.3), pose=(-0.07, 0.44, -0.2), properties=falling)
    play(
        [
            ('begin', 60.0, 60.0, 1.0, True),
            ('load_shipped', 'galton'),
            ('ask', disc),
            ('run', 1.0, 8),
            ('reset',),
            ('undo',),
            ('ask', MoveBodies(names=('ball/100',), by=(1.82, 1.0))),
            ('run', 4.0, 10),
            ('run', -4.0, 10),
            ('save',),
        ]
    )


def test_a_world_that_returns_to_its_last_request_passes_the_same_checkpoints():
    # Found by seed 1269.
    play(
        [
            ('begin', 240.0, 60.0, 0.1, False),
            *asked_discs(5, 0.5),
            ('undo',),
            ('run', 1.0, 40),
            ('redo',),
            ('undo',),
            ('run', 1.0, 40),
        ]
    )


def test_lines_that_have_run_on_from_a_saved_moment_show_what_they_have_shown():
    # A course that has been left goes on from the moment to which the undo leads.
    play(
        [
            ('begin', 240.0, 60.0, 0.5, False),
            *asked_discs(6, 1.0),
            ('save',),
            ('load',),
            ('reset',),
            ('run', 1.0, 60),
            ('seek', 0.5),
            ('ask', Spawn(name='b/0', shape=Disc(radius=0.3), pose=(2.0, 5.0, 0.0))),
            ('undo',),
            ('save_moment', 40),
            ('course', 0),
            ('seek', 0.9),
            ('course', 0),
            ('run', 1.0, 5),
            ('undo',),
            ('redo',),
            ('redo',),
            ('drag', 'a/0', (1.0, 3.0), 3, False),
            ('save_moment', 3),
            ('restore',),
        ]
    )


@pytest.mark.slow
def test_a_history_shows_the_same_in_another_process():
    words = ('-m', 'test.simulation.histories', '17', '--digest')
    assert run_python(*words, PYTHONHASHSEED='7').strip() == play(history_of(17)).digest()
