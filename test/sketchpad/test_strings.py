# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The texts of the page, and their translations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby
import json
from operator import itemgetter
from pathlib import Path
import re
from string import Formatter
from typing import Any

from physsim_ros.files import (
    check_world_name,
    load_world,
    OwnWorlds,
    shipped_lessons,
    shipped_worlds,
    title_of,
    worlds_in,
)
from physsim_ros.model import errors
from physsim_ros.model.joints import JointKind
from physsim_ros.model.settings import check_limit, WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.model.translation import Text
from physsim_ros.sketchpad.message import text_content
from physsim_ros.sketchpad.messages.fields import person
from physsim_ros.sketchpad.server.page_handlers import PAGE, PageFiles
import pytest

from .chromium import NOTE_TEXTS, OpenSheet, Sheet, WORLD
from .scripts import texts_of
from .templates import made_texts, NAMES, places_in, server_texts
from .test_locks import ATTEMPTS
from .test_locks import WORLD as LOCKED

LANGUAGES = sorted(PAGE.glob('languages/*.json'))
ENGLISH = PAGE / 'languages' / 'en.json'
SCRIPTS = sorted(PAGE.rglob('*.js'))
# Texts of HTML for people: those between tags, and attributes that are read out.
HTML = re.compile(r'>([^<>]*[a-z]{2}[^<>]*)<|(?:aria-label|alt|title|placeholder)="([^"]+)"')
# A text that looks like one for people: words beside each other, or a capital at the begin.
WORDS = re.compile(r'[A-Za-z]{2,} [A-Za-z(]|^\W*[A-Z][a-z]+')
# Strings that look like texts for people, and are none: names of files and keys, styles, queries,
# names of languages, errors for developers.
OTHER = re.compile(
    r"""\.js(on)?$ | system-ui | \((max|min)-width | ^[#.\[] | ^format: | ^Content-Type$ |
    ^(Escape|Enter|Tab|Delete|Backspace|Esc|Home|End|ContextMenu)$ |
    ^(Shift\+[A-Z]?|Ctrl\+[YZ]|[RN],\ Shift\+[RN])$ |
    ^(Arrow|Page|Key)[A-Z] | ^\^\(Arrow | ^W\ A\ S\ D | ^(Teacher|Rerun|Deutsch|English)$ |
    ^in\ the\ past$ | \[[NJ]\]$ |
    ^(cards\ lessons|row\ legend)$ |
    ^(another\ version\ of\ frames|the\ world\ of\ this\ link|no\ $|\ on\ this\ page$)""",
    re.VERBOSE,
)
# Every text of the page, each as its own translation, in brackets.
MARKED = '⟦{}⟧'


def html_texts(path: Path) -> set[str]:
    """Return the texts that an HTML file shows."""
    found = HTML.findall(path.read_text(encoding='utf-8'))
    return {(text or attribute).strip() for text, attribute in found}


def page_texts() -> set[str]:
    """Return all texts of the page that are translated."""
    texts = {
        text.text
        for path in SCRIPTS
        for text in texts_of(path.read_text(encoding='utf-8'))
        if text.translated
    }
    return texts.union(*map(html_texts, PAGE.glob('*.html')))


def shipped_texts() -> set[str]:
    """Return the texts of the lessons and of the worlds that ship with the package."""
    texts = set()
    for path in worlds_in(shipped_lessons()).values():
        lesson = load_world(path).lesson
        assert lesson is not None
        texts |= {lesson.title, lesson.question, lesson.hint, lesson.measure, lesson.answer}
        # Bodies are called by the stems of their names.
        texts |= {each.body.name.partition('/')[0] for each in load_world(path).bodies}
    for name, path in worlds_in(shipped_worlds()).items():
        heading = name.replace('_', ' ')
        texts |= {heading[0].upper() + heading[1:], title_of(path)}
    return texts


def test_a_browser_gets_every_text_of_a_script_in_its_line() -> None:
    for path in SCRIPTS:
        served = b''.join(PageFiles.get_content(str(path))).decode()
        assert [*texts_of(served)] == [*texts_of(path.read_text(encoding='utf-8'))], path
        assert served.startswith('// SPDX-License-Identifier')


