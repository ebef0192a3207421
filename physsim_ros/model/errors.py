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
The one family of errors; each class carries the stable code of its refusal.

Law: a refusal changes nothing, and says what and why.
"""

from __future__ import annotations


class PhysSimError(Exception):
    """Everything this package raises on purpose."""


class Refusal(PhysSimError):
    """
    A request that the world does not carry out.

    :param message: one sentence: what is refused and why
    :param field: the offending field of the request, '' where it is the whole
    :param values: what else there is to tell, as pairs of key and value
    """

    code = 'refused'

    def __init__(
        self, message: str, *, field: str = '', values: tuple[tuple[str, str], ...] = ()
    ) -> None:
        super().__init__(_sayable(message))
        self.field = _sayable(field)
        self.values = values


def _sayable(text: str) -> str:
    """Return a text without what no message and no log can hold: halves of characters."""
    return text.encode(errors='replace').decode()


class Malformed(Refusal):
    """Not a number, infinite, or arrays whose lengths do not fit."""

    code = 'malformed'


class UnknownShape(Refusal):
    """A marker type that has no body."""

    code = 'unknown_shape'


class BadSize(Refusal):
    """A length that is not positive, too small or too large to simulate."""

    code = 'bad_size'


class BadOutline(Refusal):
    """An outline that crosses itself or encloses no area."""

    code = 'bad_outline'


class NotPlanar(Refusal):
    """A rotation that leaves the plane."""

    code = 'not_planar'


class UnknownFrame(Refusal):
    """A frame that is neither the world nor a body."""

    code = 'unknown_frame'


class UnknownProperty(Refusal):
    """A property that a body, or a joint of that kind, does not have."""

    code = 'unknown_property'


class BadProperty(Refusal):
    """A property whose value is of the wrong kind or out of its range."""

    code = 'bad_property'


class UnknownBody(Refusal):
    """A name that no body has."""

    code = 'unknown_body'


class UnknownJoint(Refusal):
    """A name that no joint has."""

    code = 'unknown_joint'


class Anchored(Refusal):
    """Motion asked of a body that is fixed to the background, or a joint between two that are."""

    code = 'anchored'


class NothingThere(Refusal):
    """A point with no body under it."""

    code = 'nothing_there'


class WorldFull(Refusal):
    """One body more than the world may hold."""

    code = 'world_full'


class NotRecognised(Refusal):
    """A stroke that might mean anything."""

    code = 'not_recognised'


class BadWorldFile(Refusal):
    """A world file that cannot be read, written or understood."""

    code = 'bad_world_file'


class OutOfHistory(Refusal):
    """A time that is kept no more, or has not come yet; or nothing to undo."""

    code = 'out_of_history'
