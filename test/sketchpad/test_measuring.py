# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Measuring on the page: plots, tables, trails, ruler and protractor, stopwatch and counter."""

from __future__ import annotations

import math
import re
from typing import Any

from playwright.sync_api import Locator
import pytest

from .chromium import NOTE_TEXTS, OpenSheet, Sheet

G = 9.81
# A ball that is thrown, one that falls, a cart that passes two gates without friction.
WORLD = """
format: 1
bounds: [-8, 0, 8, 10]
gravity: [0, -9.81]
bodies:
  - {name: ball/0, circle: {radius: 0.3}, at: [-7.5, 8], velocity: [2, 0]}
  - {name: ball/1, circle: {radius: 0.3}, at: [3, 8], elasticity: 1}
  - name: rail/0
    box: {width: 9, height: 0.4}
    at: [0, 2]
    anchored: true
    friction: 0
    elasticity: 1
  - name: cart/0
    box: {width: 0.6, height: 0.4}
    at: [-3, 2.4]
    velocity: [1.5, 0]
    friction: 0
  - {name: gate/0, box: {width: 0.1, height: 1}, at: [-1, 2.8], anchored: true, sensor: true}
  - {name: gate/1, box: {width: 0.1, height: 1}, at: [1.1, 2.8], anchored: true, sensor: true}
"""
# Whether there are pixels of a colour in a square around a point of the page [px].
HAS_COLOR = """([x, y, half, name]) => {
    const canvas = document.querySelector('canvas'), ratio = devicePixelRatio;
    const color = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const wanted = color.match(/\\w\\w/g).map((each) => parseInt(each, 16));
    const {data} = canvas.getContext('2d').getImageData(
        (x - half) * ratio, (y - half) * ratio, 2 * half * ratio, 2 * half * ratio);
    for (let i = 0; i < data.length; i += 4) {
        if (wanted.every((each, channel) => Math.abs(each - data[i + channel]) < 24)) return true;
    }
    return false;
}"""

# Whether plots have pixels of the ink of the page.
INKED = """() => {
    const color = getComputedStyle(document.documentElement).getPropertyValue('--ink').trim();
    const ink = color.match(/\\w\\w/g).map((each) => parseInt(each, 16));
    return [...document.querySelectorAll('#plot canvas, .plots canvas')].map((plot) => {
        const {data} = plot.getContext('2d').getImageData(0, 0, plot.width, plot.height);
        for (let i = 0; i < data.length; i += 4) {
            if (data[i + 3] === 255 && ink.every((each, j) => data[i + j] === each)) return true;
        }
        return false;
    });
}"""
# The width by which a list is narrower than its widest item [px].
WIDTH_MISSING = """(select) => {
    const whole = document.body.appendChild(select.cloneNode(true));
    whole.style.position = 'absolute';
    const missing = whole.offsetWidth - select.offsetWidth;
    whole.remove();
    return missing;
}"""


@pytest.fixture
def sheet(open_sheet: OpenSheet) -> Sheet:
    """Give a test a page with the hand, and the world from its beginning, paused."""
    sheet = open_sheet(permissions=['clipboard-read', 'clipboard-write']).begin(6)
    sheet.press('Hand')
    return sheet


def chosen(sheet: Sheet, x: float, y: float) -> None:
    """Choose the body at a place [m]."""
    sheet.tap(x, y)
    sheet.page.get_by_role('button', name='Delete body').wait_for()


def typed(sheet: Sheet, label: str, text: str) -> None:
    """Enter a number of the body that is chosen, in its panel for the first time."""
    sheet.page.get_by_text('Enter numbers').click()
    sheet.enter(label, text)


def pointed(sheet: Sheet, share: float, down: float = 0.5) -> list[float]:
    """Point into the large plot, that far from its left and top, and return what is read there."""
    box = sheet.page.get_by_label('Large plot').bounding_box()
    sheet.page.mouse.move(box['x'] + share * box['width'], box['y'] + down * box['height'])
    reading = sheet.page.locator('#plot output')
    sheet.until(lambda: '·' in reading.inner_text(), 'a reading')
    text = reading.inner_text().replace('\N{MINUS SIGN}', '-')
    return [float(each) for each in re.findall(r' (-?[\d.]+)', text)]