@pytest.mark.parametrize('path', LANGUAGES, ids=lambda path: path.stem)
def test_a_language_has_every_text_and_no_other(path: Path) -> None:
    texts = json.loads(path.read_text(encoding='utf-8'))['texts']
    assert sorted(texts) == sorted(() if path == ENGLISH else page_texts() | shipped_texts())
    for text, translation in texts.items():
        values = re.findall(r'\{\w+\}', text)
        assert sorted(values) == sorted(re.findall(r'\{\w+\}', translation)), text


def test_each_text_has_the_values_of_its_template() -> None:
    # Else it could not be made; one that another language alone tells may be further.
    unfilled = {
        f'{each.place}: {each.template}'
        for each in made_texts()
        if '**' not in each.values and not places_in(each.template) <= each.values
    }
    assert unfilled == set()


@pytest.mark.parametrize('path', LANGUAGES, ids=lambda path: path.stem)
def test_a_language_tells_every_text_of_the_server_by_its_values(path: Path) -> None:
    told, texts = json.loads(path.read_text(encoding='utf-8'))['server'], server_texts()
    # A page in English says the text itself, where it has no other words.
    assert told.keys() <= texts.keys()
    assert path == ENGLISH or texts.keys() - told.keys() <= NAMES
    made = [(each.template, each.values) for each in made_texts() if '**' not in each.values]
    for template, values in [*texts.items(), *made]:
        # Of a value with a capital, which begins a sentence, the name has a small one.
        asked = {each[0].lower() + each[1:] for each in places_in(told.get(template, ''))}
        assert asked <= values, template


def test_no_value_is_a_text_that_a_language_would_have_to_tell() -> None:
    # A value of several words would stand in a sentence of another language as it is.
    left = {
        f'{each.place}: {value}'
        for each in made_texts()
        for value in each.words
        if WORDS.search(value)
    }
    assert left == set()


@pytest.mark.parametrize('path', LANGUAGES, ids=lambda path: path.stem)
def test_a_language_tells_every_refusal(path: Path) -> None:
    codes = {
        each.code
        for each in vars(errors).values()
        if isinstance(each, type) and issubclass(each, errors.Refusal)
    }
    refusals = json.loads(path.read_text(encoding='utf-8'))['refusals']
    # Refused by the server of the page, or by the reader of drawings.
    assert path == ENGLISH or codes <= refusals.keys()
    assert all(set(re.findall(r'\{(\w+)\}', each)) <= {'message'} for each in refusals.values())


@pytest.mark.parametrize('path', SCRIPTS, ids=lambda path: path.name)
def test_no_text_for_people_is_left_in_a_script(path: Path) -> None:
    left = [
        f'line {text.line}: {text.text}'
        for text in texts_of(path.read_text(encoding='utf-8'))
        if not text.translated and WORDS.search(text.text) and not OTHER.search(text.text)
    ]
    # Such a text is written t('…'), and has a translation in each file of languages/.
    assert left == []


# Texts and attributes that people read, of what is on the page now, and texts on its canvases.
SEEN = """() => {
    const texts = [...new Set(window.texts)];
    for (const element of document.querySelectorAll('body *')) {
        for (const name of ['aria-label', 'title', 'placeholder', 'alt', 'aria-valuetext']) {
            texts.push(element.getAttribute(name) ?? '');
        }
        for (const node of element.childNodes) {
            if (node.nodeType === Node.TEXT_NODE) texts.push(node.nodeValue);
        }
    }
    return texts;
}"""
# Words that no language translates: names of bodies and worlds, units, keys, names of languages.
NAMED = re.compile(
    r"""\b(ball|box|shelf)/\d | \b(Deutsch|English|Enter|Rerun|physsim|QR)\b |
    \b(kg|rad|Ctrl|Shift|vx|vy|px|py|ax|ay)\b | \(\w+(\+\w+)?\) | \bW\ A\ S\ D\b""",
    re.VERBOSE,
)


