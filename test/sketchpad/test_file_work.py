# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Work on files is done by one thread, in its order, and the thread ends with it."""

from concurrent.futures import wait
import threading

from physsim_ros.sketchpad.file_work import FileWork
import pytest

from ..outside import PATIENCE


def test_one_thread_does_one_piece_of_work_after_the_other_and_ends_with_the_last() -> None:
    begins, threads, woken = threading.Event(), list[threading.Thread](), list[None]()
    work = FileWork(lambda: woken.append(None))

    def note() -> int:
        begins.wait(PATIENCE)
        threads.append(threading.current_thread())
        return len(threads)

    for count in (100, 200):
        begins.clear()
        done = [work.submit(note) for _ in range(100)]
        begins.set()
        wait(done)
        assert [each.result() for each in done] == [*range(count - 99, count + 1)]
        assert len({*threads[-100:]}) == 1
        threads[-1].join(PATIENCE)
        assert not threads[-1].is_alive()
        assert len(woken) == count


def test_work_goes_on_after_an_error() -> None:
    work = FileWork(lambda: None)
    failed, done = work.submit(lambda: int('x')), work.submit(lambda: 1)
    with pytest.raises(ValueError, match='x'):
        failed.result(PATIENCE)
    assert done.result(PATIENCE) == 1


def test_work_goes_on_where_a_thread_could_not_be_started(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: threading.Thread) -> None:
        raise RuntimeError('no more threads')

    work = FileWork(lambda: None)
    with monkeypatch.context() as patched:
        patched.setattr(threading.Thread, 'start', refuse)
        failed = work.submit(lambda: 1)
    with pytest.raises(RuntimeError, match='no more threads'):
        failed.result(0.0)
    assert work.submit(lambda: 1).result(PATIENCE) == 1
