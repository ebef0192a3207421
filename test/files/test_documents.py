# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The world files and drawings of the documents are read, whole ones and parts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from physsim_ros.files import load_drawing, load_world
import pytest
import yaml

from ..source_tree import blocks_of, ROOT

PAGES = [str(page.relative_to(ROOT)) for page in sorted((ROOT / 'docs').rglob('*.md'))]
WORLDS = [(page, block) for page in PAGES for block in blocks_of(page, 'yaml')]
DRAWINGS = [block for page in PAGES for block in blocks_of(page, 'json')]


def whole(part: Any) -> dict[str, Any]:
    """Return a world with a part of a world file: bodies, or a robot or sensors of a body."""
    if isinstance(part, list):
        part = {'bodies': part}
    if 'sensors' in part:
        part = {'robot': part}
    if 'robot' in part:
        part = {'bodies': [{'name': 'it/0', 'circle': {'radius': 0.1}, 'at': [0, 0], **part}]}
    return {'format': 1, **part}


@pytest.mark.parametrize(('page', 'block'), WORLDS, ids=[page for page, _ in WORLDS])
def test_a_world_of_a_document_is_read(page: str, block: str, tmp_path: Path) -> None:
    world = whole(yaml.safe_load(block))
    # Of the page beside which no map lies.
    world.pop('map', None)
    path = tmp_path / 'world.yaml'
    path.write_text(yaml.safe_dump(world), encoding='utf-8')
    bodies = load_world(path).bodies
    assert {body['name'] for body in world['bodies']} <= {body.body.name for body in bodies}


@pytest.mark.parametrize('block', DRAWINGS)
def test_a_drawing_of_a_document_is_read(block: str, tmp_path: Path) -> None:
    path = tmp_path / 'drawing.json'
    path.write_text(block, encoding='utf-8')
    assert load_drawing(path)