@pytest.fixture
def marked(open_sheet: OpenSheet, address: str) -> Sheet:
    """Give a test a page in a language in which each text is its own translation, marked."""
    sheet = open_sheet('about:blank', locale='de-DE')
    texts = {text: MARKED.format(text) for text in page_texts() | shipped_texts()}
    said = {each: each for each in server_texts()}
    said |= json.loads(ENGLISH.read_text(encoding='utf-8'))['server']
    said = {each: text and MARKED.format(text) for each, text in said.items()}
    table = json.dumps({'texts': texts, 'server': said, 'refusals': {}})
    sheet.context.add_init_script(f'({NOTE_TEXTS})()')
    sheet.page.route('**/languages/de.json', lambda route: route.fulfill(body=table))
    sheet.page.goto(address)
    sheet.wait('heard.people && Object.keys(physsim.bodies).length === 3')
    return sheet


def press(sheet: Sheet, name: str) -> None:
    sheet.press(MARKED.format(name))


def unmarked(sheet: Sheet, texts: str = SEEN) -> set[str]:
    """Return the texts of the page that do not come from its table."""
    left = set()
    for text in sheet.page.evaluate(texts):
        if re.search(r'[A-Za-z]{2,}', NAMED.sub('', left_over(text))):
            left.add(text)
    return left


def left_over(text: str) -> str:
    """Return the parts of a text that do not come from the table."""
    # A text may stand in another one, and a phrase takes the bracket after it for its name.
    while '⟦' in text:
        text = re.sub(r'⟦[^⟦⟧]*(⟧|$)', '', text)
    return text


def test_all_that_the_page_shows_comes_from_its_table(marked: Sheet) -> None:
    press(marked, 'Pause')
    press(marked, 'Show velocities')
    press(marked, 'Show forces')
    press(marked, 'Hand')
    marked.tap(*marked.pose('ball/0')[:2])
    marked.page.get_by_text(MARKED.format('Label')).wait_for()
    press(marked, 'Large plot')
    assert unmarked(marked) == set()
    press(marked, 'Close the plot')
    for panel in ('Material', 'Measure'):
        press(marked, panel)
        assert unmarked(marked) == set()
    for dialog in ('Help', 'Save'):
        press(marked, dialog)
        assert unmarked(marked) == set()
        marked.page.keyboard.press('Escape')


# Texts that the page has told since then, and phrases of what can be undone.
TOLD = """() => {
    window.told = new Set();
    const watch = (element, tell) => new MutationObserver(() => window.told.add(tell(element)))
        .observe(element, {attributes: true, childList: true});
    watch(document.getElementById('status'), ({textContent}) => textContent);
    watch(document.querySelector('#edit button'), ({title}) => title);
}"""


def test_all_that_the_page_tells_comes_from_its_table(marked: Sheet) -> None:
    press(marked, 'Pause')
    marked.page.evaluate(TOLD)
    for tool, *points in (
        ('Circle', (-3.0, 6.0), (-2.5, 6.0)),
        ('Rectangle', (0.0, 5.0), (2.0, 5.0), (2.0, 7.0)),
        ('Spring', (-3.0, 6.0), (1.0, 6.0)),
        ('Axle', (-3.0, 6.0)),
        ('Velocity', (1.0, 6.0), (2.0, 6.0)),
        ('Force', (1.0, 6.0), (2.0, 6.0)),
        ('Knife', (-1.0, 6.2), (3.0, 6.4)),
    ):
        press(marked, tool)
        before = marked.page.evaluate('window.told.size')
        for point in points:
            marked.tap(*point)
        marked.wait('before => window.told.size > before + 1', before)
    press(marked, 'Undo')
    press(marked, 'Lasso')
    marked.drag((-5.0, 4.0), (4.0, 4.0), (4.0, 8.0), (-5.0, 8.0), (-5.0, 4.0))
    for button in ('Bottom', 'Copy beside'):
        press(marked, button)
    press(marked, 'Undo')
    press(marked, 'Undo')
    marked.wait('[...window.told].some((text) => /Undone.*several bodies/.test(text))')
    press(marked, 'Measure')
    marked.page.get_by_label(MARKED.format('Stops when touched')).select_option('ball/0')
    press(marked, 'Reset')
    marked.wait('Object.keys(physsim.bodies).length === 3')
    assert unmarked(marked, '() => [...window.told]') == set()


