# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""*The page* of the contract, to the letter; contrast, motion and what a screen reader finds."""

from __future__ import annotations

import pytest

from .chromium import OpenSheet, Sheet

# Of `INTERFACE.md`, *The page*.
BUTTONS = """
Fast rewind, Rewind, Pause, Play, Fast forward, Step, Undo, Redo, Reset, Pen, Hand, Circle,
Circle by diameter, Rectangle, Polygon, Wall, Anchor, Release, Pin, Axle, Spring, Rod, Rope,
Velocity, Gravity, Delete, Worlds, Save
"""
# Least side of what a finger presses [px], WCAG 2.2, 2.5.5.
FINGER = 44
# Least contrast of text, WCAG 2.2, 1.4.3.
CONTRAST = 4.5
# Contrast of all texts and icons that are shown, by WCAG's relative luminance.
MEASURE = """() => {
  const luminance = (color) => {
    const [r, g, b] = color.match(/[\\d.]+/g).slice(0, 3).map((each) => each / 255)
      .map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = (element) => {
    for (let each = element; each; each = each.parentElement) {
      const color = getComputedStyle(each).backgroundColor;
      if (!/^rgba\\(.*, 0(\\.\\d+)?\\)$/.test(color)) return color;
    }
    return getComputedStyle(document.body).backgroundColor;
  };
  const ratio = (a, b) => {
    const [dark, light] = [luminance(a), luminance(b)].sort((p, q) => p - q);
    return (light + 0.05) / (dark + 0.05);
  };
  const found = {};
  for (const element of document.querySelectorAll('body *:not(script)')) {
    const style = getComputedStyle(element);
    const text = [...element.childNodes].some((each) => each.nodeType === 3 && each.data.trim());
    const seen = element.checkVisibility({opacityProperty: true});
    if (!seen || !(text || element.tagName === 'svg')) continue;
    const name = element.closest('[aria-label]')?.getAttribute('aria-label') ?? '';
    found[`${name} ${element.textContent.trim().slice(0, 30)}`] =
      ratio(text ? style.color : style.stroke, behind(element));
  }
  const palette = getComputedStyle(document.documentElement);
  const hex = (name) => palette.getPropertyValue(name).trim().match(/\\w\\w/g)
    .map((each) => parseInt(each, 16)).join(' ');
  for (const name of ['--faint', '--ink', '--accent', '--force', '--warn']) {
    found[name] = ratio(hex(name), hex('--paper'));
  }
  return found;
}"""


def poor(sheet: Sheet) -> dict[str, float]:
    """Return the ratios of the texts and colours with too little contrast."""
    found: dict[str, float] = sheet.page.evaluate(MEASURE)
    assert len(found) > 20
    return {name: ratio for name, ratio in found.items() if ratio < CONTRAST}


@pytest.fixture(params=['desk', 'phone'])
def sheet(open_sheet: OpenSheet, request: pytest.FixtureRequest) -> Sheet:
    """Give a test a page of either size."""
    phone = {'size': (390, 844), 'has_touch': True}
    return open_sheet(**(phone if request.param == 'phone' else {})).begin()


def test_every_name_of_the_contract_is_there_once_and_large_enough_for_a_finger(
    sheet: Sheet,
) -> None:
    names = BUTTONS.replace('\n', ' ').split(',')
    assert len(names) == 28
    for name in names:
        button = sheet.page.get_by_role('button', name=name.strip(), exact=True)
        assert button.count() == 1, name
        box = button.bounding_box()
        assert min(box['width'], box['height']) >= FINGER, name
    for box in (each.bounding_box() for each in sheet.page.get_by_role('button').all()):
        assert min(box['width'], box['height']) >= FINGER
    for role, name in (('slider', 'Time'), ('img', 'World')):
        assert sheet.page.get_by_role(role, name=name, exact=True).count() == 1
    assert sheet.page.get_by_role('status').count() == 1


def test_window_physsim_is_that_of_the_contract(sheet: Sheet) -> None:
    page = sheet.page
    assert page.evaluate('[physsim.time, physsim.speed]') == [0, 0]
    x, y = page.evaluate('physsim.toWorld(...physsim.toPage(1.25, 2.5))')
    assert (x, y) == pytest.approx((1.25, 2.5))
    # x to the right, y up.
    assert sheet.place(1, 0)[0] > sheet.place(0, 0)[0]
    assert sheet.place(0, 1)[1] < sheet.place(0, 0)[1]
    assert {name: sheet.pose(name) for name in sheet.names()} == {
        'ball/0': [0, 0.5, 0],
        'box/0': [4, 0.5, 0],
        'shelf/0': [-4, 3, 0],
    }


