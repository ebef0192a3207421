# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The arrows of forces and velocities on the page, against mechanics."""

from __future__ import annotations

import math

from physsim_ros.files import shipped_lessons
import pytest

from .chromium import NOTE_TEXTS, OpenSheet, Sheet, started_world
from ..outside import Outside

G = 9.81
SLOPE = math.radians(30.0)
# A block of 5 kg that rests on a slope, weights of 2 kg on a rope and an axle, a fast ball.
WORLD = """
format: 1
bounds: [-10, 0, 10, 9]
gravity: [0, -9.81]
elasticity: 0
bodies:
  - name: slope/0
    polygon: [[0, 0], [8, 0], [0, 4.6188]]
    at: [-10, 0]
    friction: 1
    anchored: true
  - name: block/0
    box: {width: 0.9, height: 0.7}
    at: [-8.2336, 4.0031, -0.5236]
    friction: 1
    mass: 5
  - {name: bob/0, circle: {radius: 0.4}, at: [3, 4], mass: 2}
  - {name: bob/1, circle: {radius: 0.4}, at: [6, 4], mass: 2}
  - {name: table/0, box: {width: 2, height: 0.4}, at: [-2, 1], anchored: true}
  - {name: ball/0, circle: {radius: 0.4}, at: [0, 7], velocity: [0, -18]}
joints:
  - {name: rope/0, kind: rope, a: bob/0, points: [[3, 4], [3, 8]]}
  - {name: axle/0, kind: axle, a: bob/1, points: [[6, 4]]}
"""
# The number of pixels of a colour from a point [px] on, in a direction, without a gap.
RUN = """([[x, y], [ux, uy], name]) => {
    const ctx = document.querySelector('canvas').getContext('2d'), ratio = devicePixelRatio;
    const color = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const wanted = color.match(/\\w\\w/g).map((each) => parseInt(each, 16));
    const pixel = (along) => [...ctx.getImageData(
        (x + along * ux) * ratio, (y + along * uy) * ratio, 1, 1).data].slice(0, 3);
    let end = 8;
    while (end < 600 && pixel(end).every((each, i) => Math.abs(each - wanted[i]) < 40)) end++;
    return end;
}"""


@pytest.fixture
def sheet(sheet: Sheet) -> Sheet:
    """Give a test a page that shows forces."""
    sheet.press('Show forces')
    return sheet


def forces_on(sheet: Sheet, name: str) -> dict[str, tuple[float, float]]:
    """Return the forces on a body as they are drawn [N], by kind."""
    drawn = sheet.page.evaluate('physsim.forces')
    return {each['kind']: tuple(each['force']) for each in drawn if each['name'] == name}


def numbers_on(sheet: Sheet, name: str) -> dict[str, str]:
    """Return the numbers of the arrows of a body, by kind."""
    drawn = sheet.page.evaluate('physsim.forces')
    return {each['kind']: each['size'] for each in drawn if each['name'] == name}


def check_block(sheet: Sheet) -> None:
    """Check the forces on the block that rests on the slope."""
    weight = 5.0 * G
    normal, friction = weight * math.cos(SLOPE), weight * math.sin(SLOPE)
    assert numbers_on(sheet, 'block/0') == {
        'weight': '49.1 N',
        'normal': '42.5 N',
        'friction': '24.5 N',
        'sum': '0 N',
    }
    found = forces_on(sheet, 'block/0')
    assert found['weight'] == pytest.approx((0.0, -weight), rel=1e-6)
    up_x, up_y = math.sin(SLOPE), math.cos(SLOPE)
    assert found['normal'] == pytest.approx((normal * up_x, normal * up_y), rel=1e-3)
    assert found['friction'] == pytest.approx((-friction * up_y, friction * up_x), rel=1e-3)


def test_a_block_on_a_slope_has_the_same_forces_at_four_speeds_and_paused(sheet: Sheet) -> None:
    sheet.play_until(1.0)
    speed = sheet.page.locator('#speed')
    for _ in range(3):
        wanted = float(speed.inner_text().removesuffix('×'))
        sheet.press('Play')
        sheet.wait('speed => Math.abs(physsim.speed - speed) < 1e-6', wanted)
        begin = sheet.page.evaluate('physsim.time')
        sheet.wait('begin => physsim.time > begin + 0.05', begin)
        check_block(sheet)
        sheet.press('Pause')
        sheet.wait('physsim.speed === 0')
        check_block(sheet)
        speed.click()
    sheet.press('Fast forward')
    sheet.wait('physsim.speed > 1')
    begin = sheet.page.evaluate('physsim.time')
    sheet.wait('begin => physsim.time > begin + 0.3', begin)
    check_block(sheet)
    sheet.press('Pause')
    sheet.wait('physsim.speed === 0')
    check_block(sheet)


def test_the_pixels_of_an_arrow_are_its_newtons(sheet: Sheet) -> None:
    def pixels(kind: str, color: str) -> float:
        """Return the length of the block's arrow by its pixels [N]."""
        (drawn,) = (
            each
            for each in sheet.page.evaluate('physsim.forces')
            if each['name'] == 'block/0' and each['kind'] == kind
        )
        x, y = drawn['force']
        size = math.hypot(x, y)
        found: float = sheet.page.evaluate(RUN, [drawn['from'], [x / size, -y / size], color])
        return found / float(sheet.page.evaluate('physsim.scales.newton'))

    def check() -> None:
        # Two pixels at either end.
        slack = 4.0 / sheet.page.evaluate('physsim.scales.newton')
        assert pixels('normal', '--force') == pytest.approx(5.0 * G * math.cos(SLOPE), abs=slack)
        assert pixels('friction', '--friction') == pytest.approx(
            5.0 * G * math.sin(SLOPE), abs=slack
        )

    sheet.play_until(1.5)
    check()
    speed = sheet.page.locator('#speed')
    for _ in range(3):
        sheet.press('Play')
        sheet.wait('physsim.speed > 0')
        begin = sheet.page.evaluate('physsim.time')
        sheet.wait('begin => physsim.time > begin + 0.05', begin)
        check()
        sheet.press('Pause')
        sheet.wait('physsim.speed === 0')
        speed.click()
    sheet.press('Fast forward')
    sheet.wait('physsim.speed > 1')
    check()


