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

"""
Bodies made ready for the space that the next keyframe is built in, some in every frame.

To build a thousand bodies at once, and to throw as many away, takes three times as long as all the
rest of a keyframe. What the space before this one has left over is used again.
"""

from __future__ import annotations

from physsim_ros.engine import body as rigid_body
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.space import Space
from physsim_ros.model.scene import Scene


class Spares:
    """
    Bodies outside any space, as good as new.

    :param retired: a space that is used no more; None is none
    """

    def __init__(self, retired: Space | None = None) -> None:
        self.bodies: dict[str, RigidBody] = {}
        self._retired = retired
        if retired is not None:
            retired.retire()
        # What has been looked through for bodies that have none, and how far.
        self._scene: Scene | None = None
        self._row = 0

    def add(self, scene: Scene, count: int) -> None:
        """Make so many more bodies ready, as far as a scene needs them."""
        while count and self._retired is not None:
            rigid = self._retired.give_up()
            if rigid is None:
                self._retired = None
            else:
                self.bodies[rigid.body.name] = rigid
                count -= 1
        if scene is not self._scene:
            self._scene, self._row = scene, 0
        while count and self._row < len(scene.bodies):
            body = scene.bodies[self._row]
            spare = self.bodies.get(body.name)
            if spare is None or spare.body is not body:
                self.bodies[body.name] = rigid_body.build(body, self._row)
                count -= 1
            self._row += 1
