# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages of a class: names of people, their own undo, and what a teacher alone may do."""

from __future__ import annotations

import itertools
import re

from physsim_ros.model.checks import flag, Whole
from physsim_ros.model.errors import BadProperty, NothingThere
from physsim_ros.model.lesson import LONGEST_TITLE
from physsim_ros.model.requests import DeleteBodies
from physsim_ros.model.translation import Text
from physsim_ros.simulation.entries import Origin, TakeBack, Unread
from physsim_ros.sketchpad.locks import check_taken_back, locks_of
from physsim_ros.sketchpad.message import message
from physsim_ros.sketchpad.messages import fields
from physsim_ros.sketchpad.messages.files import reaching
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.person import author_of, TEACHER, UNNAMED
from physsim_ros.sketchpad.rights import Right, Role

# Lengths of an answer to a lesson and of a message to all [characters]; the rest is left out.
LONGEST_ANSWER, LONGEST_MESSAGE = 24, 200


def _patterns(value: object, name: str) -> tuple[str, ...]:
    """Return names of bodies, or patterns of them; there may be none."""
    patterns = fields.names(value, name) if value != [] else ()
    if any(',' in each for each in patterns):
        raise BadProperty('a name in {field} has no comma', field=name)
    # Compiled here, on the server's thread.
    locks_of(patterns)
    return patterns


def _title(value: object, name: str) -> str:
    """Return the title of a lesson."""
    title = fields.text(value, name)
    if len(title) > LONGEST_TITLE:
        raise BadProperty(
            '{field} has more than {most} characters', field=name, most=LONGEST_TITLE
        )
    return title


@message('person', 'page', Right.DRAW, name=fields.person)
def choose_name(page: PageSession, origin: Origin, name: str) -> None:
    """Choose the name of the person at this page."""
    if name != page.person.unnamed and re.fullmatch(rf'{UNNAMED}\d+|{TEACHER}', name):
        raise BadProperty('{name} may be another person, who has no name', field='name', name=name)
    page.person.name = name
    # A page that was loaded again does not know.
    page.person.answered = page.shared.results.last_of(name)
    page.answer_page(origin, Text('you are {person}', person=name))


@message('answered', 'page', Right.DRAW, lesson=_title, answer=fields.text, right=flag)
def note_answer(
    page: PageSession, origin: Origin, lesson: str, answer: str, *, right: bool
) -> None:
    """Note an answer to a lesson, which a teacher sees."""
    name = page.person.name

    def note() -> Text:
        with reaching('the results'):
            page.person.answered = page.shared.results.note(
                name, lesson, answer[:LONGEST_ANSWER], right=right, visitor=page.person.unnamed
            )
        return Text('the answer is noted')

    page.answer_from_thread(origin, note)


@message('forget_results', 'page', Right.TEACH)
def forget_results(page: PageSession, origin: Origin) -> None:
    """Forget the results of lessons in this world."""

    def forget() -> Text:
        with reaching('the results'):
            page.shared.results.forget()
        return Text('the results are forgotten')

    page.answer_from_thread(origin, forget)


@message('raise_hand', 'page', Right.DRAW, raised=flag)
def raise_hand(page: PageSession, origin: Origin, *, raised: bool) -> None:
    """Raise a hand, or lower it."""
    page.person.raised = raised
    page.answer_page(origin, Text('your hand is raised' if raised else 'your hand is down'))


@message('lower_hand', 'page', Right.TEACH, page=Whole(1, 2**31))
def lower_hand(session: PageSession, origin: Origin, page: int) -> None:
    """Have the page of a number lower its hand."""
    session.shared.send({'type': 'lower_hand'}, page)
    session.answer_page(origin, Text('the hand is lowered'))


@message('leave', 'page', Right.TEACH)
def leave(page: PageSession, origin: Origin) -> None:
    """Have the pupils who have come until now leave this world, as their seat is free."""
    page.shared.ask_to_leave()
    page.answer_page(origin, Text('pupils have left this world'))


@message('say', 'page', Right.TEACH, text=fields.text)
def say(page: PageSession, origin: Origin, text: str) -> None:
    """Show a message on all pages of this world."""
    page.send_all({'type': 'said', 'name': page.person.name, 'text': text[:LONGEST_MESSAGE]})
    page.answer_page(origin, Text('the message is shown'))


@message('take_back', '~/undo')
def take_back(page: PageSession, origin: Origin) -> None:
    """Undo the last gesture of the person at this page, where it stands alone; time stays."""
    simulation = page.control.simulation

    def check() -> None:
        origin.check()
        last = simulation.past.line.last_gesture_of(origin.author)
        gestures, snapshot = () if last is None else (last.gesture,), simulation.world.snapshot()
        check_taken_back(page.role, gestures, snapshot, page.control)

    # Requests that wait before it may add a gesture of this person, or take one back.
    simulation.requests.submit(TakeBack(), origin._replace(check=check))


@message('freeze', 'page', Right.TEACH, frozen=flag)
def freeze(page: PageSession, origin: Origin, *, frozen: bool) -> None:
    """Freeze the pages of pupils, or free them."""
    page.control.set_parameter('sketchpad_frozen', frozen)
    told = Text('the pages are frozen' if frozen else 'the pages are no longer frozen')
    page.answer_page(origin, told)


@message('lock', 'page', Right.TEACH, names=_patterns)
def lock(page: PageSession, origin: Origin, names: tuple[str, ...]) -> None:
    """Lock bodies, so that pages of pupils do not change them, in place of those before."""
    page.control.set_parameter('sketchpad_locked', ','.join(names))
    locked = Text('locked {names}', names=', '.join(names))
    page.answer_page(origin, locked if names else Text('no body is locked'))


@message('clear_of', '~/command', Right.TEACH, person=fields.person)
def clear_of(page: PageSession, origin: Origin, person: str) -> None:
    """Delete the bodies and joints that a person has added since the beginning of the history."""

    def deletion() -> DeleteBodies:
        past = page.control.simulation.past
        added = [past.added_by(author_of(person, role)) for role in (Role.DRAW, Role.TEACH)]
        bodies, joints = (tuple(itertools.chain(*each)) for each in zip(*added, strict=True))
        if not bodies and not joints:
            raise NothingThere('there is nothing of {person}', field='person', person=person)
        return DeleteBodies(names=bodies, joints=joints)

    # Requests that wait may add some.
    page.control.simulation.requests.submit(Unread('', deletion), origin)
