# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages about time and whole worlds: services, speed, seeking, courses and files."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from physsim_ros.files import check_world_name, load_mapping, on_thread, text_of
from physsim_ros.model.answer import Answer
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import flag, LONGEST, number, shown, Whole, Within
from physsim_ros.model.errors import BadProperty, BadWorldFile, Failed, Refusal
from physsim_ros.model.translation import Text
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import in_slices, Sliced, with_checks
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.sketchpad.locks import check_moment, has_locks
from physsim_ros.sketchpad.message import answer_content, message, Optional, request_of
from physsim_ros.sketchpad.messages import fields
from physsim_ros.sketchpad.messages.files import reaching
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.rights import Right
from physsim_ros.sketchpad.world_control import open_content

# Names of the services that a page may call.
ACTIONS = (
    'play',
    'pause',
    'rewind',
    'fast_forward',
    'fast_rewind',
    'step',
    'undo',
    'redo',
    'reset',
    'clear',
    'save_world',
    'load_world',
)
# Length of a world that a page may have as text [characters].
MOST_SHARED = 2**20
# Length of a world that a page may send as text [characters]; a message has up to 1 MiB.
MOST_SENT = 2**19


def _action(value: object, name: str) -> str:
    if value not in ACTIONS:
        raise BadProperty('there is no service {value}', field=name, value=shown(value))
    return str(value)


def _stamp(value: object, name: str) -> int:
    """Return a simulation time in [ns], which is given in [s]."""
    return round(Within(0.0, LONGEST, 's')(value, name) * 1e9)


def _world_name(value: object, name: str) -> str:
    checked = fields.text(value, name)
    if not checked:
        raise BadProperty('a world has a name', field=name)
    return checked


def _world_text(value: object, name: str) -> str:
    if not isinstance(value, str) or len(value) > MOST_SENT:
        raise BadProperty(
            '{field} must be text of at most {most} characters', field=name, most=MOST_SENT
        )
    return value


# Time


@message('service', 'page', name=_action, world=Optional(fields.text))
def service(page: PageSession, origin: Origin, name: str, world: str = '') -> None:
    """Perform the action of a service, on the world file of a name where one is given."""
    origin = origin._replace(topic=f'~/{name}')
    action, wait = page.control.services[name]
    if world:
        of_files = {'load_world': page.control.load_world, 'save_world': page.control.save_world}
        if name not in of_files:
            raise BadWorldFile('~/{name} takes no world', field='world', name=name)
        action = partial(of_files[name], world)
    if name == 'save_world':
        page.perform(origin, partial(_saving, page, action), wait)
    elif name in ('clear', 'load_world', 'reset', 'undo', 'redo'):
        _replace_bodies(page, origin, action, wait)
    else:
        page.perform(origin, action, wait)


def _replace_bodies(page: PageSession, origin: Origin, action: Sliced[Text], wait: Wait) -> None:
    """Perform an action unless pages are frozen, or a body locked, be it in a later slice."""
    check = partial(check_moment, page.role, page.control)
    if has_locks(page.role, page.control):
        # The check reads the world.
        wait = Wait.FOR_SEEK
    page.perform(origin, partial(with_checks, action, check), wait)


@message('speed', '~/speed', speed=number)
def set_speed(page: PageSession, origin: Origin, speed: float) -> None:
    """Set the speed of time [simulation seconds a second]."""
    page.perform(origin, partial(page.control.time.set_speed, speed))


@message('seek', '~/seek', time=_stamp)
def seek(page: PageSession, origin: Origin, time: int) -> None:
    """Go to a simulation time, which a message has in [s] and the function in [ns]."""
    page.control.time.submit_seek(time, origin)


@message('course', '~/timeline', course=Whole(0, 2**31))
def return_to_course(page: PageSession, origin: Origin, course: int) -> None:
    """Return to a course of events that was left, by its number."""
    action = partial(page.control.simulation.return_to_course, course)
    _replace_bodies(page, origin, action, Wait.BEHIND_REQUESTS)


# World files


