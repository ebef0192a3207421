# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page under fingers and a stylus."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math
from typing import Any

import numpy as np
import pytest

from .chromium import circle, Fingers, OpenSheet, POINTER, Sheet, started_world, Stylus
from ..outside import Outside


def test_a_second_finger_turns_the_body_that_is_placed(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
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


def before_a_circle(open_sheet: OpenSheet) -> tuple[Sheet, set[str], list[tuple[float, float]]]:
    """Return a sheet, the names of its bodies, and the places of a circle that is to be drawn."""
    sheet = open_sheet(has_touch=True).begin()
    return sheet, sheet.names(), [sheet.place(*point) for point in circle(1.0, 5.0, 0.8)]


def test_a_finger_draws_and_two_fingers_zoom(open_sheet: OpenSheet) -> None:
    sheet, before, places = before_a_circle(open_sheet)
    fingers = Fingers(sheet)
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


@pytest.mark.parametrize('ends', [Fingers.lift, Fingers.cancel])
def test_a_palm_does_not_end_the_stroke_of_a_stylus(
    open_sheet: OpenSheet, ends: Callable[[Fingers], None]
) -> None:
    sheet, before, places = before_a_circle(open_sheet)
    stylus, palm = Stylus(sheet), Fingers(sheet)
    corner = sheet.place(0.0, 0.0)
    stylus.put(places[0])
    stylus.move(places[1:8])
    palm.put((900, 600))
    stylus.move(places[8:12])
    palm.move((910, 605))
    ends(palm)
    stylus.move(places[12:])
    stylus.lift(places[-1])
    sheet.wait_for_new(before)
    assert sheet.place(0.0, 0.0) == corner
    sheet.close()


BLUR = """() => {
    dispatchEvent(new Event('blur'));
    document.dispatchEvent(new Event('visibilitychange'));
}"""
# Events that may come while somebody draws.
MEANWHILE: dict[str, Callable[[Sheet], object]] = {
    'wheel': lambda sheet: sheet.page.mouse.wheel(0, -120),
    'focus': lambda sheet: sheet.page.evaluate(BLUR),
    'tool': lambda sheet: sheet.page.keyboard.press('h'),
    'frame': lambda sheet: sheet.page.keyboard.press('f'),
    'zoom': lambda sheet: sheet.page.keyboard.press('+'),
    'space': lambda sheet: sheet.page.keyboard.press(' '),
    'right': lambda sheet: sheet.page.mouse.down(button='right'),
    'turned': lambda sheet: sheet.page.set_viewport_size({'width': 800, 'height': 1200}),
    'palm': lambda sheet: sheet.page.evaluate(POINTER, ['touch', 1, 9, [['down', 500, 300]]]),
    'stylus': lambda sheet: sheet.page.evaluate(POINTER, ['pen', 1, 9, [['down', 500, 300]]]),
}


@pytest.mark.parametrize('pointer', ['mouse', 'pen'])
def test_a_stroke_is_drawn_to_its_end_whatever_happens_meanwhile(
    open_sheet: OpenSheet, pointer: str
) -> None:
    sheet = open_sheet(has_touch=True).begin()
    mouse, stylus, stroke = sheet.page.mouse, Stylus(sheet), circle(1.0, 5.0, 0.8)

    def move(points: Sequence[tuple[float, float]]) -> None:
        for point in points:
            place = sheet.place(*point)
            if pointer == 'pen':
                stylus.move([place])
            else:
                mouse.move(*place)

    for name, interrupt in MEANWHILE.items():
        # Such a second pointer moves the view, or takes over.
        if pointer == 'mouse' and name in ('palm', 'stylus'):
            continue
        sheet.press('Pen')
        before = sheet.names()
        if pointer == 'pen':
            stylus.put(sheet.place(*stroke[0]))
        else:
            move(stroke[:1])
            mouse.down()
        move(stroke[1:12])
        interrupt(sheet)
        move(stroke[12:])
        if pointer == 'pen':
            stylus.lift(sheet.place(*stroke[-1]))
        mouse.up()
        mouse.up(button='right')
        drawn = sheet.wait_for_new(before)
        assert sheet.pose(drawn)[:2] == pytest.approx((1.0, 5.0), abs=0.05), name
        sheet.press('Undo')
        sheet.wait('name => !(name in physsim.bodies)', drawn)


@pytest.mark.parametrize('end', ['cancel', 'lost'])
def test_the_stroke_of_a_stylus_whose_end_is_not_told_ends_where_it_was(
    open_sheet: OpenSheet, end: str
) -> None:
    sheet, before, places = before_a_circle(open_sheet)
    corner = sheet.place(0.0, 0.0)
    down, *moves = [['move', *place] for place in places]
    sheet.page.evaluate(POINTER, ['pen', 1, 9, [['down', *down[1:]], *moves]])
    last = ['cancel', 0, 0] if end == 'cancel' else ['move', 900, 600]
    sheet.page.evaluate(POINTER, ['pen', 0, 9, [last]])
    name = sheet.wait_for_new(before)
    assert sheet.pose(name)[:2] == pytest.approx((1.0, 5.0), abs=0.05)
    assert sheet.place(0.0, 0.0) == corner
    sheet.close()


def test_a_hand_lets_go_though_its_second_finger_was_cancelled(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
    sheet.press('Hand')
    fingers = Fingers(sheet)
    fingers.put(sheet.place(4.0, 0.5))
    fingers.move(sheet.place(4.0, 4.0))
    sheet.wait('Math.abs(physsim.bodies["box/0"][1] - 4) < 0.1')
    sheet.page.evaluate(POINTER, ['touch', 1, 99, [['down', 900, 300], ['cancel', 900, 300]]])
    fingers.lift()
    # A hand that holds it would keep it there.
    sheet.press('Play')
    sheet.wait('physsim.bodies["box/0"][1] < 1')


def test_a_long_stroke_is_thinned_out(open_sheet: OpenSheet) -> None:
    sheet = open_sheet().begin()
    before = sheet.names()
    (x, y), count = sheet.place(1.0, 6.0), 9000
    turns = np.linspace(0.0, math.tau, count)
    places = [['move', x + 70 * math.cos(turn), y + 70 * math.sin(turn)] for turn in turns]
    places = [['down', x + 70, y], *places, ['up', x + 70, y]]
    sheet.page.evaluate(POINTER, ['mouse', 1, 99, places])
    sheet.wait_for_new(before)
    sheet.told('Circle added')


def test_the_eraser_of_a_stylus_erases_and_its_button_selects(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
    corner = sheet.place(0.0, 0.0)
    # Right through a body, and past the others.
    (x, y), (end_x, _) = sheet.place(-5.0, 3.0), sheet.place(-3.0, 3.0)
    across = [['down', x, y - 60], ['move', x, y], ['move', end_x, y], ['up', end_x, y]]
    sheet.page.evaluate(POINTER, ['pen', 32, 99, across])
    sheet.wait('Object.keys(physsim.bodies).join() === "ball/0,box/0"')
    sheet.press('Undo')
    sheet.wait('Object.keys(physsim.bodies).length === 3')
    (left, high), (right, low) = sheet.place(3.0, 2.0), sheet.place(5.0, -0.3)
    loop = [(left, high), (right, high), (right, low), (left, low), (left, high)]
    around = [['down', *loop[0]], *(['move', *place] for place in loop), ['up', *loop[-1]]]
    sheet.page.evaluate(POINTER, ['pen', 2, 99, around])
    sheet.page.get_by_role('complementary', name='Body').get_by_text('box/0').wait_for()
    assert sheet.names() == {'ball/0', 'box/0', 'shelf/0'}
    sheet.press('Close')
    assert sheet.place(0.0, 0.0) == corner


def test_a_body_beyond_the_bounds_and_a_world_of_many_kilometres_are_framed(
    open_sheet: OpenSheet, outside: Outside
) -> None:
    world = 'format: 1\nbounds: [-4000, 0, 4000, 3000]\nbodies:\n'
    bodies = '- {name: far/0, circle: {radius: 9}, at: [9000, -2000], anchored: true}'
    _, address = started_world(outside, world=world + bodies)
    sheet = open_sheet(address)
    sheet.wait('Object.keys(physsim.bodies).length === 1')
    for point in ((-4000.0, 0.0), (4000.0, 3000.0)):
        x, y = sheet.place(*point)
        assert 0 < x < 1200
        assert 0 < y < 800
    assert sheet.place(9000.0, -2000.0)[0] > 1200
    sheet.press('Frame the world')
    assert 0 < sheet.place(9000.0, -2000.0)[0] < 1200
    assert sheet.place(-4000.0, 0.0)[0] > 0


def test_a_finger_beside_a_body_means_that_body(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
    x, y = sheet.place(0.0, 1.0)
    sheet.press('Anchor')
    sheet.page.touchscreen.tap(x, y - 8)
    sheet.told('ball/0 anchored')
    sheet.press('Undo')
    # An anchored body is carried, and moves when it is let go.
    sheet.wait('heard.shown.includes("~/undo")')
    sheet.press('Hand')
    fingers = Fingers(sheet)
    fingers.put((x, y - 8))
    fingers.move((x, y - 100))
    sheet.wait('physsim.bodies["ball/0"][1] > 1')
    fingers.lift()


def test_the_first_tap_of_a_circle_leaves_a_mark(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
    sheet.press('Circle')
    x, y = sheet.place(1.0, 6.0)
    sheet.page.touchscreen.tap(x, y)
    mark = sheet.page.evaluate('([x, y]) => physsim.toWorld(x, y)', [x + 4, y])
    sheet.until(lambda: sheet.color_at(*mark) == [11, 98, 196], 'a mark')
    sheet.page.keyboard.press('Escape')


def test_a_finger_that_stays_on_a_button_asks_what_it_does(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
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


def test_a_tap_that_opens_the_panel_works_nothing_in_it(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True, size=(844, 390)).begin()
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


def test_a_stylus_draws_and_from_then_on_a_finger_moves_the_view(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True).begin()
    before = sheet.names()
    Stylus(sheet).draw([sheet.place(*point) for point in circle(1.0, 5.0, 0.8)])
    sheet.wait_for_new(before)
    x, y = sheet.place(0.0, 0.0)
    fingers = Fingers(sheet)
    fingers.put((500, 300))
    fingers.move((540, 330))
    fingers.lift()
    assert sheet.place(0.0, 0.0) == pytest.approx((x + 40, y + 30), abs=1.0)


def test_no_hint_lies_on_the_legend_of_a_telephone(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(has_touch=True, size=(390, 844)).begin()
    sheet.press('Show forces')
    sheet.press('Polygon')
    hint, legend = sheet.page.locator('#hint'), sheet.page.locator('#legend')
    hint.get_by_text('click each corner').wait_for()
    legend.wait_for()

    def is_above(one: Any, other: Any) -> bool:
        box, below = one.bounding_box(), other.bounding_box()
        return bool(box['y'] + box['height'] <= below['y'])

    sheet.until(lambda: is_above(legend, hint), 'a hint below the legend')
    assert is_above(hint, sheet.page.locator('#tools'))
