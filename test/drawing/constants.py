# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The named numbers of drawing, and a module of tests over a drawing with another number."""

import ast
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
import importlib
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
import sys
from types import ModuleType

from physsim_ros import drawing

FOLDER = Path(drawing.__file__).parent
# A file, and a number in it.
Place = tuple[Path, ast.Constant]


def constants(paths: Iterable[Path]) -> dict[str, Place]:
    """Return the named numbers of files, `module.NAME`; of a tuple or formula, its first one."""
    found: dict[str, Place] = {}
    for path in paths:
        for node in ast.parse(path.read_text('utf-8')).body:
            if not isinstance(node, ast.Assign):
                continue
            (target,) = node.targets
            pairs = [(target, node.value)]
            if isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple):
                pairs = list(zip(target.elts, node.value.elts, strict=True))
            for name, value in pairs:
                numbers = [
                    each
                    for each in ast.walk(value)
                    if isinstance(each, ast.Constant) and type(each.value) in {int, float}
                ]
                if numbers and isinstance(name, ast.Name) and name.id != '_atan2':
                    found[f'{path.stem}.{name.id}'] = path, numbers[0]
    return found


@contextmanager
def another_number(tests: str, place: Place, factor: float) -> Iterator[ModuleType]:
    """Yield a module of tests over a drawing in which one number is multiplied by a factor."""
    path, number = place
    value = number.value
    assert isinstance(value, int | float)
    changed = value * factor
    if isinstance(value, int):
        changed = (
            max(round(changed), value + 1) if factor > 1.0 else min(round(changed), value - 1)
        )
    lines = path.read_text('utf-8').splitlines()
    line = lines[number.lineno - 1]
    begin, end = number.col_offset, number.end_col_offset
    lines[number.lineno - 1] = line[:begin] + repr(changed) + line[end:]
    own = 'physsim_ros.drawing', 'test.drawing'
    kept = {name: each for name, each in sys.modules.items() if name.startswith(own)}
    for name in kept:
        del sys.modules[name]
    finder = _Patched(path, '\n'.join(lines))
    sys.meta_path.insert(0, finder)
    try:
        yield importlib.import_module(tests)
    finally:
        sys.meta_path.remove(finder)
        for name in [each for each in sys.modules if each.startswith(own)]:
            del sys.modules[name]
        sys.modules.update(kept)


class _Patched(MetaPathFinder, Loader):
    """Imports one module from another text than that of its file."""

    def __init__(self, path: Path, text: str) -> None:
        words = 'physsim_ros', 'drawing', *path.relative_to(FOLDER).with_suffix('').parts
        self._name, self._path, self._text = '.'.join(words), path, text

    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        found = name == self._name
        return spec_from_file_location(name, self._path, loader=self) if found else None

    def exec_module(self, module: ModuleType) -> None:
        exec(compile(self._text, str(self._path), 'exec'), module.__dict__)  # noqa: S102
