# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots that are driven on the page, and actors that drive themselves."""

from __future__ import annotations

import re

import pytest

from .chromium import OpenSheet, PIXEL, Sheet

WORLD = """
format: 1
bounds: [-2, -2, 2, 2]
gravity: [0, 0]
floor_friction: 0.6
bodies:
  - {name: crate/0, box: {width: 0.4, height: 0.4}, at: [-1, 1]}
  - {name: tb3/0, robot: {from: turtlebot4, battery: {capacity: 1.8, idle: 0.3, level: 0.8}},
     at: [0, 0]}
  - {name: cart/0, box: {width: 0.4, height: 0.2}, at: [1, 1.5], kinematic: true,
     actor: {kind: path, points: [[1, 1.5], [1.5, 1.5]], speed: 0.5, repeat: to_and_fro,
     start: {near: crate/0, distance: 1}}}
"""


@pytest.fixture
def sheet(open_sheet: OpenSheet) -> Sheet:
    """Give a test a page whose robot is selected, from the beginning of the world."""
    sheet = open_sheet().begin(3)
    sheet.tap(0.0, 0.0)
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_role('heading', name='differential · /tb3_0').wait_for()
    sheet.press('Play')
    return sheet


def tool(sheet: Sheet) -> str:
    name: str = sheet.page.evaluate('document.querySelector("canvas").dataset.tool')
    return name


def at_rest(sheet: Sheet) -> bool:
    """Return whether the robot does not move for a tenth of a second of simulation."""
    began, before = sheet.page.evaluate('physsim.time'), sheet.pose('tb3/0')
    sheet.wait('began => physsim.time > began + 0.1', began)
    return sheet.pose('tb3/0') == before


def test_the_panel_of_a_robot_tells_the_charge_of_its_battery(sheet: Sheet) -> None:
    sheet.page.get_by_text(re.compile(r'^Battery (80|79) % · −0.3 A$')).wait_for()


def test_keys_drive_the_robot_that_is_selected(sheet: Sheet) -> None:
    sheet.page.keyboard.down('w')
    sheet.wait('physsim.bodies["tb3/0"][0] > 0.2')
    sheet.page.keyboard.up('w')
    sheet.page.keyboard.down('a')
    sheet.wait('physsim.bodies["tb3/0"][2] > 0.5')
    sheet.page.keyboard.up('a')
    assert tool(sheet) == 'pen'
    # Without a robot they are those of the tools again.
    sheet.page.keyboard.press('Escape')
    sheet.page.keyboard.press('w')
    assert tool(sheet) == 'wall'


def test_a_robot_stops_when_another_body_is_selected(sheet: Sheet) -> None:
    sheet.page.keyboard.down('w')
    sheet.wait('physsim.bodies["tb3/0"][0] > 0.1')
    sheet.tap(-1.0, 1.0)
    sheet.until(lambda: at_rest(sheet), 'rest')
    # Far from the wall that would stop it, too.
    assert sheet.pose('tb3/0')[0] < 1.5
    sheet.page.keyboard.up('w')


def test_its_panel_tells_of_a_robot_and_not_of_what_a_robot_cannot_be(sheet: Sheet) -> None:
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_text('Up to 0.306 m/s and 1.9 rad/s').wait_for()
    assert panel.get_by_text('Anchored').count() == 0
    # Seen from above, a body has no height.
    panel.get_by_text('Kinetic energy', exact=True).wait_for()
    assert not panel.get_by_text('Potential energy', exact=True).is_visible()


def test_its_laser_is_light_around_it_while_it_is_selected(sheet: Sheet) -> None:
    # In the blue light paper has less red, even less than a line of the grid without light.
    lit = 218
    sheet.until(lambda: sheet.color_at(1.1, -0.63)[0] < lit, 'light')
    sheet.page.keyboard.press('Escape')
    sheet.until(lambda: sheet.color_at(1.1, -0.63)[0] > lit, 'paper')


def test_the_stick_drives_it_and_lets_it_stop(sheet: Sheet) -> None:
    box = sheet.page.get_by_label('Stick: drag to drive').bounding_box()
    x, y = box['x'] + box['width'] / 2, box['y'] + box['height'] / 2
    sheet.page.mouse.move(x, y)
    sheet.page.mouse.down()
    # By half of its way, at half of the greatest speed.
    sheet.page.mouse.move(x, y + 24)
    sheet.page.locator('.numbers').get_by_text('0.15 m/s').wait_for()
    sheet.page.mouse.move(x, y + 60)
    sheet.wait('physsim.bodies["tb3/0"][0] < -0.1')
    sheet.page.mouse.up()
    sheet.press('Undo')
    sheet.wait('physsim.bodies["tb3/0"].join() === "0,0,0"')


def test_the_panel_of_an_actor_says_what_it_follows(sheet: Sheet) -> None:
    sheet.tap(1.0, 1.5)
    sheet.page.get_by_text(
        'Follows a path, to and fro · 2 points · 0.5 m/s · starts when crate/0 is within 1 m'
    ).wait_for()
    # Its way is drawn: the second point is a ring in the colour of what is selected.
    x, y = sheet.place(1.5, 1.5)
    sheet.until(lambda: near_blue(sheet, x + 4.0, y), 'the way of the actor')


def near_blue(sheet: Sheet, x: float, y: float) -> bool:
    """Return whether a pixel of the canvas is blue [px]."""
    red, green, blue, _ = sheet.page.evaluate(PIXEL, [x, y])
    return bool(blue > red + 60 and blue > green + 30)
