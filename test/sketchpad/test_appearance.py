# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page as it looks to readers with colours of their own."""

from __future__ import annotations

import math

import numpy as np
import pytest

from .chromium import circle, NOTE_TEXTS, OpenSheet, started_world, WORLD
from ..outside import Outside

BACKGROUND = """name => getComputedStyle(
    document.querySelector(`button[aria-label="${name}"]`)).backgroundColor"""

# The colours of a part without words of the page, and of the dialog in which it is shown.
STICK = '<div class=stick><i></i></div>'
COLOURS = """html => {
    const dialog = document.querySelector('dialog');
    dialog.innerHTML = html;
    dialog.showModal();
    return [dialog.querySelector('i'), dialog]
        .map((each) => getComputedStyle(each).backgroundColor);
}"""

# The ends of the lines of a grid at a place of the world [m], as they are asked of a canvas [px].
GRID_LINES = """async at => {
    const {drawGrid} = await import('/page/view/grid_view.js'), lines = [];
    const camera = Object.assign(new (await import('/page/view/camera.js')).Camera(),
        {x: at, y: 5, scale: 60, width: 1200, height: 800});
    const ctx = {beginPath() {}, moveTo() {}, stroke() {}, fillText() {},
        lineTo: (...end) => lines.push(end)};
    drawGrid({ctx, camera, palette: {}, insets: {left: 0, bottom: 0}});
    return lines;
}"""


# The least space between two numbers at the lower edge of a world, at a scale [px/m], around its
# origin and as far out as bodies are.
SPACE = """async scale => {
    const {drawRulers} = await import('/page/view/grid_view.js');
    const {Camera} = await import('/page/view/camera.js');
    const ctx = document.createElement('canvas').getContext('2d'), spaces = [];
    ctx.font = '11px system-ui, sans-serif';
    for (const x of [0, 1e7]) {
        const ends = [], camera = Object.assign(new Camera(),
            {x, y: 0, scale, width: 1200, height: 800});
        const write = (text, [x], color, align) => align === 'center' &&
            ends.push([-1, 1].map((side) => x + side * ctx.measureText(text).width / 2));
        drawRulers({camera, write, palette: {}, insets: {left: 0, top: 0, right: 0, bottom: 0}});
        spaces.push(...ends.slice(1).map(([begin], i) => begin - ends[i][1]));
    }
    return Math.min(...spaces);
}"""


# The labels that are drawn of three small bodies in a row, the last one apart, and how often their
# texts are measured in two frames.
LABELS = """async () => {
    const {drawLabels} = await import('/page/view/label_view.js'), drawn = [];
    const camera = Object.assign(new (await import('/page/view/camera.js')).Camera(),
        {x: 0, y: 0, scale: 20, width: 400, height: 400});
    const bodies = ['first', 'second', 'third'].map((label, row) =>
        ({label, name: label, shape: {radius: 0.1}, centroid: [0, 0],
            at: [row === 2 ? 5 : 0.2 * row, 0]}));
    let measured = 0;
    const ctx = {measureText: (text) => (measured += 1, {width: 50 * text.length})};
    const view = {ctx, camera, palette: {}, write: (text) => drawn.push(text),
        bodies: {appearance: () => ({inner: 0.1}), isOnPage: () => true},
        world: {count: 3, scene: {bodies, joints: []}, centerOf: (row) => bodies[row].at,
            boundsOfAll: () => [0, 0, 0, 0]}};
    drawLabels(view);
    drawLabels(view);
    return [drawn, measured];
}"""

# The room about the centroid of an L, which the line of an edge passes at 1 cm, but no edge [m].
ROOM = """async () => {
    const {BodyView} = await import('/page/view/body_view.js');
    const outline = [[-1, -1], [1, -1], [1, -0.5], [3, -0.5], [3, 0.5], [1, 0.5], [1, 1], [-1, 1]];
    return new BodyView({}).appearance(
        {shape: {kind: 'polygon', outline}, color: [1, 0, 0, 1], centroid: [0.99, 0]}).inner;
}"""

