# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0


"""Worlds over HTTP: files to download, files to upload."""

from __future__ import annotations

import asyncio
from typing import Any

from physsim_ros.files import find_world, load_mapping, write_file
from physsim_ros.model.errors import Busy, Malformed, Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.handlers import Guarded
from physsim_ros.sketchpad.messages import Upload

# Uploads at once.
MOST_UPLOADS = 4
# Until the world begins to take over a file [s].
TIMEOUT = 60.0
# Of the picture of a world [bytes].
MOST_PICTURE = 200_000
_PNG = b'\x89PNG\r\n\x1a\n'


class Download(Guarded):
    """A world file, by the rules of service `~/load_world`."""

    async def get(self, name: str) -> None:
        """Answer with a file."""
        try:
            path = find_world(name, world_dir=self.server.world_dir, confined=True)
            content = path.read_bytes()
        except (Refusal, OSError):
            self.refuse(404, 'there is no such world')
        self.set_header('Content-Type', 'application/yaml; charset=utf-8')
        self.set_header('Content-Disposition', f'attachment; filename="{path.name}"')
        self.finish(content)


class Unsaved(Guarded):
    """The world of the last start that nobody has saved."""

    async def get(self) -> None:
        """Answer with a file."""
        if self.role is not Role.DRAW:
            self.refuse(403, 'this page only shows the world')
        try:
            content = self.server.autosave.unsaved_text()
        except (OSError, UnicodeDecodeError):
            self.refuse(404, 'there is no unsaved world')
        self.set_header('Content-Type', 'application/yaml; charset=utf-8')
        self.finish(content)


class Picture(Guarded):
    """The picture of an own world."""

    async def get(self, name: str) -> None:
        """Answer with the picture."""
        try:
            content = self.server.own_worlds.picture(name).read_bytes()
        except (Refusal, OSError):
            self.refuse(404, 'there is no such picture')
        self.set_header('Content-Type', 'image/png')
        self.finish(content)

    async def post(self, name: str) -> None:
        """Keep the picture of a world that has been saved."""
        self.require_origin()
        if self.role is not Role.DRAW:
            self.refuse(403, 'this page only shows the world')
        content = self.request.body
        if not content.startswith(_PNG) or len(content) > MOST_PICTURE:
            self.refuse(400, 'this is no PNG, or a large one')
        try:
            path = self.server.own_worlds.picture(name)
            find_world(name, world_dir=self.server.world_dir, confined=True)
            path.parent.mkdir(parents=True, exist_ok=True)
            write_file(path, content)
        except (Refusal, OSError):
            self.refuse(404, 'there is no such world')
        self.finish({'ok': True})
        self.server.list_worlds()


class UploadWorld(Guarded):
    """Replace the world by that of an uploaded file."""

    uploads = 0

    async def post(self) -> None:
        """Answer with `ok`, `message` and `code`, when the world has taken over the file."""
        self.require_origin()
        if self.role is not Role.DRAW:
            self.refuse(403, 'this page only shows the world')
        if UploadWorld.uploads >= MOST_UPLOADS:
            self.refuse(503, 'too many uploads at once')
        UploadWorld.uploads += 1
        try:
            self.finish(await self._replace_world())
        finally:
            UploadWorld.uploads -= 1

    async def _replace_world(self) -> dict[str, Any]:
        try:
            text = self.request.body.decode()
        except UnicodeDecodeError:
            return _content(Malformed('the file is not UTF-8', field='file'))
        try:
            # YAML of a megabyte takes a second to be read; meanwhile the pages get their frames.
            content = await asyncio.to_thread(load_mapping, text, field='the file')
        except Refusal as refusal:
            return _content(refusal)
        try:
            answer = await self.server.upload(Upload(content), TIMEOUT)
        except Busy as refusal:
            self.refuse(503, str(refusal))
        return {'ok': not answer.code, 'message': answer.message, 'code': answer.code}


def _content(refusal: Refusal) -> dict[str, Any]:
    answer = Answer.refused(refusal, topic='~/load_world')
    return {'ok': False, 'message': answer.message, 'code': answer.code}
