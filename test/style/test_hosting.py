# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Container and workflow name what there is."""

import json
import re
import shutil
import subprocess

import pytest
import yaml

from ..source_tree import ROOT

CONTAINER = ROOT / 'Containerfile'
WORKFLOWS = sorted(ROOT.glob('.github/workflows/*.yaml'))

# A checkout of colcon's tests has no hidden files.
pytestmark = [
    pytest.mark.linter,
    pytest.mark.skipif(not WORKFLOWS, reason='hidden files were not copied'),
]


def _targets():
    """Return the targets of the Makefile."""
    text = (ROOT / 'Makefile').read_text(encoding='utf-8')
    return {*re.findall(r'^([a-z-]+):', text, re.MULTILINE), '.venv/.with-tools'}


def _asked(text):
    """Return the targets of `make` that commands name."""
    return set(re.findall(r'\bmake ([\w./-]+)', text))


@pytest.mark.skipif(shutil.which('hadolint') is None, reason='hadolint is not installed')
def test_hadolint_finds_nothing_in_the_container():
    done = subprocess.run(['hadolint', CONTAINER], capture_output=True, text=True, check=False)

    assert done.stdout == ''


@pytest.mark.skipif(shutil.which('actionlint') is None, reason='actionlint is not installed')
@pytest.mark.parametrize('workflow', WORKFLOWS, ids=lambda path: path.name)
def test_actionlint_finds_nothing_in_a_workflow(workflow):
    done = subprocess.run(['actionlint', workflow], capture_output=True, text=True, check=False)

    assert done.stdout == ''


def test_the_container_starts_a_program_of_the_package_with_parameters_that_there_are():
    parameters = pytest.importorskip('physsim_ros.ros.parameters', reason='there is no ROS')
    text = CONTAINER.read_text(encoding='utf-8')
    (command,) = re.findall(r'^CMD (.*)$', text, re.MULTILINE)

    program, ros_args, *words = json.loads(command)

    assert (program, ros_args, words[::2]) == ('physsim', '--ros-args', ['-p'] * (len(words) // 2))
    assert {word.partition(':=')[0] for word in words[1::2]} <= set(parameters.SPECS)


def test_the_container_has_a_python_that_the_package_takes():
    (found,) = re.findall(r'^FROM python:3\.(\d+)', CONTAINER.read_text('utf-8'), re.MULTILINE)
    (asked,) = re.findall(r"python_requires='>=3\.(\d+)'", (ROOT / 'setup.py').read_text('utf-8'))

    assert int(found) >= int(asked)


@pytest.mark.parametrize('path', WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_runs_what_there_is(path):
    jobs = yaml.safe_load(path.read_text(encoding='utf-8'))['jobs']
    runs = [step['run'] for job in jobs.values() for step in job['steps'] if 'run' in step]

    assert 'bash .ci/run' in runs
    assert _asked('\n'.join(runs)) <= _targets()
    assert (ROOT / '.ci/run').is_file()
