# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Whatever happens to a viewer or a disk, the world is neither slowed nor stopped by it."""

from __future__ import annotations

from collections import Counter
import os
from pathlib import Path
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
from urllib.parse import parse_qs, urlsplit
from urllib.request import urlopen
import weakref

import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.view import FrameContext, Viewer, ViewerMode
from physsim_ros.view.sinks import endpoints, file_endpoint
from physsim_ros.view.sinks.sink import Endpoint
from physsim_ros.view.sinks.sink_worker import SinkWorker
import pytest

from ..building import PLAIN_BODY
from ..rerun_program import free_port, is_open, rerun

psutil = pytest.importorskip('psutil')
chunk = pytest.importorskip('rerun.chunk')

# Files are read while they are written.
pytestmark = pytest.mark.filterwarnings('ignore:RRD file has no footer')

# Ten times what anything here takes; importing Rerun alone is a second.
PATIENCE = 20.0

CONTEXT = FrameContext(real_time_factor=1.0)
SCENE = Scene(bodies=(PLAIN_BODY,), settings=WorldSettings())


def frame(step, *messages):
    pose = np.array([[float(step), 0.0, 0.0]])
    snapshot = Snapshot(step=step, stamp=step * 4_166_667, scene=SCENE, poses=pose, twists=pose)
    answers = tuple(Answer(topic='~/spawn', message=each) for each in messages)
    return Frame(snapshot=snapshot, contacts=None, answers=answers)


def until(predicate, timeout=PATIENCE):
    """Wait until something holds; return it."""
    deadline = time.monotonic() + timeout
    pause = threading.Event()
    while not (result := predicate()):
        assert time.monotonic() < deadline, 'it did not come to hold'
        pause.wait(0.01)
    return result


def show(viewer, count, first=0):
    for step in range(first, first + count):
        viewer.show(frame(step), context=CONTEXT)


def bulk():
    """Return words that cannot be compressed, so that a few hundred frames fill every buffer."""
    return os.urandom(100_000).hex()


def rows(path):
    """Return how many rows each entity of a recording has."""
    counts = Counter()
    for each in chunk.RrdReader(path).stream():
        if not each.is_static:
            counts[each.entity_path] += each.num_rows
    return counts


def rows_when(path, entity, count):
    """Wait until a recording that is being written has so many rows of an entity; return all."""

    def enough():
        try:
            counts = rows(path)
        except (OSError, RuntimeError, ValueError):
            # Not there yet, or in the middle of a message.
            return None
        return counts if counts[entity] >= count else None

    return until(enough)


def run_alone(program, *arguments):
    """Run a program in a process of its own, and return what it prints."""
    done = subprocess.run(
        [sys.executable, '-c', textwrap.dedent(program), *map(str, arguments)],
        cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE,
        text=True,
        timeout=3 * PATIENCE,
        check=True,
    )
    return done.stdout


class Server:
    """A Rerun server that writes what it is sent, of somebody else's."""

    def __init__(self, path):
        self.path = path
        self.port = free_port()
        self.url = f'rerun+http://127.0.0.1:{self.port}/proxy'
        self.process = None

    def start(self):
        self.process = rerun(f'--port={self.port}', '--save', self.path)
        until(lambda: is_open(self.port))

    def kill(self):
        self.process.kill()
        self.process.wait()

    def wait_for(self, entity, count):
        """Wait until it has written so many rows of an entity; return how many of all."""
        return rows_when(self.path, entity, count)


@pytest.fixture
def server(tmp_path):
    it = Server(tmp_path / 'server.rrd')
    yield it
    if it.process is not None:
        it.kill()


@pytest.fixture
def viewers():
    """Make viewers that are closed afterwards."""
    made = []

    def make(*, mode=ViewerMode.NONE, url='', record_file=''):
        viewer = Viewer()
        made.append(viewer)
        if record_file:
            viewer.record(Path(record_file))
        viewer.open_viewer(mode, url)
        return viewer

    yield make
    for viewer in made:
        viewer.close()


class Events:
    """The answers of a viewer so far."""

    def __init__(self, viewer):
        self._viewer = viewer
        self.all = []

    def wait_for(self, code):
        """Return the first event with that code that has not been waited for."""

        def found():
            self.all += self._viewer.poll()
            return [each for each in self.all if each.code == code]

        first = until(found)[0]
        self.all.remove(first)
        return first


