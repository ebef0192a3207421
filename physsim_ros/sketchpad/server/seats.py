# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Seats: who has which world of a class.

Laws: a pupil comes back to the same world from the same browser, and gets no other pupil's. One
machine takes few seats, however often it asks. After a restart of the class each has the same
world; a seat whose pupil has not come back since goes to a newcomer only where no other is free.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from ipaddress import ip_address, ip_network
import json
from pathlib import Path
import secrets
import time
from typing import NamedTuple

from physsim_ros.files import make_directory, read_bytes, write_file
from physsim_ros.model.errors import WorldFull

# Greatest number of seats of one machine: two browsers of each of two pupils who share it.
MOST_OF_MACHINE = 4
# Greatest age of a seat after a restart, and of its cookie [s]: that of a page's cookie, a day.
SEAT_AGE = 86_400
# Size of the file of seats [bytes].
_MOST_BYTES = 2**20


class WorldAddresses(NamedTuple):
    """
    The addresses of a world, with their tokens.

    :ivar pupil: to draw
    :ivar teacher: to teach
    :ivar results: file of the results of lessons
    """

    pupil: str
    teacher: str
    results: Path = Path('nowhere')


@dataclass(slots=True)
class _Seat:
    """
    A seat.

    :param name: of the pupil; '' where it is free
    :param key: of the pupil's browser
    :param machine: of that browser; '' if nobody has it since the restart
    :param at: time at which the pupil came last [s since 1970]
    """

    name: str = ''
    key: str = ''
    machine: str = ''
    at: float = field(default_factory=time.time)


class Seats:
    """
    The worlds of a class, and the pupils in them.

    :param worlds: their addresses
    :param path: of the file that keeps the seats; None is none
    :param most_of_machine: greatest number of seats of one machine; 0 is no limit
    """

    def __init__(
        self,
        worlds: Sequence[WorldAddresses],
        path: Path | None = None,
        most_of_machine: int = MOST_OF_MACHINE,
    ) -> None:
        self.worlds = tuple(worlds)
        self._path = path
        self._most_of_machine = most_of_machine
        before = [] if path is None else _read(path)[: len(worlds)]
        self._seats = [*before, *(_Seat() for _ in range(len(worlds) - len(before)))]

    @property
    def names(self) -> list[str]:
        """Return the names of the pupils, by world; '' where it is free."""
        return [seat.name for seat in self._seats]

    def join(self, name: str, *keys: str, address: str = '') -> tuple[int, str]:
        """
        Return the number of a pupil's world, from 0, and the key of the browser.

        :param name: of the pupil
        :param keys: that the browser was given when it came before, by its storage and its cookie
        :param address: from which it comes, of the Internet Protocol; '' has no limit
        :raises WorldFull: no world is free, or the machine has too many
        """
        machine = machine_of(address)
        number = self._number_of(keys)
        if number is None:
            self._check_machine(machine)
            number = self._free_number()
            self._seats[number].key = secrets.token_urlsafe()
        seat = self._seats[number]
        seat.name, seat.machine, seat.at = name, machine or 'unknown', time.time()
        self._save()
        return number, seat.key

    def free(self, number: int) -> None:
        """Free a seat, whose browser is a newcomer then; the world stays as it is."""
        self._seats[number] = _Seat()
        self._save()

    def _number_of(self, keys: Sequence[str]) -> int | None:
        """Return the number of the seat with one of some keys."""
        numbers = {seat.key: number for number, seat in enumerate(self._seats) if seat.key}
        return next((numbers[key] for key in keys if key in numbers), None)

    def _check_machine(self, machine: str) -> None:
        """
        Refuse a machine that has its seats.

        :raises WorldFull: it has
        """
        taken = sum(bool(machine) and seat.machine == machine for seat in self._seats)
        if 0 < self._most_of_machine <= taken:
            template = (
                '{taken} worlds of this class are those of this machine; a teacher can free one'
            )
            raise WorldFull(template, taken=taken)

    def _free_number(self) -> int:
        """
        Return the number of a free seat, else of the one that was left longest ago.

        :raises WorldFull: all pupils have come since the restart
        """
        left = [number for number, seat in enumerate(self._seats) if not seat.machine]
        if not left:
            raise WorldFull('every world of this class has a pupil')
        since = {number: self._seats[number].at for number in left if self._seats[number].name}
        number = min(left, key=lambda each: since.get(each, 0.0))
        self._seats[number] = _Seat()
        return number

    def _save(self) -> None:
        """Keep the seats, unless the file cannot be written: then a restart forgets them."""
        if self._path is not None:
            content = json.dumps([asdict(seat) for seat in self._seats], ensure_ascii=False)
            with suppress(OSError):
                make_directory(self._path.parent)
                write_file(self._path, content.encode(), mode=0o600)


def _read(path: Path) -> list[_Seat]:
    """Return the seats of a file, without those that are too old; none if it is spoilt."""
    with suppress(OSError, TypeError, ValueError, RecursionError):
        seats = [_Seat(**each) for each in json.loads(read_bytes(path, _MOST_BYTES))]
        if all(isinstance(each.name + each.key, str) for each in seats):
            since = time.time() - SEAT_AGE
            return [replace(each, machine='') if each.at > since else _Seat() for each in seats]
    return []


def machine_of(address: str) -> str:
    """Return the machine of an address: of IPv6 its network of 64 bits, which a machine has."""
    try:
        ip = ip_address(address.partition('%')[0])
    except ValueError:
        return address
    if ip.version == 4:
        return str(ip)
    return str(ip.ipv4_mapped or ip_network((ip, 64), strict=False))
