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

"""What is shown of a drawing that is not in the world, or not yet."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.shapes import Point

Line = tuple[Point, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """
    Lines, points and words over the world.

    :param lines: each from point to point [m]
    :param points: that were clicked [m]
    :param label: what it is; '' says nothing
    """

    lines: tuple[Line, ...] = ()
    points: Line = ()
    label: str = ''

    @property
    def top(self) -> Point:
        """Return the highest point of it, over which its label stands [m]."""
        every = [*self.points, *(point for line in self.lines for point in line)]
        return max(every, key=lambda point: point[1], default=(0.0, 0.0))


NOTHING = Preview()
