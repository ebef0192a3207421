# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A file is read on a thread of its own, whose error is raised where the file is awaited."""

from __future__ import annotations

from pathlib import Path
from threading import get_ident

from physsim_ros.files import on_thread
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.runtime.slices import finish, in_slices
import pytest

from ..outside import run_python


def test_the_result_comes_from_another_thread() -> None:
    assert finish(on_thread(get_ident)) != get_ident()


@pytest.mark.parametrize('error', [BadWorldFile('no'), ValueError('no')])
def test_an_error_is_raised_by_who_waits(error: Exception) -> None:
    def read() -> None:
        raise error

    with pytest.raises(type(error), match='no'):
        finish(in_slices(lambda: on_thread(read)))


def test_a_function_without_parts_has_its_result_at_once() -> None:
    assert finish(in_slices(lambda: 'done')) == 'done'


def test_a_file_that_is_being_written_is_complete_when_the_process_ends(tmp_path: Path) -> None:
    path = tmp_path / 'it'
    run_python('-c', _ENDS_WHILE_IT_WRITES, path)
    assert path.read_text() == 'complete'


_ENDS_WHILE_IT_WRITES = """
from pathlib import Path
import sys
from threading import Event

from physsim_ros.files import on_thread
from physsim_ros.ros.programs.process import end_process

def write():
    begun.set()
    never.wait(0.3)  # a slow disk
    Path(sys.argv[1]).write_text('complete')

begun, never = Event(), Event()
on_thread(write, finishes=True).send(None)
begun.wait()
end_process()
"""
