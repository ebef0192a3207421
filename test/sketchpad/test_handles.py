# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A body by its handles and by typed numbers, the grid, the numbers of what is drawn."""

from __future__ import annotations

from itertools import cycle
import math

import pytest

from .chromium import NOTE_TEXTS, PIXEL, Sheet

# Whether a speed of 1 m/s or more was written.
SPEED = r'window.texts.some((text) => / [1-9]\.\d+ m\/s/.test(text))'


@pytest.fixture
def sheet(sheet: Sheet) -> Sheet:
    """Give a test a page on which a box is selected."""
    sheet.press('Hand')
    sheet.tap(4.0, 0.5)
    sheet.page.get_by_role('heading', name='box/0').wait_for()
    sheet.wait('physsim.handles !== null')
    sheet.page.evaluate(NOTE_TEXTS)
    return sheet


def written(sheet: Sheet, text: str) -> None:
    """Wait until a text is written on the canvas."""
    sheet.wait('text => window.texts.includes(text)', text)


def drag_handle(sheet: Sheet, handle: str, turn: float, share: float, *keys: str) -> None:
    """
    Drag a handle about the centre of its body.

    :param turn: counter-clockwise [rad]
    :param share: of its distance, at the end
    :param keys: that are held
    """
    places = sheet.page.evaluate('physsim.handles')
    (cx, cy), (x, y) = places['center'], places[handle]
    angle, length = math.atan2(cy - y, x - cx) + turn, share * math.hypot(x - cx, y - cy)
    sheet.page.mouse.move(x, y)
    sheet.page.mouse.down()
    for key in keys:
        sheet.page.keyboard.down(key)
    to = cx + length * math.cos(angle), cy - length * math.sin(angle)
    sheet.page.mouse.move(*to, steps=5)
    sheet.page.mouse.up()
    for key in keys:
        sheet.page.keyboard.up(key)


def test_handles_are_not_printed(sheet: Sheet) -> None:
    def is_blue() -> bool:
        red, _, blue, _ = sheet.page.evaluate(PIXEL, sheet.page.evaluate('physsim.handles.turn'))
        return bool(blue > red + 100)

    sheet.page.mouse.move(*sheet.place(4.0, 0.6))
    sheet.until(is_blue, 'the handle')
    sheet.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert not is_blue()


def test_labels_and_notes_are_written_on_the_world(sheet: Sheet) -> None:
    label, keyboard = sheet.page.get_by_label('Label', exact=True), sheet.page.keyboard
    label.fill('m1')
    label.press('Shift+Enter')
    keyboard.type('2 kg')
    label.press('Enter')
    written(sheet, '2 kg')
    written(sheet, 'm1')
    before = sheet.names()
    # The key of the tool, then a text, as pasted.
    keyboard.press('Escape')
    keyboard.press('9')
    sheet.tap(0.0, 7.0)
    keyboard.insert_text('who\twins?')
    keyboard.press('Enter')
    written(sheet, 'who wins?')
    sheet.page.get_by_text('Note added').wait_for()
    (note,) = sheet.names() - before
    assert sheet.pose(note) == pytest.approx([0.0, 7.0, 0.0], abs=0.02)
    # It has the size of its text: a point beside the middle is on it, and edits it.
    sheet.press('Hand')
    sheet.tap(0.3, 7.0)
    sheet.page.get_by_role('heading', name='Note').wait_for()
    label.fill('a much longer question')
    label.press('Enter')
    written(sheet, 'a much longer question')
    keyboard.press('Escape')
    sheet.tap(1.2, 7.0)
    sheet.page.get_by_role('heading', name='Note').wait_for()
    sheet.press('Undo')
    sheet.press('Undo')
    sheet.wait('name => !(name in physsim.bodies)', note)
    # Escape while one types leaves text and world as they were.
    keyboard.press('9')
    sheet.tap(0.0, 7.0)
    keyboard.type('no')
    keyboard.press('Escape')
    sheet.press('Play')
    sheet.wait('physsim.time > 0.1')
    assert sheet.names() == before
    assert not sheet.errors


def test_the_round_handle_turns_a_body(sheet: Sheet) -> None:
    drag_handle(sheet, 'turn', math.radians(70.0), 1.3)
    sheet.wait('Math.abs(physsim.bodies["box/0"][2] - 70 * Math.PI / 180) < 0.02')
    written(sheet, '70°')
    # About its centre of mass.
    assert sheet.pose('box/0')[:2] == pytest.approx([4.0, 0.5], abs=1e-6)
    sheet.press('Undo')
    sheet.wait('physsim.bodies["box/0"][2] === 0')


def test_with_the_key_of_the_grid_it_turns_by_steps(sheet: Sheet) -> None:
    drag_handle(sheet, 'turn', math.radians(-47.0), 1.0, 'Shift')
    sheet.wait('Math.abs(physsim.bodies["box/0"][2] + Math.PI / 4) < 1e-6')


def test_the_square_handle_scales_a_body(sheet: Sheet) -> None:
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_text('1 kg · ').wait_for()
    drag_handle(sheet, 'scale', 0.0, 1.52, 'Shift')
    written(sheet, '1.5 × 1.5 m')
    # Of the same density.
    panel.get_by_text('2.25 kg · ').wait_for()
    assert sheet.pose('box/0') == pytest.approx([4.0, 0.5, 0.0], abs=1e-6)
    sheet.press('Undo')
    panel.get_by_text('1 kg · ').wait_for()


