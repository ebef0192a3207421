# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints that are tapped on the page: their constants, their force, their end."""

from __future__ import annotations

from playwright.sync_api import Locator
import pytest

from .chromium import Sheet

G = 9.81
WORLD = """
format: 1
bounds: [-8, 0, 8, 9]
gravity: [0, -9.81]
bodies:
  - {name: ball/0, circle: {radius: 0.3}, at: [-5, 5], mass: 1}
  - {name: beam/0, box: {width: 4, height: 0.4}, at: [4, 5], mass: 1}
joints:
  - name: spring/0
    kind: spring
    a: ball/0
    points: [[-5, 5], [-5, 8]]
    stiffness: 100
    damping: 4
  - {name: axle/0, kind: axle, a: beam/0, points: [[2.2, 5]]}
"""


@pytest.fixture
def sheet(sheet: Sheet) -> Sheet:
    """Give a test a page with the hand."""
    sheet.press('Hand')
    return sheet


def tapped(sheet: Sheet, x: float, y: float, kind: str) -> Locator:
    """Tap a joint, and return its panel."""
    sheet.tap(x, y)
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_role('heading', name=kind).wait_for()
    return panel


def set_number(sheet: Sheet, label: str, value: str) -> None:
    """Type a number into the panel, and wait until it is done."""
    sheet.enter(label, value)
    sheet.told('changed')


def test_a_spring_has_the_constant_that_is_typed(sheet: Sheet) -> None:
    panel = tapped(sheet, -5.0, 6.5, 'Spring')
    assert panel.get_by_label('Spring constant [N/m], typed').input_value() == '100'
    assert panel.get_by_label('Rest length [m], typed').input_value() == '3'
    set_number(sheet, 'Spring constant [N/m], typed', '20')
    # Without another tap.
    assert panel.get_by_label('Rest length [m], typed').input_value() == '3'
    sheet.press('Play')
    sheet.wait('physsim.time > 5')
    # 1 kg rests where k x = m g.
    sheet.wait('low => Math.abs(physsim.bodies["ball/0"][1] - low) < 0.002', 5.0 - G / 20.0)
    # x is 0.49 m, and half of k x² 2.41 J.
    panel.get_by_text('Force now: 9.81 N · length 3.49 m · energy 2.41 J').wait_for()


def test_an_axle_becomes_a_ratchet(sheet: Sheet) -> None:
    panel = tapped(sheet, 2.2, 5.0, 'Axle')
    # Its weight would turn the beam clockwise.
    panel.get_by_label('Turns', exact=True).last.select_option('counter-clockwise')
    sheet.told('changed')
    sheet.play_until(1.0)
    assert sheet.pose('beam/0')[2] == pytest.approx(0.0, abs=1e-4)


def test_an_axle_has_limits_from_the_pose_in_which_it_was_made(sheet: Sheet) -> None:
    # The beam has turned before its limits are set.
    sheet.play_until(0.25)
    assert -0.6 < sheet.pose('beam/0')[2] < -0.1
    tapped(sheet, 2.2, 5.0, 'Axle')
    set_number(sheet, 'Least [rad]', '-0.6')
    sheet.press('Play')
    sheet.wait('physsim.time > 4')
    sheet.wait('Math.abs(physsim.bodies["beam/0"][2] + 0.6) < 0.01')
    # Without a number there is no limit any more.
    set_number(sheet, 'Least [rad]', '')
    sheet.wait('physsim.bodies["beam/0"][2] < -1.2')


def test_a_joint_breaks_at_the_force_that_is_typed(sheet: Sheet) -> None:
    panel = tapped(sheet, -5.0, 6.5, 'Spring')
    set_number(sheet, 'Breaks at [N]', '12')
    sheet.press('Play')
    # It falls to less than the spring would let it: k x is 12 N at 12 cm.
    sheet.wait('physsim.bodies["ball/0"][1] < 2')
    panel.wait_for(state='hidden')


def test_a_joint_is_deleted_and_a_second_tap_means_the_body_below(sheet: Sheet) -> None:
    tapped(sheet, 2.2, 5.0, 'Axle')
    sheet.tap(2.2, 5.0)
    sheet.page.get_by_role('heading', name='beam/0').wait_for()
    tapped(sheet, 2.2, 5.0, 'Axle')
    sheet.press('Delete joint')
    sheet.press('Play')
    # It falls.
    sheet.wait('physsim.bodies["beam/0"][1] < 1')


def test_a_gear_is_made_by_its_tool_and_reached_from_its_wheels(sheet: Sheet) -> None:
    for tool, place in (('Circle', (-2.0, 2.0)), ('Circle', (0.0, 2.0))):
        sheet.press(tool)
        for x, y in (place, (place[0] + 1.0 + place[0] / 4.0, place[1])):
            sheet.tap(x, y)
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    sheet.press('Gears')
    for x in (-2.0, 0.0):
        sheet.tap(x + 0.2, 2.0)
    sheet.told('Gear added')
    sheet.press('Hand')
    sheet.tap(0.2, 2.0)
    sheet.press('Gear')
    # Of radii of 0.5 m and 1 m.
    ratio = sheet.page.get_by_label('Ratio, typed')
    assert ratio.input_value() == '−2'
    sheet.page.get_by_text('Force now: 0 N m').wait_for()
    sheet.page.get_by_label('Breaks at [N m]').wait_for()
