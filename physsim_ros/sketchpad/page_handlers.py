# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A site: its sockets and tokens; the login, the page and its files over HTTP."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from functools import partial
import io
from pathlib import Path
import re
from typing import Any

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.sketchpad.access import Access
from physsim_ros.sketchpad.guarded import Guarded, TYPES
from physsim_ros.sketchpad.listening import listening_sockets, reachable_host
from physsim_ros.sketchpad.rights import Role
from tornado.web import Application, HTTPError, StaticFileHandler

# Width of a module of a QR code [pixels], and of the quiet zone around the code, in modules
# (ISO/IEC 18004: 4).
_SCALE, _QUIET = 8, 4
# The files that a browser runs.
PAGE = Path(__file__).with_name('page')
# Parts of scripts that browsers do not need: descriptions, types of editors, lines that are
# comments, but for the licence; and indentation, since no text of a script has several lines.
_FOR_READERS = re.compile(
    rb'/\*\*.*?\*/|^[ \t]*//(?! SPDX)[^\n]*|^[ \t]+', re.DOTALL | re.MULTILINE
)


class _CookieSetting(Guarded):
    """A handler that sets the cookie."""

    def set_cookie_for(self, role: Role) -> None:
        """Set the cookie of a role."""
        self.set_cookie(
            self.access.cookie,
            self.access.signed_cookie(role),
            expires_days=None,
            httponly=True,
            samesite='Strict',
        )


class Login(_CookieSetting):
    """Exchange a token for the cookie."""

    needs_cookie = False

    async def get(self) -> None:
        """Set the cookie, and show the page."""
        token = self.get_query_argument('token', '')
        role = self.access.role_of(token)
        if role is None:
            self.refuse(403, 'this token is wrong, or of a world that has ended')
        self.set_cookie_for(role)
        shows_only = role is Role.VIEW or 'view' in self.request.arguments
        self.redirect('/?view' if shows_only else '/')


class Page(_CookieSetting):
    """The page itself."""

    def initialize(self, file: str) -> None:
        """Set the name of its file."""
        self._file = file

    async def get(self) -> None:
        """Answer with the page."""
        if self.role is not None:
            # The time of the cookie begins anew at each visit.
            self.set_cookie_for(self.role)
        self.set_header('Content-Type', TYPES['.html'])
        self.finish((PAGE / self._file).read_bytes())


class CookieCheck(Guarded):
    """Whether the cookie of a page is still valid: a socket that is refused cannot say why."""

    async def get(self) -> None:
        """Answer with the rights of the page."""
        self.finish({'ok': True, 'view_only': self.role is Role.VIEW})


class QrCode(Guarded):
    """The address of pupils as a QR code, for a teacher."""

    def initialize(self, address: Callable[[], str]) -> None:
        """Set what returns that address."""
        self._address = address

    async def get(self) -> None:
        """Answer with the picture."""
        if self.role is not Role.TEACH:
            self.refuse(403, 'this is for teachers')
        try:
            # An extra: a node without a class does not need it.
            import segno  # noqa: PLC0415 - see above
        except ImportError:
            self.refuse(404, 'QR codes need segno: pip install segno')
        image, code = io.BytesIO(), segno.make(self._address(), micro=False)
        code.save(image, kind='svg', scale=_SCALE, border=_QUIET, dark='#000', light='#fff')
        self.set_header('Content-Type', TYPES['.svg'])
        self.finish(image.getvalue())


class Missing(Guarded):
    """Every other path."""

    async def get(self) -> None:
        """Answer that there is nothing."""
        self.refuse(404, 'there is nothing here')

    post = head = delete = patch = put = options = get


class Files(Guarded, StaticFileHandler):
    """The files of a directory."""

    def validate_absolute_path(self, root: str, absolute_path: str) -> str | None:
        """Return the path of a file; a path that names no file is missing."""
        try:
            return super().validate_absolute_path(root, absolute_path)
        except (HTTPError, ValueError):
            self.refuse(404, 'there is nothing here')

    def get_content_type(self) -> str:
        """Return the type of a file of the page; other files are bytes."""
        path = Path(self.absolute_path or '')
        return TYPES.get(path.suffix, 'application/octet-stream')


class PageFiles(Files):
    """The files of the page; scripts without comments and indentation, in the same lines."""

    @classmethod
    def get_content(
        cls, abspath: str, start: int | None = None, end: int | None = None
    ) -> Generator[bytes, None, None]:
        """Yield a part of a file."""
        content = Path(abspath).read_bytes()
        if abspath.endswith('.js'):
            content = _FOR_READERS.sub(lambda found: b'\n' * found[0].count(b'\n'), content)
        yield content[start:end]

    def get_content_size(self) -> int:
        """Return the size of the file [bytes]."""
        return sum(map(len, self.get_content(self.absolute_path or '')))


class Site:
    """
    A site of pages: what the server of a world and that of a class have in common.

    :param address: to listen on
    :param port: to listen on; where it is taken, one of the next; 0 is any
    :raises PhysSimError: it cannot listen there

    :ivar sockets: that listen
    """

    def __init__(self, address: str, port: int) -> None:
        self.sockets = listening_sockets(address, port)
        self._port: int = self.sockets[0].getsockname()[1]
        self._address = address
        self._access = Access(address, self._port)

    def url(self, role: Role) -> str:
        """Return the address of the site with the token of a role."""
        host = reachable_host(self._address)
        return f'http://{host}:{self._port}/login?token={self._access.tokens[role]}'

    def application(
        self, page: str, handlers: Sequence[Any], boundary: ErrorBoundary, **options: Any
    ) -> Application:
        """
        Return the application of a site.

        :param page: name of the file of its page
        :param handlers: of other requests
        :param boundary: where unexpected errors end
        :param options: of tornado
        """
        return Application(
            [
                ('/', Page, {'file': page}),
                ('/login', Login),
                ('/session', CookieCheck),
                ('/qr.svg', QrCode, {'address': partial(self.url, Role.DRAW)}),
                ('/page/(.*)', PageFiles, {'path': str(PAGE)}),
                *handlers,
            ],
            access=self._access,
            boundary=boundary,
            compress_response=True,
            default_handler_class=Missing,
            # Answers with an error concern those who asked.
            log_function=lambda _: None,
            **options,
        )
