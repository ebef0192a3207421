# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The texts of the package that pages translate, as a reader of Python finds them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from operator import attrgetter
from pathlib import Path
from string import Formatter
from typing import Any, NamedTuple

import physsim_ros
from physsim_ros.drawing.strokes.stages import MeaningKind
from physsim_ros.model import errors
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join
from physsim_ros.model.settings import _COUNTED, WorldSettings
from physsim_ros.model.timeline import RunState
from physsim_ros.model.translation import counted
from physsim_ros.ros.diagnostics import _SAME_NAME_REMEDY
from physsim_ros.simulation.world.world import HANDLERS

_PACKAGE = Path(physsim_ros.__file__).parent
_FILES = sorted(_PACKAGE.rglob('*.py'))
# Folders whose refusals no message of a page meets: what uses a world, and what of ROS is no
# action of a page.
_BESIDE_PAGES = {'convert', 'gym', 'ros', 'sweeps', 'testing', 'view'}
_OF_ACTIONS = {'ros/time_control.py', 'ros/world_files.py'}
_PHRASED: list[Any] = [each for each in HANDLERS if each is not Join]
# Templates that are no literals where a text is made of them, by their expressions there.
_DECLARED: dict[str, set[str]] = {
    **{each: set(JointKind) for each in ('kind', 'self.kind', 'request.kind', 'joint.kind')},
    'self.noun': {'forces', 'mappings', 'names', 'numbers', 'pairs of angles', 'points'},
    **{each: {kind.phrase for kind in JointKind} for each in ('kind.phrase', 'self.kind.phrase')},
    'state': set(RunState),
    'noun': {'body', 'joint'},
    'said': {'pose', 'velocity', 'force', 'nothing'},
    'self.OBJECT': {each.OBJECT for each in _PHRASED} - {''},
    "f'{verb} {{thing}}'": {
        f'{each.VERB or each.__name__.lower()} {{thing}}' for each in _PHRASED
    },
    '_COUNTED[limit]': set(_COUNTED.values()),
    '_SAME_NAME_REMEDY': {_SAME_NAME_REMEDY},
    **{each: set(WorldSettings.FIELDS) for each in ('names[0]', 'changed[0]')},
}
# Templates that are not translated: names of settings, which files and ROS have, too.
NAMES = set(WorldSettings.FIELDS)
# Classes of refusals that pages meet; `BadDrawing` is left out: no page reads a drawing.
_REFUSALS = {'NotYaml', 'error'} | {
    name
    for name, each in vars(errors).items()
    if isinstance(each, type) and issubclass(each, errors.Refusal)
}
# First arguments of refusals that are texts.
_TEXTS = {'error.text', 'refusal.text', 'refusal.brief', 'message', 'advice'}
# Files that make texts of the templates that they get.
_MAKERS = 'model/translation.py', 'model/errors.py'
# Keywords of a refusal that are no values of its template.
_OWN = {'brief', 'cause', 'concerns', 'guesses'}


class Made(NamedTuple):
    """
    A template that a call makes a text of.

    :ivar place: of the call: file and line
    :ivar values: names of those that it gives
    :ivar words: values that are literals, and literal parts of others
    :ivar is_met: whether a page can meet it
    """

    place: str
    template: str
    values: frozenset[str]
    words: tuple[str, ...] = ()
    is_met: bool = True


def made_texts() -> Iterator[Made]:
    """Yield the templates of all texts and refusals of the package."""
    for path in _FILES:
        tree = ast.parse(path.read_text(encoding='utf-8'))
        name = str(path.relative_to(_PACKAGE))
        is_met = path.parent != _PACKAGE and (
            name.partition('/')[0] not in _BESIDE_PAGES or name in _OF_ACTIONS
        )
        for call, function in _calls(tree):
            place, kind = f'{name}:{call.lineno}', call.func.id
            given = {each.arg or '**' for each in call.keywords} - _OWN
            words = tuple(word for each in call.keywords for word in _words(each))
            if kind == 'counted':
                for number in (1, 2):
                    text = counted(number, ast.literal_eval(call.args[1]))
                    yield Made(place, text.template, frozenset(text.values))
            elif kind == 'Text' or (kind == 'must_be' and not _is_text(call.args[0])):
                for template in _templates(call.args[0], function, tree, place):
                    yield Made(place, template, frozenset(given), words)
            elif kind in _REFUSALS and not _is_text(call.args[0]):
                for template in _templates(call.args[0], function, tree, place):
                    yield Made(place, template, frozenset(given | {'field'}), words, is_met)


