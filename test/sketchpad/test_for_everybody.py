# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page by keys, with words at its icons, hints that learn, and a screen reader."""

from __future__ import annotations

import re

from .chromium import OpenSheet, Sheet

# The page's clock runs ten times faster than before.
SLOWED = """() => {
    const now = performance.now.bind(performance), begin = now();
    performance.now = () => begin + 10 * (now() - begin);
}"""
# Notes all that is announced: each announcement takes the place of the one before.
ANNOUNCEMENTS = """() => {
    const log = document.querySelector('[role=log]');
    window.announced = '';
    new MutationObserver(() => { announced += log.textContent; }).observe(log, {childList: true});
}"""
FOCUSED = "document.activeElement.getAttribute('aria-label')"
ENOUGH = 8

# The numbers of the elements that are found, each as the one that lies at the middle of its place.
TOPMOST = """selector => {
    const all = [...document.querySelectorAll(selector)];
    return all.map((each) => {
        const {left, right, top, bottom} = each.getBoundingClientRect();
        return all.indexOf(document.elementFromPoint((left + right) / 2, (top + bottom) / 2));
    });
}"""


def tab_to(sheet: Sheet, name: str) -> list[str]:
    """Press Tab until something has the focus, and return the names on the way."""
    names: list[str] = []
    while not names or names[-1] != name:
        assert len(names) < ENOUGH, names
        sheet.page.keyboard.press('Tab')
        names.append(sheet.page.evaluate(FOCUSED))
    return names


def keys(sheet: Sheet, *pressed: str) -> list[str]:
    """Press keys, and return what has the focus after each."""
    names = []
    for key in pressed:
        sheet.page.keyboard.press(key)
        names.append(sheet.page.evaluate(FOCUSED))
    return names


