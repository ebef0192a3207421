# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The settings of a world have their ranges; what lies outside is refused and named."""

from dataclasses import FrozenInstanceError, replace
import math
from typing import Any

from physsim_ros.model.checks import HEAVIEST, LIGHTEST
from physsim_ros.model.errors import BadProperty, Malformed, Refusal
from physsim_ros.model.settings import check_setting, STRONGEST, WorldSettings
from physsim_ros.model.shapes import LARGEST
import pytest

RANGES: dict[str, tuple[float, float]] = {
    'damping': (0.0, 1.0),
    'density': (LIGHTEST, HEAVIEST),
    'friction': (0.0, 10.0),
    'elasticity': (0.0, 1.0),
    'command_timeout': (0.0, 1e9),
    'drag_force': (0.0, 1000.0),
}
COUNTS = {'iterations': (1, 1000), 'max_bodies': (0, 1_000_000)}


def refusal_of(**settings: Any) -> Refusal:
    with pytest.raises(Refusal) as refused:
        WorldSettings(**settings)
    return refused.value


def test_the_defaults_are_those_of_the_contract() -> None:
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


@pytest.mark.parametrize('name', RANGES)
def test_a_number_is_taken_up_to_the_ends_of_its_range(name: str) -> None:
    low, high = RANGES[name]

    for value in (low, high):
        assert getattr(WorldSettings(**{name: value}), name) == value
    for value in (math.nextafter(low, -math.inf), math.nextafter(high, math.inf)):
        refusal = refusal_of(**{name: value})
        assert isinstance(refusal, BadProperty)
        assert refusal.field == name


@pytest.mark.parametrize('name', RANGES)
@pytest.mark.parametrize(
    ('value', 'error'),
    [(math.nan, Malformed), (math.inf, Malformed), (-math.inf, Malformed), (10**400, Malformed),
     (None, BadProperty), ('1', BadProperty), (True, BadProperty), ([1.0], BadProperty)],
)  # fmt: skip
def test_what_is_no_finite_number_is_refused(
    name: str, value: object, error: type[Refusal]
) -> None:
    refusal = refusal_of(**{name: value})

    assert isinstance(refusal, error)
    assert refusal.field == name


@pytest.mark.parametrize('name', RANGES)
def test_a_whole_number_is_kept_as_a_fraction(name: str) -> None:
    assert type(getattr(WorldSettings(**{name: 1}), name)) is float


@pytest.mark.parametrize('name', COUNTS)
def test_a_count_is_a_whole_number_in_its_range(name: str) -> None:
    low, high = COUNTS[name]

    for value in (low, high):
        assert getattr(WorldSettings(**{name: value}), name) == value
    for other in (low - 1, high + 1, 5.0, '5', None, True, math.nan, [5]):
        refusal = refusal_of(**{name: other})
        assert isinstance(refusal, BadProperty)
        assert refusal.field == name


def test_gravity_points_anywhere_up_to_the_strongest() -> None:
    assert WorldSettings(gravity=[1, 0]).gravity == (1.0, 0.0)
    assert WorldSettings(gravity=(0.0, STRONGEST)).gravity == (0.0, STRONGEST)

    refusal = refusal_of(gravity=(STRONGEST, 1e3))

    assert isinstance(refusal, BadProperty)
    assert refusal.field == 'gravity'


@pytest.mark.parametrize(
    ('gravity', 'error'),
    [((0.0,), Malformed), ((0.0, 0.0, 0.0), Malformed), ((0.0, math.nan), Malformed),
     ((math.inf, 0.0), Malformed), (9.81, BadProperty), (None, BadProperty),
     ('down', BadProperty), (('a', 'b'), BadProperty)],
)  # fmt: skip
def test_gravity_that_is_none_is_refused(gravity: object, error: type[Refusal]) -> None:
    refusal = refusal_of(gravity=gravity)

    assert isinstance(refusal, error)
    assert refusal.field == 'gravity'


def test_bounds_are_a_rectangle_or_none() -> None:
    assert WorldSettings(bounds=None).bounds is None
    assert WorldSettings(bounds=[-1, 0, 1, 2]).bounds == (-1.0, 0.0, 1.0, 2.0)
    assert WorldSettings(bounds=(-LARGEST, -LARGEST, LARGEST, LARGEST)).bounds is not None


@pytest.mark.parametrize(
    ('bounds', 'error'),
    [((), Malformed), ((0.0, 0.0, 1.0), Malformed), ((0.0, 0.0, 1.0, 1.0, 1.0), Malformed),
     ((0.0, 0.0, math.nan, 1.0), Malformed), ((-math.inf, 0.0, 1.0, 1.0), Malformed),
     ((1.0, 0.0, 0.0, 1.0), BadProperty), ((0.0, 1.0, 1.0, 0.0), BadProperty),
     ((0.0, 0.0, 0.0, 1.0), BadProperty), ((0.0, 0.0, 1.0, 0.0), BadProperty),
     ((0.0, 0.0, 1.0, 2 * LARGEST), BadProperty), (5.0, BadProperty), ('wide', BadProperty),
     ((0.0, 0.0, '1', 1.0), BadProperty), ((0.0, 0.0, True, 1.0), BadProperty)],
)  # fmt: skip
def test_bounds_that_are_none_are_refused(bounds: object, error: type[Refusal]) -> None:
    refusal = refusal_of(bounds=bounds)

    assert isinstance(refusal, error)
    assert refusal.field == 'bounds'


def test_settings_are_frozen_and_a_change_is_checked_anew() -> None:
    settings = WorldSettings()

    with pytest.raises(FrozenInstanceError):
        settings.damping = 0.5  # type: ignore[misc]
    with pytest.raises(BadProperty):
        replace(settings, damping=2.0)
    assert replace(settings, damping=0.5).damping == 0.5


def test_only_the_names_of_settings_are_settings() -> None:
    for name in (*RANGES, *COUNTS, 'gravity', 'bounds'):
        check_setting(name)
    for name in ('speed', '', 'Gravity', 'friction '):
        with pytest.raises(BadProperty) as refused:
            check_setting(name)
        assert refused.value.field == name
