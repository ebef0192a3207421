# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A field that is declared is read from world files, checked, and written, without more code."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from physsim_ros.model.actors import ACTORS
from physsim_ros.model.actors import Path as PathActor
from physsim_ros.model.checks import Within
from physsim_ros.model.robots.drives import Differential, DRIVES
from physsim_ros.model.robots.sensors import Imu, SENSORS
from physsim_ros.model.shapes import Disc, SHAPES
import pytest
import yaml

from .world_files import load, refusal_of, save, write

_SHARE = Within(0.0, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Tracked(Differential):
    """A drive with one field more than is known."""

    KIND: ClassVar = 'tracked'
    slack: Annotated[float, _SHARE, 'of its tracks'] = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Compass(Imu):
    """A sensor with one field more than is known."""

    KIND: ClassVar = 'compass'
    slack: Annotated[float | None, _SHARE, 'of its needle'] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Rail(PathActor):
    """An actor with one field more than is known."""

    KIND: ClassVar = 'rail'
    slack: Annotated[float, _SHARE, 'of its wheels'] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Tube(Disc):
    """A shape with one field more than is known."""

    KEY: ClassVar = 'circle'
    slack: Annotated[float, _SHARE, 'of its wall']


TEXT = """\
format: 1
bodies:
  - name: a/0
    circle: {radius: 0.2, slack: 0.5}
    robot:
      drive: {kind: tracked, slack: 0.5}
      sensors: [{kind: compass, name: north, slack: 0.5}]
  - name: b/0
    circle: {radius: 0.2, slack: 0.5}
    at: [3, 0]
    actor: {kind: rail, points: [[3, 0], [4, 0]], speed: 1, slack: 0.5}
"""


@pytest.fixture(autouse=True)
def declared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Give each test kinds that have one declared field more."""
    monkeypatch.setitem(DRIVES, 'tracked', Tracked)
    monkeypatch.setitem(SENSORS, 'compass', Compass)
    monkeypatch.setitem(ACTORS, 'rail', Rail)
    monkeypatch.setitem(SHAPES, 'circle', Tube)  # type: ignore[arg-type]


def test_a_declared_field_is_read_and_written(folder: Path) -> None:
    path = write(folder, TEXT)
    state = load(path)

    written = save(state, folder, 'again')
    one, other = yaml.safe_load(written.read_text())['bodies']

    assert load(written) == state
    assert one['circle'] == other['circle'] == {'radius': 0.2, 'slack': 0.5}
    assert one['robot']['drive']['slack'] == 0.5
    assert one['robot']['sensors'][0]['slack'] == 0.5
    assert other['actor']['slack'] == 0.5


@pytest.mark.parametrize(
    'of', ['circle: {radius: 0.2, ', 'tracked, ', 'north, ', 'speed: 1, '], ids=str.strip
)
@pytest.mark.parametrize(
    ('said', 'words'), [('slack: 2', 'between 0 and 1'), ('slakc: 0.5', "nearest is 'slack'")]
)
def test_a_declared_field_is_checked_and_listed(
    of: str, said: str, words: str, folder: Path
) -> None:
    refusal = refusal_of(TEXT.replace(f'{of}slack: 0.5', f'{of}{said}'), folder)

    assert refusal.field == said.partition(':')[0]
    assert words in str(refusal)
