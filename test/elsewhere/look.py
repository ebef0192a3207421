# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Wait for the first poses of a world, and tell how long that took."""

from __future__ import annotations

import time

from geometry_msgs.msg import PoseArray
from visitor import Visitor


def main() -> None:
    visitor = Visitor()
    print('LOOKING', flush=True)  # noqa: T201 - the world may begin
    poses: list[tuple[float, int]] = []

    def see(message: PoseArray) -> None:
        # The clock that the test reads too.
        poses.append((time.monotonic(), len(message.poses)))

    visitor.node.create_subscription(PoseArray, '/physsim/poses', see, 10)
    visitor.spin_until(lambda: poses, 'a first pose')
    visitor.finish(first=poses[0][0], bodies=poses[0][1])


if __name__ == '__main__':
    main()
