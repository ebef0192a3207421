# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Let a disc fall from 5 m in a world that runs, and tell where it was seen when."""

from __future__ import annotations

from sensor_msgs.msg import MultiDOFJointState
from visitor import disc, stamp_of, Visitor
from visualization_msgs.msg import Marker


def main() -> None:
    visitor = Visitor()
    states = visitor.listen(MultiDOFJointState, '/physsim/states')
    spawn = visitor.publisher(Marker, '/physsim/spawn')
    visitor.spin_until(lambda: len(states) > 3, 'a world that runs')
    spawn.publish(disc('ball', 0, 1.0, 5.0, 0.5, '{velocity: [0.5, 0]}'))

    def deep() -> bool:
        last = states[-1]
        return bool(last.transforms) and last.transforms[0].translation.y < -5.0

    visitor.spin_until(deep, 'a fall of 10 m')
    visitor.finish(
        frames=[
            (
                stamp_of(each),
                list(each.joint_names),
                [[way.translation.x, way.translation.y] for way in each.transforms],
                [[twist.linear.x, twist.linear.y] for twist in each.twist],
            )
            for each in states
        ]
    )


if __name__ == '__main__':
    main()
