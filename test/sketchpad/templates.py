# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The texts of the package that pages translate, as a reader of Python finds them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from string import Formatter
from typing import Any

import physsim_ros
from physsim_ros.drawing.strokes.stages import MeaningKind
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join
from physsim_ros.model.settings import _COUNTED, WorldSettings
from physsim_ros.model.timeline import RunState
from physsim_ros.model.translation import counted
from physsim_ros.simulation.world.world import HANDLERS

_FILES = sorted(Path(physsim_ros.__file__).parent.rglob('*.py'))
_PHRASED: list[Any] = [each for each in HANDLERS if each is not Join]
# Templates that are no literals where a text is made of them, by their expressions there.
_DECLARED: dict[str, set[str]] = {
    **{each: set(JointKind) for each in ('kind', 'self.kind', 'request.kind', 'joint.kind')},
    'state': set(RunState),
    'noun': {'body', 'joint'},
    'said': {'pose', 'velocity', 'force', 'nothing'},
    'self.OBJECT': {each.OBJECT for each in _PHRASED} - {''},
    "f'{verb} {{thing}}'": {
        f'{each.VERB or each.__name__.lower()} {{thing}}' for each in _PHRASED
    },
    '_COUNTED[limit]': set(_COUNTED.values()),
    **{each: set(WorldSettings.FIELDS) for each in ('names[0]', 'changed[0]')},
}
# Templates that are not translated: names of settings, which files and ROS have, too.
NAMES = set(WorldSettings.FIELDS)


def server_texts() -> dict[str, set[str]]:
    """Return the templates of all texts that pages translate, with the names of their values."""
    texts: dict[str, set[str]] = {str(meaning): set() for meaning in MeaningKind}
    for path in _FILES:
        tree = ast.parse(path.read_text(encoding='utf-8'))
        for call in _calls(tree, 'Text'):
            for template in _templates(call.args[0], tree, path):
                names = texts.setdefault(template, set())
                names |= {each for _, each, *_ in Formatter().parse(template) if each}
                names |= {each.arg for each in call.keywords if each.arg}
        for call in _calls(tree, 'counted'):
            for number in (1, 2):
                text = counted(number, ast.literal_eval(call.args[1]))
                texts[text.template] = set(text.values)
    return texts


def _calls(tree: ast.AST, name: str) -> Iterator[ast.Call]:
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == name:
            yield call


def _templates(value: ast.expr, tree: ast.AST, path: Path) -> Iterator[str]:
    """
    Yield the templates that an expression may have.

    :param tree: of its file, in which a variable has its values, a parameter its arguments
    """
    if isinstance(value, ast.Constant):
        yield value.value
    elif isinstance(value, ast.IfExp):
        yield from _templates(value.body, tree, path)
        yield from _templates(value.orelse, tree, path)
    elif (source := ast.unparse(value)) in _DECLARED:
        yield from _DECLARED[source]
    elif path.stem != 'translation':
        given = [
            each.value
            for each in ast.walk(tree)
            if isinstance(each, ast.Assign) and ast.unparse(each.targets[0]) == source
        ]
        given += [
            call.args[0]
            for each in ast.walk(tree)
            if isinstance(each, ast.FunctionDef)
            and each.args.args[:1]
            and each.args.args[0].arg == source
            for call in _calls(tree, each.name)
        ]
        assert given, f'{path}: the template {source} is neither a literal nor declared here'
        for each in given:
            if isinstance(each, ast.Constant | ast.IfExp):
                yield from _templates(each, tree, path)
