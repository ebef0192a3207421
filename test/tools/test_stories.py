# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The animations show what their captions say."""

from physsim_ros import load_world, MoveBodies, Robot, Simulation
from tools.gallery.stories import (
    ASIDE,
    car_story,
    CRASH_BACK,
    CRASH_END,
    CRASH_TURN,
    CRATE,
    YARD,
)


def test_the_car_passes_below_a_wall_and_ends_at_it_after_a_branch():
    frames = car_story()
    past = [frame.past for frame in frames]
    turn, branch = past.index(True), len(past) - past[::-1].index(True)
    assert not any(past[branch:])
    # Bodies in spawn order: the road, the chassis, its wheels, the wall.
    passed, ended = frames[turn - 1].snapshot.poses, frames[-1].snapshot.poses
    assert passed[1, 0] > passed[-1, 0]
    assert ended[1, 0] < ended[-1, 0]
    assert ended[-1, 1] < passed[-1, 1]


def test_the_robot_hits_the_crate_and_passes_it_where_that_was_moved(tmp_path):
    file = tmp_path / 'yard.yaml'
    file.write_text(YARD)
    simulation = Simulation()
    simulation.load(load_world(file))
    robot = Robot(simulation, 'robot/0')
    simulation.run(CRASH_TURN)
    assert robot.bumped

    simulation.seek(round(CRASH_BACK * 1e9))
    assert not robot.bumped
    simulation.perform(MoveBodies(names=('crate/0',), by=ASIDE))
    simulation.run(CRASH_END - CRASH_BACK)
    x, y, _ = robot.truth().pose
    assert not robot.bumped
    # It has gone round the shelf.
    assert x < CRATE[0]
    assert y > 1.0
