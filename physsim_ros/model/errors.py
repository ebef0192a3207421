# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Errors of this package; each class of refusal has a stable code.

Law: a refused request changes nothing; the message names what is refused and the reason.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from physsim_ros.model.texts import abbreviated, message_text, nearest_name
from physsim_ros.model.translation import Text


class PhysSimError(Exception):
    """
    Base class of the errors that this package raises.

    :param message: one sentence, in which others' texts are abbreviated and escaped
    """

    def __init__(self, message: str = '') -> None:
        super().__init__(message_text(message))


class Refusal(PhysSimError):
    """
    A request that is not applied.

    :param template: one sentence as for `Text`, the refused value and the reason; or a `Text`
    :param field: the offending field of the request, '' if it is the whole request; the template
        may name it
    :param concerns: name of the body for which it is refused, where the request does not name it
    :param values: further values of the template

    :ivar details: further pairs of key and value for the event
    :ivar is_half_done: whether the request has changed the world, which is to be rebuilt
    """

    code = 'refused'
    args: tuple[Text]

    def __init__(
        self, template: str, /, *, field: str = '', concerns: str = '', **values: Any
    ) -> None:
        is_text = isinstance(template, Text)
        super().__init__(template if is_text else Text(template, field=field, **values))
        self.field = abbreviated(field)
        self.concerns = concerns
        self.details: tuple[tuple[str, str], ...] = ()
        self.is_half_done = False

    @property
    def text(self) -> Text:
        """Return the message with its template, which pages translate."""
        return self.args[0]


class Malformed(Refusal):
    """NaN, infinity, or arrays of the wrong length."""

    code = 'malformed'


class UnknownShape(Refusal):
    """A type of marker that no shape is made from."""

    code = 'unknown_shape'


class BadSize(Refusal):
    """A length that is not positive, too small or too large to simulate."""

    code = 'bad_size'


class BadOutline(Refusal):
    """An outline that is not simple or encloses no area."""

    code = 'bad_outline'


class NotPlanar(Refusal):
    """A rotation with roll or pitch."""

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
    """A name of no body in the world."""

    code = 'unknown_body'


class UnknownJoint(Refusal):
    """A name of no joint in the world."""

    code = 'unknown_joint'


class Anchored(Refusal):
    """A velocity or wrench for an anchored body, or a joint between two anchored bodies."""

    code = 'anchored'


class NothingThere(Refusal):
    """A point that lies in no body."""

    code = 'nothing_there'


class WorldFull(Refusal):
    """A request that exceeds a limit on the size of the world."""

    code = 'world_full'


# Meanings that a stroke may have, each with the confidence in it, 0 .. 1, the likeliest first.
Confidences = tuple[tuple[str, float], ...]


class NotRecognised(Refusal):
    """
    A stroke whose interpretation is not confident enough.

    :param guesses: that are too doubtful
    """

    code = 'not_recognised'

    def __init__(self, template: str, /, *, guesses: Confidences = (), **values: Any) -> None:
        super().__init__(template, **values)
        self.guesses = guesses
        self.details = values_of(guesses)


def values_of(guesses: Confidences) -> tuple[tuple[str, str], ...]:
    """Return guesses as pairs of key and value, of at most three."""
    keys = (
        ('reading', 'confidence'),
        ('runner_up', 'runner_up_confidence'),
        ('third', 'third_confidence'),
    )
    return tuple(
        pair
        for (name, share), (meaning, confidence) in zip(keys, guesses, strict=False)
        for pair in ((name, meaning), (share, f'{confidence:.3f}'))
    )


class BadWorldFile(Refusal):
    """
    A world file that cannot be read or written, or whose content is refused.

    :param brief: the message without anything that the file holds; None where the message is that
    :param line: of the file, from 1; None if it is unknown
    :param cause: code of the refusal of the content
    """

    code = 'bad_world_file'

    def __init__(
        self,
        template: str,
        /,
        *,
        brief: Text | None = None,
        line: int | None = None,
        cause: str = '',
        **values: Any,
    ) -> None:
        super().__init__(template, **values)
        self.brief = brief or self.text
        self.line = line
        self.cause = cause


class Exists(Refusal):
    """A name of a world, or a namespace of a robot, that is taken."""

    code = 'exists'


class OutOfHistory(Refusal):
    """A time before the oldest or after the newest checkpoint, or no request to undo."""

    code = 'out_of_history'


class InPast(Refusal):
    """While the past is shown, robots are not driven and a person's undo is refused."""

    code = 'in_past'


class NotAlone(Refusal):
    """A later request needs the gesture that a person wants to undo."""

    code = 'not_alone'


class Frozen(Refusal):
    """A teacher has frozen the pages, or locked a body."""

    code = 'frozen'


class ViewOnly(Refusal):
    """A page only shows the world."""

    code = 'view_only'


class TeacherOnly(Refusal):
    """A page is not a teacher's."""

    code = 'teacher_only'


class Running(Refusal):
    """Time is running, where it must be paused."""

    code = 'running'


class InUse(Refusal):
    """Another node has the lock of the directory."""

    code = 'in_use'


class Busy(Refusal):
    """More requests wait than may wait."""

    code = 'busy'


class Failed(Refusal):
    """An error that nobody expected; the log has its traceback (`error_boundary`)."""

    code = 'failed'


class StepFailed(BaseException):
    """An error inside of a step, which leaves no world: no `except Exception` catches it."""


def no_body(name: str, known: Iterable[str], field: str) -> UnknownBody:
    """
    Return the refusal of the name of no body.

    :param known: names of which the most similar one is told
    :param field: of the request, that has the name
    """
    return UnknownBody(
        'there is no body {body!r}{near}', field=field, body=name, near=nearest_name(name, known)
    )


def no_joint(name: str, known: Iterable[str], field: str) -> UnknownJoint:
    """Return the refusal of the name of no joint; parameters as for `no_body`."""
    template = 'there is no joint {joint!r}{near}'
    return UnknownJoint(template, field=field, joint=name, near=nearest_name(name, known))


def no_frame(frame: str, known: Iterable[str]) -> UnknownFrame:
    """
    Return the refusal of a frame that is neither the world nor a body.

    :param known: names of the bodies, of which the most similar one is told
    """
    return UnknownFrame(
        'frame {frame!r} is neither the world nor a body{near}',
        field='header.frame_id',
        frame=frame,
        near=nearest_name(frame, known),
    )


def nothing_at(point: tuple[float, float], field: str) -> NothingThere:
    """Return the refusal of a point in no body [m], of a field of the request."""
    x, y = point
    return NothingThere('there is no body at ({x:g}, {y:g})', field=field, x=x, y=y)
