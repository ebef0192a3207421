# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Keys and the menu that every editor has, and a frame back."""

from __future__ import annotations

import math

from .chromium import Sheet


def test_bodies_are_copied_cut_pasted_and_all_selected_by_keys(sheet: Sheet) -> None:
    keyboard, before = sheet.page.keyboard, sheet.names()
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    # The panel makes the world smaller.
    sheet.page.locator('#panel h2').wait_for()
    keyboard.press('Control+c')
    sheet.page.mouse.move(*sheet.place(-2.0, 6.0))
    keyboard.press('Control+v')
    name = sheet.wait_for_new(before)
    assert math.dist(sheet.pose(name)[:2], (-2.0, 6.0)) < 0.1
    # What is cut is moved where it is pasted, and keeps its name.
    keyboard.press('Control+x')
    sheet.page.mouse.move(*sheet.place(2.0, 6.0))
    keyboard.press('Control+v')
    sheet.wait(
        'Math.hypot(physsim.bodies["ball/0"][0] - 2, physsim.bodies["ball/0"][1] - 6) < 0.1'
    )
    keyboard.press('Control+d')
    sheet.wait('Object.keys(physsim.bodies).length === 5')
    keyboard.press('Control+a')
    sheet.page.get_by_role('heading', name='5 bodies').wait_for()
    # Of another world nothing is pasted, though the names of its bodies are the same.
    keyboard.press('Control+c')
    sheet.press('Worlds')
    sheet.press('Empty room')
    sheet.wait('Object.keys(physsim.bodies).length === 0')
    sheet.press('Undo')
    sheet.wait('Object.keys(physsim.bodies).length === 5')
    sheet.page.mouse.click(*sheet.place(0.0, 5.0), button='right')
    sheet.page.get_by_role('menuitem', name='Select all').wait_for()
    assert sheet.page.get_by_role('menuitem', name='Paste').count() == 0


def test_a_text_that_is_selected_is_copied_as_a_text(sheet: Sheet) -> None:
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='9. Pendulum').click()
    sheet.wait('"bob/0" in physsim.bodies && physsim.time === 0')
    sheet.page.evaluate(
        'document.addEventListener("copy", () => { window.copied = String(getSelection()); })'
    )
    sheet.tap(*sheet.pose('bob/0')[:2])
    sheet.page.locator('#lesson .question').click(click_count=3)
    sheet.page.keyboard.press('Control+c')
    assert sheet.page.evaluate('window.copied').startswith('How long does a pendulum of 2.5 m')
    # On the canvas, bodies are copied, though the text is still selected.
    sheet.page.locator('#world').focus()
    sheet.page.keyboard.press('Control+c')
    sheet.told('Copied', exact=True)
    sheet.press('Undo')
    sheet.wait('"ball/0" in physsim.bodies')


def test_the_right_button_opens_a_menu_of_the_body_there(sheet: Sheet) -> None:
    menu = sheet.page.get_by_role('menu')
    sheet.page.mouse.click(*sheet.place(4.0, 0.5), button='right')
    menu.get_by_role('menuitem', name='Delete (Del)').click()
    sheet.wait('!("box/0" in physsim.bodies)')
    assert menu.is_hidden()
    # By keys it is opened at the cursor, and goes by Esc.
    sheet.page.keyboard.press('Shift+F10')
    menu.wait_for()
    sheet.page.keyboard.press('Escape')
    menu.wait_for(state='hidden')
    # A drag by the right button moves the view.
    before = sheet.place(0.0, 0.0)
    x, y = sheet.place(0.0, 6.0)
    sheet.page.mouse.move(x, y)
    sheet.page.mouse.down(button='right')
    sheet.page.mouse.move(x + 40, y, steps=3)
    sheet.page.mouse.up(button='right')
    assert sheet.place(0.0, 0.0) != before
    assert menu.is_hidden()


def test_a_field_that_is_clicked_beside_the_menu_has_the_keys(sheet: Sheet) -> None:
    sheet.page.mouse.click(*sheet.place(4.0, 0.5), button='right')
    menu = sheet.page.get_by_role('menu')
    menu.wait_for()
    label = sheet.page.get_by_label('Label')
    label.click()
    assert menu.is_hidden()
    assert label.evaluate('each => each === document.activeElement')


def test_a_step_back_is_one_frame(sheet: Sheet) -> None:
    time = sheet.play_until(0.3)
    sheet.press('Step back')
    sheet.wait('time => Math.abs(time - physsim.time - 1 / 60) < 1e-6', time)