# Recording


def test_a_recording_holds_every_frame_once_it_is_closed(viewers, tmp_path):
    path = tmp_path / 'it.rrd'
    viewer = viewers(mode=ViewerMode.NONE, record_file=str(path))

    show(viewer, 1000)
    viewer.close()

    assert rows(path)['/world/bodies/box/0'] >= 1000
    assert ', ended, 1000 frames, 0 dropped' in viewer.state


def test_a_file_that_cannot_be_written_is_told_and_the_rest_goes_on(viewers, server, tmp_path):
    path = tmp_path / 'nowhere' / 'it.rrd'
    server.start()
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url, record_file=str(path))
    events = Events(viewer)

    failure = events.wait_for('record_failed')
    events.wait_for('')
    show(viewer, 50)
    viewer.close()

    assert failure.topic == 'viewer'
    assert str(path) in failure.message
    server.wait_for('/world/bodies/box/0', 50)


def test_a_file_that_is_no_regular_one_is_refused_and_blocks_nothing(viewers, tmp_path):
    path = tmp_path / 'fifo.rrd'
    os.mkfifo(path)
    viewer = viewers(record_file=path)

    assert 'no regular file' in Events(viewer).wait_for('record_failed').message
    until(lambda: not viewer.is_open)


def test_a_share_that_does_not_answer_is_told_and_delays_nothing(viewers, tmp_path, monkeypatch):
    monkeypatch.setattr('physsim_ros.view.sinks.sink_worker.SILENT_AFTER', 0.1)
    go_on = threading.Event()
    create = file_endpoint._create_regular_file  # noqa: SLF001  it stands for the share

    def late(path):
        assert go_on.wait(PATIENCE)
        return create(path)

    monkeypatch.setattr(file_endpoint, '_create_regular_file', late)
    viewer = viewers(record_file=tmp_path / 'it.rrd')
    events = Events(viewer)

    assert 'no answer' in events.wait_for('record_failed').message
    show(viewer, 10)
    go_on.set()
    events.wait_for('')
    until(lambda: ', open, 10 frames' in viewer.state)


def test_a_recording_that_was_deleted_is_told_once_and_begun_again(viewers, tmp_path):
    path = tmp_path / 'it.rrd'
    viewer = viewers(record_file=path)
    events = Events(viewer)
    events.wait_for('')
    show(viewer, 10)

    path.unlink()
    assert 'gone' in events.wait_for('record_failed').message
    until(lambda: not viewer.is_open)
    assert 'the file is gone' in viewer.failure
    viewer.show(frame(10, 'before'), context=CONTEXT)
    assert 'failed (the file is gone' in viewer.state
    viewer.open_viewer(ViewerMode.NONE)
    events.wait_for('')
    assert viewer.failure == ''
    viewer.show(frame(20, 'after'), context=CONTEXT)
    viewer.close()

    assert not [each for each in [*events.all, *viewer.poll()] if each.code]
    # With the last frame of before.
    assert rows(path)['/events'] == 2


# A process whose files cannot grow past a limit: a disk that is full, and has space again later.
FULL_DISK = """
    import sys
    from pathlib import Path
    from resource import getrlimit, RLIM_INFINITY, RLIMIT_FSIZE, setrlimit
    from test.view.test_viewer import bulk, CONTEXT, Events, frame, until
    from physsim_ros.view import FrameContext, Viewer, ViewerMode

    setrlimit(RLIMIT_FSIZE, (300_000, RLIM_INFINITY))
    viewer = Viewer()
    viewer.record(Path(sys.argv[1]))
    events = Events(viewer)
    events.wait_for('')
    for step in range(10):
        viewer.show(frame(step, bulk()), context=CONTEXT)
    print(events.wait_for('record_failed').message)
    until(lambda: not viewer.is_open)
    setrlimit(RLIMIT_FSIZE, (RLIM_INFINITY, RLIM_INFINITY))
    viewer.open_viewer(ViewerMode.NONE)
    print(events.wait_for('').message)
    for step in range(10, 20):
        viewer.show(frame(step, bulk()), context=CONTEXT)
    viewer.close()
    print([each.code for each in (*events.all, *viewer.poll())])
"""


