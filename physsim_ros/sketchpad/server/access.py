# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Access to the page: tokens, cookies, hosts and origins, and the headers of every answer.

Laws: nothing but the login is served to a request without a valid cookie. A request that names a
host by a foreign domain is refused (DNS rebinding), and so is a socket or an upload that another
origin opens. No page of this server runs a script, or calls a host, that is not its own. A page
that was logged in is still logged in after a restart of the node, by the key that signs cookies;
tokens are not kept. The key of a person is signed for this run alone, and gives no right.
"""

from __future__ import annotations

import hmac
from ipaddress import ip_address
import os
from pathlib import Path
import secrets
import socket
import stat
from urllib.parse import urlsplit

from physsim_ros.files import make_directory, user_directory, write_file
from physsim_ros.sketchpad.rights import Role
from tornado.web import create_signed_value, decode_signed_value

# Random bytes of a token: too many to be guessed.
_TOKEN_BYTES = 24
# Greatest age of a cookie [days]: a class of one day need not type the address again.
_COOKIE_AGE = 1.0
# Policy of every answer. Browsers before 2022 do not count web sockets to this server as 'self'.
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "font-src 'self'; manifest-src 'self'; connect-src 'self' ws://{host} wss://{host}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
# Length of the key that signs cookies [bytes]: that of the digest of SHA-256, by which tornado
# signs.
_KEY_BYTES = 32
_KEY_FILE = 'cookie_key'


class Access:
    """
    The tokens of one server, and the checks of its requests.

    :param address: that the server listens on
    :param port: that the server listens on

    :ivar tokens: of this run, by role
    :ivar cookie: name of the cookie, with the port: a host's cookies are shared by all its ports
    """

    def __init__(self, address: str, port: int) -> None:
        self.cookie = f'physsim_{port}'
        self._key = cookie_key()
        self._run_key = secrets.token_bytes(_KEY_BYTES)
        self.tokens = {role: secrets.token_urlsafe(_TOKEN_BYTES) for role in Role}
        name = socket.gethostname().lower()
        # The names of this machine, as its owner types them; no foreign domain has them.
        self._hosts = {'localhost', name, f'{name.partition(".")[0]}.local', address.lower()}

    def role_of(self, token: str) -> Role | None:
        """Return the role that a token gives; None for a wrong one."""
        given = token.encode(errors='replace')
        for role, known in self.tokens.items():
            # Compared in constant time, so that no answer tells how much of a token is right.
            if hmac.compare_digest(given, known.encode()):
                return role
        return None

    def signed_cookie(self, role: Role) -> bytes:
        """Return the value of the cookie for a role, signed."""
        return create_signed_value(self._key, self.cookie, role.value)

    def role_of_cookie(self, value: str) -> Role | None:
        """Return the role of a cookie's value; None where it is forged, or too old."""
        role = decode_signed_value(self._key, self.cookie, value, max_age_days=_COOKIE_AGE)
        return None if role is None else Role(role.decode())

    def person_key(self, person: int) -> str:
        """Return the key with which a page is the person of a number again, signed."""
        return create_signed_value(self._run_key, 'person', str(person)).decode()

    def person_of(self, key: bytes) -> int | None:
        """Return the number of the person of a key; None where it is forged, or of another run."""
        person = decode_signed_value(self._run_key, 'person', key)
        return None if person is None else int(person)

    def allows_host(self, host: str) -> bool:
        """Tell whether a Host header names this machine: by an address, or by its own name."""
        try:
            parts = urlsplit(f'//{host}')
            # `port` raises, too, where it is no number.
            name, _ = parts.hostname or '', parts.port
        except ValueError:
            return False
        if name in self._hosts:
            return True
        try:
            ip_address(name)
        except ValueError:
            return False
        return True

    @staticmethod
    def allows_origin(origin: str | None, host: str) -> bool:
        """Tell whether an Origin header is that of this server's pages, with TLS or not."""
        origins = {f'{scheme}://{host}'.lower() for scheme in ('http', 'https')}
        return origin is not None and origin.lower() in origins


def headers_for(host: str) -> dict[str, str]:
    """
    Return the headers of every answer.

    :param host: that the request was sent to, already checked
    """
    return {
        'Content-Security-Policy': _POLICY.format(host=host),
        'X-Content-Type-Options': 'nosniff',
        'X-Frame-Options': 'DENY',
        'Referrer-Policy': 'no-referrer',
        'Cross-Origin-Opener-Policy': 'same-origin',
        'Cross-Origin-Resource-Policy': 'same-origin',
        'Cache-Control': 'no-cache',
    }


def cookie_key() -> bytes:
    """Return the key of the user, made at first; one for this run where it cannot be kept."""
    directory = user_directory('XDG_STATE_HOME', '.local', 'state')
    try:
        make_directory(directory)
        return _read_key(directory / _KEY_FILE) or _make_key(directory / _KEY_FILE)
    except OSError:
        # Without the file, pages log in again after a restart.
        return secrets.token_bytes(_KEY_BYTES)


def _read_key(path: Path) -> bytes:
    """
    Return the key of a file; empty where another user could know it, or the length is wrong.

    :raises OSError: it cannot be read
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
    except FileNotFoundError:
        return b''
    with os.fdopen(descriptor, 'rb') as file:
        status = os.fstat(file.fileno())
        private = status.st_uid == os.getuid() and not stat.S_IMODE(status.st_mode) & 0o077
        key = file.read(_KEY_BYTES + 1) if stat.S_ISREG(status.st_mode) and private else b''
    return key if len(key) == _KEY_BYTES else b''


def _make_key(path: Path) -> bytes:
    """
    Write a new key, whole or not at all, in place of an old one.

    :raises OSError: it cannot be written
    """
    key = secrets.token_bytes(_KEY_BYTES)
    write_file(path, key, mode=0o600)
    return key
