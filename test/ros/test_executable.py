# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The program `physsim`, as people start, interrupt and mistype it."""

from __future__ import annotations

from contextlib import suppress
import json
import os
from pathlib import Path
import re
import signal
import sys

from physsim_ros.ros.parameters import SPECS
import pytest

from ..outside import installed_program, Outside, PATIENCE, Program, ROOT

SHAPES = ('circle: {radius: 0.3}', 'box: {width: 0.5, height: 0.5}')
# A grid of discs and boxes, which fall apart over each other.
THOUSAND = 'format: 1\nbodies:\n' + ''.join(
    f'  - {{name: a/{each}, {SHAPES[each % 2]}, at: [{each % 40}, {each // 40}]}}\n'
    for each in range(1000)
)

# The program with a bug in a step, which shows when there is a viewer.
BUG = """
import psutil
from physsim_ros.engine.space import Space
from physsim_ros.ros.programs.physsim import main


def fail(*words, **options):
    if children := psutil.Process().children():
        print('CHILDREN', *(each.pid for each in children), flush=True)
        raise ZeroDivisionError
    return step(*words, **options)


step, Space.step = Space.step, fail
main()
"""


# The program in a state without end, in which Python runs no signal handler.
STUCK = """
import ctypes
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.programs.physsim import main


def wait_forever(*_):
    print('STUCK', flush=True)
    libc = ctypes.CDLL(None)
    while True:
        # A C function, as a step of the engine; the loop is for the signal that interrupts it.
        libc.sleep(1000)


PhysSimNode.{method} = wait_forever
main()
"""

# The program with an object that takes for ever to be freed, at the end of the interpreter.
FREEING = """
import ctypes
import sys
from physsim_ros.ros.programs.physsim import main


class Crowd:
    def __del__(self, sleep=ctypes.CDLL(None).sleep):
        while True:
            sleep(1000)


sys.crowd = Crowd()
main()
"""


def start_python(outside: Outside, program: str, viewer: str = 'none') -> Program:
    """Start a program in Python with the arguments of the world."""
    words = ('--ros-args', '-p', f'viewer:={viewer}')
    return outside.start(sys.executable, '-c', program, *words)


def world_file(outside: Outside, content: str) -> Path:
    path = outside.directory / 'given.yaml'
    path.write_text(content)
    return path


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_it_says_that_it_is_ready_and_ends_with_0_when_told_to(
    outside: Outside, number: int
) -> None:
    with outside.start_world(world_file='demo') as world:
        line = world.wait_for('ready')
        bodies = (ROOT / 'config' / 'worlds' / 'demo.yaml').read_text().count('name: ')
        assert f'{bodies} bodies' in line
        assert world.interrupt(number) == 0
        assert 'Traceback' not in ''.join(world.lines)


def test_it_ends_with_0_when_told_to_again_and_again(outside: Outside) -> None:
    with outside.start_world() as world:
        world.wait_for('ready')
        for _ in range(20):
            world.process.send_signal(signal.SIGINT)
            world.process.send_signal(signal.SIGTERM)
        assert world.finish() == 0
        assert 'Traceback' not in ''.join(world.lines)


@pytest.mark.parametrize('method', ['tick', '_set_up', 'destroy_node'])
def test_it_ends_with_0_when_told_to_whatever_it_does(outside: Outside, method: str) -> None:
    with start_python(outside, STUCK.format(method=method)) as world:
        world.wait_for('ready' if method == 'destroy_node' else 'STUCK')
        assert world.interrupt() == 0


def test_it_does_not_wait_for_what_is_freed_in_the_end(outside: Outside) -> None:
    with start_python(outside, FREEING) as world:
        world.wait_for('ready')
        assert world.interrupt() == 0


def test_nothing_outlives_it_when_it_is_killed(outside: Outside) -> None:
    psutil = pytest.importorskip('psutil')
    with outside.start_world(viewer='web') as world:
        world.wait_for('http://127.0.0.1')
        children = psutil.Process(world.process.pid).children(recursive=True)
        assert children
        world.interrupt(signal.SIGKILL)
        _, alive = psutil.wait_procs(children, PATIENCE)
        assert not alive


