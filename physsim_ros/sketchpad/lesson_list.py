# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The lessons that pages offer: those that ship with the package, and the user's own."""

from __future__ import annotations

from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any

from physsim_ros.files import load_world, shipped_lessons, user_lessons, worlds_in
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import PhysSimError

# Lessons of the user that are listed, at most.
MOST_LESSONS = 100


def lesson_list(world_dir: Path, boundary: ErrorBoundary) -> list[dict[str, Any]]:
    """
    Return name, number, title and question of each lesson, by their numbers.

    The title of a file that is no lesson is its name; who opens it is told why.

    :param world_dir: directory of the user's worlds
    :param boundary: of the files
    """
    own = islice(worlds_in(user_lessons(world_dir)).items(), MOST_LESSONS)
    # A lesson of the user comes before the shipped one of its name.
    files = worlds_in(shipped_lessons()) | dict(own)
    lessons = [
        {'name': name} | _read(path, _version(path), boundary) for name, path in files.items()
    ]
    return sorted(lessons, key=lambda each: (each['number'], each['name']))


def _version(path: Path) -> tuple[int, int]:
    """Return time of change [ns] and size [bytes] of a file; zeros where it is gone."""
    try:
        status = path.stat()
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_size


@lru_cache(maxsize=2 * MOST_LESSONS)
def _read(
    path: Path,
    version: tuple[int, int],  # noqa: ARG001 - a key
    boundary: ErrorBoundary,
) -> dict[str, Any]:
    """Return number, title and question of a lesson."""
    try:
        with boundary.reading('lesson'):
            lesson = load_world(path).lesson
    except PhysSimError:
        lesson = None
    if lesson is None:
        return {'number': 0, 'title': path.stem, 'question': ''}
    return {'number': lesson.number, 'title': lesson.title, 'question': lesson.question}
