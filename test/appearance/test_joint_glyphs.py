# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The lines of joints, in the poses of frames."""

from dataclasses import replace

import numpy as np
from physsim_ros.appearance import JointGlyphs
from physsim_ros.simulation.world import World

from ..building import DISC, join, spawn


def test_each_rope_has_the_line_that_it_has_alone():
    world = World()
    for number in range(6):
        spawn(world, f'a/{number}', DISC, (2.0 * number, (-1.0) ** number, 0.3 * number))
    for name, bodies in enumerate(((0, 1, 2), (1, 2, 3, 4), (3, 4, 5))):
        points = [(2.0 * number, (-1.0) ** number + 0.1) for number in bodies]
        first, *over, last = (f'a/{number}' for number in bodies)
        join(world, 'rope', points, f'rope/{name}', a=first, b=last, over=tuple(over))
    join(world, 'rod', [(0.0, 1.0), (2.0, -1.0)], 'rod/0', a='a/0', b='a/1')
    scene, poses = world.snapshot().scene, world.snapshot().poses
    frames = np.stack((poses, poses + 0.5))
    assert [len(each.guides) for each in scene.joints] == [1, 2, 1, 0]

    together = JointGlyphs(scene).corners(frames)
    alone = [JointGlyphs(replace(scene, joints=(each,))).corners(frames) for each in scene.joints]

    assert np.array_equal(together, np.concatenate(alone, axis=1))