def test_a_frozen_viewer_does_not_keep_it(outside: Outside) -> None:
    psutil = pytest.importorskip('psutil')
    with outside.start_world(viewer='web') as world:
        world.wait_for('http://127.0.0.1')
        (child,) = psutil.Process(world.process.pid).children()
        child.suspend()
        assert world.interrupt() == 0
        _, alive = psutil.wait_procs([child], PATIENCE)
        assert not alive


def test_a_record_file_that_blocks_does_not_keep_it_from_starting(outside: Outside) -> None:
    path = outside.directory / 'fifo.rrd'
    os.mkfifo(path)
    with outside.start_world(record_file=path) as world:
        world.wait_for('ready')
        assert str(path) in world.wait_for('record_failed')
        assert world.interrupt() == 0


def test_a_bug_in_a_step_ends_it_loudly_and_leaves_no_viewer_running(outside: Outside) -> None:
    psutil = pytest.importorskip('psutil')
    with start_python(outside, BUG, viewer='web') as world:
        _, page = world.wait_for('CHILDREN').split()
        assert world.finish() == 1
    left = []
    with suppress(psutil.NoSuchProcess):
        _, left = psutil.wait_procs([psutil.Process(int(page))], PATIENCE)
    for each in left:
        each.kill()
    assert 'ZeroDivisionError' in ''.join(world.lines)
    assert not left


@pytest.mark.parametrize('output', ['/dev/full', '>(true)'])
def test_nobody_has_to_read_what_it_prints(outside: Outside, output: str) -> None:
    words = '--ros-args -p viewer:=none -p sketchpad:=serve -p sketchpad_port:=0'
    command = f'exec {installed_program("physsim")} {words} > {output}'
    with outside.start('bash', '-c', command) as world:
        world.wait_for('failure 1, sketchpad')
        world.wait_for('ready')
        assert world.interrupt() == 0


def test_its_first_pose_is_seen_by_another_process(outside: Outside) -> None:
    with outside.start_elsewhere('look') as watcher:
        watcher.wait_for('LOOKING')
        with outside.start_world(world_file='demo') as world:
            line = watcher.wait_for('RESULT')
            seen = json.loads(line.partition(' ')[2])
            assert watcher.finish() == 0
            took = seen['first'] - world.started
            print(f'{took:.2f} s to the first pose')  # noqa: T201 - for who reads the log
            assert seen['bodies'] > 0
            assert world.interrupt() == 0


def test_a_thousand_bodies_without_a_viewer_fit_into_memory(outside: Outside) -> None:
    with outside.start_world(world_file=world_file(outside, THOUSAND)) as world:
        assert '1000 bodies' in world.wait_for('ready')
        # Somebody looks, so that everything has been made that is ever sent.
        seen = outside.run_program('look')
        assert seen['bodies'] == 1000
        status = Path(f'/proc/{world.process.pid}/status').read_text()
        found = re.search(r'^VmRSS:\s+(\d+) kB$', status, re.MULTILINE)
        assert found
        megabytes = int(found[1]) / 1024
        print(f'{megabytes:.0f} MB with 1000 bodies')  # noqa: T201 - for who reads the log
        assert megabytes < 250
        assert world.interrupt() == 0


