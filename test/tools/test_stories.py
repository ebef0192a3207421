# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The animations show what their captions say."""

from tools.gallery.stories import car_story, crash_story


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


def test_the_robot_hits_the_crate_and_passes_it_where_that_was_moved():
    frames = crash_story()
    turn = [frame.speed < 0.0 for frame in frames].index(True)
    names = frames[turn].snapshot.scene.names
    robot, crate = names.index('robot/0'), names.index('wall/0')
    crashed, ended = frames[turn - 1], frames[-1].snapshot.poses
    # Rows of the bodies that touch.
    assert {robot, crate} in [set(pair) for pair in crashed.contacts.pairs.tolist()]
    assert crashed.snapshot.poses[robot, 0] < ended[crate, 0] < ended[robot, 0]
