# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Capacity: limits on the size of a world, checked before the engine changes.

Law: a request is refused as `world_full` if the world would have more bodies, convex pieces,
overlapping pairs of pieces or joints than its settings allow; so are a grip beyond `MOST_HANDS`,
a robot beyond `MOST_ROBOT_TOPICS` and a body beyond `MOST_ATTRACTING`.

Overlaps are bounded from above: each body that is spawned or moved adds the pieces whose boxes its
own boxes meet in the engine's tree. Only when this bound exceeds the limit, the overlaps of the
whole world are counted (`engine.overlaps`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from itertools import chain

import numpy as np
from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.overlaps import bounds_of_pieces, count_inside, count_overlaps, laid_out
from physsim_ros.engine.space import Space
from physsim_ros.model.attraction import attracts, check_attraction
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import WorldFull
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.settings import (
    check_limit,
    MOST_JOINTS_ON_BODY,
    WorldSettings,
)
from physsim_ros.model.transform import Pose

# Greatest number of hands that drag at once [1], each 12 µs a step: one for each page.
MOST_HANDS = 64
# Greatest number of topics of all robots [1]: those of 440 TurtleBots. Fast DDS takes a second to
# make them, and 15 s for 2,000 TurtleBots.
MOST_ROBOT_TOPICS = 4000
# Pairs of pieces of one body that cost as much as one contact [1]: the engine lists them too, and
# rejects each in a tenth of the time (measured: compounds of 1,000 discs).
_INSIDE = 10
# Within a step, overlaps are counted again when the pieces and overlaps of the world are fewer
# than this many times the pieces of the requests since the last count [1]. A count takes 3 µs for
# each piece and overlap, a request a third of a millisecond more.
_PIECE = 100


class Capacity:
    """
    The capacity of a space.

    :param space: with the limits in its settings

    :ivar checking: whether anything is refused; not while requests are replayed
    """

    def __init__(self, space: Space) -> None:
        self.checking = True
        self._space = space
        # Upper bound of the number of overlaps; None is unknown.
        self._bound: int | None = None
        # Steps that the space had made at the last count, and pieces of requests since then.
        self._age = -1
        self._since = 0

    @contextmanager
    def unchecked(self) -> Iterator[None]:
        """Refuse nothing within the block, whose requests were checked the first time."""
        self.checking = False
        try:
            yield
        finally:
            self.checking = True

    def check_body(self, body: Body, pose: Pose, *, old: RigidBody | None = None) -> None:
        """
        Refuse a body that exceeds a limit.

        :param pose: that it is to have
        :param old: the same body as it is now; None if it is new
        :raises WorldFull: it does
        """
        self.check_bodies([(body, pose, old)])

    def check_bodies(self, placed: Sequence[tuple[Body, Pose, RigidBody | None]]) -> None:
        """
        Refuse bodies that exceed a limit together.

        :param placed: each body, the pose that it is to have, and the body as it is now if it is
            not new
        :raises WorldFull: they do
        """
        if not self.checking:
            return
        space, settings = self._space, self._space.settings
        most = settings.max_overlaps
        if new_bodies := sum(old is None for _, _, old in placed):
            check_limit('max_bodies', len(space.bodies.by_name) + new_bodies, settings)
        added, shapes = 0, len(space.shapes)
        for body, pose, old in placed:
            pieces = len(body.shape.form.pieces)
            shapes += pieces - (0 if old is None else len(old.body.shape.form.pieces))
            added += _inside(body) + space.bodies.count_near(
                bounds_of_pieces(body.shape, pose),
                without=old,
                moving_only=body.anchored,
                most=most,
            )
            self._since += pieces
        check_limit('max_shapes', shapes, settings)
        new = [(body, pose) for body, pose, _ in placed]
        names = {body.name for body, _ in new}
        if len(new) > 1:
            added += _count(new, most, first=names)
        if self._bound is not None and self._bound + added <= most:
            self._bound += added
            return
        # The bound is exceeded: count.
        before = self._bound
        if before is None or self._age != space.age or self._since * _PIECE > shapes + before:
            rigids = space.bodies.by_name.values()
            others = [(each.body, each.pose) for each in rigids if each.body.name not in names]
            before = _count(others, most)
            added = _count([*others, *new], most, first=names)
            added += sum(_inside(body) for body, _ in new)
            self._age, self._since = space.age, 0
        if before + added > most:
            raise _too_many(before + added, most)
        self._bound = before + added

    def check_robot(self, body: Body) -> None:
        """
        Refuse a robot beyond `MOST_ROBOT_TOPICS`; a body of its name does not count.

        :raises WorldFull: the robots would have too many topics
        """
        if self.checking and body.robot is not None:
            _check_topics(self._with(body))

    def check_attraction(self, body: Body) -> None:
        """
        Refuse a body beyond `MOST_ATTRACTING`; a body of its name does not count.

        :raises WorldFull: too many bodies would attract each other
        """
        if self.checking and attracts(body, self._space.settings):
            check_attraction(self._with(body), self._space.settings)

    def _with(self, body: Body) -> Iterator[Body]:
        """Yield the bodies of the space, a new one in place of that of its name."""
        others = self._space.bodies.by_name.values()
        return chain((body,), (each.body for each in others if each.body.name != body.name))

    def check_settings(self, settings: WorldSettings) -> None:
        """
        Refuse settings by which too many bodies would attract each other.

        :raises WorldFull: they would
        """
        if self.checking:
            bodies = (rigid.body for rigid in self._space.bodies.by_name.values())
            check_attraction(bodies, settings)

    def check_joint(self, joint: Joint) -> None:
        """
        Refuse a joint that exceeds a limit, unless it replaces the one of its name.

        :raises WorldFull: it does
        """
        if not self.checking:
            return
        joints = self._space.joints
        if joint.name not in joints.by_name:
            check_limit('max_joints', len(joints.by_name) + 1, self._space.settings)
        for body in joint.bodies:
            _check_on_body(joints.count_on(body, joint), body)

    def check_hand(self, hand: str) -> None:
        """
        Refuse the grip of a hand beyond `MOST_HANDS`, unless the hand has one already.

        :raises WorldFull: too many hands drag a body
        """
        space = self._space
        if self.checking and space.grips.of(hand) is None and len(space.grips) >= MOST_HANDS:
            raise WorldFull('{most} hands drag a body; no more are allowed', most=MOST_HANDS)


def check_state(state: WorldState) -> None:
    """
    Refuse a state that is too large.

    :raises WorldFull: it is
    """
    pieces = sum(len(each.body.shape.form.pieces) for each in state.bodies)
    check_limit('max_bodies', len(state.bodies), state.settings)
    check_limit('max_shapes', pieces, state.settings)
    check_limit('max_joints', len(state.joints), state.settings)
    _check_topics(each.body for each in state.bodies)
    check_attraction((each.body for each in state.bodies), state.settings)
    ends = Counter(end for joint in state.joints for end in joint.bodies)
    for body, count in ends.items():
        _check_on_body(count, body)
    most = state.settings.max_overlaps
    count = _count([(each.body, each.pose) for each in state.bodies], most)
    if count > most:
        raise _too_many(count, most)


def _count(
    placed: Sequence[tuple[Body, Pose]], most: int, *, first: set[str] | None = None
) -> int:
    """
    Count the overlaps of pieces.

    :param most: the count ends when it is greater
    :param first: names of bodies whose overlaps with all bodies are counted; None counts the
        overlaps of all, with those between the pieces of each
    """
    bodies = [body for body, _ in placed]
    poses = np.array([pose for _, pose in placed], np.float64).reshape(-1, 3)
    layout = laid_out([body.shape for body in bodies], poses)
    some = [first is None or body.name in first for body in bodies]
    anchored = np.array([body.anchored for body in bodies], np.bool_)
    count = sum(map(_inside, bodies)) if first is None else 0
    return count + count_overlaps(layout, np.array(some, np.bool_), anchored, most=most)


def _inside(body: Body) -> int:
    """Return the overlaps between the pieces of a body, as the contacts that cost the same."""
    return 0 if body.anchored else count_inside(body.shape) // _INSIDE


def _check_on_body(count: int, body: str) -> None:
    if count > MOST_JOINTS_ON_BODY and body != WORLD:
        template = '{body} would have {count} joints; a body has at most {most}'
        raise WorldFull(template, body=body, count=count, most=MOST_JOINTS_ON_BODY)


def _check_topics(bodies: Iterable[Body]) -> None:
    count = sum(body.robot.topic_count for body in bodies if body.robot is not None)
    if count > MOST_ROBOT_TOPICS:
        template = 'the robots would have {count} topics; there are at most {most}'
        raise WorldFull(template, count=count, most=MOST_ROBOT_TOPICS)


def _too_many(count: int, most: int) -> WorldFull:
    template = '{count} or more pairs of pieces would overlap; max_overlaps is {most}'
    return WorldFull(template, count=count, most=most)
