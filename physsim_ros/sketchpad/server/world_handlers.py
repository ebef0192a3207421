# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The files of worlds over HTTP: downloads and uploads, pictures, the unsaved world.

Law: nothing but the files of own and shipped worlds can be read.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from urllib.parse import quote

from physsim_ros.files import (
    find_world,
    load_mapping,
    make_directory,
    MOST_BYTES,
    OwnWorlds,
    read_bytes,
    read_parts,
    write_file,
)
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Busy, Malformed, PhysSimError, Refusal
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.inbox import Inbox, Upload, UPLOADERS
from physsim_ros.sketchpad.message import text_content
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.guarded import Guarded, GuardedUpload, TYPES
from physsim_ros.sketchpad.server.world_picture import svg_of_world

# Uploads at once, and size of each [bytes].
MOST_UPLOADS, MOST_UPLOADED = 4, 2**20
# Size of the picture of a world [bytes].
MOST_PICTURE = 200_000
_PNG = b'\x89PNG\r\n\x1a\n'


class _OfWorlds(Guarded):
    """A handler of own worlds."""

    def initialize(self, own_worlds: OwnWorlds) -> None:
        """Set the worlds of the user."""
        self.own_worlds = own_worlds

    def world_path(self, name: str) -> Path:
        """
        Return the path of a world, by the rules of service `~/load_world`.

        :raises Refusal: there is no such world
        """
        own = self.own_worlds
        return find_world(name, world_dir=own.directory, lesson_dir=own.lessons, confined=True)


class Download(_OfWorlds):
    """The file of a world."""

    async def get(self, name: str) -> None:
        """Answer with the file."""
        try:
            path = self.world_path(name)
            self.set_header('Content-Type', TYPES['.yaml'])
            # RFC 6266 and 8187: a name of any letters.
            file = quote(path.name, safe='')
            self.set_header('Content-Disposition', f"attachment; filename*=UTF-8''{file}")
            for part in read_parts(path, MOST_BYTES):
                self.write(part)
                # As fast as the browser reads.
                await self.flush()
        except (Refusal, OSError):
            self.refuse(404, 'there is no such world')


class WorldPicture(_OfWorlds):
    """The picture of the file of a world or lesson."""

    async def get(self, name: str) -> None:
        """Answer with the picture."""
        try:
            path = self.world_path(name)
            changed = path.stat().st_mtime_ns
            # YAML of a megabyte takes a second to be read.
            picture = await asyncio.to_thread(svg_of_world, path, changed)
        except (PhysSimError, OSError):
            self.refuse(404, 'there is no such world')
        self.set_header('Content-Type', TYPES['.svg'])
        self.finish(picture)


class Picture(_OfWorlds, GuardedUpload):
    """The picture of an own world."""

    most = MOST_PICTURE

    def initialize(  # type: ignore[override]
        self, own_worlds: OwnWorlds, on_change: Callable[[], None]
    ) -> None:
        """
        Set the worlds of the user.

        :param on_change: called when a picture has changed
        """
        super().initialize(own_worlds)
        self._on_change = on_change

    async def get(self, name: str) -> None:
        """Answer with the picture."""
        try:
            content = read_bytes(self.own_worlds.picture(name), MOST_PICTURE)
        except (Refusal, OSError):
            self.refuse(404, 'there is no such picture')
        self.set_header('Content-Type', TYPES['.png'])
        self.finish(content)

    async def post(self, name: str) -> None:
        """Write the picture of a world that was saved."""
        content = self.content
        if not content.startswith(_PNG):
            self.refuse(400, 'this is no PNG')
        try:
            path = self.own_worlds.picture(name)
            self.world_path(name)
            make_directory(path.parent)
            write_file(path, content)
        except (Refusal, OSError):
            self.refuse(404, 'there is no such world')
        self.finish({'ok': True})
        self._on_change()


class Unsaved(Guarded):
    """The unsaved world of the last start."""

    def initialize(self, autosave: Autosave) -> None:
        """Set the autosave, which has its file."""
        self._autosave = autosave

    async def get(self) -> None:
        """Answer with the file."""
        self.require_drawing()
        try:
            content = self._autosave.unsaved_content()
        except OSError:
            self.refuse(404, 'there is no unsaved world')
        self.set_header('Content-Type', TYPES['.yaml'])
        self.finish(content)


class UploadWorld(GuardedUpload):
    """Replace the world by that of an uploaded file."""

    most = MOST_UPLOADED

    def initialize(self, inbox: Inbox, turns: asyncio.Semaphore) -> None:
        """Set the inbox of the world's thread, and the turns of its uploads."""
        self._inbox, self._turns = inbox, turns

    async def post(self) -> None:
        """Answer with the world's own answer."""
        content = self.content
        if self._turns.locked():
            self.refuse(503, 'too many uploads at once', Busy.code)
        async with self._turns:
            try:
                answer = await self._replace_world(content)
            except Refusal as refusal:
                answer = Answer.refused(refusal, topic='~/load_world')
        text = text_content(answer.message)
        ok, message, code = not answer.code, answer.message, answer.code
        self.finish({'ok': ok, 'message': message, 'text': text, 'code': code})

    async def _replace_world(self, file: bytes) -> Answer:
        """
        Have the world's thread replace the world, and return its answer.

        :raises Refusal: the file is no mapping in YAML
        """
        try:
            text = file.decode()
        except UnicodeDecodeError as error:
            raise Malformed('the file is not UTF-8', field='file') from error
        # YAML of a megabyte takes a second to be read; meanwhile the pages get their frames.
        content = await asyncio.to_thread(load_mapping, text, field='the file')
        loop = asyncio.get_running_loop()
        reply: asyncio.Future[Answer] = loop.create_future()

        def take_reply(answer: Answer) -> None:
            # The loop has ended where the server is closed.
            with suppress(RuntimeError):
                loop.call_soon_threadsafe(reply.set_result, answer)

        # Of so few uploads none is refused.
        self._inbox.put(UPLOADERS, Upload(content, self.role or Role.VIEW, take_reply))
        return await reply
