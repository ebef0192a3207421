# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make ablate`; `make ablate ARGS='chain bridge'` chooses scenes by words in their names."""

from __future__ import annotations

import sys

from .cost import shares
from .scenes import error_of, fails, Scene, SCENES
from .stages import Stage, STAGES, switched_off


def cell(scene: Scene, stage: Stage | None) -> str:
    """Return the error of a scene without a stage, in bold type where it fails."""
    with switched_off(stage):
        error = error_of(scene)
    return f'**{error:.2g}**' if fails(scene, error) else f'{error:.2g}'


def line(*cells: str) -> None:
    """Print a row of the table."""
    print(f'| {" | ".join(cells)} |', flush=True)


def table(words: list[str]) -> None:
    """Print errors of scenes, with all stages and without each; of all scenes the costs, too."""
    chosen = [each for each in SCENES if not words or any(word in each.name for word in words)]
    if not chosen:
        sys.exit(f'no scene with {" or ".join(words)}')
    line('scene (law)', 'unit', 'tolerance', 'all stages', *(each.name for each in STAGES))
    line(*['---'] * (4 + len(STAGES)))
    for scene in chosen:
        cells = (cell(scene, stage) for stage in (None, *STAGES))
        line(scene.name, scene.unit, f'{scene.tolerance:.2g}', *cells)
    if words:
        return
    costs = ('–' if share is None else f'{100 * share:.1f}' for share in shares(STAGES))
    line('cost of the stage', '% of a step', '', '', *costs)


if __name__ == '__main__':
    table(sys.argv[1:])
