# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The process of a program: its signals, streams and memory, and its end.

Law: the first SIGINT or SIGTERM ends the program within `ENDING`, whatever it is doing, with exit
code 0; a second one ends it at once.
"""

from __future__ import annotations

from contextlib import suppress
import ctypes
import gc
import os
from pathlib import Path
import signal
import socket
import sys
import threading
from typing import NoReturn

from physsim_ros.runtime.ending import ENDING

# `mallopt(3)` of glibc: the number of its option, and the size from which on a block comes from
# the system itself and not from the heap [bytes]; that costs a third of a microsecond for each
# 4 KiB.
M_MMAP_THRESHOLD = -3
LARGE_BLOCK = 2**18


class TerminationWatch:
    """
    A thread that receives SIGINT and SIGTERM, and ends the process where it does not end itself.

    Python runs a signal handler on the main thread, between two of its own instructions: a step of
    the engine or a file that cannot be opened delays it without limit. The wakeup descriptor is
    written at once, by the handler in C.
    """

    def __init__(self) -> None:
        self._requested = threading.Event()
        self._signals, self._wakeup = socket.socketpair()
        self._wakeup.setblocking(False)
        signal.set_wakeup_fd(self._wakeup.fileno(), warn_on_full_buffer=False)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: None)
        threading.Thread(target=self._wait, name='signals', daemon=True).start()

    @property
    def requested(self) -> bool:
        """Whether the end was asked for."""
        return self._requested.is_set()

    def _wait(self) -> None:
        self._signals.recv(1)
        self._requested.set()
        self._signals.settimeout(ENDING)
        with suppress(TimeoutError):
            self._signals.recv(1)
        # Child processes end with their parent (`view.child_process`).
        os._exit(0)


def begin_process() -> TerminationWatch:
    """
    Prepare the process of a world, before ROS is imported; return the watch of its signals.

    A collection of garbage would find nothing before the `Collector` of `run_worlds` enables it.
    """
    open_closed_streams()
    watch = TerminationWatch()
    reduce_latency()
    limit_fragmentation()
    gc.disable()
    return watch


def reduce_latency() -> None:
    """Reduce the time that other threads of the process delay a step; before `rclpy.init`."""
    # With the default switch interval of 5 ms, a busy thread of the viewer delays a step of 0.6 ms
    # by 6 ms.
    sys.setswitchinterval(0.0005)
    # See docs/decisions/publication_mode.md.
    profiles = Path(__file__).with_name('fastdds_profiles.xml')
    os.environ.setdefault('FASTRTPS_DEFAULT_PROFILES_FILE', str(profiles))


def limit_fragmentation() -> None:
    """Have large arrays returned to the system when they are freed."""
    # The threshold of glibc grows with each large block that is freed, up to 32 MiB; blocks below
    # it lie in the heap, which smaller ones in between keep from shrinking.
    set_option = getattr(ctypes.CDLL(None), 'mallopt', None)
    if set_option is not None:
        set_option(M_MMAP_THRESHOLD, LARGE_BLOCK)


def open_closed_streams() -> None:
    """
    Open the null device in place of closed standard streams.

    Else the next file or socket would get the descriptor, and what is printed would go to it.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            # The least free descriptor, which is this one.
            os.open(os.devnull, os.O_RDWR)
    sys.stdout = sys.stdout or os.fdopen(1, 'w')
    sys.stderr = sys.stderr or os.fdopen(2, 'w')


def end_process() -> NoReturn:
    """
    End the process with exit code 0 when its files are written, whoever reads what it prints.

    The interpreter would free each space of the engine piece by piece, as Pymunk 7.3 does it, for
    seconds in a crowded world, when it has no threads any more that could end it.
    """
    # Not above: what `begin_process` prepares is imported before ROS and the engine.
    from physsim_ros.files import finish_files  # noqa: PLC0415

    finish_files()
    with suppress(OSError):
        sys.stdout.flush()
    os._exit(0)
