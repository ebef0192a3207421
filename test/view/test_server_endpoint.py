# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Viewers in browsers: their server is started, found, and ended with the world."""

from __future__ import annotations

import shutil
import threading
from urllib.parse import parse_qs, urlsplit
from urllib.request import urlopen

from physsim_ros.view import endpoints, ViewerMode
import pytest

from .viewers import BOX, Events, rows_when, show
from ..outside import PATIENCE, until
from ..rerun_program import is_open, rerun

psutil = pytest.importorskip('psutil')


def page(event):
    return event.message.removeprefix('Rerun web: ')


def test_the_web_viewer_is_served_on_this_machine_alone(viewers):
    viewer = viewers(mode=ViewerMode.WEB)
    show(viewer, 10)

    url = page(Events(viewer).wait_for(''))
    stream = urlsplit(parse_qs(urlsplit(url).query)['url'][0])
    until(lambda: is_open(urlsplit(url).port))
    with urlopen(url) as answer:  # noqa: S310  an address of our own
        text = answer.read().decode()

    assert 'rerun' in text.lower()
    assert url in viewer.state
    ours = [psutil.Process(), *psutil.Process().children(recursive=True)]
    ports = {urlsplit(url).port, stream.port}
    listening = {
        connection.laddr
        for process in ours
        for connection in process.net_connections('inet')
        if connection.status == psutil.CONN_LISTEN and connection.laddr.port in ports
    }
    assert {(address.ip, address.port) for address in listening} == {
        ('127.0.0.1', port) for port in ports
    }


def test_who_looks_late_at_what_is_served_sees_all_of_it(viewers, tmp_path):
    viewer = viewers(mode=ViewerMode.WEB)
    stream = parse_qs(urlsplit(page(Events(viewer).wait_for(''))).query)['url'][0]
    show(viewer, 20)
    until(lambda: ' 20 frames' in viewer.state)

    path = tmp_path / 'late.rrd'
    late = rerun(stream, '--save', path)
    try:
        rows_when(path, BOX, 20)
    finally:
        late.kill()
        late.wait()


def test_nothing_is_left_running_after_closing(viewers):
    others = set(psutil.Process().children())
    viewer = viewers(mode=ViewerMode.WEB)
    Events(viewer).wait_for('')
    (program,) = set(psutil.Process().children()) - others

    viewer.close()

    assert not program.is_running()


def test_what_is_just_being_started_does_not_outlive_closing(viewers, monkeypatch):
    began, go_on, started = threading.Event(), threading.Event(), []
    start = endpoints.start_child

    def slowly(*arguments, **options):
        # As long as it takes to begin: Rerun may have to be read from a cold disk.
        began.set()
        assert go_on.wait(PATIENCE)
        started.append(start(*arguments, **options))
        return started[0]

    monkeypatch.setattr(endpoints.ServerEndpoint, 'closing', 0.0)
    monkeypatch.setattr(endpoints, 'rerun_program', lambda: shutil.which('yes'))
    monkeypatch.setattr(endpoints, 'start_child', slowly)
    viewer = viewers(mode=ViewerMode.WEB)
    assert began.wait(PATIENCE)

    viewer.close()
    go_on.set()

    until(lambda: not viewer.is_open)
    assert started[0].poll() is not None


@pytest.mark.parametrize('program', ['true', 'false'])
def test_a_page_server_that_ends_is_told_and_opened_again_when_asked(
    viewers, monkeypatch, program
):
    with monkeypatch.context() as patch:
        patch.setattr(endpoints, 'rerun_program', lambda: shutil.which(program))
        viewer = viewers(mode=ViewerMode.WEB)
        events = Events(viewer)

        assert 'another one: rerun rerun+http://' in events.wait_for('viewer_lost').message
        # The address is for a viewer that is installed elsewhere.
        assert viewer.is_open
        assert 'any Rerun viewer at rerun+http://127.0.0.1:' in viewer.state
        assert viewer.page_address == ''
    viewer.open_viewer(ViewerMode.WEB)

    until(lambda: viewer.poll() is not None and viewer.page_address)
    until(lambda: is_open(urlsplit(viewer.page_address).port))


@pytest.mark.parametrize(
    ('mode', 'display', 'code', 'words'),
    [
        (ViewerMode.AUTO, '', '', ['Rerun web: http://127.0.0.1:']),
        (ViewerMode.SPAWN, '', 'viewer_lost', ['there is no display', 'http://127.0.0.1:']),
        (ViewerMode.AUTO, ':987', 'viewer_lost', ['the window has failed']),
    ],
)
def test_where_no_window_can_be_opened_it_is_a_page_and_that_is_told(
    viewers, monkeypatch, mode, display, code, words
):
    monkeypatch.setenv('DISPLAY', display)
    monkeypatch.delenv('WAYLAND_DISPLAY', raising=False)

    told = Events(viewers(mode=mode)).wait_for(code).message

    assert [word for word in words if word not in told] == []
