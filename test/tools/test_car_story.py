# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The animation of the README shows what its caption says."""

from tools.gallery.car_story import car_story


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
