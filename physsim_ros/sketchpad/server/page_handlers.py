# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The login, the page and its files over HTTP."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
import io
from pathlib import Path
import re

from physsim_ros.sketchpad.results import read_results
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.guarded import Guarded, TYPES
from tornado.web import HTTPError, StaticFileHandler

# Width of a module of a QR code [pixels], and of the quiet zone around the code, in modules
# (ISO/IEC 18004: 4).
_SCALE, _QUIET = 8, 4
# The files that a browser runs.
PAGE = Path(__file__).parents[1] / 'page'
# Parts of files that browsers do not need, by their suffix: descriptions, types of editors,
# comments, but for the licence and after code those with quotes, which may be the end of a text;
# and indentation, since no text has several lines.
_FOR_READERS = {
    suffix: re.compile(pattern, re.DOTALL | re.MULTILINE)
    for suffix, pattern in {
        '.js': rb'/\*\*.*?\*/|^[ \t]*//(?! SPDX)[^\n]*|[ \t]+// [^\n\'"`]*$|^[ \t]+',
        '.css': rb'/\*(?! SPDX).*?\*/|^[ \t]+',
    }.items()
}


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


class ResultList(Guarded):
    """The results of lessons, for a teacher."""

    def initialize(self, files: Sequence[Path]) -> None:
        """Set the files of the worlds."""
        self._files = files

    async def get(self) -> None:
        """Answer with the results, each with the number of its world, from 1."""
        if self.role is not Role.TEACH:
            self.refuse(403, 'this is for teachers')
        results = [
            result | {'world': number}
            for number, file in enumerate(self._files, 1)
            for result in read_results(file)
        ]
        self.finish({'results': results})


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

    post = delete = patch = put = options = get


class PageFiles(Guarded, StaticFileHandler):  # type: ignore[misc] # both know `head`
    """The files of the page; scripts and styles without comments and indentation, line by line."""

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

    @classmethod
    def get_content(
        cls, abspath: str, start: int | None = None, end: int | None = None
    ) -> Generator[bytes, None, None]:
        """Yield a part of a file."""
        content = Path(abspath).read_bytes()
        pattern = _FOR_READERS.get(Path(abspath).suffix)
        if pattern is not None:
            content = pattern.sub(lambda found: b'\n' * found[0].count(b'\n'), content)
        yield content[start:end]

    def get_content_size(self) -> int:
        """Return the size of the file [bytes]."""
        return sum(map(len, self.get_content(self.absolute_path or '')))