def test_a_body_is_where_numbers_say(sheet: Sheet) -> None:
    sheet.page.get_by_text('Enter numbers').click()
    for label, text in (('x [m]', '2'), ('y [m]', '3.5'), ('Angle [°]', '30')):
        sheet.enter(label, text, exact=True)
    sheet.wait('Math.abs(physsim.bodies["box/0"][2] - Math.PI / 6) < 1e-6')
    assert sheet.pose('box/0')[:2] == pytest.approx([2.0, 3.5], abs=1e-6)
    sheet.enter('Mass [kg]', '5', exact=True)
    sheet.enter('vx [m/s]', '3', exact=True)
    sheet.enter('vy [m/s]', '-4', exact=True)
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_text('5 kg · at 2.00, 3.50 m · 30° · 5.00 m/s').wait_for()
    panel.get_by_text('Momentum 25.00 N s (15.00, \N{MINUS SIGN}20.00)').wait_for()
    # m v² / 2
    panel.get_by_text('62.50 J').wait_for()


def test_the_angle_of_a_body_is_that_of_its_direction_and_its_turns_are_kept(sheet: Sheet) -> None:
    with sheet.dragging((4.0, 0.5), (4.0, 3.0)):
        # 13 rad, by 2 mrad a pixel.
        sheet.page.mouse.wheel(0, -6500)
        sheet.wait('Math.abs(physsim.bodies["box/0"][2] - 13) < 1e-3')
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_text('1 kg · at 4.00, 3.00 m · 24.8°').wait_for()
    sheet.page.get_by_text('Enter numbers').click()
    sheet.enter('x [m]', '2', exact=True)
    sheet.wait('Math.abs(physsim.bodies["box/0"][0] - 2) < 1e-6')
    assert sheet.pose('box/0')[2] == pytest.approx(13.0, abs=1e-3)
    sheet.enter('Angle [°]', '30', exact=True)
    sheet.wait('Math.abs(physsim.bodies["box/0"][2] - 25 / 6 * Math.PI) < 1e-6')


def test_numbers_that_are_typed_before_a_frame_comes_are_kept(sheet: Sheet) -> None:
    sheet.page.evaluate(
        """(numbers) => {
        for (const [label, text] of numbers) {
            const labels = [...document.querySelectorAll('#panel label')];
            const named = labels.find((each) => each.textContent === label);
            named.control.value = text;
            named.control.dispatchEvent(new Event('change'));
        }
    }""",
        [
            ['x [m]', '2'],
            ['y [m]', '3.5'],
            ['Angle [°]', '30'],
            ['vx [m/s]', '3'],
            ['vy [m/s]', '-4'],
        ],
    )
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_text('1 kg · at 2.00, 3.50 m · 30° · 5.00 m/s').wait_for()


def test_what_is_drawn_and_placed_snaps_to_the_grid_while_a_key_is_held(sheet: Sheet) -> None:
    # Its fine lines are 0.4 m apart in this window.
    before = sheet.names()
    sheet.page.keyboard.press('Escape')
    sheet.press('Circle')
    sheet.page.keyboard.down('Shift')
    with sheet.dragging((-1.06, 5.05), (-0.34, 5.07)):
        written(sheet, 'radius 0.8 m')
    name = sheet.wait_for_new(before)
    assert sheet.pose(name) == pytest.approx([-1.2, 5.2, 0.0], abs=1e-6)
    sheet.press('Hand')
    with sheet.dragging((-1.13, 5.41), (-1.5, 6.32)):
        sheet.wait('name => Math.abs(physsim.bodies[name][1] - 6.0) < 1e-3', name)
    sheet.page.keyboard.up('Shift')
    # By its centre, wherever it is held.
    sheet.wait('name => Math.abs(physsim.bodies[name][0] + 1.6) < 1e-3', name)


def test_the_hand_tells_where_a_body_is_and_how_fast(sheet: Sheet) -> None:
    with sheet.dragging((-4.0, 3.0), (-4.0, 5.0)):
        written(sheet, 'at \N{MINUS SIGN}4.00, 5.00 m · 0°')
    sheet.press('Play')
    with sheet.dragging((0.0, 0.5), (1.0, 4.0)):
        places = cycle((sheet.place(-1.0, 4.0), sheet.place(1.0, 4.0)))

        def is_told() -> bool:
            sheet.page.mouse.move(*next(places))
            return bool(sheet.page.evaluate(SPEED))

        sheet.until(is_told, 'a speed')
    sheet.press('Pen')
    with sheet.dragging((1.0, 5.0), (3.0, 5.0), (3.0, 6.5)):
        written(sheet, '2 × 1.5 m')


def test_a_handle_is_dragged_by_keys(sheet: Sheet) -> None:
    keyboard = sheet.page.keyboard
    keyboard.press('Escape')
    sheet.page.get_by_role('img', name='World').focus()
    # The second body is the box. The cursor is at its centre, near its handles.
    keyboard.press('n')
    keyboard.press('n')
    (x, y), (turn_x, turn_y) = (
        sheet.place(*sheet.pose('box/0')[:2]),
        sheet.page.evaluate('physsim.handles.turn'),
    )
    assert abs(turn_x - x) < 1.0
    for _ in range(round((y - turn_y) / 16.0)):
        keyboard.press('ArrowUp')
    keyboard.press('Enter')
    for _ in range(round((y - turn_y) / 16.0)):
        keyboard.press('ArrowRight')
    keyboard.press('Enter')
    sheet.wait('Math.abs(physsim.bodies["box/0"][2] + Math.PI / 4) < 0.1')