# This script sends messages, and returns the page's sentences for what was done, or refused, and
# its phrases for what can be undone.
CROSSED = """async ([world, attempts, done, after]) => {
    const {Words} = await import('/page/words.js');
    const heard = {}, told = new Set(), waiting = new Map();
    const words = new Words({on: (type, hear) => { heard[type] = hear; }});
    const socket = new WebSocket(`ws://${location.host}/ws`);
    socket.binaryType = 'arraybuffer';
    socket.onmessage = ({data}) => {
        const message = typeof data === 'string' ? JSON.parse(data) : {};
        if (message.type in heard) heard[message.type](message);
        if (message.type === 'timeline') {
            told.add(words.say(message.undo_text));
        }
        if (message.type !== 'answer' || !message.request) return;
        if (message.ok === done) told.add(words.sayAnswer(message));
        waiting.get(message.request)?.();
    };
    await new Promise((resolve) => { socket.onopen = resolve; });
    const ask = (id, message) => new Promise((resolve) => {
        waiting.set(id, resolve);
        socket.send(JSON.stringify({...message, id}));
    });
    for (const [i, messages] of attempts.entries()) {
        await fetch('/world', {method: 'POST', body: world});
        for (const [j, message] of messages.entries()) await ask(`${i} ${j}`, message);
        await ask(`${i} undo`, {type: 'service', name: 'undo'});
    }
    await fetch('/world', {method: 'POST', body: after});
    socket.close();
    return [...told];
}"""
# Kinds that are answered only where they are refused.
SILENT = {'move', 'drive'}
# Tools of which a page has no button.
NO_BUTTON = {'none'}


@pytest.mark.slow
def test_all_that_is_answered_to_a_message_comes_from_the_table(marked: Sheet) -> None:
    press(marked, 'Pause')
    attempts = [
        [{'type': kind, **fields} for fields in tries]
        for kind, tries in ATTEMPTS.items()
        if kind not in (*SILENT, 'click')
    ]
    clicks = [{'type': 'click', **fields} for fields in ATTEMPTS['click']]
    tools = groupby(clicks, itemgetter('tool'))
    attempts += [list(gestures)[:3] for tool, gestures in tools if tool not in NO_BUTTON]
    told = marked.page.evaluate(CROSSED, [LOCKED, attempts, True, WORLD])
    assert len(told) > 60
    assert not {text for text in told if re.search(r'[a-z]{2}', left_over(text))}


MACHINE = """
format: 1
bodies:
- {name: a/0, circle: {radius: 0.5}, at: [0, 5]}
- {name: a/1, circle: {radius: 0.5}, at: [1, 5]}
- {name: a/2, circle: {radius: 1}, at: [9, 2], anchored: true, sensor: true, medium: {density: 2}}
joints:
- {name: spring/0, kind: spring, a: a/0, b: a/1, points: [[0, 5], [1, 5]]}
- {name: rope/0, kind: rope, a: a/0, b: a/1, points: [[0, 5], [1, 5]]}
- {name: slider/0, kind: slider, a: a/1, points: [[1, 5], [2, 5]]}
- {name: axle/0, kind: axle, a: a/0, points: [[0, 5]]}
- {name: motor/0, kind: motor, a: a/1, points: [[1, 5]]}
- {name: gear/0, kind: gear, a: a/0, b: a/1, points: [[0.5, 5]], ratio: -1}
"""
# Numbers that the panel has fields for, by what they are of.
OF_BODIES = [
    'mass',
    'density',
    'friction',
    'elasticity',
    'spin',
    'belt',
    'rolling_resistance',
    'charge',
]
OF_WATER = ['density', 'viscosity', 'gusts']
OF_AIR = ['damping', 'air_density', 'air_viscosity', 'gusts', 'gravitation']
OF_JOINTS = {
    'spring/0': ['stiffness', 'rest_length', 'damping', 'break_force'],
    'rope/0': ['length', 'rate', 'max_force'],
    'slider/0': ['rate', 'friction', 'lower', 'upper'],
    'axle/0': ['stiffness', 'rest_angle', 'damping', 'lower'],
    'motor/0': ['rate', 'max_torque'],
    'gear/0': ['ratio'],
}


