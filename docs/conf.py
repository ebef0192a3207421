# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
How Sphinx builds these pages: `make docs`, and rosdoc2 as for any package of ROS.

Sphinx, since it is what docs.ros.org is made with and the docstrings are written for it
(`:param x:`); MyST, so that the pages stay Markdown that reads well in the repository too.
"""

from pathlib import Path
import re
import sys

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

project = 'physsim_ros'
author = 'physsim_ros maintainers'
(release,) = re.findall('<version>(.*)</version>', (ROOT / 'package.xml').read_text('utf-8'))
version = release

extensions = ['myst_parser', 'sphinx.ext.apidoc', 'sphinx.ext.autodoc']
exclude_patterns = ['_build']
html_theme = 'furo'
html_title = f'physsim_ros {release}'

# Single backticks in docstrings are names of the code.
default_role = 'literal'
# Headings that links name by their text, as in the repository.
myst_heading_anchors = 3

# A page for each module, from its docstrings.
apidoc_modules = [
    {
        'path': '../physsim_ros',
        'destination': 'api',
        'separate_modules': True,
        'module_first': True,
    }
]
autodoc_member_order = 'bysource'
# A type that a folder exports has two pages, of the folder and of its file: links may lead to
# either.
suppress_warnings = ['ref.python']
autodoc_typehints = 'description'
autodoc_typehints_description_target = 'documented'
