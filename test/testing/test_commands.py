# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands with `ros2` in the documents are accepted by a world, as a reader types them."""

from __future__ import annotations

from collections.abc import Iterator
import importlib
from pathlib import Path
import re
import shlex
from typing import Any

from physsim_ros import find_world
from physsim_ros.testing import own_world
import pytest
import yaml

from ..client import Client, message_of
from ..source_tree import ROOT

# The world in which a page has its reader, where it is not that of `make run`.
WORLDS = {'rewind_to_the_crash': 'boxes', 'actors': 'people', 'robots': 'boxes'}
# A command ends at a line break outside of quotes.
COMMAND = re.compile(r"""^ *ros2 ((?:'[^']*'|"[^"]*"|[^'"\n])+)""", re.MULTILINE)
VERBS = ['topic pub', 'service call', 'param set']
# A parameter at the start, and its value.
STARTED = re.compile(r"-p '?(\w+):='?(\[[^]]*\]|[^\s'`\")]+)")
# A joint of a kind that the reader of a tutorial has added.
UNKNOWN_HERE = 'kind: damper'


def commands(page: Path) -> Iterator[list[str]]:
    """Yield the words after `ros2` of each command in the blocks of a page."""
    text = page.read_text('utf-8')
    for block in re.findall(r'^ *```sh\n(.*?)^ *```', text, re.MULTILINE | re.DOTALL):
        for command in COMMAND.findall(block):
            words = shlex.split(command, comments=True)
            if ' '.join(words[:2]) in VERBS and UNKNOWN_HERE not in command:
                yield words


PAGES = [
    page
    for page in (ROOT / 'README.md', *sorted((ROOT / 'docs').rglob('*.md')))
    if any(commands(page))
]


def test_the_parameters_of_documents_are_accepted_and_their_worlds_are_there() -> None:
    documents = (ROOT / 'README.md', *sorted((ROOT / 'docs').rglob('*.md')))
    given = {each for page in documents for each in STARTED.findall(page.read_text('utf-8'))}
    worlds = {value for name, value in given if name == 'world_file' and '/' not in value}
    accepted = {name: yaml.safe_load(value) for name, value in given}
    accepted |= {'world_file': '', 'record_file': '', 'sketchpad': 'none', 'viewer': 'none'}

    assert {'demo', 'boxes', 'pendulum'} <= worlds
    for world in worlds:
        find_world(world)
    with own_world(**accepted) as physsim:
        assert not physsim.names


def kind_of(name: str) -> Any:
    """Return the class of a type such as `std_srvs/srv/Trigger`."""
    package, folder, kind = name.split('/')
    return getattr(importlib.import_module(f'{package}.{folder}'), kind)


def fill(message: Any, fields: dict[str, Any]) -> Any:
    """Set fields of a message, as `ros2 topic pub` does."""
    types = message.get_fields_and_field_types()
    for name, value in fields.items():
        of = types[name]
        if isinstance(value, dict):
            fill(getattr(message, name), value)
        elif value and isinstance(value, list) and isinstance(value[0], dict):
            package, kind = re.findall(r'<(\w+)/(\w+)', of)[0]
            each = kind_of(f'{package}/msg/{kind}')
            setattr(message, name, [fill(each(), item) for item in value])
        else:
            setattr(message, name, float(value) if of in {'double', 'float'} else value)
    return message


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.stem)
def test_the_commands_of_a_page_are_accepted(page: Path) -> None:
    with own_world() as physsim:
        physsim.load(WORLDS.get(page.stem, 'demo'))
        client = Client(physsim)
        for words in commands(page):
            match words:
                case ['topic', 'pub', *options, topic, kind, fields]:
                    assert {*options} <= {'--once', '-w', '1', '-r', '10'}
                    message = fill(kind_of(kind)(), yaml.safe_load(fields))
                    # Robots subscribe when they have found a publisher, which takes a second.
                    if topic.startswith(('/physsim', '/clicked')):
                        client.ask(topic, message)
                case ['service', 'call', service, kind]:
                    assert client.request(kind_of(kind), service, kind_of(kind).Request()).success
                case ['param', 'set', '/physsim', name, value]:
                    (result,) = client.set_parameters(message_of(name, yaml.safe_load(value)))
                    assert result.successful, result.reason
                case _:
                    pytest.fail(f'no such command: {words}')
        assert client.refusals == []