def test_a_disk_that_is_full_is_told_once_and_recording_begins_again_beside(tmp_path):
    path = tmp_path / 'it.rrd'

    failed, begun, others = run_alone(FULL_DISK, path).splitlines()

    assert str(path) in failed
    assert begun == f'record: {tmp_path / "it-2.rrd"}'
    assert others == '[]'
    assert path.stat().st_size <= 300_000
    # The last frame of before, and all since.
    assert rows(tmp_path / 'it-2.rrd')['/events'] == 11


def test_where_there_is_no_rerun_that_is_told_and_nothing_is_open(viewers, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'rerun', None)
    viewer = viewers(record_file=str(tmp_path / 'it.rrd'))

    assert 'rerun' in Events(viewer).wait_for('record_failed').message
    until(lambda: not viewer.is_open)
    assert 'failed' in viewer.state


# Serving


def page(event):
    return event.message.removeprefix('web: ')


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


def test_what_is_recorded_goes_on_when_the_viewer_changes(viewers, server, tmp_path):
    server.start()
    path = tmp_path / 'it.rrd'
    viewer = viewers(record_file=str(path))
    viewer.show(frame(0, 'first'), context=CONTEXT)
    viewer.open_viewer(ViewerMode.CONNECT, server.url)
    viewer.show(frame(4, 'second'), context=CONTEXT)
    # The one before is in the new viewer too: the world may stand still.
    server.wait_for('/events', 2)
    viewer.open_viewer(ViewerMode.NONE)
    viewer.show(frame(8, 'third'), context=CONTEXT)
    assert 'connect' not in viewer.state
    viewer.close()

    assert rows(path)['/events'] == 3


def test_who_looks_late_at_what_is_served_sees_all_of_it(viewers, tmp_path):
    viewer = viewers(mode=ViewerMode.WEB)
    stream = parse_qs(urlsplit(page(Events(viewer).wait_for(''))).query)['url'][0]
    show(viewer, 20)
    until(lambda: ' 20 frames' in viewer.state)

    path = tmp_path / 'late.rrd'
    late = rerun(stream, '--save', path)
    try:
        rows_when(path, '/world/bodies/box/0', 20)
    finally:
        late.kill()
        late.wait()


def test_nothing_is_left_running_after_closing(viewers):
    viewer = viewers(mode=ViewerMode.WEB)
    Events(viewer).wait_for('')
    (program,) = psutil.Process().children()

    viewer.close()

    assert not program.is_running()


@pytest.fixture
def impatient(monkeypatch):
    """Make closing give up at once on a viewer that has not ended."""
    monkeypatch.setattr('physsim_ros.view.sinks.endpoints.ServerEndpoint.closing', 0.0)


def test_nothing_is_started_after_closing(viewers, monkeypatch, impatient):
    began, go_on, started = threading.Event(), threading.Event(), []

    def program():
        # As long as it takes to begin: Rerun may have to be read from a cold disk.
        began.set()
        assert go_on.wait(PATIENCE)
        return 'rerun'

    monkeypatch.setattr('physsim_ros.view.sinks.endpoints._program', program)
    monkeypatch.setattr('subprocess.Popen', lambda *_, **__: started.append('a program'))
    viewer = viewers(mode=ViewerMode.WEB)
    assert began.wait(PATIENCE)

    viewer.close()
    go_on.set()

    until(lambda: not viewer.is_open)
    assert started == []


def test_what_is_just_being_started_is_ended_by_closing(viewers, monkeypatch, impatient):
    began, closed, started = threading.Event(), threading.Event(), []
    start, join = subprocess.Popen, SinkWorker.join

    def slowly(*arguments, **options):
        began.set()
        assert closed.wait(PATIENCE)
        started.append(start(*arguments, **options))
        return started[0]

    def joins(worker):
        closed.set()
        return join(worker)

    monkeypatch.setattr('physsim_ros.view.sinks.endpoints._program', lambda: shutil.which('yes'))
    monkeypatch.setattr('subprocess.Popen', slowly)
    viewer = viewers(mode=ViewerMode.WEB)
    assert began.wait(PATIENCE)
    monkeypatch.setattr(SinkWorker, 'join', joins)

    viewer.close()

    assert started[0].poll() is not None


