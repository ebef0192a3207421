# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The settings of a world: their defaults, their own checks, and their names."""

from dataclasses import FrozenInstanceError, replace
import math

from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.settings import check_setting, WorldSettings
from physsim_ros.model.shapes import LARGEST
import pytest

from ..building import refusal


def test_the_defaults_are_those_of_the_contract():
    assert WorldSettings() == WorldSettings(
        gravity=(0.0, -9.81),
        damping=0.0,
        iterations=16,
        bounds=None,
        density=1.0,
        friction=0.5,
        elasticity=0.5,
        command_timeout=0.5,
        drag_force=10.0,
        max_bodies=20000,
    )


@pytest.mark.parametrize(
    ('bounds', 'error'),
    [((), Malformed), ((0.0, 0.0, 1.0), Malformed), ((0.0, 0.0, 1.0, 1.0, 1.0), Malformed),
     ((0.0, 0.0, math.nan, 1.0), Malformed), ((-math.inf, 0.0, 1.0, 1.0), Malformed),
     ((1.0, 0.0, 0.0, 1.0), BadProperty), ((0.0, 1.0, 1.0, 0.0), BadProperty),
     ((0.0, 0.0, 0.0, 1.0), BadProperty), ((0.0, 0.0, 1.0, 0.0), BadProperty),
     ((0.0, 0.0, 1.0, 2 * LARGEST), BadProperty), (5.0, BadProperty), ('wide', BadProperty),
     ((0.0, 0.0, '1', 1.0), BadProperty), ((0.0, 0.0, True, 1.0), BadProperty)],
)  # fmt: skip
def test_bounds_are_a_rectangle_or_none(bounds, error):
    assert WorldSettings(bounds=None).bounds is None
    assert WorldSettings(bounds=[-1, 0, LARGEST, 2]).bounds == (-1.0, 0.0, LARGEST, 2.0)
    assert refusal(WorldSettings, bounds=bounds) == (error, 'bounds')


@pytest.mark.parametrize('datum', [(91.0, 0.0), (0.0, 181.0), (0.0,), 'here', (0.0, math.nan)])
def test_a_datum_is_a_latitude_and_a_longitude(datum):
    assert WorldSettings(datum=[-90, 180]).datum == (-90.0, 180.0)
    assert refusal(WorldSettings, datum=datum)[1] == 'datum'


def test_settings_are_frozen_and_a_change_is_checked_anew():
    settings = WorldSettings()

    with pytest.raises(FrozenInstanceError):
        settings.damping = 0.5  # type: ignore[misc]
    with pytest.raises(BadProperty):
        replace(settings, damping=2.0)
    assert replace(settings, damping=0.5).damping == 0.5


def test_only_the_names_of_settings_are_settings():
    for name in WorldSettings.FIELDS:
        check_setting(name)
    for name in ('speed', '', 'Gravity', 'friction '):
        assert refusal(check_setting, name) == (BadProperty, name)