def typed(number: float) -> Iterator[dict[str, Any]]:
    """Give messages of a page in each of whose fields that number was typed."""
    bodies: list[dict[str, Any]] = [{key: number} for key in OF_BODIES]
    bodies += [{'at': [number, 5, 0]}, {'at': [0, 5, number]}, {'velocity': [number, 0]}]
    bodies += [{'forces': [{'force': [number, 0]}]}, {'label': 'x' * 201}]
    for properties in bodies:
        yield {'type': 'change', 'name': 'a/0', 'properties': properties}
    for medium in ({'density': 1, key: number} for key in OF_WATER):
        yield {'type': 'change', 'name': 'a/2', 'properties': {'medium': medium}}
    for name, keys in OF_JOINTS.items():
        for key in keys:
            yield {'type': 'change_joint', 'name': name, 'properties': {key: number}}
    for key in OF_AIR:
        yield {'type': 'air', key: number}
    yield {'type': 'air', 'wind': [number, 0]}
    yield {'type': 'gravity', 'gravity': [0, number]}
    yield {'type': 'change_joint', 'name': 'slider/0', 'properties': {'lower': 2, 'upper': 1}}
    yield {'type': 'move_bodies', 'names': ['a/0'], 'by': [number, 0]}
    yield {'type': 'copy_machine', 'names': ['a/0'], 'by': [number, 0]}
    yield {'type': 'open', 'name': 'nowhere'}


@pytest.mark.slow
def test_what_is_wrong_with_a_number_that_was_typed_comes_from_the_table(marked: Sheet) -> None:
    press(marked, 'Pause')
    messages = [message for number in (-1e300, -1, 0, 1e-9, 1e300) for message in typed(number)]
    told = marked.page.evaluate(CROSSED, [MACHINE, [messages], False, WORLD])
    assert len(told) > 20
    units = re.compile(r'(?<=\d )(m|m/s|m/s²|N)$')
    assert not {text for text in told if re.search('[a-z]{2}', units.sub('', left_over(text)))}


def test_a_page_is_in_the_language_of_the_browser_until_another_is_chosen(
    open_sheet: OpenSheet,
) -> None:
    sheet = open_sheet(locale='de-DE')
    sheet.wait('heard.people && Object.keys(physsim.bodies).length === 3')
    assert sheet.page.locator('html').get_attribute('lang') == 'de'
    sheet.press('Pause')
    sheet.press('Befestigen')
    sheet.tap(-2.0, 6.0)
    sheet.told('Hier ist kein Körper', exact=True)
    sheet.press('Hilfe')
    sheet.page.get_by_label('Sprache').select_option('English')
    sheet.page.get_by_role('button', name='Anchor', exact=True).wait_for()
    assert sheet.page.locator('html').get_attribute('lang') == 'en'


SAID = """async (texts) => {
    const {said} = await import('/page/strings.js');
    return texts.map((text) => said(text));
}"""
SENTENCES = """async (texts) => {
    const {Words} = await import('/page/words.js'), words = new Words({on() {}});
    return texts.map((text) => words.say(text));
}"""


def test_numbers_have_the_decimal_sign_of_a_language_and_names_stay(open_sheet: OpenSheet) -> None:
    texts = []
    for template, names in server_texts().items():
        formats = {name: each for _, name, each, _ in Formatter().parse(template) if name}
        numbers = {name for name in names if formats.get(name) or name == 'time'}
        values = {name: '2.5 s' if name in numbers else 'v2.5/1' for name in sorted(names)}
        texts.append([template, values])
    sheet = open_sheet(locale='de-DE')
    said = ' '.join(sheet.page.evaluate(SENTENCES, texts))
    assert {*re.findall(r'v\d.\d/1', said)} == {'v2.5/1'}
    assert {*re.findall(r'(?<!v)\d[.,]\d', said)} == {'2,5'}


CROWDED = WorldSettings(max_bodies=1, max_shapes=1, max_joints=1)


