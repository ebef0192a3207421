# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
