# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Convert a world of another program, and print what is left out."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path
import sys

from physsim_ros.convert import flatland, irsim, rube, tiled
from physsim_ros.convert.content import BadContent, Content, parsed
from physsim_ros.convert.conversion import Conversion
from physsim_ros.files import (
    advice_on_xml,
    CONVERTED,
    load_world,
    MOST_BYTES,
    read_bytes,
)
from physsim_ros.model.errors import BadWorldFile, Refusal, WorldFull

_CONVERTERS: Mapping[str, Callable[[Content, Path], Conversion]] = {
    'flatland': flatland.convert,
    'ir-sim': irsim.convert,
    'Tiled': tiled.convert,
    'R.U.B.E.': rube.convert,
}


def convert(source: Path) -> Conversion:
    """
    Return the world of a file of another program.

    :param source: path of the file
    :raises Refusal: it is of no kind that is converted, or has a mistake
    :raises OSError: it cannot be read
    """
    text = read_bytes(source, MOST_BYTES)
    if advice := advice_on_xml(text.decode()):
        raise Refusal(advice)
    value = parsed(text, source.name)
    content = Content(value if isinstance(value, Mapping) else {})
    kind = content.kind
    if kind not in _CONVERTERS:
        raise BadContent(f'{source.name} is no world of {", ".join(CONVERTED)}')
    try:
        conversion = _CONVERTERS[kind](content, source.parent)
    except Refusal as refusal:
        raise BadContent(f'{source.name} is no valid world of {kind}: {refusal}') from refusal
    except RecursionError:
        raise BadContent(
            f'{source.name} is no valid world of {kind}: it is nested too deep'
        ) from None
    for place in content.unread():
        conversion.tell(f'left out: {place}')
    return conversion


def main(arguments: list[str] | None = None) -> int:
    """Convert a file; return the exit code."""
    parser = argparse.ArgumentParser(prog='python -m physsim_ros.convert', description=__doc__)
    parser.add_argument('source', type=Path, help=f'file of {", ".join(CONVERTED)}')
    parser.add_argument(
        'target', type=Path, nargs='?', help='world file to write; default: SOURCE-world.yaml'
    )
    parsed = parser.parse_args(arguments)
    source: Path = parsed.source
    target: Path = parsed.target or source.with_name(f'{source.stem}-world.yaml')
    try:
        conversion = convert(source)
        # A world file that somebody has edited is not overwritten.
        with target.open('x', encoding='utf-8') as file:
            file.write(conversion.text())
        load_world(target)
    except (OSError, UnicodeDecodeError, Refusal) as error:
        is_written = isinstance(error, BadWorldFile | WorldFull)
        written = f'{target} is written, but ' if is_written else ''
        print(f'{written}{error}', file=sys.stderr)
        return 1
    bodies, joints = len(conversion.bodies), len(conversion.joints)
    print(f'{target}: {bodies} bodies, {joints} joints')
    for sentence in conversion.told():
        print(f'  {sentence}')
    return 0


if __name__ == '__main__':
    sys.exit(main())
