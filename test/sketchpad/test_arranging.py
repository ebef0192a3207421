# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Constant forces and the knife on the page, by mouse."""

from __future__ import annotations

import pytest

from .chromium import Sheet

WORLD = """
format: 1
bounds: [-10, 0, 10, 9]
gravity: [0, 0]
bodies:
  - {name: block/0, box: {width: 2, height: 1}, at: [-4, 4], mass: 2}
  - {name: block/1, box: {width: 1, height: 1}, at: [1, 5.5], mass: 2}
  - {name: ball/0, circle: {radius: 0.5}, at: [4, 2]}
"""


def test_a_force_is_put_on_a_body_by_an_arrow_and_changed_in_its_panel(sheet: Sheet) -> None:
    sheet.press('Force')
    sheet.drag((-4.0, 4.0), (-2.0, 4.0))
    sheet.press('Hand')
    sheet.tap(-4.6, 4.0)

    newtons = sheet.page.get_by_label('Force [N] (1)')
    newtons.wait_for()
    assert float(newtons.input_value()) == pytest.approx(20.0, rel=0.02)
    newtons.fill('8')
    newtons.press('Enter')
    sheet.page.get_by_label('Turns with the body').check()
    sheet.wait('heard.shown.filter((topic) => topic === "~/spawn").length === 2')
    sheet.press('Show forces')
    sheet.wait('physsim.forces.some(({kind}) => kind === "applied")')
    (drawn,) = (
        each for each in sheet.page.evaluate('physsim.forces') if each['kind'] == 'applied'
    )
    time = sheet.play_until(0.5)

    assert drawn['force'] == pytest.approx([8.0, 0.0], abs=0.3)
    x, _, _ = sheet.pose('block/0')
    assert x == pytest.approx(-4.0 + 8.0 / 2.0 * time**2 / 2, abs=0.02)


def test_the_knife_cuts_along_a_stroke_and_undo_makes_whole(sheet: Sheet) -> None:
    sheet.press('Knife')
    sheet.drag((-5.5, 3.6), (-2.5, 4.4))
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    sheet.press('Undo')
    sheet.wait('Object.keys(physsim.bodies).length === 3')


def test_bodies_are_aligned_and_distributed_and_each_is_undone_at_once(sheet: Sheet) -> None:
    before = {name: sheet.pose(name) for name in sheet.names()}
    sheet.press('Lasso')
    sheet.drag((-6.0, 1.0), (6.0, 1.0), (6.0, 8.0), (-6.0, 8.0), (-6.0, 1.0))
    sheet.press('Top')
    sheet.wait('Math.abs(physsim.bodies["ball/0"][1] - 5.5) < 1e-5')
    assert [sheet.pose(f'block/{number}')[1] for number in (0, 1)] == pytest.approx([5.5, 5.5])

    sheet.press('Across')
    sheet.wait('Math.abs(physsim.bodies["block/1"][0] - 0.25) < 1e-5')
    # Gaps of 2.75 m from -5 to 4.5 m, with the outermost in place.
    xs = [sheet.pose(name)[0] for name in ('block/0', 'ball/0')]
    assert xs == pytest.approx([before[name][0] for name in ('block/0', 'ball/0')])

    sheet.press('Undo')
    sheet.press('Undo')
    sheet.wait('Math.abs(physsim.bodies["ball/0"][1] - 2) < 1e-5')
    assert {name: sheet.pose(name) for name in sheet.names()} == before
