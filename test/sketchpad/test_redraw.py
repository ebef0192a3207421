# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A picture of the world is drawn when it may have changed, at most once a frame of the page."""

from __future__ import annotations

import pytest

from .chromium import DRAWN, Sheet

BODIES = 300
WORLD = 'format: 1\nbounds: [-1, -1, 20, 16]\nbodies:\n' + ''.join(
    f'- {{name: b/{number}, circle: {{radius: 0.3}}, at: [{number % 20}, {number // 20}]}}\n'
    for number in range(BODIES)
)
# Moves a pointer a hundred times within a frame of the page, over an element, and returns how many
# pictures of the world are drawn for that.
PICTURES = f"""async (selector) => {{
    const canvases = CanvasRenderingContext2D.prototype, {{fillRect}} = canvases;
    const element = document.querySelector(selector);
    const {{left, top, width, height}} = element.getBoundingClientRect();
    await new Promise({DRAWN});
    let pictures = 0;
    canvases.fillRect = function (...box) {{
        pictures += box[2] === innerWidth && box[3] === innerHeight;
        fillRect.apply(this, box);
    }};
    for (let i = 0; i < 100; i++) {{
        const place = {{clientX: left + width * i / 100, clientY: top + height / 2}};
        element.dispatchEvent(new PointerEvent('pointermove', {{bubbles: true, ...place}}));
    }}
    await new Promise({DRAWN});
    canvases.fillRect = fillRect;
    return pictures;
}}"""


@pytest.mark.parametrize(('selector', 'pictures'), [('#world', 1), ('#tools', 0), ('#bar', 0)])
def test_a_hundred_moves_of_a_pointer_draw_one_picture_of_the_world_and_over_a_bar_none(
    sheet: Sheet, selector: str, pictures: int
) -> None:
    # In between, the server may tell something.
    sheet.until(
        lambda: sheet.page.evaluate(PICTURES, selector) == pictures, f'{pictures} pictures'
    )
