# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The experiment of each shipped lesson is what its page shows first, and shows large."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from physsim_ros.files import shipped_lessons, worlds_in
from physsim_ros.model.transform import local_to_world, ORIGIN
import pytest

from .chromium import OpenSheet, Sheet
from ..worlds.film import Film, simulation, state_of

# Time in which what each lesson asks for has been seen [s], and the body that is tapped.
SEEN = {
    'free_fall': (1.0, 'heavy/0'),
    'horizontal_throw': (1.0, 'thrown/0'),
    'oblique_throw': (1.15, 'ball/0'),
    'slope': (1.85, 'ice/0'),
    'friction': (1.3, 'block/0'),
    'lever': (3.0, 'green/0'),
    'elastic_collision': (2.7, 'light/0'),
    'inelastic_collision': (2.1, 'fast/0'),
    'pendulum': (3.2, 'bob/0'),
    'spring_energy': (0.7, 'block/0'),
    'floating': (2.0, 'block/0'),
    'terminal_speed': (2.4, 'ball/0'),
    'orbit': (8.0, 'planet/0'),
    'pulley': (1.0, 'load/0'),
    'belt': (1.75, 'parcel/0'),
}
SIDES = [(1, 0), (0, 1), (-1, 0), (0, -1)]
CORNERS = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
# Boxes of the bars and panels, and of what is beyond the page.
COVERS = """() => {
    const bars = document.querySelectorAll('#tools, #top > .bar, #bar, #lesson, #panel, #plot');
    const boxes = [...bars].map((bar) => bar.getBoundingClientRect()).filter((box) => box.width);
    const far = 1e6;
    return [...boxes.map(({left, top, right, bottom}) => [left, top, right, bottom]),
        [-far, -far, 0, far], [innerWidth, -far, far, far],
        [-far, -far, far, 0], [-far, innerHeight, far, far]];
}"""
# Of a frame in which a body is drawn on the edge of what covers it [px].
EDGE = 1.0


class Box(NamedTuple):
    """A box in the world [m], y up, or on the page [px], y down."""

    left: float
    low: float
    right: float
    high: float


@cache
def motion_of(name: str) -> Box:
    """Return the box of all places of bodies that move, of what holds them, and of media."""
    film = Film(simulation(name), SEEN[name][0])
    scene = film.frames[0].scene
    poses = {'world': ORIGIN, **{saved.body.name: saved.pose for saved in state_of(name).bodies}}
    points = [
        np.array(
            [
                local_to_world(point, poses[body])
                for joint in state_of(name).joints
                for body, point in (
                    (joint.a, (joint.seat.ax, joint.seat.ay)),
                    (joint.b, (joint.seat.bx, joint.seat.by)),
                    *((guide.body, (guide.x, guide.y)) for guide in joint.guides),
                )
            ]
        ).reshape(-1, 2)
    ]
    for body in scene.bodies:
        if body.anchored and body.medium is None:
            continue
        x, y, yaw = film.pose(body.name).T
        shape = body.shape
        if hasattr(shape, 'radius'):
            corners = [(x + dx, y + dy) for dx, dy in shape.radius * np.array(SIDES)]
        else:
            half = np.array([shape.width, shape.height]) / 2
            corners = [
                (x + np.cos(yaw) * dx - np.sin(yaw) * dy, y + np.sin(yaw) * dx + np.cos(yaw) * dy)
                for dx, dy in half * np.array(CORNERS)
            ]
        points += [np.stack(corner, axis=1) for corner in corners]
    every = np.concatenate(points)
    return Box(*every.min(axis=0), *every.max(axis=0))


def test_every_lesson_has_its_experiment() -> None:
    assert set(SEEN) == set(worlds_in(shipped_lessons()))


@pytest.fixture(params=[(1280, 800), (390, 844), (320, 640)], ids=lambda size: str(size[0]))
def sheet(open_sheet: OpenSheet, request: pytest.FixtureRequest) -> Sheet:
    """Give a test a page of a size."""
    sheet = open_sheet(unfolded=False, size=request.param)
    sheet.wait('heard.people && Object.keys(physsim.bodies).length > 0')
    return sheet


def begin(sheet: Sheet, name: str) -> None:
    """Open a lesson."""
    sheet.press('Worlds')
    number = 1 + list(SEEN).index(name)
    sheet.page.locator('.lessons').get_by_role('button', name=f'{number}. ').first.click()
    body = SEEN[name][1]
    sheet.wait('name => name in physsim.bodies && physsim.time === 0', body)
    sheet.wait(f'document.querySelector("#lesson h2").textContent.startsWith("{number}. ")')


def shown(sheet: Sheet, name: str) -> Box:
    """Return where the motion of a lesson is shown; nothing covers it [px]."""
    left, low, right, high = motion_of(name)

    def box() -> Box:
        return Box(*sheet.place(left, high), *sheet.place(right, low))

    def is_in_sight() -> bool:
        covers, now = np.array(sheet.page.evaluate(COVERS)), np.array(box())
        overlaps = np.minimum(covers[:, 2:], now[2:]) - np.maximum(covers[:, :2], now[:2])
        return bool((overlaps.min(axis=1) < EDGE).all())

    sheet.until(is_in_sight, f'the motion of {name} in sight')
    return box()


def shares(sheet: Sheet, name: str) -> tuple[float, float]:
    """Return the shares of the width and of the height of the page that the motion takes."""
    left, top, right, bottom = shown(sheet, name)
    size = sheet.page.viewport_size
    return (right - left) / size['width'], (bottom - top) / size['height']


def test_the_experiment_is_the_page(sheet: Sheet) -> None:
    width = sheet.page.viewport_size['width']
    found: dict[str, list[tuple[float, float]]] = {}
    for name, (_, body) in SEEN.items():
        begin(sheet, name)
        found[name] = [shares(sheet, name)]
        # Once time has run, the card is folded to the question and the field for its answer.
        sheet.press('Step')
        sheet.page.locator('#lesson.folded').wait_for()
        assert sheet.page.get_by_text('To measure:').is_hidden()
        assert sheet.page.get_by_role('textbox', name='Your answer').is_visible()
        found[name].append(shares(sheet, name))
        sheet.tap(*sheet.pose(body)[:2])
        sheet.page.get_by_role('complementary', name='Body').wait_for()
        # Numbers alone.
        assert sheet.page.get_by_role('slider', name='Friction', exact=True).is_hidden()
        sheet.press('Show forces')
        found[name].append(shares(sheet, name))
        sheet.press('Show forces')
        sheet.press('Close')
    for name, (card, folded, panel) in found.items():
        if width == 1280:
            assert max(card) >= 0.5, name
            assert max(panel) >= 0.4, name
        elif width == 390:
            # What is higher than wide has the height between the bars.
            assert folded[0] >= 0.9 or folded[1] >= 0.5, name
        else:
            assert max(panel) >= 0.2, name
