# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The key of a scene, of which digests are made, has every field of its parts."""

from collections.abc import Mapping
from copy import copy
from dataclasses import fields
from typing import Any

from physsim_ros.model.body_description import new_body
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Spawn
from physsim_ros.model.scene import Joint, Scene, Seat
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
import pytest

BODY = new_body(Spawn(name='a/0', shape=Disc(radius=1.0)), WorldSettings(), None)[0]
JOINT = Joint(
    name='joint/0', kind=JointKind.PIN, a='a/0', b='world', seat=Seat(*[0.0] * 8),
    properties=JointProperties(),
)  # fmt: skip
PARTS = {'settings': WorldSettings(), 'bodies': BODY, 'joints': JOINT}


@pytest.mark.parametrize(
    ('part', 'name'), [(part, each.name) for part in PARTS for each in fields(PARTS[part])]
)
def test_every_field_is_in_the_key(part: str, name: str) -> None:
    other = copy(PARTS[part])
    # Whatever the checks of its class.
    object.__setattr__(other, name, 'another')

    assert key_of(PARTS) != key_of({**PARTS, part: other})


def key_of(parts: Mapping[str, Any]) -> bytes:
    return Scene(
        settings=parts['settings'], bodies=(BODY, parts['bodies']), joints=(parts['joints'],)
    ).key
