# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Crossings of scenes and relations that do not hold, each with how far it is off, and why.

``exceptions.yaml`` has reasons, below each the relations, and below these the scenes with figures:
metres, of a chaotic scene a share of its energy. ``python -m test.relations.exceptions`` measures
all crossings, scene by scene, and writes those of each anew as soon as they are known; names of
relations after it have only those measured. Known crossings keep their reasons; to others it gives
`UNKNOWN`, which a test refuses. A core that is built meanwhile ends the run.
"""

from pathlib import Path
import sys
import zlib

import yaml

from .relations import RELATIONS, ROUNDING
from .scenes import SCENES, SMALL

FILE = Path(__file__).with_name('exceptions.yaml')
REASONS = yaml.safe_load(FILE.read_text(encoding='utf-8'))
UNKNOWN = 'unknown'
# By relation and scene.
EXCEPTIONS = {
    (relation, scene): off
    for relations in REASONS.values()
    for relation, scenes in relations.items()
    for scene, off in scenes.items()
}
# By which factor a figure of an exception may be exceeded [1]: it is a rounded one, and of bodies
# that other parts of the step move as well.
MARGIN = 3.0
# Of other crossings than those of small scenes, one in so many is quick.
ONE_IN = 23
# How far two worlds may part that differ by rounding, in ways that two part of which one is shaken
# by a picometre [1]: places of a few metres are rounded to less, but in each sub-step.
SENSITIVITY = 30.0


def is_quick(relation, scene):
    """
    Return whether `make test` has a crossing: all of small scenes, and some of the others.

    Those are chosen by the two names alone, so that a new scene or relation changes no choice.
    """
    return scene in SMALL or zlib.crc32(f'{relation}, {scene}'.encode()) % ONE_IN == 0


def crossings():
    """Return the names of all relations and scenes that are crossed."""
    return [(relation, scene) for relation in RELATIONS for scene in SCENES]


def limit(relation, scene):
    """
    Return by how much a crossing may be off: metres, of a chaotic scene a share of its energy.

    Where a picometre parts two worlds of a scene, rounding does.
    """
    law = RELATIONS[relation]
    limit = law.limit(SCENES[scene])
    if law.reason != ROUNDING or relation == 'shaken':
        return limit
    return max(limit, SENSITIVITY * EXCEPTIONS.get(('shaken', scene), 0.0))


def measured(scene, names):
    """Return how far crossings of a scene with relations are off that do not hold, to 2 digits."""
    found = {}
    for name in names:
        relation = RELATIONS[name]
        if relation.is_about(SCENES[scene]):
            off = relation.off(SCENES[scene])
            if not off <= limit(name, scene):
                found[name, scene] = float(f'{off:.2g}')
    return found


def with_reasons(found):
    """Return crossings by their reasons, relations and scenes, as the file has them."""
    reasons = {
        (relation, scene): reason
        for reason, relations in REASONS.items()
        for relation, scenes in relations.items()
        for scene in scenes
    }
    told = {}
    for (relation, scene), off in sorted(found.items()):
        reason = reasons.get((relation, scene), UNKNOWN)
        told.setdefault(reason, {}).setdefault(relation, {})[scene] = off
    return told


def write(found):
    """Write crossings to the file."""
    text = yaml.safe_dump(with_reasons(found), allow_unicode=True, width=99)
    FILE.write_text(text, encoding='utf-8')


def main(names):
    """Measure the crossings of some relations with all scenes, and write them."""
    for number, scene in enumerate(SCENES, start=1):
        for name in names:
            EXCEPTIONS.pop((name, scene), None)
        # The first relation says what a picometre does, by which others are bounded.
        for name in names:
            EXCEPTIONS.update(measured(scene, [name]))
        write(EXCEPTIONS)
        sys.stderr.write(f'{number} of {len(SCENES)}: {scene}\n')


if __name__ == '__main__':
    main(sys.argv[1:] or list(RELATIONS))
