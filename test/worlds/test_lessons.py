# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The figure of each lesson is that of the law, and is measured in its world."""

from math import pi, radians, sin, sqrt

import numpy as np
from physsim_ros.files import load_world, save_world, shipped_lessons, worlds_in
from physsim_ros.model.requests import ChangeBody, Configure
from physsim_ros.model.settings import WorldSettings
import pytest

from .film import at, Film, first, FRAMES, G, RATE, simulation, state_of
from ..slow import slow

LESSONS = sorted(worlds_in(shipped_lessons()))
# Frames are this far apart [s].
FRAME = 1 / FRAMES


def lands(film: Film, name: str, radius: float) -> int:
    """Return the first frame in which a disc has reached the floor, to a millimetre."""
    return first(film.pose(name)[:, 1] < radius + 0.001)


def free_fall() -> float:
    film = Film(simulation('free_fall'), 1.5)
    times = [lands(film, 'light/0', 0.25) * FRAME, lands(film, 'heavy/0', 0.5) * FRAME]
    assert times[0] == pytest.approx(times[1], abs=FRAME)
    return times[0]


def horizontal_throw() -> float:
    film = Film(simulation('horizontal_throw'), 1.5)
    landed = lands(film, 'thrown/0', 0.25)
    assert landed == pytest.approx(lands(film, 'dropped/0', 0.25), abs=1)
    return film.x('thrown/0')[landed]


def oblique_throw() -> float:
    film = Film(simulation('oblique_throw'), 1.5)
    height = film.pose('ball/0')[:, 1]
    landed = first((height < 0.201) & (np.arange(len(height)) > 10))
    return film.x('ball/0')[landed]


def slope() -> float:
    film = Film(simulation('slope'), 2.5)
    # It stops in what the lesson shows, half of its length before the end of that.
    assert film.x('ice/0')[-1] < 4.3 - 0.4
    speed = np.hypot(*film.twist('ice/0')[:, :2].T)
    return speed[at(1.1)] - speed[at(0.1)]


def friction() -> float:
    film = Film(simulation('friction'), 3.0)
    assert film.twist('block/0')[-1] == pytest.approx(0.0, abs=1e-3)
    return film.x('block/0')[-1]


def tilt(x: float) -> float:
    """Return the angle of the beam after 4 s, with the green block at a place [rad]."""
    sim = simulation('lever')
    sim.perform(ChangeBody(name='green/0', pose=(x, 1.0, 0.0)))
    film = Film(sim, 4.0)
    return film.yaw('beam/0')[-FRAMES:].mean()


def lever() -> float:
    assert abs(tilt(1.5)) < radians(0.2)
    # Left of it the beam tips to the left, counter-clockwise.
    assert tilt(1.4) > radians(1.0)
    assert tilt(1.6) < radians(-1.0)
    return 1.5


def elastic_collision() -> float:
    film = Film(simulation('elastic_collision'), 2.0)
    assert film.twist('light/0')[-1, 0] == pytest.approx(-2.0, rel=0.005)
    return film.twist('heavy/0')[-1, 0]


def inelastic_collision() -> float:
    film = Film(simulation('inelastic_collision'), 2.0)
    fast, slow = (film.twist(name)[:, 0] for name in ('fast/0', 'slow/0'))
    assert fast[-1] == pytest.approx(slow[-1], abs=0.01)
    energy = fast**2 + slow**2 / 2
    return energy[0] - energy[-1]


def pendulum() -> float:
    film = Film(simulation('pendulum'), 14.0)
    x = film.x('bob/0')
    falling = np.flatnonzero((x[:-1] > 0) & (x[1:] <= 0))
    moments = falling + x[falling] / (x[falling] - x[falling + 1])
    return (moments[3] - moments[0]) / 3 * FRAME


def spring_energy() -> float:
    film = Film(simulation('spring_energy'), 2.0)
    return film.twist('block/0')[:, 0].max()


def floating() -> float:
    film = Film(simulation('floating'), 12.0)
    assert film.twist('block/0')[-1] == pytest.approx(0.0, abs=1e-3)
    return 0.4 - film.pose('block/0')[-1, 1]


def terminal_speed() -> float:
    film = Film(simulation('terminal_speed'), 2.4)
    return -film.twist('ball/0')[-1, 1]