def test_tab_comes_to_play_in_five_steps(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    sheet.wait('heard.people && Object.keys(physsim.bodies).length > 0')
    assert len(tab_to(sheet, 'Play')) <= 5
    assert keys(sheet, 'ArrowRight', 'ArrowLeft', 'End', 'Home') == [
        'Fast forward',
        'Play',
        'Step',
        'Fast rewind',
    ]
    # Back and forth, Tab comes to the button that was reached last.
    assert keys(sheet, 'Tab', 'Shift+Tab')[-1] == 'Fast rewind'


def test_arrow_keys_move_in_the_columns_of_tools(sheet: Sheet) -> None:
    sheet.page.evaluate('document.activeElement.blur()')
    tab_to(sheet, 'Pen')
    assert keys(sheet, 'ArrowRight', 'ArrowDown', 'ArrowLeft', 'ArrowDown', 'Enter') == [
        'Hand',
        'Circle by diameter',
        'Circle',
        'Polygon',
        'Polygon',
    ]
    polygon = sheet.page.get_by_role('button', name='Polygon', exact=True)
    assert polygon.get_attribute('aria-pressed') == 'true'


def test_a_toolbar_has_one_stop_also_where_its_buttons_come_and_go(sheet: Sheet) -> None:
    sheet.press('Show forces')
    sheet.press('Show velocities')
    stops = sheet.page.locator('#legend button[tabindex="0"]')
    assert stops.count() == 1
    sheet.press('Show forces')
    assert stops.count() == 1


def test_a_button_that_is_pressed_by_a_key_keeps_the_focus(sheet: Sheet) -> None:
    # The box around the button is made anew.
    sheet.press('Show velocities')
    sheet.press('Material')
    for name in ('Momentum', 'Wood'):
        button = sheet.page.get_by_role('button', name=name, exact=True)
        button.focus()
        sheet.page.keyboard.press('Enter')
        sheet.wait('true')
        assert button.evaluate('each => each === document.activeElement'), name


def test_keys_belong_to_the_control_that_has_the_focus(sheet: Sheet) -> None:
    pen = sheet.page.get_by_role('button', name='Pen', exact=True)
    sheet.press('Pen')
    sheet.tap(0.0, 0.5)
    ways = sheet.page.get_by_label('Lets others pass')
    ways.focus()
    sheet.page.keyboard.press('ArrowDown')
    assert ways.input_value() == '0,1'
    # By its first letters an option is chosen.
    sheet.page.keyboard.press('d')
    assert ways.input_value() == '0,-1'
    numbers = sheet.page.locator('.typed')
    for key in ('Enter', 'Space'):
        before = numbers.evaluate('each => each.open')
        numbers.locator('summary').focus()
        sheet.page.keyboard.press(key)
        assert numbers.evaluate('each => each.open') != before
    sheet.page.get_by_role('button', name='Delete body').focus()
    sheet.page.keyboard.press('h')
    assert pen.get_attribute('aria-pressed') == 'true'
    assert sheet.page.evaluate('physsim.speed') == 0


def test_letters_are_no_keys_where_somebody_does_not_want_them(sheet: Sheet) -> None:
    sheet.press('Pen')
    sheet.press('Help')
    sheet.page.get_by_label('Letters and digits as keys').uncheck()
    sheet.page.keyboard.press('Escape')
    hand, pen = (
        sheet.page.get_by_role('button', name=name, exact=True) for name in ('Hand', 'Pen')
    )
    sheet.page.keyboard.press('h')
    assert pen.get_attribute('aria-pressed') == 'true'
    sheet.page.keyboard.press('?')
    assert sheet.page.get_by_role('dialog').count() == 0
    # Keys without a letter work on.
    sheet.page.keyboard.press('Control+a')
    sheet.page.get_by_role('heading', name='3 bodies').wait_for()
    sheet.press('Help')
    sheet.page.get_by_label('Letters and digits as keys').check()
    sheet.page.keyboard.press('Escape')
    sheet.page.keyboard.press('h')
    assert hand.get_attribute('aria-pressed') == 'true'


def test_words_stand_at_icons_where_somebody_wants_them(sheet: Sheet) -> None:
    word = sheet.page.get_by_role('button', name='Spring', exact=True).get_by_text('Spring')
    assert not word.is_visible()
    sheet.press('Help')
    sheet.page.get_by_label('Words at icons').check()
    sheet.page.keyboard.press('Escape')
    word.wait_for()
    sheet.page.reload()
    word.wait_for()


def test_a_zoom_is_told_in_per_cent(sheet: Sheet) -> None:
    frame = sheet.page.get_by_role('button', name='Frame the world', exact=True)
    view = sheet.page.get_by_role('toolbar', name='View')
    view.get_by_text('100 %').wait_for()
    sheet.page.keyboard.press('+')
    view.get_by_text('125 %').wait_for()
    frame.click()
    view.get_by_text('100 %').wait_for()


def test_a_hint_that_was_followed_twice_is_not_given_again(sheet: Sheet) -> None:
    hint = sheet.page.locator('#hint:not(.faded)').get_by_text('drag from point to point')
    for time in range(3):
        sheet.press('Ruler')
        # Chosen again without a use, it is told again.
        sheet.press('Pen')
        sheet.press('Ruler')
        sheet.wait('true')
        assert hint.is_visible() == (time < 2)
        sheet.drag((-2.0, 5.0), (2.0, 5.0))
        sheet.press('Pen')


def test_a_screen_reader_is_told_what_the_selected_body_does(sheet: Sheet) -> None:
    sheet.page.evaluate(ANNOUNCEMENTS)
    sheet.press('Hand')
    sheet.drag((0.0, 0.5), (0.0, 4.0))
    sheet.wait("physsim.bodies['ball/0'][1] > 3.99")
    sheet.tap(*sheet.pose('ball/0')[:2])
    sheet.page.get_by_role('complementary', name='Body').wait_for()
    sheet.press('Play')
    for told in ('ball/0 touches a wall at', 'ball/0 rests at'):
        sheet.wait('told => announced.includes(told)', told)
    sheet.press('Pause')


def test_a_screen_reader_is_told_of_all_bodies_where_somebody_asks(sheet: Sheet) -> None:
    tells = sheet.page.get_by_label('Tell what moves, for screen readers')

    def ask(*, tell: bool) -> None:
        sheet.press('Help')
        assert tells.is_checked() != tell
        tells.set_checked(tell)
        sheet.page.keyboard.press('Escape')

    ask(tell=True)
    # It is remembered.
    sheet.page.reload()
    sheet.begin()
    sheet.page.evaluate(ANNOUNCEMENTS)
    sheet.press('Play')
    sheet.wait("announced.includes('box/0 touches a wall at')")
    ask(tell=False)
    # A page that has announced nothing would do so at once.
    sheet.begin()
    sheet.page.reload()
    sheet.begin()
    sheet.page.evaluate(ANNOUNCEMENTS)
    sheet.play_until(0.5)
    assert sheet.page.evaluate('announced') == ''


def test_buttons_of_the_legend_are_as_large_as_a_finger(open_sheet: OpenSheet) -> None:
    for size in ((1200, 800), (390, 844), (844, 390)):
        sheet = open_sheet(size=size, has_touch=True, is_mobile=True)
        sheet.press('Show forces')
        buttons = sheet.page.locator('#legend button:visible')
        buttons.first.wait_for()
        boxes = [each.bounding_box() for each in buttons.all()]
        assert boxes
        assert all(min(box['width'], box['height']) >= 44 for box in boxes)


def test_the_reason_of_a_slow_world_is_told_once(sheet: Sheet) -> None:
    # Frames that come ten times too late: their clock says so, not the machine of the test.
    sheet.page.evaluate(SLOWED)
    sheet.press('Play')
    sheet.wait("heard.notes.some((note) => note.startsWith('Slower than 1×'))")
    speed = sheet.page.locator('#speed.slow')
    speed.wait_for()
    sheet.press('Pause')
    assert sheet.page.evaluate("heard.notes.filter((note) => note.includes('Slower')).length") == 1


def test_each_ring_of_the_time_line_can_be_pressed(sheet: Sheet) -> None:
    rings = sheet.page.locator('#marks button')
    sheet.play_until(1.0)
    sheet.press('Circle')
    for time, x in ((0.5, 2.0), (0.8, -2.0)):
        sheet.seek(time)
        before = sheet.names()
        sheet.drag((x, 5.0), (x + 0.7, 5.0))
        sheet.wait_for_new(before)
        sheet.play_until(1.0)
    # Both courses have left this one at one moment.
    rings.first.click()
    sheet.wait('Object.keys(physsim.bodies).length === 3')
    sheet.until(lambda: rings.count() == 2, 'two rings')
    assert sheet.page.evaluate(TOPMOST, '#marks button') == [0, 1]


def test_rings_of_the_time_line_end_with_their_world(sheet: Sheet) -> None:
    rings = sheet.page.locator('#marks button')
    sheet.play_until(1.0)
    sheet.seek(0.5)
    sheet.press('Circle')
    sheet.drag((2.0, 5.0), (2.7, 5.0))
    rings.first.wait_for()
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name=re.compile('^1\\. ')).click()
    sheet.page.get_by_role('heading', name='Free fall').wait_for()
    sheet.wait("document.querySelectorAll('#marks button').length === 0")