def test_of_a_flood_of_changes_the_last_counts_and_few_are_carried_out(viewers, monkeypatch):
    started = []
    start = endpoints.start_child

    def count(*arguments, **options):
        started.append(start(*arguments, **options))
        return started[-1]

    monkeypatch.setattr(endpoints, 'start_child', count)
    viewer = viewers()
    for _ in range(100):
        viewer.open_viewer(ViewerMode.WEB)
        viewer.open_viewer(ViewerMode.NONE)
    viewer.open_viewer(ViewerMode.WEB)

    def one_runs():
        viewer.poll()
        running = [program for program in started if program.poll() is None]
        return viewer.state.startswith('web: http') and len(running) == 1

    until(one_runs)
    assert len(started) <= 2


def test_a_page_server_that_dies_is_started_again(viewers, monkeypatch):
    # It has settled at once.
    monkeypatch.setattr('physsim_ros.view.sinks.endpoints.SETTLING', 0.0)
    viewer = viewers(mode=ViewerMode.WEB)
    events = Events(viewer)
    events.wait_for('')
    (program,) = psutil.Process().children()

    program.kill()
    events.wait_for('viewer_lost')

    port = until(lambda: urlsplit(viewer.state.removeprefix('web: ').split(', ')[0]).port)
    until(lambda: is_open(port))


@pytest.mark.parametrize('program', ['true', 'false'])
def test_a_page_server_that_ends_at_once_is_not_started_again(viewers, monkeypatch, program):
    started = []
    monkeypatch.setattr(
        'physsim_ros.view.sinks.endpoints._program',
        lambda: started.append(program) or shutil.which(program),
    )
    viewer = viewers(mode=ViewerMode.WEB)

    assert 'no page could be served' in Events(viewer).wait_for('viewer_lost').message
    assert len(started) == 1
    # The address is for a viewer that is installed elsewhere.
    assert viewer.is_open
    assert 'any Rerun viewer at rerun+http://127.0.0.1:' in viewer.state


@pytest.fixture
def no_display(monkeypatch):
    monkeypatch.delenv('DISPLAY', raising=False)
    monkeypatch.delenv('WAYLAND_DISPLAY', raising=False)


def test_where_there_is_no_display_auto_is_a_page(viewers, no_display):
    viewer = viewers(mode=ViewerMode.AUTO)

    assert Events(viewer).wait_for('').message.startswith('web: http://127.0.0.1:')


def test_where_there_is_no_display_a_window_becomes_a_page_and_that_is_told(viewers, no_display):
    viewer = viewers(mode=ViewerMode.SPAWN)

    why = Events(viewer).wait_for('viewer_lost').message

    assert 'http://127.0.0.1:' in why
    assert 'there is no display' in why


def test_where_no_window_can_be_opened_it_becomes_a_page(viewers, monkeypatch):
    monkeypatch.setenv('DISPLAY', ':987')
    monkeypatch.delenv('WAYLAND_DISPLAY', raising=False)
    viewer = viewers(mode=ViewerMode.AUTO)

    assert 'no window could be opened' in Events(viewer).wait_for('viewer_lost').message


# Pages


def test_a_page_is_sent_the_next_batch_when_it_shows_the_one_before(viewers):
    viewer, sent = viewers(), []
    page = viewer.open_page(lambda batch, recorded: sent.append((batch, recorded)))
    show(viewer, 10)
    until(lambda: sent)

    # As many as a page of two seconds a frame leaves out.
    show(viewer, 120, first=10)
    until(lambda: ' dropped' in viewer.state and ', 0 dropped' not in viewer.state)
    assert len(sent) == 1
    page.note_shown(sent[0][1] - 1)
    assert Events(viewer).wait_for('frames_dropped').code == 'frames_dropped'
    assert len(sent) == 1
    page.note_shown(sent[0][1])
    until(lambda: len(sent) == 2)

    assert sent[1][1] > sent[0][1]
    viewer.close_page(page)
    until(lambda: not viewer.is_open)


def test_a_page_begins_with_what_is_shown_last(viewers, tmp_path):
    viewer, sent = viewers(), []
    show(viewer, 100)
    page = viewer.open_page(lambda batch, _: sent.append(batch))
    until(lambda: sent)
    viewer.close_page(page)

    path = tmp_path / 'page.rrd'
    path.write_bytes(sent[0])
    assert rows(path)['/plots/energy'] == 1


