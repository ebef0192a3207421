# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Runs, each in a process of its own: an exit, a kill and a hang are failures of that run alone.

A process is forked for a case, and ends with its run, which it sends through a pipe. Of one that
ends otherwise, the count of the controller's calls is known, which it keeps in shared memory: the
case is run again up to the last of them, to the bit, for its way and the world before its end.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
import gc
import math
import mmap
import os
import pickle
import resource
import selectors
import signal
import struct
import sys
import time
from typing import NoReturn
import warnings

import numpy as np
from physsim_ros.sweeps.experiment import Case, Ended, Experiment, Run

# Bytes that are read from a pipe at once.
_CHUNK = 1 << 16
# Length of what a process sends, before it.
_LENGTH = struct.Struct('<q')


@dataclass(frozen=True, slots=True)
class _End:
    """
    The end of a process without a result.

    :param calls: of the controller, the last of which did not return
    :param how: it ended
    """

    calls: int
    how: str


@dataclass(frozen=True, slots=True)
class _Job:
    """
    A case that is to be run.

    :param number: of the case
    :param case: itself
    :param end: of its first process, which ended without a result; None is a first one
    """

    number: int
    case: Case
    end: _End | None = None


class _Process:
    """
    A process that runs a case; it is forked at once.

    :param experiment: of the case
    :param job: the case, and how its first process ended

    :ivar job: of the process
    :ivar pipe: through which it sends its result
    :ivar deadline: steady time after which it is ended [s]
    """

    def __init__(self, experiment: Experiment, job: _Job) -> None:
        self.job = job
        self._experiment = experiment
        self._calls = mmap.mmap(-1, _LENGTH.size)
        self._received = bytearray()
        self.pipe, out = os.pipe()
        self.deadline = time.monotonic() + experiment.wall_limit * self._attempts
        # Buffers are written before the fork, or each process would write them.
        sys.stdout.flush()
        sys.stderr.flush()
        with warnings.catch_warnings():
            # Python 3.12 warns where there are threads. None of them is in the process, which uses
            # nothing of theirs; OpenBLAS makes its own anew (`pthread_atfork`).
            warnings.simplefilter('ignore', DeprecationWarning)
            self._pid = os.fork()
        if self._pid == 0:
            self._work(out)
        with suppress(ProcessLookupError, PermissionError):
            # A group of its own: it is not interrupted from the keyboard, and ends with all
            # processes that it has started.
            os.setpgid(self._pid, self._pid)
        os.close(out)

    @property
    def _attempts(self) -> int:
        """Return how many times the limits hold: a second process is not to miss the end."""
        return 1 if self.job.end is None else 2

    def _work(self, out: int) -> NoReturn:
        """Run the case, send what came of it, and end; in the process itself."""
        status = 1
        # Garbage of the parent is not this process's own either: a node of ROS that is freed
        # without its threads ends it.
        gc.freeze()
        try:
            seconds = math.ceil(self._experiment.cpu_limit * self._attempts)
            _, most = resource.getrlimit(resource.RLIMIT_CPU)
            soft = seconds if most == resource.RLIM_INFINITY else min(seconds, most)
            resource.setrlimit(resource.RLIMIT_CPU, (soft, most))
            result: Run | Exception
            try:
                result = self._run()
            except Exception as error:  # noqa: BLE001 - raised where the sweep is
                result = error
            if isinstance(result, Run):
                # Its case may have parameters that do not pickle.
                result = replace(result, case=Case())
            data = pickle.dumps(result)
            sys.stdout.flush()
            sys.stderr.flush()
            with os.fdopen(out, 'wb') as pipe:
                pipe.write(_LENGTH.pack(len(data)) + data)
            status = 0
        finally:
            # Neither the stack nor the exit functions of the parent are this process's own.
            os._exit(status)

    def _run(self) -> Run:
        """Run the case, note each call, and stop at that in which the first process ended."""
        calls, end = self._experiment.calls(self.job.case), self.job.end
        try:
            while True:
                count = next(calls)
                _LENGTH.pack_into(self._calls, 0, count)
                if end is not None and count == end.calls:
                    calls.throw(Ended(end.how))
        except StopIteration as stop:
            run: Run = stop.value
            return run

    def receive(self) -> bool:
        """Read what has been sent; return whether nothing more comes."""
        chunk = os.read(self.pipe, _CHUNK)
        self._received += chunk
        return not chunk or self._is_complete

    @property
    def _is_complete(self) -> bool:
        size = len(self._received) - _LENGTH.size
        return size >= 0 and size == _LENGTH.unpack_from(self._received)[0]

    def close(self) -> str:
        """End the process, with all that it has started; return how it ended."""
        is_overdue = time.monotonic() >= self.deadline
        with suppress(ProcessLookupError):
            os.killpg(self._pid, signal.SIGKILL)
        _, status = os.waitpid(self._pid, 0)
        os.close(self.pipe)
        code = os.waitstatus_to_exitcode(status)
        if is_overdue:
            return f'took more than {self._experiment.wall_limit:g} s'
        if code == -signal.SIGXCPU:
            return f'took more than {self._experiment.cpu_limit:g} s of CPU time'
        if code < 0:
            return f'killed by {signal.Signals(-code).name}'
        return f'its process ended with exit code {code}'

    def result(self) -> Run | _Job:
        """
        End the process; return its run, or the job of a second one that finds what came before.

        :raises Refusal: the case was refused
        """
        how, number, case = self.close(), self.job.number, self.job.case
        if self._is_complete:
            start = _LENGTH.size
            data = memoryview(self._received)[start:]
            result: Run | Exception = pickle.loads(data)  # noqa: S301 - its own
            if isinstance(result, Exception):
                raise result
            return replace(result, case=case)
        if self.job.end is None:
            (calls,) = _LENGTH.unpack_from(self._calls)
            return _Job(number, case, _End(calls, how))
        # It does not repeat itself: no more is known than when it ended.
        experiment = self._experiment
        return Run(
            case=case,
            failure=self.job.end.how,
            seconds=max(0, self.job.end.calls - 1) * experiment.period,
            way=np.empty((0, 2)),
            score=math.nan,
            before=None,
            physics_rate=experiment.physics_rate,
        )


def run_apart(
    experiment: Experiment, cases: Iterable[tuple[int, Case]], processes: int = 1
) -> Iterator[tuple[int, Run]]:
    """
    Run cases, each in a process of its own; yield the number and the run of each as it ends.

    :param experiment: of the cases
    :param cases: with their numbers
    :param processes: greatest number of those that run at once
    :raises Refusal: as `Experiment.run`
    """
    waiting = deque(_Job(number, case) for number, case in cases)
    running: dict[int, _Process] = {}
    selector = selectors.DefaultSelector()
    try:
        while waiting or running:
            while waiting and len(running) < processes:
                process = _Process(experiment, waiting.popleft())
                running[process.pipe] = process
                selector.register(process.pipe, selectors.EVENT_READ)
            due = min(each.deadline for each in running.values()) - time.monotonic()
            ready = {key.fd for key, _ in selector.select(max(0.0, due))}
            for process in [*running.values()]:
                is_over = process.pipe in ready and process.receive()
                if is_over or time.monotonic() >= process.deadline:
                    del running[process.pipe]
                    selector.unregister(process.pipe)
                    result = process.result()
                    if isinstance(result, Run):
                        yield process.job.number, result
                    else:
                        waiting.appendleft(result)
    finally:
        selector.close()
        for process in running.values():
            process.close()