def rounding(value: float) -> float:
    """Return how far a number is at most from one that is told to three digits."""
    return 0.5 * 10.0 ** (math.floor(math.log10(abs(value))) - 2)


# The unit of each quantity, and its value, of a sample.
QUANTITIES = """async ([sample, body, gravity]) => {
    const {QUANTITIES} = await import('/page/measures/quantities.js');
    return Object.fromEntries(Object.entries(QUANTITIES).map(([key, {label, of}]) =>
        [key, [label.match(/\\[(.*)\\]/)[1], of(sample, body, gravity)]]));
}"""
# Exponents of mass, length and time.
DIMENSIONS = {
    's': (0, 0, 1),
    'm': (0, 1, 0),
    'rad': (0, 0, 0),
    'm/s': (0, 1, -1),
    'rad/s': (0, 0, -1),
    'm/s²': (0, 1, -2),
    'N': (1, 1, -2),
    'N s': (1, 1, -1),
    'N m': (1, 2, -2),
    'J': (1, 2, -2),
    'N m s': (1, 2, -1),
}


def quantities(sheet: Sheet, mass: float, length: float, time: float) -> dict[str, Any]:
    """Return unit and value of all quantities of a sample, by other units of measurement."""
    speed, acceleration = length / time, length / time**2
    kinds = ('weight', 'normal', 'friction', 'joint', 'applied', 'sum')
    sample = {
        'time': 1.7 * time,
        'yaw': 0.4,
        'x': 2.1 * length,
        'y': 0.8 * length,
        'vx': -1.3 * speed,
        'vy': 0.6 * speed,
        'ax': 0.9 * acceleration,
        'ay': -3.1 * acceleration,
        'spin': 0.7 / time,
        'spinning': -0.2 / time**2,
        'forces': {kind: (3 + number) * mass * acceleration for number, kind in enumerate(kinds)},
    }
    body = {'mass': 2.3 * mass, 'moment': 0.9 * mass * length**2}
    gravity = [1.1 * acceleration, -9.8 * acceleration]
    return dict(sheet.page.evaluate(QUANTITIES, [sample, body, gravity]))


def test_quantities_have_the_dimension_of_their_unit_and_make_up_each_other(sheet: Sheet) -> None:
    scales = 2.0, 3.0, 5.0
    found, other = quantities(sheet, 1.0, 1.0, 1.0), quantities(sheet, *scales)
    value = {key: each for key, (_, each) in found.items()}
    for key, (unit, each) in other.items():
        scale = math.prod(map(math.pow, scales, DIMENSIONS[unit]))
        assert each == pytest.approx(scale * value[key]), key
    assert value['energy'] == pytest.approx(value['motion'] + value['height'])
    assert value['motion'] == pytest.approx((2.3 * (1.3**2 + 0.6**2) + 0.9 * 0.7**2) / 2)
    assert value['height'] == pytest.approx(2.3 * (9.8 * 0.8 - 1.1 * 2.1))
    for size, x, y in (
        ('speed', 'vx', 'vy'),
        ('momentum', 'px', 'py'),
        ('acceleration', 'ax', 'ay'),
    ):
        assert value[size] == pytest.approx(math.hypot(value[x], value[y]))