@pytest.mark.parametrize('scheme', ['light', 'dark'])
def test_all_that_is_to_be_read_has_contrast(open_sheet: OpenSheet, scheme: str) -> None:
    sheet = open_sheet(color_scheme=scheme, reduced_motion='reduce').begin()
    assert sheet.page.evaluate('document.documentElement.dataset.theme') == scheme
    assert poor(sheet) == {}
    sheet.press('Anchor')
    sheet.tap(-2.0, 6.0)
    sheet.page.locator('.note.refusal').wait_for()
    assert poor(sheet) == {}
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    sheet.page.get_by_role('complementary', name='Body').wait_for()
    assert poor(sheet) == {}
    for name in ('Worlds', 'Save', 'Help'):
        sheet.press(name)
        # Its script is loaded when it is asked for.
        sheet.page.locator('dialog[open]').wait_for()
        assert poor(sheet) == {}
        sheet.page.keyboard.press('Escape')


def test_nothing_moves_by_itself_for_those_who_wish_so(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(reduced_motion='reduce').begin()
    sheet.press('Circle')
    sheet.drag((0.0, 6.0), (0.4, 6.0))
    # The hint points at the hand now.
    sheet.page.locator('button.next').wait_for()
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    sheet.page.get_by_role('complementary', name='Body').wait_for()
    assert sheet.page.evaluate('document.getAnimations().length') == 0


def test_a_screen_reader_finds_the_bodies_with_their_places(sheet: Sheet) -> None:
    items = sheet.page.get_by_role('list', name='Bodies').get_by_role('listitem')
    texts = (
        'ball/0: circle, at 0.0, 0.5 m',
        'box/0: rectangle, at 4.0, 0.5 m',
        'shelf/0: rectangle, anchored, at \N{MINUS SIGN}4.0, 3.0 m',
    )
    # The list is renewed each second.
    for number, text in enumerate(texts):
        items.nth(number).filter(has_text=text).wait_for(state='attached')
    sheet.until(lambda: items.count() == len(texts), 'a list of three')


def test_a_button_says_what_it_does_as_soon_as_it_is_pointed_at(open_sheet: OpenSheet) -> None:
    sheet = open_sheet().begin()
    tip = sheet.page.get_by_role('tooltip')
    button = sheet.page.get_by_role('button', name='Rectangle', exact=True)
    button.hover()
    tip.get_by_text('from corner to corner').wait_for()
    sheet.page.get_by_role('button', name='Circle', exact=True).focus()
    sheet.page.keyboard.press('ArrowRight')
    tip.get_by_text('Circle by diameter (D)').wait_for()
    sheet.press('Circle')
    assert tip.count() == 0
    assert 'corner to corner' in button.get_attribute('title')


def test_a_tip_lies_on_the_page_and_not_on_its_button(open_sheet: OpenSheet) -> None:
    sheet = open_sheet().begin()
    for name in ('Rectangle', 'Play', 'Reset', 'Help', 'Save'):
        button = sheet.page.get_by_role('button', name=name, exact=True)
        button.hover()
        tip = sheet.page.get_by_role('tooltip').filter(has_text=name).bounding_box()
        box, size = button.bounding_box(), sheet.page.viewport_size
        assert 0 <= tip['x'] <= size['width'] - tip['width'], name
        assert 0 <= tip['y'] <= size['height'] - tip['height'], name
        apart = (
            abs(tip[at] + tip[by] / 2 - box[at] - box[by] / 2) >= (tip[by] + box[by]) / 2
            for at, by in (('x', 'width'), ('y', 'height'))
        )
        assert any(apart), name


def test_hints_lead_from_a_first_body_to_a_changed_past(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    hint = sheet.page.locator('#hint')
    hint.get_by_text('Draw').wait_for()
    sheet.begin()
    before = sheet.names()
    sheet.press('Circle')
    hint.get_by_text('From the centre').wait_for()
    sheet.drag((0.0, 6.0), (0.4, 6.0))
    name = sheet.wait_for_new(before)
    hint.get_by_text('press play').wait_for()
    sheet.press('Play')
    hint.get_by_text('take the hand').wait_for()
    sheet.press('Pause')
    sheet.wait('physsim.speed === 0')
    sheet.press('Hand')
    with sheet.dragging(tuple(sheet.pose(name)[:2]), (2.0, 6.0)):
        sheet.wait('name => physsim.bodies[name][0] > 1', name)
    hint.get_by_text('rewind').wait_for()
    sheet.press('Play')
    sheet.wait('physsim.time > 0.5')
    sheet.press('Rewind')
    hint.get_by_text('the past').wait_for()
    sheet.press('Pause')
    sheet.press('Delete')
    sheet.tap(*sheet.pose('box/0')[:2])
    hint.get_by_text('what happened before').wait_for()
    # A step that was done is not taught again.
    sheet.page.reload()
    sheet.wait('Object.keys(physsim.bodies).length > 0')
    assert 'Draw a circle' not in hint.inner_text()
