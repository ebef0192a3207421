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
Blows that a body takes at several places at once, as at a crease or on two corners.

Each contact wants its own speed apart, and the engine goes from one to the next, a few times over.
Where normals are nearly parallel, or points on both sides of a centre of mass are struck, that is
far from what they agree on, and what is elastic leaves with more energy than it came with. Here
the engine goes on for as long as they need, in a step in which such a blow falls.

Law: contacts that agree give an elastic body its energy back, and no more; of a crowd the engine
goes through no more contacts than `MOST`, so that no step takes long.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.stages import pre_solve_hook
from physsim_ros.engine.stages.pre_solve_hook import ELASTIC, SLOWEST
import pymunk
from pymunk import batch

# ruff: noqa: SLF001 - the speeds of the engine's contacts have no public way to be read

# So often the engine goes through all contacts: a disc in creases of 2° then keeps its energy to
# a ten-thousandth for a hundred blows; a third as often, to a thousandth.
ITERATIONS = 3000
# So many contacts it goes through in a step, however many there are: half a millisecond. Of a
# crowd that falls together, all of elasticity 1, a step takes half as long again by that.
MOST = 20_000


class Blows:
    """
    Lets contacts agree that are struck together in a space.

    :param space: whose contacts they are
    :param arrays: of it
    """

    def __init__(self, space: pymunk.Space, arrays: EngineArrays) -> None:
        self._space = space
        self._arrays = arrays
        # Bodies that begin to touch something elastic in the coming step.
        self._begun: dict[pymunk.Body, None] = {}
        # How often the engine otherwise goes through all contacts, while it does so more often.
        self._usual: int | None = None
        pre_solve_hook.hang(space, self._more).post_solve = self._as_before

    def begin(self, struck: Iterable[pymunk.Body]) -> None:
        """Take note of bodies that begin to touch something elastic."""
        self._begun.update(dict.fromkeys(struck))

    def _more(self, *_: object) -> None:
        """Let the engine go on for longer if blows of the coming step have to agree."""
        if not self._begun:
            return
        begun, self._begun = self._begun, {}
        contacts = self._arrays.contacts(batch.ArbiterFields.CONTACT_COUNT)[0]
        iterations = min(ITERATIONS, MOST // max(1, len(contacts)))
        usual = self._space.iterations
        if iterations > usual and any(map(_struck_together, begun)):
            self._usual, self._space.iterations = usual, iterations

    def _as_before(self, *_: object) -> None:
        if self._usual is not None:
            self._space.iterations, self._usual = self._usual, None


def _struck_together(body: pymunk.Body) -> bool:
    """Tell whether a body takes a blow while it touches at several points."""
    bounces: list[float] = []

    def note(arbiter: pymunk.Arbiter) -> None:
        raw: Any = arbiter._arbiter
        # The engine keeps speeds times restitution.
        bounces.extend(raw.contacts[place].bounce for place in range(raw.count))

    body.each_arbiter(note)
    return len(bounces) > 1 and min(bounces) < -SLOWEST * ELASTIC
