# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The key of a scene, of which digests are made, has every field of its bodies."""

from dataclasses import fields, replace

from physsim_ros.model.body_description import new_body
from physsim_ros.model.requests import Spawn
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
import pytest

SETTINGS = WorldSettings()
BODY = new_body(Spawn(name='a/0', shape=Disc(radius=1.0)), SETTINGS, None)[0]


@pytest.mark.parametrize('name', [each.name for each in fields(Body)])
def test_every_field_of_a_body_is_in_the_key(name: str) -> None:
    other = replace(BODY, **{name: 'another'})

    keys = {Scene(bodies=(body,), settings=SETTINGS).key for body in (BODY, other)}

    assert len(keys) == 2
