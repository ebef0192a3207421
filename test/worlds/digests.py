# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Digests of every shipped world and drawing, which tell whether a change moves anything by a bit.

``python -m test.worlds.digests`` writes them anew, into ``digests.yaml``; with ``--print``
those of the first time are printed instead.
"""

from pathlib import Path
import sys

from physsim_ros.drawing import DrawingSession, DrawingSettings
from physsim_ros.files import drawings, load_drawing, shipped_worlds
from physsim_ros.simulation.simulation import Simulation
import yaml

from .film import simulation

DIGESTS = Path(__file__).with_name('digests.yaml')
WORLDS = sorted(path.stem for path in shipped_worlds().glob('*.yaml'))
DRAWINGS = sorted(drawings())
SCENES = [f'worlds/{name}' for name in WORLDS] + [f'drawings/{name}' for name in DRAWINGS]
# Simulation time at which digests are taken [s]; the rewind goes from the last to the first.
TIMES = (2, 6)


def scene(name):
    """Begin with a shipped world, or with a drawing that has been drawn while time stood."""
    folder, _, name = name.partition('/')
    if folder == 'worlds':
        return simulation(name)
    sim, pen = Simulation(speed=0.0), DrawingSession(DrawingSettings())
    frame = sim.advance_frame()
    for _, stroke in load_drawing(name):
        for request in pen.stroke(stroke, '', frame.snapshot).requests:
            sim.requests.submit(request, topic='~/stroke')
        frame = sim.apply_requests() or frame
    return sim


def digest_at(sim, time):
    """Go on to a time [s], and return the digest there."""
    while sim.step < round(time * sim.physics_rate):
        sim.advance_frame()
    return sim.world.digest()


def digests(times=TIMES):
    """Return the digests of all scenes at some times [s], by name of the scene."""
    found = {}
    for name in SCENES:
        played = scene(name)
        found[name] = [digest_at(played, time) for time in times]
    return found


if __name__ == '__main__':
    if '--print' in sys.argv:
        sys.stdout.write(yaml.safe_dump(digests(TIMES[:1])))
    else:
        DIGESTS.write_text(yaml.safe_dump(digests()), encoding='utf-8')
