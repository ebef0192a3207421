# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What is served over HTTP: the page and its modules, pictures, worlds, and the login.

Law: every request passes `Guarded.prepare` before it is answered.
"""

from __future__ import annotations

from html import escape
from http import HTTPStatus
from pathlib import Path
from typing import Any, NoReturn, TYPE_CHECKING

from physsim_ros.sketchpad.access import headers_for, Role
from tornado.web import HTTPError, RequestHandler, StaticFileHandler

if TYPE_CHECKING:
    from physsim_ros.sketchpad.server import Server

# Of the files that are served; the machine's own table may lack some, and nothing is guessed.
TYPES = {
    '.css': 'text/css; charset=utf-8',
    '.html': 'text/html; charset=utf-8',
    '.js': 'text/javascript; charset=utf-8',
    '.json': 'application/json',
    '.png': 'image/png',
    '.svg': 'image/svg+xml',
    '.wasm': 'application/wasm',
    '.webmanifest': 'application/manifest+json',
}


# What somebody sees who has opened an address that is refused. The page's own style is behind the
# cookie, and nothing inline is allowed.
_REFUSAL = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>physsim</title>
<h1>This cannot be opened</h1>
<p>{reason}.</p>
<p>The node prints the address of its page when it starts, with a token that is new each time: copy
that one from the terminal, or ask the person who started it.</p>
</html>
"""


class Guarded(RequestHandler):
    """
    A handler behind the checks of host and cookie.

    :ivar server: that it belongs to
    :ivar role: that the cookie gives
    """

    needs_cookie = True
    _refusal = ''

    def initialize(self, server: Server) -> None:
        """Set the server."""
        self.server = server
        self.role: Role | None = None

    def set_default_headers(self) -> None:
        """Set the headers of every answer, errors included."""
        self.set_header('Server', 'physsim')
        host = self.request.host
        server = self.application.settings['server']
        known = host if server.access.allows_host(host) else 'localhost'
        for name, value in headers_for(known).items():
            self.set_header(name, value)

    async def prepare(self) -> None:
        """Refuse a foreign host, and a request without the cookie."""
        if not self.server.access.allows_host(self.request.host):
            self.refuse(403, 'this name is not one of this machine')
        access = self.server.access
        self.role = access.role_of_cookie(self.get_cookie(access.cookie) or '')
        if self.needs_cookie and self.role is None:
            self.refuse(403, 'open the address that the node has printed: it holds the token')

    def set_cookie_for(self, role: Role) -> None:
        """Set the cookie of a role."""
        access = self.server.access
        self.set_cookie(
            access.cookie,
            access.signed_cookie(role),
            expires_days=None,
            httponly=True,
            samesite='Strict',
        )

    def require_origin(self) -> None:
        """Refuse a request that no page of this server has made."""
        origin = self.request.headers.get('Origin')
        if not self.server.access.allows_origin(origin, self.request.host):
            self.refuse(403, 'this request comes from another page')

    def refuse(self, status: int, reason: str) -> NoReturn:
        """Answer with an error and its reason."""
        self._refusal = reason
        raise HTTPError(status)

    def log_exception(self, *details: Any) -> None:
        """Log the errors of this server, not those of its clients."""
        if not isinstance(details[1], HTTPError):
            super().log_exception(*details)

    def write_error(self, status_code: int, **_: Any) -> None:
        """Write the reason of a refusal, or the meaning of the status; nothing of the request."""
        reason = self._refusal or HTTPStatus(status_code).phrase
        if 'text/html' not in self.request.headers.get('Accept', ''):
            self.set_header('Content-Type', 'text/plain; charset=utf-8')
            self.finish(f'{reason}\n')
            return
        # Opened in a browser: for the eyes of a person.
        self.set_header('Content-Type', TYPES['.html'])
        self.finish(_REFUSAL.format(reason=escape(reason[:1].upper() + reason[1:])))


class Login(Guarded):
    """Exchange a token for the cookie."""

    needs_cookie = False

    async def get(self) -> None:
        """Set the cookie, and show the page."""
        token = self.get_query_argument('token', '')
        role = self.server.access.role_of(token)
        if role is None:
            self.refuse(403, 'this token is wrong, or of a world that has ended')
        self.set_cookie_for(role)
        shows_only = role is Role.VIEW or 'view' in self.request.arguments
        self.redirect('/?view' if shows_only else '/')


class Page(Guarded):
    """The page itself."""

    async def get(self) -> None:
        """Answer with the page."""
        if self.role is not None:
            # Visited again, so that its time begins anew.
            self.set_cookie_for(self.role)
        self.set_header('Content-Type', TYPES['.html'])
        self.finish((self.server.page_directory / 'index.html').read_bytes())


class CookieCheck(Guarded):
    """Whether the cookie of a page is still right: a socket that is refused cannot say why."""

    async def get(self) -> None:
        """Answer with the rights of the page."""
        self.finish({'ok': True, 'view_only': self.role is not Role.DRAW})


class Missing(Guarded):
    """Every other path."""

    async def get(self) -> None:
        """Answer that there is nothing."""
        self.refuse(404, 'there is nothing here')

    post = head = delete = patch = put = options = get


class Files(Guarded, StaticFileHandler):
    """The files of a directory."""

    def initialize(self, server: Server, path: Path) -> None:  # type: ignore[override]
        """Set server and directory."""
        Guarded.initialize(self, server)
        StaticFileHandler.initialize(self, str(path))

    def validate_absolute_path(self, root: str, absolute_path: str) -> str | None:
        """Return the path of a file; what is none, or no path at all, is missing."""
        try:
            return super().validate_absolute_path(root, absolute_path)
        except (HTTPError, ValueError):
            self.refuse(404, 'there is nothing here')

    def get_content_type(self) -> str:
        """Return the type of a file of the page; other files are bytes."""
        path = Path(self.absolute_path or '')
        return TYPES.get(path.suffix, 'application/octet-stream')
