# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The pages of learning and sweeps: their programs run, and print what they say."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
import re
import runpy

import numpy as np
from PIL import Image
import pytest

from .outside import ROOT, run_python
from .source_tree import blocks_of

PAGE = (ROOT / 'docs' / 'learning.md').read_text(encoding='utf-8')
EXAMPLE = ROOT / 'examples' / 'learn_wall_following.py'
BLOCKS, PRINTED = (blocks_of('docs/learning.md', each) for each in ('python', 'text'))
needs_gymnasium = pytest.mark.skipif(not find_spec('gymnasium'), reason='needs gymnasium')


def run(folder: Path, program: str) -> str:
    (folder / 'program.py').write_text(program, encoding='utf-8')
    return run_python('program.py', cwd=folder, PYTHONPATH=str(ROOT))


@needs_gymnasium
def test_the_environment_of_the_page_prints_what_it_says(tmp_path: Path) -> None:
    (tmp_path / 'wall_task.py').write_text(BLOCKS[0], encoding='utf-8')
    assert run(tmp_path, ''.join(BLOCKS[1:4])) == ''.join(PRINTED[:3])


def test_the_sweep_of_the_page_prints_what_it_says(tmp_path: Path) -> None:
    (tmp_path / 'follower.py').write_text(BLOCKS[4], encoding='utf-8')
    printed = run(tmp_path, BLOCKS[5] + BLOCKS[6])
    assert printed.startswith(PRINTED[3])
    failures = sorted(printed.removeprefix(PRINTED[3]).splitlines())
    assert [line[:14] for line in failures] == ['run 1: crashed', 'run 8: crashed']
    drawn, shown = (
        np.array(Image.open(path), np.float64)
        for path in (tmp_path / 'runs.png', ROOT / 'docs' / 'sweep.png')
    )
    # Versions of Pillow differ at the edges of lines.
    assert np.abs(drawn - shown).mean() < 0.5
    # The one that the page opens.
    (opened,) = re.findall(r'world_file:=\$PWD/(\S+)', PAGE)
    assert (tmp_path / opened).is_file()


@needs_gymnasium
def test_the_example_of_the_tutorial_is_an_environment_in_which_a_plain_rule_earns() -> None:
    from gymnasium.utils.env_checker import check_env  # noqa: PLC0415 - where it is installed
    from physsim_ros.gym import RobotEnv  # noqa: PLC0415

    example = runpy.run_path(str(EXAMPLE))
    check_env(RobotEnv(example['make_task']()), skip_render_check=True)
    crashes, way, error = example['evaluate'](lambda _: (0.0, 0.0), episodes=2)
    assert (crashes, round(way, 3)) == (0, 0.0)
    assert 0.0 < error < 0.3
    crashes, way, _ = example['evaluate'](lambda _: (1.0, 0.0), episodes=3)
    assert crashes == 3
    assert way > 0.1


def test_the_tutorial_shows_the_reward_of_the_example() -> None:
    blocks = blocks_of('docs/tutorials/learn_to_follow_a_wall.md', 'python')
    (shown,) = (block for block in blocks if block.startswith('def reward'))
    code = re.sub(r'    """.*?"""\n', '', EXAMPLE.read_text(encoding='utf-8'))
    assert shown in code
