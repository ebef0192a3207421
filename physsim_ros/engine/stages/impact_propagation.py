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
Blows that run through bodies in touch, as through the balls of a cradle.

The engine measures how fast two bodies meet before a step, and solves all contacts of the step
together. A body that is struck while it rests against another one has no speed against that one
yet, so the two would take the blow as one body. Here a contact in which nothing has happened yet
waits while a neighbour is struck: the next step finds the speed that the blow has given, and
passes it on. Stiff bodies do the same, one contact after the other.

Law: only contacts between elastic bodies that forces move wait, for one step, and only those that
press with nothing yet.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from physsim_ros.engine.stages import pre_solve_hook
from physsim_ros.engine.stages.pre_solve_hook import ELASTIC, SLOWEST
import pymunk

# ruff: noqa: SLF001 - the engine's contacts have no public way to be written

# Whatever moves against its neighbour by less than this share of the blow has no speed yet.
SHARE = 0.05
# Steps for which a body is looked at after the last blow.
LASTS = 8
# With more bodies it is a pile that is shaken, not a row that is struck; to look at each of them
# in each step would cost more than the step.
MOST = 64


class Cascade:
    """
    Passes blows on in a space.

    :param space: whose contacts they come through
    """

    def __init__(self, space: pymunk.Space) -> None:
        # Bodies that have been struck, and for how many steps they are still looked at.
        self._struck: dict[pymunk.Body, int] = {}
        pre_solve_hook.hang(space, self._relay)

    def begin(self, struck: Iterable[pymunk.Body]) -> None:
        """Take note of bodies that begin to touch something elastic."""
        self._struck.update((body, LASTS) for body in struck)

    def forget(self, body: pymunk.Body) -> None:
        """Look no more at a body that leaves the space."""
        self._struck.pop(body, None)

    def _relay(self, *_: object) -> None:
        """Let contacts wait whose bodies are struck in the coming step."""
        if not self._struck:
            return
        struck = {body: left - 1 for body, left in self._struck.items() if left > 1}
        if len(self._struck) <= MOST:
            contacts = self._contacts()
            blows: dict[pymunk.Body, float] = {}
            for bodies, speeds, _ in contacts:
                blow = -min(speeds)
                if blow > SLOWEST:
                    for body in bodies:
                        blows[body] = max(blow, blows.get(body, 0.0))
            for bodies, speeds, raw in contacts:
                blow = max(blows.get(body, 0.0) for body in bodies)
                if max(map(abs, speeds)) < SHARE * blow:
                    _wait(raw, blow)
            struck.update(dict.fromkeys(blows, LASTS))
        self._struck = struck

    def _contacts(self) -> list[tuple[tuple[pymunk.Body, ...], list[float], Any]]:
        """Return contacts of what is struck: bodies, speeds apart [m/s], the engine's own."""
        found: dict[Any, tuple[tuple[pymunk.Body, ...], list[float], Any]] = {}

        def note(arbiter: pymunk.Arbiter) -> None:
            raw = arbiter._arbiter
            if raw in found or raw.e < ELASTIC or not raw.count:
                return
            bodies = arbiter.bodies
            if all(body.body_type == pymunk.Body.DYNAMIC for body in bodies):
                # The engine keeps speeds times restitution.
                speeds = [raw.contacts[place].bounce / raw.e for place in range(raw.count)]
                found[raw] = bodies, speeds, raw

        for body in self._struck:
            body.each_arbiter(note)
        return list(found.values())


def _wait(raw: Any, blow: float) -> None:
    """Let the bodies of a contact come together for a step as fast as the blow is [m/s]."""
    places = [raw.contacts[place] for place in range(raw.count)]
    # What presses already, as in a stack, cannot wait.
    if all(place.jnAcc <= SHARE * blow * place.nMass for place in places):
        for place in places:
            # The speed apart that the engine goes for is the negative of this.
            place.bounce = 2.0 * blow


class ImpactPropagation:
    def __init__(self, *_):
        pass