# Connecting


def test_nobody_at_the_other_end_holds_nothing_up_and_is_said(viewers):
    viewer = viewers(mode=ViewerMode.CONNECT, url=f'rerun+http://127.0.0.1:{free_port()}/proxy')

    until(lambda: 'nobody there' in viewer.state)
    show(viewer, 1000)
    viewer.close()


def test_an_address_that_is_none_is_told(viewers):
    viewer = viewers(mode=ViewerMode.CONNECT, url='http://nonsense')

    assert 'http://nonsense' in Events(viewer).wait_for('viewer_lost').message


def test_a_server_that_comes_late_is_found_and_gets_every_answer(viewers, server):
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url)
    until(lambda: 'nobody there' in viewer.state)
    for step in range(200):
        viewer.show(frame(step, f'answer {step}'), context=CONTEXT)

    server.start()
    Events(viewer).wait_for('')
    until(lambda: ' 60 frames, 140 dropped' in viewer.state)
    viewer.close()

    written = server.wait_for('/events', 200)
    assert written['/world/bodies/box/0'] >= 60


def test_a_server_that_goes_and_comes_again_is_found_again(viewers, server):
    server.start()
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url)
    events = Events(viewer)
    events.wait_for('')
    show(viewer, 10)

    server.kill()
    events.wait_for('viewer_lost')
    server.start()
    events.wait_for('')
    show(viewer, 10, first=10)
    viewer.close()

    # With the geometry, as nothing of before has been kept.
    assert server.wait_for('/world/bodies/box/0', 10)['/world/camera'] == 1


# The whole life of a process whose viewer freezes: a frozen one would keep this one from ending.
# A process that looks what ten viewers leave behind.
TEN_VIEWERS = """
    import psutil, threading
    from test.view.test_viewer import Events, show, until
    from physsim_ros.view import Viewer, ViewerMode, viewer as module

    module.CHANGE_PERIOD = 0.0
    process = psutil.Process()
    viewer = Viewer()
    events = Events(viewer)

    def open_and_close():
        viewer.open_viewer(ViewerMode.WEB)
        events.wait_for('')
        show(viewer, 50)
        until(lambda: 'open, 5' in viewer.state)
        viewer.open_viewer(ViewerMode.NONE)
        until(lambda: not any('viewer' in each.name for each in threading.enumerate()))

    def held():
        return process.num_threads(), process.num_fds(), len(process.net_connections())

    open_and_close()
    open_and_close()
    print(most := held())
    for _ in range(8):
        open_and_close()
    # What is being closed is waited for: Rerun's threads end some time after their server.
    until(lambda: all(now <= before for now, before in zip(held(), most)))
    print('no more')
"""


def test_ten_viewers_leave_no_threads_descriptors_or_ports():
    assert run_alone(TEN_VIEWERS).splitlines()[-1] == 'no more'


FROZEN = """
    import os, signal, sys, threading
    from pathlib import Path
    from test.view.test_viewer import bulk, CONTEXT, Events, frame, until
    from physsim_ros.view import FrameContext, Viewer, ViewerMode

    url, path, server = sys.argv[1], sys.argv[2], int(sys.argv[3])
    viewer = Viewer()
    viewer.record(Path(path))
    viewer.open_viewer(ViewerMode.CONNECT, url)
    events = Events(viewer)
    until(lambda: viewer.state.count(', open,') == 2)
    os.kill(server, signal.SIGSTOP)
    step = 0
    while 'takes nothing' not in viewer.state:
        viewer.show(frame(step, bulk()), context=CONTEXT)
        step += 1
        threading.Event().wait(0.01)
    events.wait_for('viewer_lost')
    viewer.close()
    print(step)
"""


def test_a_frozen_viewer_holds_up_neither_frames_nor_closing_nor_the_end(server, tmp_path):
    server.start()
    path = tmp_path / 'it.rrd'
    arguments = [server.url, str(path), str(server.process.pid)]

    done = run_alone(FROZEN, *arguments)

    # It came to its end, and the file is whole all the same.
    assert rows(path)['/events'] == int(done)