def test_forces_that_are_first_shown_while_paused_are_those_of_the_last_steps(
    sheet: Sheet,
) -> None:
    sheet.press('Show forces')
    sheet.play_until(1.0)
    sheet.press('Show forces')
    sheet.until(lambda: len(forces_on(sheet, 'block/0')) == 4, 'the forces on the block')
    check_block(sheet)


def test_a_rope_and_an_axle_bear_a_weight(sheet: Sheet) -> None:
    sheet.play_until(1.0)
    for name in ('bob/0', 'bob/1'):
        found = forces_on(sheet, name)
        assert found['joint'] == pytest.approx((0.0, 2.0 * G), rel=1e-3, abs=1e-3)
        assert found['sum'] == (0.0, 0.0)


def test_on_a_body_that_is_tapped_forces_have_their_names_and_others_have_none(
    sheet: Sheet,
) -> None:
    sheet.play_until(1.0)
    sheet.press('Hand')
    sheet.tap(3.0, 4.0)
    sheet.wait('physsim.forces.every(({name}) => name === "bob/0")')
    assert set(numbers_on(sheet, 'bob/0')) == {'weight', 'joint', 'sum'}


def test_what_was_moved_in_a_paused_world_has_no_contacts_any_more_and_others_keep_theirs(
    sheet: Sheet,
) -> None:
    sheet.play_until(2.0)
    sheet.press('Hand')
    x, y, _ = sheet.pose('ball/0')
    assert 'normal' in numbers_on(sheet, 'ball/0')
    with sheet.dragging((x, y), (x, 4.0)):
        sheet.wait('Math.abs(physsim.bodies["ball/0"][1] - 4) < 0.1')
    sheet.until(lambda: 'normal' not in numbers_on(sheet, 'ball/0'), 'no contact of the ball')
    check_block(sheet)


def test_the_ring_of_a_fast_body_stays_on_the_page(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(0.0, 7.0)
    sheet.wait('Number.isFinite(physsim.scales.speed)')
    length = 18.0 * sheet.page.evaluate('physsim.scales.speed')
    assert 40 < length < 300
    x, y = sheet.place(0.0, 7.0)
    # Its ring, 22 px beyond the tip, is taken and put to 9 m/s upwards.
    sheet.page.mouse.move(x, y + length + 22)
    sheet.page.mouse.down()
    sheet.page.mouse.move(x, y - length / 2 - 22, steps=5)
    sheet.page.mouse.up()
    sheet.told('changed')
    sheet.press('Step')
    sheet.wait('physsim.bodies["ball/0"][1] > 7.1')


def test_a_round_arrow_has_the_torque_on_a_ball_that_rolls_and_its_angular_momentum(
    open_sheet: OpenSheet, outside: Outside
) -> None:
    world = """
format: 1
gravity: [0, -9.81]
bodies:
  - {name: slope/0, polygon: [[-5, 0], [5, 0], [-5, 4]], anchored: true, friction: 1}
  - {name: ball/0, circle: {radius: 0.5}, at: [-3.6, 3.985], friction: 1, elasticity: 0, mass: 2}
"""
    program, address = started_world(outside, world=world)
    sheet = open_sheet(address).begin(2)
    sheet.page.evaluate(NOTE_TEXTS)
    for name in ('Show forces', 'Show velocities', 'Momentum', 'Hand'):
        sheet.press(name)
    sheet.tap(*sheet.pose('ball/0')[:2])
    time = sheet.play_until(0.6)
    # Rolling, a third of the force down the slope turns it; I = m r² / 2.
    torque = 2.0 * G * math.sin(math.atan(0.4)) / 3.0 * 0.5
    sheet.page.evaluate('window.texts = []')
    sheet.press('Frame the world')
    sheet.wait('text => window.texts.includes(text)', f'torque {torque:.3g} N m')
    told = sheet.page.evaluate('window.texts.filter((text) => text.endsWith("N m s"))')
    # It lies in the air for less than a frame.
    assert float(told[0].split()[0]) == pytest.approx(torque * time, rel=0.05)
    sheet.close()
    program.interrupt()


def test_each_strand_of_a_rope_bears_its_share_of_a_load(
    open_sheet: OpenSheet, outside: Outside
) -> None:
    program, address = started_world(
        outside, world=(shipped_lessons() / 'pulley.yaml').read_text()
    )
    sheet = open_sheet(address).begin(3)
    sheet.press('Show forces')
    sheet.play_until(1.0)
    sheet.until(lambda: 'sum' in numbers_on(sheet, 'load/0'), 'the forces on the load')
    drawn = sheet.page.evaluate('physsim.forces')
    strands = [e for e in drawn if e['name'] == 'load/0' and e['kind'] == 'joint']
    assert [e['size'] for e in strands] == ['98.1 N'] * 4
    assert all(e['force'] == pytest.approx((0.0, 10.0 * G), abs=0.05) for e in strands)
    assert numbers_on(sheet, 'load/0')['sum'] == '0 N'
    sheet.close()
    program.interrupt()