@pytest.mark.parametrize(
    ('name', 'value', 'words'),
    [
        ('speed', '99', ['speed', '64']),
        ('viewer', 'spwan', ['viewer', 'connect', "nearest is 'spawn'"]),
        ('publish_rate', '7', ['publish_rate', 'divide']),
        ('gravity', '[0, -9.81]', ['gravity', 'same type']),
        ('world_fil', 'demo', ["no parameter 'world_fil'; nearest is 'world_file'"]),
        ('world_file', 'dominos', ['nearest is', 'dominoes', 'config/worlds']),
        # Files, by what they hold.
        ('world_file', 'bodies: [', ['given.yaml', 'YAML']),
        ('world_file', 'format: 2', ['given.yaml', 'format']),
        (
            'world_file',
            'format: 1\nbodies: [{name: a/0, circle: {radius: -1}}]',
            ['given.yaml', 'a/0', 'radius'],
        ),
    ],
)
def test_a_bad_parameter_ends_it_with_a_sentence(
    outside: Outside, name: str, value: str, words: list[str]
) -> None:
    given: object = world_file(outside, value) if 'given.yaml' in words else value
    with outside.start_world(**{name: given}) as world:
        assert world.finish() == 1
    *_, last = world.lines
    assert 'Traceback' not in ''.join(world.lines)
    assert last.startswith('physsim: ')
    assert all(word in last for word in words), last


@pytest.mark.parametrize(
    'words',
    [
        '-p speed:=2 -p gravity:=[0,-9] -p bounds:=[] -p physics_rate:=480 -p density:=3',
        # The later viewer counts.
        f'--params-file {ROOT}/config/physsim.yaml -p viewer:=none',
    ],
)
def test_it_starts_with_whole_numbers_empty_lists_and_the_file_that_comes_with_it(
    outside: Outside, words: str
) -> None:
    with outside.start_world(*words.split()) as world:
        world.wait_for('ready')
        assert world.interrupt() == 0


@pytest.mark.parametrize(
    ('nodes', 'starts'), [('/**', True), ('/physsim', False), ('physsim', False)]
)
def test_a_file_for_all_nodes_may_have_parameters_of_others(
    outside: Outside, nodes: str, *, starts: bool
) -> None:
    path = outside.directory / 'shared.yaml'
    text = '{use_sim_time: false, speed: 0.0, gravty: [0.0, 0.0], plan: {rate: 2}}'
    path.write_text(f'{nodes}:\n  ros__parameters: {text}\n')
    with outside.start_world('--params-file', str(path)) as world:
        if starts:
            world.wait_for("no parameter 'gravty'; nearest is 'gravity'")
            world.wait_for("ignored parameters for all nodes: 'plan.rate'")
            world.wait_for('ready')
            assert world.interrupt() == 0
        else:
            assert world.finish() == 1
            assert "physsim: there is no parameter 'gravty'" in ''.join(world.lines)


def test_it_can_be_started_in_a_namespace_under_another_name(outside: Outside) -> None:
    with outside.start_world('-r', '__ns:=/lab', '-r', '__node:=world') as world:
        assert '[lab.world]' in world.wait_for('ready')
        assert world.interrupt() == 0


@pytest.mark.parametrize(
    ('words', 'code', 'said'),
    [
        (['--help'], 0, 'usage: physsim'),
        (['demo'], 2, 'usage: physsim'),
        (['-p', 'speed:=1.0'], 2, '--ros-args -p name:=value'),
        (['world_file:=demo'], 2, 'a parameter: --ros-args -p world_file:=demo'),
        (['--ros-args', '--foo'], 1, "unknown arguments after --ros-args: ['--foo']"),
        (['--ros-args', '-r', f'__ns:=/{"x" * 300}'], 1, 'physsim: error creating node: invalid'),
    ],
)
def test_it_says_how_it_is_told_things(
    outside: Outside, words: list[str], code: int, said: str
) -> None:
    with outside.start_installed('physsim', *words) as program:
        assert program.finish() == code
    assert said in ''.join(program.lines)


def test_its_help_tells_every_world_and_parameter(outside: Outside) -> None:
    with outside.start_installed('physsim', '--help') as program:
        assert program.finish() == 0
    names = [line.split()[0] for line in program.lines if re.match('  [a-z]', line)]
    worlds = [path.stem for path in (ROOT / 'config' / 'worlds').glob('*.yaml')]
    assert {*worlds, *SPECS} <= set(names)
    # The sentence that the file begins with, whole.
    assert 'at its steepest 36 degrees' in ' '.join(' '.join(program.lines).split())
