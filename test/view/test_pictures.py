# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pictures of Rerun's own renderer: bodies are where they should be, in the colours asked for.

One viewer without a screen serves the module; each test opens a recording of its own in it.
"""

from __future__ import annotations

import itertools

import numpy as np
from physsim_ros.model.requests import Configure
from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.simulation.simulation import Simulation
import pytest

from .picture_file import BLUE, Recording, RED
from ..building import spawning
from ..pictures import has_vulkan, headless_viewer

pytest.importorskip('PIL.Image')

pytestmark = pytest.mark.skipif(
    not has_vulkan(),
    reason='no Vulkan driver: apt-get install mesa-vulkan-drivers libvulkan1',
)

GREEN = (0.1, 0.6, 0.2, 1.0)
# Of levels 0 .. 255: one from rounding.
COLOR_TOLERANCE = 2


@pytest.fixture(scope='module')
def viewer():
    """Start a viewer without a screen."""
    with headless_viewer(1000, 700) as it:
        yield it


class Film:
    """A recording of a simulation, and what a viewer shows of it."""

    def __init__(self, path, viewer):
        self._recording, self._viewer = Recording(path), viewer
        self._shown = False
        self.times = {}

    def draw(self, frame, *, mark=''):
        """Draw a frame; `mark` names its time."""
        self.times[mark] = self._recording.draw(frame, real_time_factor=1.0)

    def look(self, mark):
        """Return the picture of the world at a time, (h, w, 3) uint8, when it is complete."""
        if not self._shown:
            self._recording.close()
            self._viewer.open_recording(self._recording.path)
            self._shown = True
        picture = self._viewer.picture(self.times[mark])
        assert self._viewer.errors() == []
        return np.asarray(picture)


@pytest.fixture
def film(tmp_path, viewer):
    return Film(tmp_path / 'film.rrd', viewer)


def pixels_of(picture, color):
    """Return rows and columns of the pixels of a colour."""
    wanted = np.rint(np.array(color[:3]) * 255)
    return np.nonzero(np.abs(picture - wanted).max(axis=2) <= COLOR_TOLERANCE)


def middle(picture, color):
    """Return column and row of the middle of the pixels of a colour."""
    rows, columns = pixels_of(picture, color)
    assert len(rows), f'nothing has the colour {color}'
    return np.array((columns.mean(), rows.mean()))


def world(*requests, **settings):
    """Return a simulation that begins with requests, 20 m wide."""
    simulation = Simulation(physics_rate=240, publish_rate=60)
    simulation.perform(Configure(changes={'bounds': (-10.0, 0.0, 10.0, 8.0), **settings}))
    for request in requests:
        simulation.perform(request)
    return simulation


def test_colours_sizes_and_directions_are_those_that_were_asked_for(film):
    simulation = world(
        spawning('red/0', Box(width=4.0, height=2.0), (-5.0, 6.0, 0.0), color=RED, anchored=True),
        spawning('blue/0', Box(width=2.0, height=2.0), (5.0, 2.0, 0.0), color=BLUE, anchored=True),
    )
    film.draw(simulation.advance_frame(), mark='now')

    picture = film.look('now')

    assert (middle(picture, RED) < middle(picture, BLUE)).all(), 'x is not right, or y not up'
    rows, columns = pixels_of(picture, color=RED)
    width, height = np.ptp(columns), np.ptp(rows)
    # 4 m by 2 m without their outlines, and ten metres apart: to the pixel or two at an edge.
    assert width / height == pytest.approx(2.0, rel=0.05)
    across = middle(picture, BLUE)[0] - middle(picture, RED)[0]
    assert across / width == pytest.approx(10 / 4, rel=0.05)


def test_bodies_are_where_they_were_in_the_past_in_a_branch_and_now(film):
    wedge = Polygon(outline=((0, 0), (2, 0), (0, 2)))
    simulation = world(
        spawning('ball/0', Disc(radius=0.6), (-8.0, 4.0, 0.0), color=RED, velocity=(4.0, 0.0)),
        spawning('wedge/0', wedge, (6.0, 5.0, 0.0), color=GREEN, anchored=True),
        gravity=(0.0, 0.0),
    )
    clock = itertools.count()

    def run(frames, mark):
        for _ in range(frames):
            for frame in simulation.advance(next(clock) * 16_666_667):
                film.draw(frame, mark=mark)

    run(61, 'first')
    simulation.speed = -1.0
    run(30, 'past')
    simulation.speed = 1.0
    stone = spawning('stone/0', Disc(radius=0.6), (0.0, 1.5, 0.0), color=BLUE)
    simulation.requests.submit(stone, topic='~/spawn')
    run(60, 'branch')

    pictures = {mark: film.look(mark) for mark in ('first', 'past', 'branch')}

    # One scale for all: the camera stands still.
    x = {mark: middle(picture, RED)[0] for mark, picture in pictures.items()}
    scale = (middle(pictures['branch'], BLUE)[0] - x['past']) / 6.0
    assert x['first'] - x['past'] == pytest.approx(2.0 * scale, abs=0.2 * scale)
    assert x['branch'] - x['past'] == pytest.approx(4.0 * scale, abs=0.2 * scale)
    wedge = [middle(picture, GREEN) for picture in pictures.values()]
    assert np.ptp(wedge, axis=0) == pytest.approx([0.0, 0.0], abs=0.5)
    for mark in ('first', 'past'):
        assert not len(pixels_of(pictures[mark], BLUE)[0]), 'the branch is seen before it began'
