# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cheat sheet of strokes and keys, as tables and as one page to print.

The page's own scripts declare both: `strokes.js` the strokes with a small picture each,
`tools.js`, `time_bar.js` and `help.js` the keys.
"""

from __future__ import annotations

from pathlib import Path
import re

PAGE = Path(__file__).parents[2] / 'physsim_ros' / 'sketchpad' / 'page'
# A text of the page, which `t` translates.
_TEXT = r"t\('((?:[^'\\]|\\.)*)'\)"
# A stroke in its box of 60 by 40: its name, its path, and what is there before it.
_STROKE = re.compile(rf"^  \[{_TEXT}, '([^']+)'(?:, '([^']+)')?\],$", re.MULTILINE)
_TOOL = re.compile(rf"^  tool\('\w+', {_TEXT}, '([^']+)', {_TEXT}", re.MULTILINE)
_TIME = re.compile(rf"\[{_TEXT}, '\w+', '([^']+)'(?:, {_TEXT})?\]")
_KEY = re.compile(rf"^  \[(?:'([^']+)'|{_TEXT}), {_TEXT}\],$", re.MULTILINE)


def strokes() -> list[tuple[str, str, str]]:
    """Return the name of each stroke, and as SVG paths the stroke and what is there before it."""
    return _STROKE.findall(_script('ui/strokes.js'))


def keys() -> dict[str, list[tuple[str, str]]]:
    """Return groups of keys by their titles: the key, and what it does."""
    time = _script('ui/time_bar.js')
    others = _script('ui/help.js').partition('const MOVING')[2]
    return {
        'Tools': [
            (key if len(key) > 1 else key.upper(), name)
            for name, key, _ in _TOOL.findall(_script('tools/tools.js'))
        ],
        'Time': [
            (key, f'{name}: {more}' if more else name) for name, key, more in _TIME.findall(time)
        ],
        'Other keys': [(plain or text, does) for plain, text, does in _KEY.findall(others)],
    }


def tables() -> str:
    """Return the keys as tables of a document."""
    return '\n' + '\n'.join(
        f'**{title}**\n\n| key | action |\n|---|---|\n'
        + ''.join(f'| {key} | {does} |\n' for key, does in rows)
        for title, rows in keys().items()
    ) + '\n'  # fmt: skip


def write_pdf(path: Path) -> None:
    """Write strokes and keys as one page of A4; needs fpdf2, of the extra `docs`."""
    from fpdf import FPDF  # noqa: PLC0415 - only the site needs it
    from fpdf.svg import SVGObject  # noqa: PLC0415

    pdf = FPDF(orientation='landscape', format='A4')
    pdf.set_auto_page_break(auto=False)
    pdf.add_page()
    pdf.set_font('helvetica', 'B', 15)
    pdf.text(10, 13, 'physsim_ros: strokes and keys of the page')
    for i, (name, stroke, before) in enumerate(strokes()):
        row, column = divmod(i, 5)
        x, y = 10 + 56 * column, 18 + 30 * row
        picture = SVGObject(_svg(stroke, before))
        picture.transform_to_rect_viewport(1, 36, 24)
        with pdf.local_context():
            pdf.set_xy(x, y)
            picture.draw_to_page(pdf, x, y)
        pdf.set_font('helvetica', '', 9)
        pdf.text(x, y + 26, name)
    pdf.set_xy(10, 112)
    for x, width, rows in _columns():
        y = 114.0
        for key, does in rows:
            pdf.set_xy(x, y)
            pdf.set_font('helvetica', 'B', 8)
            pdf.multi_cell(19, 3.8, _latin(key))
            below = pdf.get_y()
            pdf.set_xy(x + 19, y)
            pdf.set_font('helvetica', '', 8)
            pdf.multi_cell(width - 21, 3.8, _latin(does), align='L')
            y = max(below, pdf.get_y())
    pdf.output(str(path))


def _columns() -> list[tuple[float, float, list[tuple[str, str]]]]:
    """Return place and width [mm] of four columns of keys."""
    groups = keys()
    tools, time, others = groups['Tools'], groups['Time'], groups['Other keys']
    middle = (len(tools) + 1) // 2
    return [
        (10, 56, tools[:middle]),
        (66, 56, tools[middle:]),
        (122, 56, time),
        (178, 110, others),
    ]


def _svg(stroke: str, before: str) -> str:
    style = 'fill="none" stroke-width="1.5" stroke-linecap="round" stroke-linejoin="round"'
    older = f'<path d="{before}" {style} stroke="#999999"/>' if before else ''
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" width="102" height="68" viewBox="0 0 60 40">'
        f'{older}<path d="{stroke}" {style} stroke="#1f5fbf"/></svg>'
    )


def _latin(text: str) -> str:
    """Return a text in the characters of the PDF's own fonts."""
    return text.replace('\N{MINUS SIGN}', '-').replace('\u2026', '...')


def _script(name: str) -> str:
    return (PAGE / name).read_text(encoding='utf-8')
