# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The sentences in which the page tells what was done."""

from __future__ import annotations

import pytest

from .chromium import circle, Sheet

# Bodies from another socket of this page, which is closed, so that nobody else draws: name, x [m].
SPAWN = """bodies => new Promise((resolve) => {
    const socket = new WebSocket(`ws://${location.host}/ws`);
    socket.onopen = () => {
        for (const [name, x] of bodies) socket.send(JSON.stringify(
            {type: 'spawn', id: '', body: {name, box: {width: 1, height: 1}, at: [x, 6]}}));
        socket.close();
    };
    socket.onclose = () => resolve();
})"""


def test_what_nobody_has_named_is_called_what_it_is(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    name = sheet.wait_for_new(before)
    sheet.told('Circle added', exact=True)
    sheet.press('Anchor')
    sheet.tap(1.0, 5.0)
    sheet.told('Circle anchored', exact=True)
    sheet.press('Hand')
    sheet.tap(1.0, 5.0)
    title = sheet.page.get_by_role('complementary', name='Body').get_by_role('heading').first
    assert title.inner_text().split() == ['Circle', name]
    sheet.page.keyboard.press('Delete')
    sheet.told('Circle deleted', exact=True)
    sheet.press('Undo')
    sheet.press('Undo')
    sheet.press('Undo')
    sheet.told('Undone: add the circle', exact=True)
    sheet.press('Redo')
    sheet.told('Redone: add the circle', exact=True)


def test_a_knife_tells_that_it_passed_a_joint_too(sheet: Sheet) -> None:
    for tool, points in (
        ('Rectangle', ((-1.0, 4.0), (1.0, 5.0))),
        ('Rod', ((-4.0, 3.0), (4.0, 0.5))),
        ('Knife', ((0.7, 5.5), (0.7, 1.2))),
    ):
        sheet.press(tool)
        sheet.drag(*points)
        sheet.page.evaluate('new Promise(requestAnimationFrame)')
    sheet.told('Cut into 2 pieces, and joints cut through', exact=True)


def test_a_chain_is_told_as_one_thing_not_as_its_last_axle(sheet: Sheet) -> None:
    sheet.press('Chain')
    sheet.drag((-4.0, 3.0), (-4.0, 6.0))
    sheet.told('Chain of 9 links added', exact=True)
    sheet.press('Circle')
    sheet.drag((2.0, 5.0), (2.7, 5.0))
    sheet.told('Circle added', exact=True)
    sheet.press('Undo')
    sheet.press('Undo')
    sheet.told('Undone: add chain', exact=True)


def test_what_somebody_has_named_is_called_by_its_name(sheet: Sheet) -> None:
    sheet.press('Delete')
    sheet.tap(4.0, 0.5)
    sheet.told('box/0 deleted', exact=True)


def test_worlds_have_their_names(sheet: Sheet) -> None:
    sheet.press('Save')
    sheet.page.get_by_role('textbox', name='Name of the world').fill('mine')
    sheet.press('Save world')
    sheet.told('Saved as mine', exact=True)
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='mine', exact=True).click()
    sheet.told('Opened mine', exact=True)


def test_a_refusal_says_here_for_its_place(sheet: Sheet) -> None:
    sheet.press('Anchor')
    sheet.tap(-2.0, 6.0)
    sheet.told('There is no body here', exact=True)


@pytest.mark.parametrize(
    ('name', 'title'),
    [
        ('<img src=x onerror=window.hit=1>/0', '<img src=x onerror=window.hit=1>/0'),
        (f'{"W" * 998}/0', f'{"W" * 24}…{"W" * 10}/0'),
        (f'{"W " * 498}W/0', f'{"W " * 12}…{" W" * 5}/0'),
    ],
    ids=['markup', 'long', 'spaces'],
)
def test_names_are_shown_as_text_and_long_ones_short(sheet: Sheet, name: str, title: str) -> None:
    sheet.page.evaluate(SPAWN, [[name, 0.0]])
    sheet.wait('name => name in physsim.bodies', name)
    sheet.press('Hand')
    sheet.tap(0.0, 6.0)
    panel = sheet.page.get_by_role('complementary', name='Body')
    assert panel.get_by_role('heading').first.inner_text().strip() == title
    # Playwright clicks only what nothing covers.
    panel.get_by_label('Anchored').click()
    sheet.told(f'{title} changed', exact=True)
    with sheet.page.expect_download():
        sheet.press('Table (CSV)')
    undo = sheet.page.get_by_role('button', name='Undo', exact=True)
    undo.hover()
    sheet.page.get_by_role('tooltip').get_by_text(title[:20]).wait_for()
    assert sheet.page.evaluate('window.hit') is None