# Both ends of the ticks of walls, which are 0.1 m away from them and 0.5 m apart [m].
TICKS = """async walls => {
    const {groundTicks} = await import('/page/view/body_view.js');
    return walls.map(([a, b]) => {
        const starts = [], ends = [];
        const moveTo = (...point) => starts.push(point), lineTo = (...point) => ends.push(point);
        groundTicks({moveTo, lineTo}, a, b, 0, 0.1, 0.5);
        return [starts, ends];
    });
}"""

# The angle to which the line of a round arrow goes, and that which its head is long [rad].
ROUND = """async sweep => {
    const {SceneView} = await import('/page/view/scene_view.js'), angles = [], points = [];
    const ctx = {beginPath() {}, stroke() {}, fill() {}, lineTo: (...point) => points.push(point),
        arc: (x, y, radius, begin, end) => angles.push(begin - end)};
    const view = {ctx, onRim: (color, width, draw) => draw(0)};
    const {tip} = SceneView.prototype.roundArrow.call(view, [0, 0], 30, sweep, '');
    const [across] = points.map(([x, y]) => Math.hypot(x - tip[0], y - tip[1]));
    return [angles[0], across / 30];
}"""

# The box that is framed of a world in which a rod hangs just below the upper bound [m].
HUNG = """async () => {
    const {WorldState} = await import('/page/world_state.js'), world = new WorldState({on() {}});
    Object.assign(world.scene, {bounds: [-1, 0, 1, 5.1],
        joints: [{kind: 'rod', a: 0, b: -1, points: [[0, 0], [0, 5]]}]});
    return world.extent();
}"""


def test_a_label_that_is_larger_than_its_body_is_on_no_other_and_is_measured_once(
    open_sheet: OpenSheet,
) -> None:
    sheet = open_sheet()
    drawn, measured = sheet.page.evaluate(LABELS)
    assert drawn == ['first', 'third'] * 2
    assert measured == 3