def test_details_of_what_a_person_can_do_wrong_are_in_german(open_sheet: OpenSheet) -> None:
    refused: dict[str, Callable[[], object]] = {
        'höchstens 1 Körper': lambda: check_limit('max_bodies', 2, CROWDED),
        'höchstens 1 Teile von Körpern': lambda: check_limit('max_shapes', 2, CROWDED),
        'höchstens 1 Verbindungen': lambda: check_limit('max_joints', 2, CROWDED),
        '1e-06 liegt nicht zwischen 0,001 und 100000': lambda: Disc(radius=1e-6),
        'ein Name hat 1 bis 64 Zeichen': lambda: check_world_name('x' * 65),
        'ein Name hat 1 bis 24 Zeichen': lambda: person('', 'name'),
        'ein Name hat weder „/“ noch „.“': lambda: check_world_name('a/b'),
        'keine Welt heißt mine': lambda: OwnWorlds(Path('/nowhere')).delete('mine'),
    }
    texts = []
    for refuse in refused.values():
        with pytest.raises(errors.Refusal) as caught:
            refuse()
        texts.append(text_content(caught.value.text))
    sheet = open_sheet(locale='de-DE')
    assert sheet.page.evaluate(SAID, texts) == [*refused]


# The sentences of a page for refusals, each a code and a text.
REFUSED = """async (refusals) => {
    const {refusalText, said} = await import('/page/strings.js');
    return refusals.map(([code, text]) => refusalText(code, said(text), text[0]));
}"""


def test_a_refusal_has_its_own_sentence_where_that_is_translated(open_sheet: OpenSheet) -> None:
    robot = Text('{body} is a robot, a part of one or an actor, which no knife cuts', body='a/0')
    refused = {
        'Roboter und Akteure schneidet kein Messer': errors.NothingThere(robot),
        'Hier ist kein Körper': errors.NothingThere('it has no translation'),
        'Ungültige Angabe: ein Name hat 1 bis 9 Zeichen': errors.Malformed(
            Text('a name has at most {most} characters', most='9')
        ),
        'Die Welt ist voll: it has no translation': errors.WorldFull('it has no translation'),
    }
    texts = [[each.code, text_content(each.text)] for each in refused.values()]
    sheet = open_sheet(locale='de-DE')
    assert sheet.page.evaluate(REFUSED, texts) == [*refused]


# The body of a wrong world file, and what a German page says of it.
WRONG_BODIES = [
    ('circle: {radius: 1}, att: 1', "att: den Schlüssel 'att' gibt es nicht, aber 'at'"),
    ('circle: {radius: 1}, zebra: 1', "zebra: den Schlüssel 'zebra' gibt es nicht"),
    ('circle: {radius: -1}', 'radius: -1 liegt nicht zwischen 0,001 und 100000'),
    ('box: {width: 1}', 'height: height fehlt'),
    ('friction: 1', 'shape: ihm fehlt eines von circle, box, polygon, chain, triangles, compound'),
    ('circle: {radius: 1}, mass: heavy', "mass: mass ist 'heavy'; nötig ist eine Zahl"),
    ('circle: {radius: 1}, anchored: 2', 'anchored: anchored ist 2; nötig ist true oder false'),
    ('circle: {radius: 1}}, {name: a/0, circle: {radius: 1}', 'name: der Name kommt zweimal vor'),
]
# Other wrong files.
AXLE = 'joints: [{name: j/0, kind: axle, a: b/0, points: [[0, 0]]}]'
WRONG_FILES = [
    ('format: 1\nbodies: [', 'Zeile 2 ist kein YAML'),
    ('hello', 'sie hat keine Schlüssel mit Werten'),
    ('format: 9', '„format: 1“ fehlt'),
    (f'format: 1\n{AXLE}', "Verbindung 'j/0', a: den Körper 'b/0' gibt es nicht"),
    (
        f'format: 1\n{AXLE}'.replace('axle', 'glue'),
        "Verbindung 'j/0', kind: die Art 'glue' gibt es nicht; es gibt "
        + ', '.join(kind for kind in JointKind),
    ),
    ('format: 1\ngravity: 5', 'gravity ist keine Liste von 2 Zahlen'),
    *(
        (f'format: 1\nbodies: [{{name: a/0, {body}}}]', f"Körper 'a/0', {wrong}")
        for body, wrong in WRONG_BODIES
    ),
]
# The sentences of a page for the refusals of files.
OF_FILES = """async (files) => {
    const {said} = await import('/page/strings.js'), texts = [];
    for (const body of files) {
        const response = await fetch('/world', {method: 'POST', body});
        texts.push(said((await response.json()).text));
    }
    return texts;
}"""


