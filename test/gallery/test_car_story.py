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

"""The animation of the README shows what its caption says."""

from .car_story import car_story


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
