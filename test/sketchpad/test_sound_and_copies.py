# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Impacts are heard where somebody wants it; several bodies are copied together."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .chromium import OpenSheet, Sheet, started_world
from ..outside import Outside

WORLD = """
format: 1
bounds: [-10, 0, 10, 8]
elasticity: 0.5
bodies:
  - {name: ball/0, circle: {radius: 0.4}, at: [-3, 4]}
  - {name: box/0, box: {width: 1, height: 1}, at: [-1, 0.5]}
joints:
  - {name: rod/0, kind: rod, a: ball/0, b: box/0, points: [[-3, 4], [-1, 0.5]]}
  - {name: rod/1, kind: rod, a: box/0, points: [[-1, 0.5], [-1, 3]]}
"""

COUNT_TONES = """() => {
    window.tones = 0;
    const start = OscillatorNode.prototype.start;
    OscillatorNode.prototype.start = function (...times) {
        window.tones++;
        start.apply(this, times);
    };
}"""


@pytest.fixture
def sheet(open_sheet: OpenSheet, outside: Outside) -> Iterator[Sheet]:
    """Give a test a page of a world with a ball in the air, paused."""
    program, address = started_world(outside, world=WORLD)
    sheet = open_sheet(address).begin(2)
    yield sheet
    sheet.close()
    program.interrupt()


def test_an_impact_is_heard_after_sound_was_switched_on(sheet: Sheet) -> None:
    sheet.page.evaluate(COUNT_TONES)
    sheet.press('Play')
    sheet.wait('physsim.bodies["ball/0"][1] < 1')
    assert sheet.page.evaluate('window.tones') == 0
    sheet.press('Material')
    sheet.page.get_by_label('Sound of impacts').check()

    def is_heard() -> bool:
        # A page that is shown few frames does not hear each of its bounces.
        sheet.begin(2)
        sheet.play_until(3.0)
        return bool(sheet.page.evaluate('window.tones'))

    sheet.until(is_heard, 'an impact')


def test_bodies_of_the_lasso_are_copied_beside_with_their_joint(sheet: Sheet) -> None:
    sheet.press('Lasso')
    sheet.drag((-5, 6), (1, 6), (1, 0.1), (-5, 0.1), (-5, 6))
    sheet.press('Copy beside')
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    ball, box = sheet.pose('drawn/0'), sheet.pose('drawn/1')
    assert ball[1] == 4.0
    assert box[0] - ball[0] == pytest.approx(2.0)
    assert ball[0] > 0.0
    sheet.told('Copied 2 bodies')
    sheet.press('Undo')
    sheet.wait('Object.keys(physsim.bodies).length === 2')


def test_a_body_is_copied_beside_with_its_joint_to_the_background(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(-1.0, 0.4)
    sheet.press('Copy beside')
    sheet.wait('"drawn/0" in physsim.bodies')
    # By its width and half a metre.
    assert sheet.pose('drawn/0')[:2] == pytest.approx([0.5, 0.5])
    sheet.told('Copied 1 body')
