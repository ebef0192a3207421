# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Water and air by the panels of the page: bodies float, and the wind blows."""

from __future__ import annotations

import pytest

from .chromium import Sheet

WORLD = """
format: 1
bounds: [-10, 0, 10, 9]
gravity: [0, -9.81]
bodies:
  - {name: pool/0, box: {width: 8, height: 4}, at: [0, 2], anchored: true}
  - {name: block/0, box: {width: 2, height: 0.8}, at: [0, 4.4], density: 1, elasticity: 0}
  - {name: ball/0, circle: {radius: 0.3}, at: [-8, 0.3], mass: 0.5}
"""

# Wind from another socket of this page.
OTHER_WIND = """() => {
    const socket = new WebSocket(`ws://${location.host}/ws`);
    socket.onopen = () => {
        socket.send(JSON.stringify({type: 'air', id: '', wind: [0, 1.5]}));
        socket.close();
    };
}"""


TWO_NUMBERS = """() => {
    const numbers = {'Density of the medium [kg/m²]': 4, 'Viscosity [N s/m²]': 10};
    for (const [label, value] of Object.entries(numbers)) {
        const field = document.querySelector(`[aria-label="${label}, typed"]`);
        field.value = value;
        field.dispatchEvent(new Event('change'));
    }
}"""


@pytest.fixture
def sheet(sheet: Sheet) -> Sheet:
    """Give a test a page with the hand."""
    sheet.press('Hand')
    return sheet


def type_number(sheet: Sheet, label: str, text: str) -> None:
    """Type a number into the panel."""
    sheet.enter(f'{label}, typed', text, exact=True)


def test_a_body_becomes_water_and_a_block_floats_in_it(sheet: Sheet) -> None:
    sheet.tap(2.0, 1.0)
    sheet.page.get_by_label('Water: bodies float in it').check()
    type_number(sheet, 'Density of the medium [kg/m²]', '4')
    type_number(sheet, 'Viscosity [N s/m²]', '10')
    sheet.play_until(5.0)
    # A quarter of its height is under the level of 4 m.
    assert sheet.pose('block/0') == pytest.approx([0.0, 4.2, 0.0], abs=1e-3)


def test_two_numbers_that_are_typed_in_a_row_are_both_kept(sheet: Sheet) -> None:
    sheet.tap(2.0, 1.0)
    sheet.page.get_by_label('Water: bodies float in it').check()
    sheet.page.get_by_label('Viscosity [N s/m²], typed', exact=True).wait_for()
    # Before the world can answer.
    sheet.page.evaluate(TWO_NUMBERS)
    sheet.play_until(5.0)
    assert sheet.pose('block/0') == pytest.approx([0.0, 4.2, 0.0], abs=1e-3)


def test_a_pool_without_water_is_the_body_that_it_was(sheet: Sheet) -> None:
    sheet.tap(2.0, 1.0)
    water = sheet.page.get_by_label('Water: bodies float in it')
    water.check()
    density = sheet.page.get_by_label('Density of the medium [kg/m²], typed', exact=True)
    density.wait_for()
    water.uncheck()
    density.wait_for(state='hidden')
    # The block lies on it.
    sheet.play_until(2.0)
    assert sheet.pose('block/0')[1] == pytest.approx(4.4, abs=1e-3)


def test_what_floated_in_an_emptied_pool_falls_to_its_floor(sheet: Sheet) -> None:
    sheet.tap(2.0, 1.0)
    water = sheet.page.get_by_label('Water: bodies float in it')
    water.check()
    sheet.play_until(1.0)
    water.uncheck()
    gate = sheet.page.get_by_role('checkbox', name='Gate: lets bodies through', checked=True)
    gate.wait_for()
    sheet.press('Play')
    sheet.wait('physsim.bodies["block/0"][1] < 0.41')


def test_the_air_of_the_world_has_the_wind_that_is_typed(sheet: Sheet) -> None:
    sheet.press('Material')
    type_number(sheet, 'Viscosity of the air [N s/m²]', '2')
    # Meanwhile somebody else has set how it blows upward.
    sheet.page.evaluate(OTHER_WIND)
    sheet.until(lambda: sheet.page.evaluate('window.physsim.wind[1] === 1.5'), 'the other wind')
    type_number(sheet, 'Wind to the right [m/s]', '3')
    sheet.until(lambda: sheet.page.evaluate('window.physsim.wind[0] === 3'), 'the wind')
    assert sheet.page.evaluate('window.physsim.wind[1]') == 1.5
    sheet.page.keyboard.press('Escape')
    sheet.press('Material')
    wind = sheet.page.get_by_label('Wind to the right [m/s], typed', exact=True)
    sheet.until(lambda: wind.input_value() == '3', 'the wind that was typed')
    sheet.play_until(1.0)
    # Linear drag alone brings the ball to 3 m/s in a fraction of a second.
    assert sheet.pose('ball/0')[0] > -8.0 + 1.0


def test_water_is_drawn_in_one_gesture_and_what_is_in_it_is_tapped(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.press('Water')
    sheet.drag((-9.5, 0.0), (-8.0, 1.0), (-6.0, 2.0))
    name = sheet.wait_for_new(before)
    assert name == 'water/1'
    assert sheet.pose(name) == pytest.approx([-7.75, 1.0, 0.0], abs=0.05)
    panel = sheet.page.get_by_role('complementary', name='Body')
    sheet.press('Hand')
    # The water was drawn last, and lies below all bodies nevertheless.
    sheet.tap(-8.0, 0.3)
    panel.get_by_role('heading', name='ball/0').wait_for()
    sheet.tap(-6.5, 1.0)
    panel.get_by_role('heading', name='Water water/1').wait_for()
    sheet.press('Delete')
    sheet.tap(-8.0, 0.3)
    sheet.wait('!("ball/0" in physsim.bodies)')
    assert name in sheet.names()


def test_a_tap_is_a_pool_of_the_usual_size(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.press('Water')
    sheet.tap(6.0, 5.0)
    assert sheet.pose(sheet.wait_for_new(before)) == pytest.approx([6.0, 5.0, 0.0], abs=0.05)