def test_the_mark_of_a_body_has_the_room_within_its_outline(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    assert sheet.page.evaluate(ROOM) == pytest.approx(0.9 * math.hypot(0.01, 0.5))


def test_the_ticks_of_a_wall_are_on_its_lower_side_and_slant_alike(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    for angle in (-1.2, -0.4, 0.0, 0.6, 1.5):
        along = np.array((math.cos(angle), math.sin(angle)))
        down = along[1], -along[0]
        wall = [[0.0, 0.0], (2.0 * along).tolist()]
        # Whichever end it is drawn from.
        for starts, ends in np.array(sheet.page.evaluate(TICKS, [wall, wall[::-1]])):
            assert starts @ down == pytest.approx(0.1)
            assert (ends - starts) @ down == pytest.approx(0.3)
            assert (ends - starts) @ along == pytest.approx(-0.3)


@pytest.mark.parametrize('sweep', [4.0, -4.0])
def test_the_line_of_a_round_arrow_ends_within_its_head(
    sweep: float, open_sheet: OpenSheet
) -> None:
    end, head = open_sheet().page.evaluate(ROUND, sweep)
    assert abs(sweep) - head < abs(end) < abs(sweep)
    assert end * sweep > 0.0


def test_the_hinge_of_a_rod_is_framed_with_its_world(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    left, low, right, high = sheet.page.evaluate(HUNG)
    assert (left, low, right) == (-1.0, 0.0, 1.0)
    # Triangle and ground are three times as high as half of a symbol, 0.12 m.
    assert high >= 5.0 + 2.9 * 0.12


def test_a_pressed_button_is_told_from_others_in_the_colours_of_the_reader(
    open_sheet: OpenSheet,
) -> None:
    sheet = open_sheet(forced_colors='active')
    sheet.press('Hand')
    hand, pen = (sheet.page.evaluate(BACKGROUND, name) for name in ('Hand', 'Pen'))
    assert hand != pen


def test_what_is_told_by_a_colour_keeps_it_in_the_colours_of_the_reader(
    open_sheet: OpenSheet,
) -> None:
    sheet = open_sheet(forced_colors='active')
    for html in ('<ul class=histogram><li><span><i class=right></i></span></ul>', STICK):
        bar, paper = sheet.page.evaluate(COLOURS, html)
        assert bar != paper


@pytest.mark.parametrize('size', [(1366, 768), (390, 844), (844, 390), (683, 384), (600, 400)])
def test_nothing_covers_the_walls_of_a_world_that_is_framed(
    open_sheet: OpenSheet, size: tuple[int, int]
) -> None:
    width, height = size
    sheet = open_sheet(size=(width, height)).begin()
    sheet.press('Rectangle')
    hint = sheet.page.locator('#hint')
    hint.get_by_text('from corner to corner').wait_for()
    (left, top), (right, bottom) = sheet.place(-8.0, 9.0), sheet.place(8.0, 0.0)
    assert 0 < left < right < width
    for each in ('#files', '#looks', '#hint', '#status'):
        box = sheet.page.locator(each).bounding_box()
        assert box['y'] + box['height'] <= top, each
    tools, bar = (sheet.page.locator(each).bounding_box() for each in ('#tools', '#bar'))
    assert bottom <= bar['y']
    assert bottom <= tools['y'] or tools['x'] + tools['width'] <= left
    # At 200 % zoom, too, bars are no more than two fifths of the height.
    below = bar['y'] if tools['x'] + tools['width'] <= left else min(tools['y'], bar['y'])
    above = sheet.page.locator('#looks').bounding_box()
    assert below - above['y'] - above['height'] >= 0.6 * height
    reset = sheet.page.get_by_role('button', name='Reset').bounding_box()
    assert reset['x'] + reset['width'] <= bar['x'] + bar['width']


def test_a_stroke_that_begins_on_a_note_is_drawn(open_sheet: OpenSheet) -> None:
    sheet = open_sheet().begin()
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    sheet.wait_for_new(before)
    note = sheet.page.locator('.note').bounding_box()
    x, y = sheet.page.evaluate(
        '([x, y]) => physsim.toWorld(x, y)', (note['x'] + 5, note['y'] + note['height'] / 2)
    )
    before = sheet.names()
    sheet.drag(*circle(x - 1.0, y, 1.0))
    sheet.wait_for_new(before)
    assert sheet.page.evaluate('getSelection().toString()') == ''


def test_the_grid_far_from_the_origin_has_no_line_beside_the_page(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    near, far = (sheet.page.evaluate(GRID_LINES, at) for at in (0.0, 10_000.0))
    assert len(far) == len(near) > 50
    assert all(0 <= x <= 1200.5 and 0 <= y <= 800.5 for x, y in far)


def test_numbers_at_the_edge_of_a_world_are_apart_at_every_scale(open_sheet: OpenSheet) -> None:
    sheet = open_sheet()
    scales = [step * 10.0**power for power in range(-5, 4) for step in (1, 1.4, 2, 3, 5, 7)]
    assert all(sheet.page.evaluate(SPACE, scale) > 4 for scale in scales)


def test_on_a_small_page_a_panel_leaves_room_for_what_is_said_and_for_a_plot(
    open_sheet: OpenSheet,
) -> None:
    sheet = open_sheet(size=(600, 400)).begin()
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.wait_for()
    hint = sheet.page.locator('#hint').bounding_box()
    corner = panel.bounding_box()
    beside = hint['x'] + hint['width'] <= corner['x']
    assert hint['width'] > 60
    assert beside or hint['y'] + hint['height'] <= corner['y']
    sheet.press('More')
    sheet.press('Large plot')
    plot = sheet.page.get_by_role('img', name='Large plot').bounding_box()
    assert min(plot['width'] / 2, plot['height']) > 80


# Words of an element that are broken in two where they have no soft hyphen.
BROKEN = """(selector) => {
    const found = [], element = document.querySelector(selector);
    const texts = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const node = texts.currentNode, range = document.createRange();
        for (const {0: word, index} of node.data.matchAll(/[\\p{L}\\xad]{3,}/gu)) {
            range.setStart(node, index);
            range.setEnd(node, index + word.length);
            const lines = [...range.getClientRects()].map(({top}) => Math.round(top));
            if (new Set(lines).size > 1 && !word.includes('\\xad')) found.push(word);
        }
    }
    return found;
}"""


@pytest.mark.parametrize('size', [(1280, 800), (768, 1024), (360, 740)])
def test_the_hint_at_the_forces_of_many_bodies_is_a_few_lines(
    open_sheet: OpenSheet, outside: Outside, size: tuple[int, int]
) -> None:
    discs = ''.join(
        f'  - {{name: disc/{each}, circle: {{radius: 0.2}}, at: [{each - 6}, 3]}}\n'
        for each in range(13)
    )
    _, address = started_world(
        outside, world=f'format: 1\nbounds: [-8, 0, 8, 9]\nbodies:\n{discs}'
    )
    sheet = open_sheet(address, size=size)
    sheet.wait('heard.people && Object.keys(physsim.bodies).length === 13')
    sheet.press('Show forces')
    legend = sheet.page.locator('#legend')
    hint = legend.get_by_text('Tap a body')
    hint.wait_for()
    box, text = legend.bounding_box(), hint.bounding_box()
    fold = legend.locator('.fold').bounding_box()
    scale = legend.get_by_text(' N').first.bounding_box()
    assert fold is None or fold['y'] < scale['y'] + scale['height']
    assert text['height'] < 80, 'four lines'
    assert box['x'] >= 0
    assert box['x'] + box['width'] <= size[0]


@pytest.mark.parametrize('size', [(390, 844), (320, 640)])
def test_on_a_telephone_words_and_choices_are_whole(
    open_sheet: OpenSheet, outside: Outside, size: tuple[int, int]
) -> None:
    _, address = started_world(outside)
    sheet = open_sheet(address, size=size, locale='de-DE')
    sheet.wait('heard.people && Object.keys(physsim.bodies).length === 3')
    sheet.press('Pause')
    sheet.press('Speichern')
    name = sheet.page.get_by_role('textbox', name='Name der Welt')
    assert name.bounding_box()['width'] > 130
    sheet.page.keyboard.press('Escape')
    sheet.press('Welten')
    # The file of the world is one's own.
    sheet.page.get_by_role('button', name='Umbenennen').wait_for()
    assert sheet.page.evaluate(BROKEN, 'dialog[open]') == []
    sheet.page.keyboard.press('Escape')
    sheet.press('Hilfe')
    sheet.page.get_by_text('Was der Stift versteht').wait_for()
    assert sheet.page.evaluate(BROKEN, 'dialog[open]') == []
    sheet.page.keyboard.press('Escape')
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    sheet.press('Mehr')
    sheet.press('Großes Diagramm')
    row = sheet.page.locator('#plot header > .row').bounding_box()
    for label in ('Nach oben', 'Nach rechts'):
        box = sheet.page.get_by_label(label).bounding_box()
        assert row['x'] <= box['x']
        assert box['x'] + box['width'] <= row['x'] + row['width']


def test_the_words_of_a_panel_are_whole(open_sheet: OpenSheet, outside: Outside) -> None:
    world = WORLD.replace('radius: 0.5}, at: [0, 0.5]', 'radius: 1}, at: [0, 3]')
    _, address = started_world(outside, world=world, speed=0.0)
    sheet = open_sheet(address, size=(1280, 800), unfolded=False, locale='de-DE')
    sheet.wait('heard.people && Object.keys(physsim.bodies).length === 3')
    sheet.press('Hand')
    sheet.tap(0.0, 3.0)
    sheet.page.get_by_text('92,46 J').wait_for()
    assert sheet.page.evaluate(BROKEN, '#panel') == []


def test_numbers_beside_bodies_are_on_the_page(open_sheet: OpenSheet) -> None:
    sheet = open_sheet().begin()
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.press('Show forces')
    sheet.wait('boxes.some(([text]) => text === "9.81 N")')
    bar = sheet.page.get_by_role('contentinfo').bounding_box()
    ends = sheet.page.evaluate('boxes.filter(([text]) => text === "9.81 N").map((box) => box[4])')
    assert bar['y'] - 40 < max(ends) < bar['y']
    # And so is that of a place at the right edge.
    sheet.press('Hand')
    with sheet.dragging((4.0, 0.5), (7.9, 4.0)):
        sheet.wait('boxes.some(([text]) => text.startsWith("at 7.9"))')
        assert (
            1100 < sheet.page.evaluate('boxes.find(([text]) => text.startsWith("at"))[3]') < 1200
        )
    sheet.press('Undo')
