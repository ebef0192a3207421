# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
