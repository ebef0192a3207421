# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Modules, files, functions and commands that documents and docstrings name in backticks are there.

A name with a dot begins with a module, a class or a library; one without is any identifier of the
package or of a library that it imports.
"""

import ast
import builtins
from collections import defaultdict
from importlib import import_module
from importlib.util import find_spec
import re

import numpy as np
from physsim_ros.model.robots.drives import DRIVES
import pymunk
from pymunk._chipmunk_cffi import lib
import pymunk.batch
import pytest

from .sources import BASES, DOCUMENTS, module_name, ROOT, spans, trees

# Names of Chipmunk, Box2D, Bullet, Jolt, Rerun, Vega, pytest and ROS.
ELSEWHERE = re.compile(
    r'(cp|pm|b2|bt|mMax)_?[A-Z]\w*|b2_\w+|GJKRecurse|GetBB|\w+Batch|GreaterEqual|tableau10'
    r'|pytest11|\w+_(msgs|srvs|interfaces)|ROS_\w+|ament_\w+|qos_profile_\w+'
)


TREES = trees()
# Dotted names of modules, whole and from each folder on, as docstrings shorten them.
MODULES = defaultdict(list)
for _path, _tree in TREES.items():
    _parts = module_name(_path).split('.')
    for _first in range(len(_parts)):
        MODULES['.'.join(_parts[_first:])].append(_tree)


def _defined(tree):
    """Return the names that a module or class and all in it define, import or assign."""
    names = set()
    for node in ast.walk(tree):
        match node:
            case (
                ast.FunctionDef(name=name)
                | ast.AsyncFunctionDef(name=name)
                | ast.ClassDef(name=name)
                | ast.arg(arg=name)
                | ast.keyword(arg=str(name))
                | ast.Name(id=name)
                | ast.Attribute(attr=name)
            ):
                names.add(name)
            case ast.alias(name=name, asname=other):
                names.add(other or name.split('.')[0])
    return names


def _own(node):
    """Return the names of the members of a class, those set on `self` included."""
    names = set()
    for each in ast.walk(node):
        match each:
            case (
                ast.FunctionDef(name=name)
                | ast.AsyncFunctionDef(name=name)
                | ast.Name(id=name, ctx=ast.Store())
                | ast.Attribute(attr=name, ctx=ast.Store())
            ):
                names.add(name)
    return names


CLASSES = defaultdict(set)
IMPORTED = defaultdict(set)
for _tree in TREES.values():
    for _node in ast.walk(_tree):
        match _node:
            case ast.ClassDef(name=_name):
                CLASSES[_name] |= _own(_node)
            case ast.ImportFrom(module=str(_module), names=_names):
                for _alias in _names:
                    IMPORTED[_alias.asname or _alias.name].add((_module, _alias.name))
            case ast.Import(names=_names):
                for _alias in _names:
                    IMPORTED[_alias.asname or _alias.name].add((_alias.name, None))
LIBRARIES = [builtins, np, pymunk, pymunk.batch, lib]
LIBRARIES += [each for each in vars(pymunk).values() if isinstance(each, type)]
WORDS = {word for each in LIBRARIES for word in dir(each)}
WORDS |= {word for tree in TREES.values() for word in _defined(tree)}
WORDS |= {part for name in MODULES for part in name.split('.')}
# Keys, codes and names of parameters.
WORDS |= {
    node.value
    for tree in TREES.values()
    for node in ast.walk(tree)
    if isinstance(node, ast.Constant) and isinstance(node.value, str)
}
WORDS |= {path.stem for folder in ('test', 'config') for path in (ROOT / folder).rglob('*.*')}


def _found_in(value, rest):
    for part in rest:
        if not hasattr(value, part):
            return False
        value = getattr(value, part)
    return True


def _in_library(head, rest):
    """Return whether a library that the package imports, or a class of one, has a name."""
    if head in vars(pymunk) and _found_in(getattr(pymunk, head), rest):
        return True
    for module, name in IMPORTED[head]:
        if module.startswith('physsim_ros'):
            continue
        try:
            value = import_module(module)
        except ImportError:
            # The package is tested without ROS or Rerun too.
            return True
        if _found_in(value if name is None else getattr(value, name), rest):
            return True
    return False


def _resolves(name):
    """Return whether a dotted name is that of a module, or of something in a module or class."""
    parts = name.split('.')
    if name in MODULES or (len(parts) == 2 and parts[1] in CLASSES.get(parts[0], ())):
        return True
    before = '.'.join(parts[:-1])
    if any(parts[-1] in _defined(tree) for tree in MODULES.get(before, ())):
        return True
    return _in_library(parts[0], parts[1:])


def _is_known(span, *, everywhere):
    """Return whether what a span in backticks names is there, if it names anything."""
    words = span.split()
    path, head = words[0], re.match(r'\w*', span).group()
    if len(words) > 1:
        return _command_runs(words) and all(map(_path_exists, words))
    if '/' in path:
        return _path_exists(path)
    if re.fullmatch(r'\w+\.py', path):
        return any(ROOT.rglob(f'physsim_ros/**/{path}')) or path in {'setup.py', '__init__.py'}
    if path.endswith('.rrd'):
        return True  # a recording, though functions are called as it is
    if re.fullmatch(r'[A-Za-z_]\w*(\.\w+)+', path):
        known = head in MODULES or head in CLASSES or head in IMPORTED
        return ELSEWHERE.fullmatch(head) or not known or _resolves(path)
    if re.fullmatch(r'[A-Za-z_]\w*', path) and (everywhere or '_' in path):
        return path in WORDS or ELSEWHERE.fullmatch(path)
    return True


def _path_exists(word):
    """Return whether a path leads somewhere, if it begins with a folder of the project."""
    if not re.fullmatch(r'[\w.-]+(/[\w.-]*)+', word):
        return True
    folders = {each.name for base in BASES for each in base.iterdir() if each.is_dir()}
    inside = word.split('/')[0] in folders
    return not inside or any((base / word).exists() for base in BASES)


def _command_runs(words):
    match words:
        case ['make', *targets]:
            listed = re.findall(
                r'^([\w-]+):', (ROOT / 'Makefile').read_text('utf-8'), re.MULTILINE
            )
            plain = [word for word in targets if re.fullmatch(r'[a-z-]+', word)]
            return set(plain[: _before_arguments(targets)]) <= set(listed)
        case ['pytest' | 'python' | '.venv/bin/python', *_]:
            paths = [word for word in words if word.startswith('test/')]
            modules = [word for word in words if word.startswith('test.')]
            paths += [f'{module.replace(".", "/")}.py' for module in modules]
            return all((ROOT / path).exists() for path in paths)
    return True


def _before_arguments(words):
    """Return how many words come before an assignment, whose value may have spaces."""
    return next((place for place, word in enumerate(words) if '=' in word), len(words))


pytestmark = pytest.mark.linter
OF_DOCUMENTS = {
    # Files that the reader makes, and one of another project.
    *('conftest.py', 'damper.py', 'fall.py', 'first.py', 'follower.py', 'parser.py', 'stopper.py'),
    *('path.py', 'test_cradle.py', 'test_crash.py', 'test_fall.py', 'test_stopper.py'),
    *('test_tracker.py', 'tracker.py', 'test_wall_follower.py', 'wall_follower.py'),
    *('wall_task.py', 'ament_add_pytest_test'),
    # Fields of messages, names and parameters of Nav2.
    *('values.body', 'values.yaml', 'enable_stamped_cmd_vel', 'map_server'),
    *('controller_frequency', 'expected_update_rate', 'odom_frame_id'),
    *('robot_base_frame', 'base_frame_id', 'transform_tolerance', 'yaml_filename'),
    *('bringup_launch.py', 'use_sim_time', 'slam', 'params_file', 'autostart', 'use_composition'),
    *('amcl_node.cpp', 'costmap_2d_ros.cpp', 'laser_utils.cpp', 'odometry_utils.hpp'),
    *('robot_utils.cpp', 'static_layer.cpp'),
    # Of simulation_interfaces, which the node does without.
    *('STATE_LOADING_WORLD', 'TYPE_CONVEX_HULL', 'fail_on_unsupported_element'),
    # Keys of the mapping `drive` of a robot.
    *(f'drive.{key}' for each in DRIVES.values() for key in ('kind', *each.FIELDS)),
}


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: path.name)
def test_what_a_document_names_is_there(document):
    found = set(spans(document.read_text(encoding='utf-8'))) - OF_DOCUMENTS

    assert [each for each in sorted(found) if not _is_known(each, everywhere=False)] == []


def test_what_docstrings_name_is_there():
    missing = []
    for path, tree in TREES.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                missing += [
                    f'{path.relative_to(ROOT)}: {each}'
                    for each in spans(ast.get_docstring(node) or '')
                    if not _is_known(each, everywhere=True)
                ]

    assert missing == []


def _imported(tree):
    """Yield the module and the name of each import from the package."""
    for node in ast.walk(tree):
        match node:
            case ast.ImportFrom(module=str(module), level=0) if module.startswith('physsim_ros'):
                yield from ((module, each.name) for each in node.names)


def test_what_tools_and_examples_import_from_the_package_is_there():
    missing = []
    for path in sorted({*ROOT.glob('tools/**/*.py'), *ROOT.glob('examples/*.py')}):
        for module, name in _imported(ast.parse(path.read_text(encoding='utf-8'))):
            found = import_module(module)
            is_module = hasattr(found, '__path__') and find_spec(f'{module}.{name}') is not None
            if not hasattr(found, name) and not is_module:
                missing.append(f'{path.relative_to(ROOT)}: {module}.{name}')

    assert missing == []


@pytest.mark.parametrize(
    'wrong',
    [
        *('engine/no_such_file.py', 'no_such_module.py', 'Space.no_such_member', 'no_such_name'),
        *('engine.no_such_module', 'np.no_such_function', 'make no-such-target'),
        *('pytest test/no_such_test.py', 'python -m test.no_such_module'),
    ],
)
def test_what_is_not_there_is_found(wrong):
    assert not _is_known(wrong, everywhere=True)
