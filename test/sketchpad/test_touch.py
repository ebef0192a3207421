# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page under fingers and a stylus."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from .chromium import circle, Fingers, Sheet, Stylus


def test_a_second_finger_turns_the_body_that_is_placed(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    sheet.press('Hand')
    x, y = sheet.place(4.0, 0.5)
    fingers = Fingers(sheet)
    fingers.put((x, y))
    x, y = sheet.place(4.0, 4.0)
    fingers.move((x, y))
    sheet.wait('Math.abs(physsim.bodies["box/0"][1] - 4) < 0.1')
    fingers.put((x, y), (x + 100, y))
    # A quarter of a turn counter-clockwise, in steps.
    for angle in np.linspace(0.0, math.pi / 2, 9)[1:]:
        fingers.move((x, y), (x + 100 * math.cos(angle), y - 100 * math.sin(angle)))
    sheet.wait('angle => Math.abs(physsim.bodies["box/0"][2] - angle) < 0.05', math.pi / 2)
    fingers.lift()
    sheet.press('Undo')
    sheet.wait('physsim.bodies["box/0"].join() === "4,0.5,0"')
    sheet.close()


def test_a_finger_draws_and_two_fingers_zoom(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    before = sheet.names()
    fingers = Fingers(sheet)
    places = [sheet.place(*point) for point in circle(1.0, 5.0, 0.8)]
    fingers.put(places[0])
    for place in places[1:]:
        fingers.move(place)
    fingers.lift()
    sheet.wait_for_new(before)

    def width() -> float:
        return sheet.place(1.0, 0.0)[0] - sheet.place(0.0, 0.0)[0]

    narrow = width()
    fingers.put((500, 400), (600, 400))
    fingers.move((450, 400), (650, 400))
    fingers.lift()
    assert 1.7 * narrow < width() < 2.3 * narrow
    sheet.close()


def test_a_palm_does_not_end_the_stroke_of_a_stylus(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    before = sheet.names()
    stylus, palm = Stylus(sheet), Fingers(sheet)
    places = [sheet.place(*point) for point in circle(1.0, 5.0, 0.8)]
    corner = sheet.place(0.0, 0.0)
    stylus.put(places[0])
    stylus.move(places[1:8])
    palm.put((900, 600))
    stylus.move(places[8:])
    palm.move((910, 605))
    palm.lift()
    stylus.lift(places[-1])
    sheet.wait_for_new(before)
    assert sheet.place(0.0, 0.0) == corner
    sheet.close()


def test_a_finger_beside_a_body_means_that_body(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    x, y = sheet.place(0.0, 1.0)
    sheet.press('Anchor')
    sheet.page.touchscreen.tap(x, y - 8)
    sheet.page.get_by_role('status').get_by_text('ball/0 anchored').wait_for()
    sheet.press('Undo')
    # An anchored body is carried, and moves when it is let go.
    sheet.wait('heard.shown.includes("~/undo")')
    sheet.press('Hand')
    fingers = Fingers(sheet)
    fingers.put((x, y - 8))
    fingers.move((x, y - 100))
    sheet.wait('physsim.bodies["ball/0"][1] > 1')
    fingers.lift()
    sheet.close()


def test_the_first_tap_of_a_circle_leaves_a_mark(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    sheet.press('Circle')
    x, y = sheet.place(1.0, 6.0)
    sheet.page.touchscreen.tap(x, y)
    mark = sheet.page.evaluate('([x, y]) => physsim.toWorld(x, y)', [x + 4, y])
    sheet.until(lambda: sheet.color_at(*mark) == [11, 98, 196], 'a mark')
    sheet.page.keyboard.press('Escape')
    sheet.close()


def test_a_finger_that_stays_on_a_button_asks_what_it_does(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    box = sheet.page.get_by_role('button', name='Hand', exact=True).bounding_box()
    fingers = Fingers(sheet)
    fingers.put((box['x'] + 20, box['y'] + 20))
    sheet.page.get_by_role('tooltip').get_by_text('Drag and throw').wait_for()
    fingers.lift()
    sheet.press('Pen')
    sheet.page.get_by_role('button', name='Pen', pressed=True).wait_for()

    def is_pressed() -> bool:
        # On a busy machine a tap may last as long as a question.
        fingers.put((box['x'] + 20, box['y'] + 20))
        fingers.lift()
        return bool(sheet.page.get_by_role('button', name='Hand', pressed=True).count())

    sheet.until(is_pressed, 'a tap')
    sheet.close()


def test_a_tap_that_opens_the_panel_works_nothing_in_it(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True, viewport={'width': 844, 'height': 390})
    sheet.begin()
    sheet.press('Hand')
    panel = sheet.page.get_by_role('complementary', name='Body')
    sheet.page.touchscreen.tap(*sheet.place(4.0, 0.5))
    panel.wait_for()
    # The panel covers the place of the body, which the view makes room for.
    left = panel.bounding_box()['x']
    assert sheet.place(4.0, 0.5)[0] < left
    sheet.press('More')
    friction = panel.get_by_role('slider', name='Friction')
    assert friction.input_value() == '0.5'
    sheet.close()


def test_a_stylus_draws_and_from_then_on_a_finger_moves_the_view(
    chromium: Any, address: str
) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    before = sheet.names()
    Stylus(sheet).draw([sheet.place(*point) for point in circle(1.0, 5.0, 0.8)])
    sheet.wait_for_new(before)
    x, y = sheet.place(0.0, 0.0)
    fingers = Fingers(sheet)
    fingers.put((500, 300))
    fingers.move((540, 330))
    fingers.lift()
    assert sheet.place(0.0, 0.0) == pytest.approx((x + 40, y + 30), abs=1.0)
    sheet.close()