def test_a_large_plot_tells_what_is_under_the_pointer(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.play_until(0.9)
    sheet.press('Large plot')
    time, height = pointed(sheet, 0.5)
    assert 0.2 < time < 0.8
    # To three digits of the time and of the height.
    slack = rounding(height) + G * time * rounding(time)
    assert height == pytest.approx(8.0 - G * time**2 / 2, abs=slack)


def test_a_plot_has_axes_of_choice_and_several_bodies(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.play_until(0.8)
    sheet.press('Large plot')
    sheet.page.get_by_label('To the right').select_option(label='Height [m]')
    sheet.page.get_by_label('Upwards').select_option(label='vy [m/s]')
    height, speed = pointed(sheet, 0.5)
    # v² is 2 g h.
    assert speed == pytest.approx(-math.sqrt(2.0 * G * (8.0 - height)), abs=0.03)
    sheet.page.get_by_label('Upwards').select_option(label='ay [m/s²]')
    assert pointed(sheet, 0.5)[1] == pytest.approx(-G, abs=0.05)
    sheet.press('Bodies, sum, table')
    sheet.page.get_by_label('Add a body').select_option('ball/1')
    sheet.wait('physsim.records["ball/1"] && physsim.records["ball/1"][0] > 20')
    sheet.press('Copy table')
    sheet.told('Table copied')
    head, *rows = sheet.page.evaluate('navigator.clipboard.readText()').splitlines()
    assert head.split(',')[:4] == ['Time [s]', 'x [m]', 'Height [m]', 'vx [m/s]']
    assert {row.split(',')[-1] for row in rows} == {'ball/0', 'ball/1'}
    sheet.press('ball/0 ×')
    sheet.press('Close the plot')
    assert not sheet.page.get_by_label('Large plot').is_visible()


def test_the_course_that_was_left_stays_as_a_second_line(sheet: Sheet) -> None:
    chosen(sheet, 3.0, 8.0)
    sheet.play_until(1.0)
    assert sheet.page.evaluate('physsim.records["ball/1"][1]') == 0
    sheet.seek(0.5)
    typed(sheet, 'vy [m/s]', '5')
    # Of the frames that this page has shown: a slow one has few.
    sheet.wait('physsim.records["ball/1"][1] > 0')
    before = sheet.page.evaluate('physsim.records["ball/1"]')
    sheet.play_until(0.8)
    after = sheet.page.evaluate('physsim.records["ball/1"]')
    assert after[0] > before[0]
    assert after[1] == before[1]


@pytest.mark.parametrize('way', ['undo', 'course'])
def test_a_plot_shows_what_happens_in_the_line_that_is_returned_to(sheet: Sheet, way: str) -> None:
    chosen(sheet, -7.5, 8.0)
    if way == 'course':
        sheet.play_until(1.0)
        sheet.seek(0.2)
    typed(sheet, 'vy [m/s]', '5')
    sheet.wait('physsim.records["ball/0"][0] < 20')
    sheet.play_until(0.9)
    if way == 'undo':
        sheet.press('Undo')
        sheet.wait('physsim.time === 0')
        sheet.play_until(0.7)
    else:
        sheet.page.get_by_role('button', name='Go back to how it went').click()
        sheet.page.get_by_text('Back on the other course').wait_for()
    sheet.press('Large plot')
    # The other course, which is dashed, is higher.
    time, height = pointed(sheet, 0.7, 0.8)
    slack = rounding(height) + G * time * rounding(time)
    assert height == pytest.approx(8.0 - G * time**2 / 2, abs=slack)


def test_a_plot_has_the_difference_of_this_run_and_the_last_one(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.play_until(1.0)
    sheet.seek(0.5)
    typed(sheet, 'vx [m/s]', '5')
    sheet.wait('physsim.records["ball/0"][1] > 0')
    sheet.play_until(0.9)
    sheet.press('Large plot')
    sheet.page.get_by_label('Upwards').select_option(label='x [m]')
    sheet.press('Bodies, sum, table')
    sheet.press('Difference')
    time, difference = pointed(sheet, 0.7)
    assert 0.6 < time < 0.9
    # 3 m/s faster since 0.5 s; to three digits of the time and of the difference.
    assert difference == pytest.approx(3.0 * (time - 0.5), abs=0.02)


def test_plots_follow_light_and_dark_while_time_stands(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.press('Large plot')
    for ink in ('dark', 'light'):
        sheet.until(lambda: sheet.page.evaluate(INKED) == [True] * 4, f'plots in {ink} ink')
        sheet.press('Light or dark')


def test_a_curve_that_was_drawn_first_is_compared_with_the_one_that_comes(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.press('Large plot')
    sheet.press('Bodies, sum, table')
    sheet.press('Predict the curve')
    box = sheet.page.get_by_label('Large plot').bounding_box()
    sheet.until(lambda: sheet.page.get_by_label('Large plot').bounding_box() == box, 'a plot')
    mouse, middle = sheet.page.mouse, box['y'] + box['height'] / 2
    # A flat line in the middle of the plot, whose axis has the height of the world: 5 m.
    mouse.move(box['x'] + 30.0, middle)
    mouse.down()
    mouse.move(box['x'] + box['width'] - 20.0, middle, steps=8)
    mouse.up()
    mouse.move(2.0, 2.0)
    end = sheet.play_until(0.9)
    times = [end * each / 200 for each in range(201)]
    off = sum(abs(8.0 - G * each**2 / 2 - 5.0) for each in times) / len(times)
    reading = sheet.page.locator('#plot output')
    sheet.until(lambda: reading.inner_text().startswith('off by'), 'a comparison')
    told = re.fullmatch(r'off by ([\d.]+) m', reading.inner_text())
    # Pixels of the plot, and frames that a slow page has not got.
    assert told
    assert float(told[1]) == pytest.approx(off, abs=0.2)


# Mean rows of the pixels of colours in a column of the plot of energy in a panel, at a share of
# its width; 0 where there are none.
ROWS = """([share, ...names]) => {
    const plot = document.querySelector('.plots canvas:last-of-type'), {width, height} = plot;
    const {data} = plot.getContext('2d').getImageData(Math.round(share * width), 0, 1, height);
    const style = getComputedStyle(document.documentElement);
    return names.map((name) => {
        const color = style.getPropertyValue(name).trim().match(/\\w\\w/g);
        const wanted = color.map((each) => parseInt(each, 16)), rows = [];
        for (let row = 0; row < height; row++) {
            const near = (each, i) => Math.abs(each - data[4 * row + i]) < 24;
            if (data[4 * row + 3] > 80 && wanted.every(near)) rows.push(row);
        }
        return rows.length && rows.reduce((sum, row) => sum + row, 0) / rows.length;
    });
}"""


def test_a_flight_lies_on_its_curve_and_goes_ahead_of_it(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.play_until(1.0)

    def rows(share: float) -> list[float]:
        return list(sheet.page.evaluate(ROWS, [share, '--force', '--accent']))

    # The plot ends half a second after now.
    sheet.until(lambda: rows(0.9)[0], 'a flight')
    ahead, nothing = rows(0.9)
    assert nothing == 0
    for share in (0.3, 0.5):
        assert rows(share) == pytest.approx([ahead, ahead], abs=2.0)


def test_a_stroboscope_shows_where_a_body_was_with_v_and_a(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.page.get_by_label('Stroboscope, with v and a').check()
    # The panel follows nothing else; the trail stays without a selection.
    sheet.page.keyboard.press('Escape')
    sheet.page.keyboard.press('Escape')
    paused = sheet.play_until(1.0)
    time = 0.5
    x, y = sheet.place(-7.5 + 2.0 * time, 8.0 - G * time**2 / 2)
    for color in ('--accent', '--weight'):
        sheet.until(lambda color=color: sheet.page.evaluate(HAS_COLOR, [x, y, 30, color]), color)
    # Its outline, away from its way and the arrows.
    rim = sheet.place(-7.5 + 2.0 * time - 0.3, 8.0 - G * time**2 / 2)
    assert sheet.page.evaluate(HAS_COLOR, [*rim, 4, '--faint'])
    # The ball is not yet at its place of a quarter of a second later.
    time = paused + 0.25
    x, y = sheet.place(-7.5 + 2.0 * time, 8.0 - G * time**2 / 2)
    assert not sheet.page.evaluate(HAS_COLOR, [x, y, 10, '--weight'])


def test_the_arrow_of_v_in_a_stroboscope_is_as_long_as_that_of_the_velocity(sheet: Sheet) -> None:
    chosen(sheet, -7.5, 8.0)
    sheet.page.get_by_label('Stroboscope, with v and a').check()
    sheet.page.keyboard.press('Escape')
    sheet.play_until(1.0)
    # It was thrown to the right.
    (x, y), length = sheet.place(-7.5, 8.0), 2.0 * sheet.page.evaluate('physsim.scales.speed')
    sheet.until(
        lambda: sheet.page.evaluate(HAS_COLOR, [x + length - 4, y, 3, '--accent']), 'the tip of v'
    )
    assert sheet.page.evaluate(HAS_COLOR, [x + length / 2, y, 2, '--accent'])
    assert not sheet.page.evaluate(HAS_COLOR, [x + length + 6, y, 4, '--accent'])


def test_a_ruler_and_a_protractor_measure(sheet: Sheet) -> None:
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.press('Ruler')
    sheet.page.keyboard.down('Shift')
    sheet.drag((-4.03, 4.02), (0.05, 7.18))
    sheet.wait('window.texts.includes("5.12 m, 38.7°")')
    sheet.wait('window.texts.includes("Δx 4 m, Δy 3.2 m")')
    sheet.press('Protractor')
    sheet.drag((0.0, 4.0), (4.0, 4.0))
    sheet.tap(4.0, 8.0)
    sheet.wait('window.texts.includes("45°")')
    sheet.page.keyboard.up('Shift')
    # The ruler stays beside another tool, until it is tapped away.
    assert sheet.page.evaluate('window.texts.includes("5.12 m, 38.7°")')
    sheet.press('Ruler')
    sheet.tap(-2.0, 6.0)
    sheet.page.evaluate('window.texts = []')
    sheet.press('Frame the world')
    sheet.wait('window.texts.includes("45°")')
    assert not sheet.page.evaluate('window.texts.includes("5.12 m, 38.7°")')


# The texts on which another one lies.
COVERED = """text => {
    const [, left, top, right, bottom] = boxes.find((each) => each[0] === text);
    return boxes.filter((each) => each[0] !== text && each[1] < right && left < each[3] &&
        each[2] < bottom && top < each[4]).map(([other]) => other);
}"""


def test_the_number_of_an_arrow_lies_on_no_other_text(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(-3.0, 2.4)
    sheet.page.get_by_label('Meter in the world').select_option('Momentum [N s]')
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.press('Show velocities')
    sheet.press('Ruler')
    sheet.wait('boxes.some(([text]) => text === "1.5 m/s")')
    # To the tip of the arrow.
    (x, y), speed = sheet.place(-3.0, 2.4), sheet.page.evaluate('physsim.scales.speed')
    sheet.page.mouse.move(x - 60, y)
    sheet.page.mouse.down()
    sheet.page.mouse.move(x + 1.5 * speed, y, steps=4)
    sheet.page.mouse.up()
    sheet.wait('boxes.some(([text]) => text.startsWith("Δx"))')
    assert sheet.page.evaluate(COVERED, '1.5 m/s') == []


def test_the_number_of_an_arrow_lies_on_no_meter(sheet: Sheet) -> None:
    chosen(sheet, -3.0, 2.4)
    sheet.page.get_by_label('Meter in the world').select_option('Momentum [N s]')
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.page.get_by_text('Enter numbers').click()
    # The numbers of the first two speeds would lie on the words of the meter.
    for speed in ('0.1', '0.2', '0.3', '0.8', '2'):
        sheet.enter('vx [m/s]', '0')
        sheet.enter('vy [m/s]', speed)
        sheet.wait('text => boxes.some((each) => each[0] === text)', f'{speed} m/s')
        assert sheet.page.evaluate(COVERED, f'{speed} m/s') == []


def test_a_meter_stays_beside_its_body_until_the_world_is_another(sheet: Sheet) -> None:
    sheet.page.evaluate(NOTE_TEXTS)
    chosen(sheet, -3.0, 2.4)
    sheet.page.get_by_label('Meter in the world').select_option('Speed [m/s]')
    sheet.page.keyboard.press('Escape')
    sheet.play_until(0.3)
    sheet.wait('window.texts.includes("Speed 1.5 m/s")')
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='Dominoes').click()
    sheet.wait('!("cart/0" in physsim.bodies)')
    sheet.page.evaluate('window.texts = []')
    sheet.press('Frame the world')
    sheet.wait('window.texts.some((text) => text.endsWith(" m"))')
    assert not sheet.page.evaluate('window.texts.some((text) => text.startsWith("Speed"))')
    # The next test has the same world.
    sheet.press('Undo')
    sheet.wait('"cart/0" in physsim.bodies')


def test_a_meter_tells_a_velocity_that_is_entered_while_time_stands(sheet: Sheet) -> None:
    sheet.page.evaluate(NOTE_TEXTS)
    chosen(sheet, -3.0, 2.4)
    sheet.page.get_by_label('Meter in the world').select_option('Speed [m/s]')
    sheet.play_until(0.3)
    sheet.page.get_by_text('Enter numbers').click()
    for speed in ('2', '0.4'):
        sheet.enter('vx [m/s]', speed)
        sheet.wait('text => window.texts.includes(text)', f'Speed {speed} m/s')


def stopwatch(sheet: Sheet) -> tuple[Locator, Locator]:
    """Have gates start and stop the clock; return the panel and what the clock shows."""
    sheet.press('Measure')
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_label('Starts when touched').select_option('gate/0')
    panel.get_by_label('Stops when touched').select_option('gate/1')
    return panel, panel.get_by_label('Stopwatch', exact=True)


def test_gates_start_and_stop_the_clock_to_the_step(sheet: Sheet) -> None:
    panel, clock = stopwatch(sheet)
    sheet.play_until(3.0)
    sheet.until(lambda: clock.inner_text() == '1.4000 s', '2.1 m at 1.5 m/s')
    panel.get_by_text('started at').wait_for()
    first = panel.inner_text()
    # Again, by the same bits.
    sheet.press('Reset')
    sheet.until(lambda: clock.inner_text() == '–', 'a clock that has not started')
    sheet.play_until(3.0)
    sheet.until(lambda: panel.inner_text() == first, 'the same times')


def test_a_gate_tells_what_touched_it_as_lists_do(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((-4.0, 5.0), (-3.7, 5.0))
    number = sheet.wait_for_new(before).partition('/')[2]
    sheet.press('Measure')
    panel = sheet.page.get_by_role('complementary', name='Body')
    start = panel.get_by_label('Starts when touched')
    start.select_option('rail/0')
    # The chosen item can be read whole.
    start.select_option(label=f'Circle {number}')
    assert start.evaluate(WIDTH_MISSING) <= 0
    start.select_option('rail/0')
    sheet.play_until(1.5)
    panel.get_by_text(re.compile(f'started at .* by Circle {number}')).wait_for()


def test_gates_that_are_chosen_after_the_run_tell_the_same_time(sheet: Sheet) -> None:
    sheet.play_until(3.0)
    _, clock = stopwatch(sheet)
    sheet.until(lambda: clock.inner_text() == '1.4000 s', '2.1 m at 1.5 m/s')


def test_collisions_of_a_body_are_counted(sheet: Sheet) -> None:
    sheet.press('Measure')
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_label('Collisions of').select_option('ball/1')
    count = panel.get_by_label('Number of collisions')
    sheet.until(lambda: count.inner_text() == '0', 'no collision')
    # From 8 m onto the rail whose top is at 2.2 m: after 1.07 s, and then each 2.14 s.
    sheet.play_until(4.0)
    sheet.until(lambda: count.inner_text() == '2', 'two bounces')
    sheet.press('Count from here')
    sheet.until(lambda: count.inner_text() == '0', 'a new count')


def test_a_stopwatch_by_hand_has_the_time_of_the_world(sheet: Sheet) -> None:
    keyboard = sheet.page.keyboard
    keyboard.press('7')
    first = sheet.play_until(0.3)
    keyboard.press('6')
    end = sheet.play_until(first + 0.2)
    keyboard.press('7')
    sheet.play_until(end + 0.1)
    sheet.press('Measure')
    reading = sheet.page.get_by_label('Stopwatch by hand')
    assert reading.inner_text() == f'{end:.3f} s'
    sheet.page.get_by_text(f'{first:.3f} s', exact=True).wait_for()
