# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""README as the description of a release, which is read elsewhere than in the repository."""

from pathlib import Path
import re

SOURCE = Path(__file__).resolve().parents[2]


def described(home: str) -> str:
    """
    Return README with links that lead to the repository from anywhere.

    :param home: address of the repository; without one, links and pictures are left out
    """
    text = (SOURCE / 'README.md').read_text(encoding='utf-8')
    if not home:
        text = re.sub(r'!\[[^]]*\]\((?!https?:)[^)]*\)\n*', '', text)
        return re.sub(r'\[([^]]*)\]\((?!https?:)[^)]*\)', r'\1', text)
    text = re.sub(r'(!\[[^]]*\]\()(?!https?:)', rf'\g<1>{home}/raw/main/', text)
    return re.sub(r'(\]\()(?!https?:)', rf'\g<1>{home}/blob/main/', text)
