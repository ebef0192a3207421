# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Inclined planes on the page: drawn, read and typed by their angle and length."""

from __future__ import annotations

import math

import pytest

from .chromium import OpenSheet, Sheet

ANGLE, LENGTH = 'Angle of the slope [°]', 'Length of the slope [m]'
# Greatest distance of a foot from where it was [m]: poses come as float32.
NEAR = 1e-6


def drawn(sheet: Sheet, *points: tuple[float, float]) -> str:
    """Draw an inclined plane along its slope, or tap, and return its name."""
    before = sheet.names()
    sheet.press('Inclined plane')
    if len(points) > 1:
        sheet.drag(*points)
    else:
        sheet.tap(*points[0])
    return sheet.wait_for_new(before)


def shown(sheet: Sheet) -> tuple[float, float]:
    """Return angle [°] and length [m] as the panel has them."""
    sheet.page.get_by_label(ANGLE).wait_for()
    angle, length = (sheet.page.get_by_label(each).input_value() for each in (ANGLE, LENGTH))
    return float(angle), float(length)


def test_a_plane_is_drawn_along_its_slope_and_has_whole_degrees(sheet: Sheet) -> None:
    name = drawn(sheet, (-7.0, 0.0), (-5.0, 1.19))
    assert name == 'incline/1'
    angle, length = shown(sheet)
    assert angle == round(math.degrees(math.atan2(1.19, 2.0)))
    assert length == pytest.approx(math.hypot(2.0, 1.19), abs=0.06)
    sheet.page.get_by_role('heading', name='Inclined plane').wait_for()
    # Down the slope, too: the foot is at its lower end.
    x, y, _ = sheet.pose(drawn(sheet, (-2.0, 8.0), (1.0, 5.0)))
    assert shown(sheet)[0] == 45
    assert (x, y) == pytest.approx((1.0, 5.0), abs=0.1)
    sheet.press('Undo')
    sheet.wait('!("incline/2" in physsim.bodies)')


def test_a_tap_puts_a_plane_of_30_degrees_and_4_m(sheet: Sheet) -> None:
    name = drawn(sheet, (-3.0, 5.0))
    assert shown(sheet) == (30, 4)
    x, y, yaw = sheet.pose(name)
    assert (x, y, yaw) == pytest.approx((-3.0, 5.0, 0.0), abs=0.02)
    blue, grey = sheet.color_at(-0.5, 5.5), sheet.color_at(-2.0, 6.5)
    assert blue != grey


def test_angle_and_length_are_typed_and_undone_one_by_one(sheet: Sheet) -> None:
    name = drawn(sheet, (-3.0, 5.0))
    foot = sheet.pose(name)
    empty = sheet.color_at(-1.0, 6.7)
    sheet.enter(ANGLE, '52,5')
    sheet.until(lambda: sheet.color_at(-1.0, 6.7) != empty, 'a steeper plane')
    sheet.enter(LENGTH, '2.5')
    sheet.page.keyboard.press('Escape')
    sheet.until(lambda: sheet.color_at(-1.0, 6.7) == empty, 'a shorter plane')
    assert sheet.pose(name) == pytest.approx(foot, abs=NEAR)
    sheet.press('Hand')
    sheet.tap(-2.0, 5.3)
    assert shown(sheet) == (52.5, 2.5)
    sheet.press('Undo')
    sheet.until(lambda: shown(sheet) == (52.5, 4), 'the length of before')
    sheet.press('Undo')
    sheet.until(lambda: shown(sheet) == (30, 4), 'the angle of before')


def test_a_plane_that_is_none_is_refused(sheet: Sheet) -> None:
    drawn(sheet, (-3.0, 5.0))
    for label, text in ((ANGLE, '90'), (ANGLE, '-5'), (LENGTH, '0')):
        sheet.enter(label, text)
        sheet.told('between 0° and 90°')
        sheet.until(lambda: shown(sheet) == (30, 4), 'the plane of before')


def test_a_box_has_no_slope(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(*sheet.pose('box/0')[:2])
    sheet.page.get_by_role('heading', name='box/0').wait_for()
    assert not sheet.page.get_by_label(ANGLE).is_visible()


def test_a_plane_that_is_drawn_near_a_floor_stands_on_it(sheet: Sheet) -> None:
    near = 8.0 / sheet.page.evaluate('physsim.toPage(1, 0)[0] - physsim.toPage(0, 0)[0]')
    _, y, _ = sheet.pose(drawn(sheet, (-7.0, near), (-5.0, near + 1.2)))
    assert y == 0.0
    # On a shelf whose upper edge is 3.2 m high; and where there is no floor.
    _, y, _ = sheet.pose(drawn(sheet, (-4.0, 3.2 - near), (-3.0, 4.0)))
    assert y == pytest.approx(3.2, abs=NEAR)
    _, y, _ = sheet.pose(drawn(sheet, (2.0, 5.0), (3.0, 6.0)))
    assert y == pytest.approx(5.0, abs=near)


def test_two_pages_draw_planes_at_once(sheet: Sheet, open_sheet: OpenSheet) -> None:
    other = open_sheet()
    for each in (sheet, other):
        each.wait('heard.people?.length === 2')
        each.press('Inclined plane')
    for each, x in ((sheet, -3.0), (other, 1.0)):
        each.page.mouse.move(*each.place(x, 5.0))
        each.page.mouse.down()
    # Neither waits for the other's plane.
    for each in (sheet, other):
        each.page.mouse.up()
    for each in (sheet, other):
        each.wait('Object.keys(physsim.bodies).length === 5')