def orbit() -> float:
    film = Film(simulation('orbit'), 17.0)
    times = []
    for name, sign in (('planet/0', 1.0), ('comet/0', -1.0)):
        y = sign * film.pose(name)[:, 1]
        turns = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
        moments = (turns + y[turns] / (y[turns] - y[turns + 1])) * FRAME
        times.append(moments[1] - moments[0])
    assert times[0] == pytest.approx(times[1], abs=0.01)
    return times[0]


def pulley() -> float:
    sim = simulation('pulley')
    for _ in range(60):
        sim.advance_frame()
    return float(sim.world.snapshot().forces[0])


def belt() -> float:
    film = Film(simulation('belt'), 1.5)
    assert film.twist('parcel/0')[-1, 0] == pytest.approx(3.0, abs=1e-6)
    # Half of what the belt goes in the time is the way of the parcel: it is behind by as much.
    seconds = (len(film.x('parcel/0')) - 1) * FRAME
    return 3.0 * seconds - (film.x('parcel/0')[-1] - film.x('parcel/0')[0])


# The law of each lesson, and how its figure is measured.
LAWS = {
    'free_fall': (sqrt(2 * 5 / G), free_fall),
    'horizontal_throw': (4 * sqrt(2 * 5 / G), horizontal_throw),
    'oblique_throw': (8**2 * sin(radians(90)) / G, oblique_throw),
    'slope': (G * sin(radians(30)), slope),
    'friction': (5**2 / (2 * 0.4 * G), friction),
    'lever': (3 * 1 / 2, lever),
    'elastic_collision': (2 * 1 / (1 + 3) * 4, elastic_collision),
    'inelastic_collision': (2 * 4.5**2 / 2 - 3 * (2 * 4.5 / 3) ** 2 / 2, inelastic_collision),
    'pendulum': (2 * pi * sqrt(2.5 / G), pendulum),
    'floating': (0.8 * 6.5 / 10, floating),
    'terminal_speed': (sqrt(0.5 * G / 0.1), terminal_speed),
    'orbit': (2 * pi * sqrt(4**3 / 40), orbit),
    'pulley': (40 * G / 4, pulley),
    'belt': (3**2 / (2 * 0.5 * G), belt),
    'spring_energy': (0.5 * sqrt(100 / 1), spring_energy),
}


def test_every_lesson_has_a_law_and_they_are_numbered_from_one():
    assert set(LESSONS) == set(LAWS)
    numbers = sorted(state_of(name).lesson.number for name in LESSONS)
    assert numbers == list(range(1, len(LESSONS) + 1))
    assert len(LESSONS) >= 10


@pytest.mark.parametrize('name', [slow(name) if name == 'lever' else name for name in LESSONS])
def test_what_a_lesson_claims_is_the_law_and_what_its_world_does(name):
    lesson = state_of(name).lesson
    law, measured = LAWS[name]
    value = measured()

    # The figure is the law's, as it is written: with three digits.
    assert f'{lesson.figure:.3g}' == f'{law:.3g}'
    assert value == pytest.approx(law, abs=lesson.within)
    # Who measures well is right.
    assert abs(value - lesson.figure) < lesson.within


@pytest.mark.parametrize('name', LESSONS)
def test_a_lesson_stays_with_its_world_in_files_and_through_time(name, tmp_path):
    state = state_of(name)
    sim = simulation(name)
    for _ in range(5):
        sim.advance_frame()
    sim.perform(Configure(changes={'damping': 0.25}))
    path = save_world(sim.save(), 'saved', world_dir=tmp_path, physics_rate=RATE)

    assert sim.world.scene.lesson == state.lesson
    assert load_world(path).lesson == state.lesson
    sim.load(state_of('incline'))
    assert sim.world.scene.lesson is None
    sim.undo()
    assert sim.world.scene.lesson == state.lesson


@pytest.mark.parametrize('name', LESSONS)
def test_no_setting_of_the_world_before_reaches_into_a_lesson(name):
    before = WorldSettings(
        gravity=(3.0, 0.0),
        damping=0.9,
        bounds=(-1.0, -1.0, 1.0, 1.0),
        density=7.0,
        friction=3.0,
        elasticity=1.0,
        floor_friction=0.6,
        air_density=3.0,
        wind=(9.0, 0.0),
        gravitation=2.0,
    )
    path = shipped_lessons() / f'{name}.yaml'

    assert load_world(path, settings=before) == load_world(path)