def test_what_is_wrong_with_a_world_file_is_told_in_german(
    open_sheet: OpenSheet, tmp_path: Path
) -> None:
    sheet = open_sheet(locale='de-DE')
    sheet.wait('heard.people && Object.keys(physsim.bodies).length > 0')
    files, wrong = zip(*WRONG_FILES, strict=True)
    assert sheet.page.evaluate(OF_FILES, files) == list(wrong)
    path = tmp_path / 'wrong.yaml'
    path.write_text('format: 1\nbodies: [{name: a/0, circle: {radius: -1}}]')
    sheet.press('Welten')
    sheet.page.get_by_label('Datei öffnen').set_input_files(path)
    told = "Diese Weltdatei ist fehlerhaft: Körper 'a/0', radius: -1 liegt nicht zwischen 0,001"
    sheet.told(told)
    # A browser notes each refused request.
    sheet.errors.clear()


def test_a_german_page_has_its_lessons_worlds_and_numbers_in_german(open_sheet: OpenSheet) -> None:
    sheet = open_sheet(locale='de-DE')
    sheet.wait('heard.people && Object.keys(physsim.bodies).length === 3')
    sheet.press('Welten')
    sheet.page.get_by_role('button', name='Kugelstoß\xadpendel').wait_for()
    sheet.page.locator('.lessons').get_by_role('button', name='5. Reibung').click()
    card = sheet.page.locator('#lesson')
    card.get_by_text('Die Reibungszahl ist 0,4.').wait_for()
    sheet.told('Reibung geöffnet')
    sheet.page.get_by_role('textbox', name='Deine Antwort').fill('3,2')
    sheet.press('Prüfen')
    card.get_by_text('Richtig!').wait_for()
    card.get_by_text('= 3,19 m').wait_for()
    sheet.page.get_by_label('Uhr').get_by_text('0,00 s').wait_for()
    sheet.wait('"block/0" in physsim.bodies')
    sheet.press('Hand')
    sheet.tap(*sheet.pose('block/0')[:2])
    panel = sheet.page.get_by_role('complementary')
    panel.get_by_role('heading', name='Block', exact=True).wait_for()
    sheet.page.get_by_text('Zahlen eingeben').click()
    for typed, shown in (('0,75', 'bei (0 | 0,75) m'), ('1.5', 'bei (0 | 1,50) m')):
        sheet.enter('y [m]', typed, exact=True)
        sheet.page.locator('.numbers').get_by_text(shown).wait_for()
    assert sheet.page.get_by_label('Reibung, als Zahl').input_value() == '0,4'
    sheet.enter('Stoßzahl, als Zahl', '1,5')
    refused = 'nicht möglich: 1,5 liegt nicht zwischen 0 und 1'
    sheet.told(refused)
    sheet.enter('Reibung, als Zahl', 'viel')
    assert sheet.page.get_by_label('Reibung, als Zahl').input_value() == '0,4'
    # As spreadsheets in German read it.
    sheet.press('Abspielen')
    sheet.wait('physsim.records["block/0"][0] > 2')
    sheet.press('Pause')
    with sheet.page.expect_download() as download:
        sheet.press('Tabelle (CSV)')
    # Spreadsheets read umlauts by the mark at the beginning.
    text = download.value.path().read_text()
    assert text.startswith('\ufeff')
    head, first, *_ = text[1:].splitlines()
    assert head.startswith('Zeit [s];x [m];Höhe [m];')
    assert re.fullmatch(r'[^;.]*(;[^;.]*)+;block/0', first)
    assert ',' in first
    other = sheet.context.new_page()
    other.goto(sheet.page.url)
    sheet.press('Personen')
    sheet.page.locator('.people').get_by_text(re.compile(r'Seite \d+ \(du\)')).wait_for()


def test_no_key_of_a_tool_has_another_meaning() -> None:
    table = (PAGE / 'input' / 'keyboard.js').read_text().partition('this.keys = {')[2]
    taken = re.findall(r"(?:^|, |\s)'?(\S)'?: (?:\(|call)", table.partition('};')[0])
    tools = re.findall(
        r"tool\('\w+', t\('[^']+'\), '(?:Shift\+)?(.)'", (PAGE / 'tools' / 'tools.js').read_text()
    )
    assert {'7', '6', 'f', 'J'} <= set(taken)
    assert len(tools) > 25
    assert len({*tools, *taken}) == len(tools) + len(taken)
