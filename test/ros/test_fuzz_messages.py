# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A message with any content is answered once, and the world goes on with finite numbers."""

from __future__ import annotations

from collections import Counter
import math
import random
import sys
from typing import Any

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointProperties
from physsim_ros.model.settings import WorldSettings
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.streams import ContactsEncoder, PosesEncoder, StatesEncoder
from physsim_ros.ros.publishers.event_publisher import encode_event
from physsim_ros.ros.requests.request_topics import TOPICS
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.testing import box, disc
import pytest

from .test_histories import message_of
from ..simulation.random_history import Choices, NAMES, request_of
from ..slow import slow

NASTY_FLOATS = (
    0.0, -0.0, 5e-324, 1e-320, 1e-200, 1e-9, 1e-3, 0.002, 0.5, 1.0, -1.0, 1e3, 1e5, 1e7, 1e8, 1e12,
    1e150, 1e300, 1.7e308, -1e300, math.nan, math.inf, -math.inf,
)  # fmt: skip
NASTY_TEXTS = [
    '{', '}', '[', '!!bool x', '!!int ""', '!!python/object/apply:os.system [x]', '&a [*a]', '*a',
    '? [a]', '? {a: 1} : 1', '{mass: !!timestamp x}', '{mass: 2001-01-01}', '{mass: 0x10}', '---',
    '--- {}\n---\n{}', '%TAG', '\0', '\ud800', '{~: 1}', '{1: 1}', '{mass: 1e400}',
    '{mass: -.inf}',
    '{velocity: [[1, 2], 3]}', '{velocity: [.nan, 0]}', '{group: 99999999999999999999}', '"', "'",
    '{friction: 1, friction: 2}', '{anchored: true, kinematic: true}', '{"mass": "1"}', '- 1', '#',
    '{<<: {mass: 1}}', '[' * 2000, '{a: ' * 600, 'x' * 10_001, '\N{SNOWMAN}: 1', '{mass: \x85}',
]  # fmt: skip
# Texts of any characters, also of unassigned ones and of halves of pairs.
UNICODE_TEXTS = [
    ''.join(map(chr, random.Random(seed).choices(range(sys.maxunicode + 1), k=seed % 8)))
    for seed in range(64)
]
KEYS = ('kind', 'a', 'b', *Properties.FIELDS, *JointProperties.FIELDS)
VALUES = ('0', '1', '-1', '0.5', '1e5', '1e-9', '1e12', '.nan', '.inf', 'true', 'false', '[1, 2]',
          '[-1e5, 0]', '[1]', '[]', '~', 'x', '{}', '12345678901234567890', 'a/0')  # fmt: skip
INTEGERS = (*range(-1, 14), 2**31 - 1, -(2**31))
# Odd values, by the type of a field.
ODD: dict[str, tuple[Any, ...]] = {
    'double': NASTY_FLOATS,
    'float': (0.0, -1.0, 0.5, 2.0, 1e38, math.nan, math.inf),
    'int32': INTEGERS,
    'uint32': (0, 10**9, 2**32 - 1),
    'uint8': (0, 1, 255),
    'boolean': (False, True),
    'string': ('', 'world', 'nobody', *NAMES, *NASTY_TEXTS, *UNICODE_TEXTS),
}


def spoil(rng: Choices, message: Any) -> None:
    """Give a field of a message, at any depth, an odd value; or leave out or repeat an element."""
    name, kind = rng.choice([*message.get_fields_and_field_types().items()])
    if name == 'text' and rng.random() < 0.5:
        said = (f'{rng.choice(KEYS)}: {rng.choice(VALUES)}' for _ in range(rng.randint(1, 3)))
        message.text = '{' + ', '.join(said) + '}'
    elif kind in ODD:
        setattr(message, name, rng.choice(ODD[kind]))
    elif not kind.startswith('sequence'):
        spoil(rng, getattr(message, name))
    elif elements := getattr(message, name):
        place = rng.randrange(len(elements))
        if rng.random() < 0.5 and not isinstance(elements[place], str):
            spoil(rng, elements[place])
        else:
            setattr(message, name, rng.choice((elements[:place], [*elements, elements[place]])))