def server_texts() -> dict[str, set[str]]:
    """Return the templates of all texts that pages translate, with the names of their values."""
    texts: dict[str, set[str]] = {str(meaning): set() for meaning in MeaningKind}
    for each in filter(attrgetter('is_met'), made_texts()):
        texts.setdefault(each.template, set()).update(each.values | places_in(each.template))
    del texts['']
    return texts


def places_in(template: str) -> set[str]:
    """Return the names of the values that a template has."""
    return {name for _, name, *_ in Formatter().parse(template) if name is not None}


def _calls(tree: ast.AST) -> Iterator[tuple[Any, ast.AST]]:
    """Yield the calls of names that have arguments, each with the function that it is in."""
    for function in ast.walk(tree):
        if isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef | ast.Module):
            within = list(ast.iter_child_nodes(function))
            while within:
                each = within.pop()
                if not isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef):
                    within += ast.iter_child_nodes(each)
                if isinstance(each, ast.Call) and isinstance(each.func, ast.Name) and each.args:
                    yield each, function


def _words(given: ast.keyword) -> Iterator[str]:
    """Yield the literals that a value is, or may be, made of: not those that it is asked with."""
    ahead: list[ast.AST] = [] if given.arg in _OWN | {'field'} else [given.value]
    while ahead:
        each = ahead.pop()
        if isinstance(each, ast.Constant) and isinstance(each.value, str):
            yield each.value
        elif isinstance(each, ast.IfExp):
            ahead += each.body, each.orelse
        elif isinstance(each, ast.JoinedStr | ast.BoolOp):
            ahead += each.values


def _is_text(value: ast.expr) -> bool:
    """Return whether an argument is a text already: what a call returns, or a refusal has."""
    return isinstance(value, ast.Call) or ast.unparse(value) in _TEXTS


def _templates(value: ast.expr, function: ast.AST, tree: ast.AST, place: str) -> Iterator[str]:
    """
    Yield the templates that an expression may have.

    :param function: it is in, where a variable has its values
    :param tree: of its file, in which a parameter has its arguments
    """
    if isinstance(value, ast.Constant):
        yield value.value
    elif isinstance(value, ast.IfExp):
        yield from _templates(value.body, function, tree, place)
        yield from _templates(value.orelse, function, tree, place)
    elif (source := ast.unparse(value)) in _DECLARED:
        yield from _DECLARED[source]
    else:
        given = [*_assigned(source, function)] or [
            (call.args[0], within)
            for each in ast.walk(tree)
            if isinstance(each, ast.FunctionDef)
            and each.args.args[:1]
            and each.args.args[0].arg == source
            for call, within in _calls(tree)
            if call.func.id == each.name
        ]
        known = given or place.startswith(_MAKERS)
        assert known, f'{place}: the template {source} is neither a literal nor declared here'
        for each, within in given:
            if isinstance(each, ast.Constant | ast.IfExp):
                yield from _templates(each, within, tree, place)


def _assigned(name: str, function: ast.AST) -> Iterator[tuple[ast.expr, ast.AST]]:
    """Yield what a function assigns to a variable."""
    for each in ast.walk(function):
        if isinstance(each, ast.Assign):
            target, value = each.targets[0], each.value
            pairs: list[tuple[ast.expr, ast.expr]] = [(target, value)]
            if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                pairs = list(zip(target.elts, value.elts, strict=True))
            yield from ((found, function) for each, found in pairs if ast.unparse(each) == name)
