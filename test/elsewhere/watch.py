# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A program that knows the world by its topics alone, and sees where bodies go."""

from __future__ import annotations

import sys

from sensor_msgs.msg import MultiDOFJointState
from visitor import stamp_of, Visitor


def places(states: MultiDOFJointState) -> dict[str, list[float]]:
    """Return x, y [m] of every body."""
    where = (transform.translation for transform in states.transforms)
    return {name: [each.x, each.y] for name, each in zip(states.joint_names, where, strict=True)}


def main(seconds: float) -> None:
    visitor = Visitor()
    states = visitor.listen(MultiDOFJointState, '/physsim/states')
    visitor.spin_until(lambda: states, 'a state')
    until = stamp_of(states[0]) + round(seconds * 1e9)
    visitor.spin_until(lambda: stamp_of(states[-1]) >= until, 'simulation time')
    visitor.finish(first=places(states[0]), last=places(states[-1]))


if __name__ == '__main__':
    main(float(sys.argv[1]))