@message('open', '~/load_world', name=_world_name)
def open_world(page: PageSession, origin: Origin, name: str) -> None:
    """Begin with a world at time 0, which undo reverts."""
    _replace_bodies(page, origin, partial(page.control.open_world, name), Wait.FOR_SEEK)


@message('save', '~/save_world', name=_world_name, replace=Optional(flag))
def save_world(page: PageSession, origin: Origin, name: str, *, replace: bool = False) -> None:
    """
    Save the world under a name that is free.

    :param replace: whether an own world of that name may be written over, and kept
    """

    async def save() -> Text:
        with reaching(name):
            page.shared.own_worlds.check_free(check_world_name(name), replace=replace)
        return await page.control.save_world(name)

    page.perform(origin, partial(_saving, page, save), Wait.TO_READ)


async def _saving(page: PageSession, save: Sliced[Text]) -> Text:
    """Save the world, note that it is saved, and return the message about it."""
    scene = page.control.simulation.world.scene
    done = await in_slices(save)
    page.shared.autosave.note_saved(scene)
    page.shared.list_worlds(None)
    return done


@message('rename', 'page', name=_world_name, to=fields.text)
def rename(page: PageSession, origin: Origin, name: str, to: str) -> None:
    """Rename an own world."""
    _manage(page, origin, partial(page.shared.own_worlds.rename, name, to), name)


@message('remove', 'page', name=_world_name)
def remove(page: PageSession, origin: Origin, name: str) -> None:
    """Delete an own world, which is kept aside."""
    _manage(page, origin, partial(page.shared.own_worlds.delete, name), name)


@message('put_back', 'page', name=_world_name)
def put_back(page: PageSession, origin: Origin, name: str) -> None:
    """Put back the own world that was deleted or written over last."""
    _manage(page, origin, partial(page.shared.own_worlds.put_back, name), name)


@message('forget', 'page')
def forget(page: PageSession, origin: Origin) -> None:
    """Delete the unsaved world of the last start."""
    _manage(page, origin, page.shared.autosave.forget_unsaved, 'the unsaved world')


def _manage(page: PageSession, origin: Origin, action: Callable[[], Text], name: str) -> None:
    """Change the files of own worlds, and send all pages the list."""

    def manage() -> Text:
        with reaching(name):
            done = action()
        page.shared.list_worlds(None)
        return done

    page.perform(origin, partial(page.shared.file_work.do, manage))


@message('open_text', '~/load_world', Right.TEACH, world=_world_text)
def open_text(page: PageSession, origin: Origin, world: str) -> None:
    """Begin with the world of a text, as that of a run, at time 0, which undo reverts."""

    async def load() -> Text:
        # YAML of a megabyte takes a second to be read, and some a dozen.
        content = await on_thread(partial(load_mapping, world, field='world'))
        return await open_content(page.control.simulation, content)

    page.perform(origin, load, Wait.FOR_SEEK)


@message('share', '~/save_world', Right.DRAW, run=Optional(flag))
def share(page: PageSession, origin: Origin, *, run: bool = False) -> None:
    """
    Send this page the world as the text of a world file.

    :param run: whether as this run began, after the last change, so that it can be replayed
    """

    async def send_text() -> list[Answer]:
        boundary, simulation = page.control.boundary, page.control.simulation
        try:
            with boundary.message(origin.topic):
                saved = simulation.saver_of_run() if run else simulation.saver()
        except Failed as failed:
            page.refuse(origin, failed)
        else:
            write = partial(_text_content, origin, saved, simulation.physics_rate, boundary)
            page.send(await on_thread(write))
        return []

    page.call(origin, send_text, Wait.TO_READ)


def _text_content(
    origin: Origin, saved: Callable[[], WorldState], physics_rate: float, boundary: ErrorBoundary
) -> dict[str, Any]:
    """Return the answer with the text of a world, or with its refusal."""
    try:
        with boundary.refusing(origin.topic):
            text = text_of(saved(), physics_rate, longest=MOST_SHARED)
    except Refusal as refusal:
        answer = Answer.refused(refusal, topic='page')
    else:
        answer = Answer(topic='page', message=Text('the world as text'), values=(('yaml', text),))
    return answer_content(answer, request_of(origin))
