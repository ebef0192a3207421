# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
One page on the world's thread: what it draws, its hand, its time and its worlds.

Law: a session changes nothing itself; it submits requests, and each message has an answer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
import time
from typing import Any

from physsim_ros.files import check_world_name, OwnWorlds
from physsim_ros.model.errors import BadWorldFile, Busy, UnknownJoint, WorldFull
from physsim_ros.model.names import shown_name
from physsim_ros.model.requests import Join, KeepHand, LetGo
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.deferred_calls import Wait
from physsim_ros.simulation.world.joint_requests import drawn_points
from physsim_ros.sketchpad import messages
from physsim_ros.sketchpad.answers import asker_key, request_of
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.body_past import BodyPasts
from physsim_ros.sketchpad.page_drawing import PageDrawing
from physsim_ros.sketchpad.page_requests import PageRequests, Send
from physsim_ros.sketchpad.world_control import WorldControl

# From one request of a hand that holds still to the next [s]; one that is silent for 5 s lets go.
HAND_PERIOD = 2.0
# Length of a world that a page may have as text [characters].
MOST_SHARED = 2**20


class PageSession:
    """
    The session of one page.

    :param world: that it draws in
    :param page: number of the page
    :param send: sends a message to the page
    :param pasts: of bodies, for all pages
    :param own_worlds: of the user
    :param autosave: of the world
    :param list_worlds: has all pages told which worlds there are
    """

    def __init__(
        self,
        world: WorldControl,
        *,
        page: int,
        send: Send,
        pasts: BodyPasts,
        own_worlds: OwnWorlds,
        autosave: Autosave,
        list_worlds: Callable[[], None],
    ) -> None:
        self._own_worlds = own_worlds
        self._autosave = autosave
        self._list_worlds = list_worlds
        self._world = world
        self._page = page
        self._requests = PageRequests(world, send)
        self._drawing = drawing = PageDrawing(world, self._requests, send)
        self._pasts = pasts
        self._hand = f'page {page}'
        # Steady time of the last request of the hand [s]; None while it holds nothing.
        self._hand_used: float | None = None
        self._actions: dict[type, Callable[[Any, str], None]] = {
            messages.Stroke: drawing.read_stroke,
            messages.Instead: drawing.read_instead,
            messages.Click: drawing.click,
            messages.Drop: drawing.drop,
            messages.Copy: drawing.copy_body,
            messages.DrawWith: drawing.choose_material,
            messages.Submit: self._submit,
            messages.ChangeJoint: self._change_joint,
            messages.UseHand: self._use_hand,
            messages.Watch: self._watch,
            messages.Share: self._share,
            messages.Upload: self._upload,
            messages.Perform: self._perform,
            messages.ManageWorld: self._manage_world,
            messages.SetSpeed: self._set_speed,
            messages.Seek: self._seek,
            messages.ReturnToCourse: self._return_to_course,
        }

    def handle(self, message: messages.Message, request_id: str) -> None:
        """
        Do what a message asks for.

        :param request_id: of the message, for its answers
        """
        self._drawing.update_settings()
        self._actions[type(message)](message, asker_key(self._page, request_id))
        self._drawing.send_preview()

    def keep_hand(self, now: float) -> None:
        """
        Keep what the hand holds still, as long as the page is open.

        :param now: steady time [s]
        """
        if self._hand_used is not None and now - self._hand_used > HAND_PERIOD:
            self._hand_used = now
            self._requests.submit((KeepHand(hand=self._hand),), '~/drag/feedback', '')

    def close(self) -> None:
        """Let go of what the hand of the page holds, and forget what it has asked for."""
        self._pasts.forget(self._page)
        if self._hand_used is not None:
            self._requests.submit((LetGo(hand=self._hand),), '~/drag/feedback', '')

    # Bodies

    def _submit(self, message: messages.Submit, asker: str) -> None:
        self._requests.submit(message.requests, message.topic, asker)

    def _change_joint(self, message: messages.ChangeJoint, asker: str) -> None:
        snapshot = self._world.current_snapshot()
        scene, name = snapshot.scene, message.name
        joint = next((each for each in scene.joints if each.name == name), None)
        if joint is None:
            refusal = UnknownJoint(f'there is no joint {shown_name(name)}', field='name')
            self._requests.refuse(refusal, '~/join', asker)
            return
        rows = {body: row for row, body in enumerate(scene.names)}
        x_y_yaw = {end: snapshot.poses[rows[end]].tolist() for end in {joint.a, joint.b} & {*rows}}
        # Where it is drawn now, so that it keeps its seat.
        request = Join(
            name=name,
            kind=joint.kind,
            points=drawn_points(joint, {end: (x, y, yaw) for end, (x, y, yaw) in x_y_yaw.items()}),
            a=joint.a,
            b=joint.b,
            properties=message.properties,
        )
        self._requests.submit((request,), '~/join', asker)

    def _use_hand(self, message: messages.UseHand, asker: str) -> None:
        holds = not isinstance(message.request, LetGo)
        self._hand_used = time.monotonic() if holds else None
        request = replace(message.request, hand=self._hand)
        self._requests.submit((request,), '~/drag/feedback', asker)

    def _watch(self, message: messages.Watch, asker: str) -> None:
        self._pasts.ask(self._page, message.name, request_of(asker))

    # Time

    def _set_speed(self, message: messages.SetSpeed, asker: str) -> None:
        self._requests.perform('~/speed', asker, lambda: self._world.set_speed(message.speed))

    def _seek(self, message: messages.Seek, asker: str) -> None:
        stamp = message.stamp
        seek = self._world.seek
        wait = Wait.BEHIND_REQUESTS
        self._requests.submit_action('~/seek', asker, lambda: seek(stamp), wait)

    def _return_to_course(self, message: messages.ReturnToCourse, asker: str) -> None:
        course = message.course
        return_to_course = self._world.simulation.return_to_course
        wait = Wait.BEHIND_REQUESTS
        self._requests.submit_action('~/timeline', asker, lambda: return_to_course(course), wait)

    # Worlds

    def _perform(self, message: messages.Perform, asker: str) -> None:
        action, world = message.action, message.world

        def perform() -> str:
            if message.checks_name:
                self._own_worlds.check_free(check_world_name(world), replace=message.replace)
                self._own_worlds.keep(world)
            done = self._world.perform(action, world)
            if action == 'save_world':
                self._autosave.note_saved()
                self._list_worlds()
            return done

        self._requests.submit_action(f'~/{action}', asker, perform, self._world.wait_of(action))

    def _manage_world(self, message: messages.ManageWorld, asker: str) -> None:
        own, name = self._own_worlds, message.name
        actions: dict[str, Callable[[], str]] = {
            'rename': lambda: own.rename(name, message.to),
            'remove': lambda: own.delete(name),
            'put_back': lambda: own.put_back(name),
            'forget': self._autosave.forget_unsaved,
        }

        def manage() -> str:
            try:
                done = actions[message.action]()
            except OSError as error:
                reason = error.strerror or error
                raise BadWorldFile(f'{name}: {reason}', field='name') from error
            self._list_worlds()
            return done

        self._requests.perform('page', asker, manage)

    def _upload(self, message: messages.Upload, asker: str) -> None:
        def replace_world() -> str:
            content = message.take()
            if content is None:
                raise Busy('an upload has waited too long; nothing was done')
            return self._world.replace_world(content)

        self._requests.submit_action('~/load_world', asker, replace_world, Wait.FOR_SEEK)

    def _share(self, _: messages.Share, asker: str) -> None:
        def share() -> list[Answer]:
            try:
                text = self._world.world_text(longest=MOST_SHARED)
            except WorldFull as refusal:
                self._requests.answer_page(asker, str(refusal), code=refusal.code)
            else:
                self._requests.answer_page(asker, 'the world as text', values=(('yaml', text),))
            return []

        self._requests.submit_call('~/save_world', asker, share, Wait.FOR_SEEK)