def any_message(rng: Choices) -> tuple[str, Any]:
    """Return a topic and a message for it, of which up to two fields are odd."""
    while (told := message_of(request_of(rng))) is None:
        pass
    for _ in range(rng.choice((0, 1, 2))):
        spoil(rng, told[1])
    return told


class Fuzzed:
    """A world and everything that looks at it, as in the node."""

    def __init__(self) -> None:
        bounds = WorldSettings(bounds=(-20.0, -20.0, 20.0, 20.0))
        self.simulation = Simulation(settings=bounds)
        self.simulation.reports_contacts = True
        self._encoders = [
            PosesEncoder('world'),
            StatesEncoder('world'),
            MarkersEncoder('world', 60.0),
        ]
        self._contacts = ContactsEncoder('world')
        for message in (box('a/0'), disc('b/0', at=(0.0, 2.0))):
            assert self.ask('~/spawn', message) == 'ok'

    def ask(self, topic: str, message: Any) -> str:
        """Ask as the node does, check that there is one answer, and return its code."""
        before = self.simulation.world.digest()
        try:
            request = TOPICS[topic].convert(message, 'world')
        except Refusal as refusal:
            subject = TOPICS[topic].subject(message)
            self.simulation.requests.refuse(refusal, Origin(topic), subject=subject)
        else:
            self.simulation.requests.submit(request, topic=topic)
        frame = self.simulation.apply_requests()
        assert frame is not None
        (answer,) = frame.answers
        assert answer.topic == topic
        assert answer.message
        encode_event(answer)
        if answer.code:
            assert self.simulation.world.digest() == before
        self.look(frame)
        return answer.code or 'ok'

    def go(self) -> None:
        frame = self.simulation.advance_frame()
        assert {answer.topic for answer in frame.answers} <= {'body_lost', 'joint_broken'}
        self.look(frame)

    def look(self, frame: Any) -> None:
        """Check that all that is told is finite, and can be told."""
        snapshot = frame.snapshot
        assert np.isfinite(snapshot.poses).all()
        assert np.isfinite(snapshot.twists).all()
        assert np.isfinite(snapshot.forces).all()
        assert len(snapshot.forces) == len(snapshot.scene.joints)
        assert len(set(snapshot.scene.names)) == len(snapshot.poses) == len(snapshot.twists)
        for encoder in self._encoders:
            encoder.encode(frame)
        assert frame.contacts is not None
        assert np.isfinite(frame.contacts.impulses).all()
        assert np.isfinite(frame.contacts.points).all()
        self._contacts.encode(frame)


# Why a message of any content may be refused.
REASONS = {
    *('ok', 'malformed', 'unknown_shape', 'bad_size', 'bad_outline', 'not_planar'),
    *('unknown_frame', 'unknown_property', 'bad_property', 'unknown_body', 'unknown_joint'),
    *('anchored', 'nothing_there'),
}


@pytest.mark.parametrize('seeds', [range(60), slow(range(60, 400))], ids=['60', '340'])
def test_any_messages_are_answered_and_leave_a_world_that_goes_on(seeds: range) -> None:
    codes, done = Counter[str](), set()
    for seed in seeds:
        rng, fuzzed = Choices(seed), Fuzzed()
        for _ in range(rng.randint(7, 12)):
            topic, message = any_message(rng)
            code = fuzzed.ask(topic, message)
            codes[code] += 1
            done |= {topic} if code == 'ok' else set()
            fuzzed.go()
        for _ in range(3):
            fuzzed.go()
    # Not all are refused at the door, and none of the reasons is unknown.
    assert codes['ok'] > codes.total() / 4
    assert done == set(TOPICS) - {'~/drag/feedback'}
    assert codes.keys() <= REASONS