def test_a_viewer_that_thaws_is_shown_what_is_new(viewers, server):
    server.start()
    viewer = viewers(mode=ViewerMode.CONNECT, url=server.url)
    until(lambda: ', open,' in viewer.state)

    os.kill(server.process.pid, signal.SIGSTOP)
    steps = iter(range(10_000))

    def is_stuck():
        viewer.show(frame(next(steps), bulk()), context=CONTEXT)
        return 'takes nothing' in viewer.state

    until(is_stuck)
    os.kill(server.process.pid, signal.SIGCONT)
    until(lambda: ', open,' in viewer.state)
    viewer.show(frame(20_000), context=CONTEXT)
    viewer.close()

    server.wait_for('/events', next(steps))


# The queue


class Blocked(Endpoint):
    """An endpoint that takes nothing until it is released."""

    kind, where, capacity = 'blocked', 'here', 10

    def __init__(self):
        self.entered, self.release = threading.Event(), threading.Event()
        self.drawn = []

    def open_sink(self):
        return self

    def draw(self, frames, **_):
        self.entered.set()
        assert self.release.wait(PATIENCE)
        self.drawn += frames

    def flush(self, patience):
        pass

    def close(self):
        pass


def test_a_full_queue_drops_the_oldest_frames_and_keeps_all_answers():
    endpoint, told = Blocked(), []
    worker = SinkWorker(endpoint, report=told.append)
    worker.put_frame(frame(0, 'answer 0'), context=CONTEXT)
    assert endpoint.entered.wait(PATIENCE)

    for step in range(1, 101):
        worker.put_frame(frame(step, f'answer {step}'), context=CONTEXT)
    endpoint.release.set()
    worker.end()

    assert worker.join()
    assert [each.snapshot.step for each in endpoint.drawn] == [0, *range(91, 101)]
    answers = [answer.message for each in endpoint.drawn for answer in each.answers]
    assert answers == [f'answer {step}' for step in range(101)]
    assert '11 frames, 90 dropped' in worker.state
    assert [each.code for each in told] == ['', 'frames_dropped']


def test_putting_a_frame_never_waits_for_drawing():
    endpoint = Blocked()
    worker = SinkWorker(endpoint, report=lambda _: None)
    worker.put_frame(frame(0), context=CONTEXT)
    assert endpoint.entered.wait(PATIENCE)

    worker.put_frame(frame(1), context=CONTEXT)
    assert not endpoint.release.is_set()
    endpoint.release.set()
    worker.end()

    assert worker.join()


def test_closing_gives_up_on_one_that_never_draws():
    endpoint = Blocked()
    worker = SinkWorker(endpoint, report=lambda _: None)
    worker.put_frame(frame(0), context=CONTEXT)
    assert endpoint.entered.wait(PATIENCE)

    worker.end()

    assert not worker.join()
    endpoint.release.set()


@pytest.mark.filterwarnings('ignore::pytest.PytestUnhandledThreadExceptionWarning')
def test_a_bug_in_drawing_is_told_and_nothing_is_open_any_more():
    class Buggy(Endpoint):
        kind = 'buggy'

        def open_sink(self):
            raise ZeroDivisionError('by zero')

    told = []
    worker = SinkWorker(Buggy(), report=told.append)

    assert worker.join()
    assert not worker.is_open
    (answer,) = told
    assert answer.code == 'viewer_lost'
    assert 'ZeroDivisionError: by zero' in answer.message


def test_what_waited_for_a_way_that_failed_is_let_go():
    class Failing(Endpoint):
        kind = 'failing'

        def __init__(self):
            self.release = threading.Event()

        def open_sink(self):
            assert self.release.wait(PATIENCE)
            raise ConnectionError('there never can be one')

    endpoint = Failing()
    worker = SinkWorker(endpoint, report=lambda _: None)
    waiting = frame(0, 'answer')
    kept = weakref.ref(waiting.snapshot)
    worker.put_frame(waiting, context=CONTEXT)
    del waiting

    endpoint.release.set()

    assert worker.join()
    assert kept() is None
    assert 'failed (there never can be one), 0 frames, 1 dropped' in worker.state


def test_importing_the_viewer_does_not_import_rerun():
    check = 'import sys, physsim_ros.view; sys.exit("rerun" in sys.modules)'

    assert subprocess.run([sys.executable, '-c', check], check=False).returncode == 0
