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
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

# Both are found by the line above.
from tools.tables.cheat_sheet import write_pdf  # noqa: E402
from tools.tables.search_words import with_entries  # noqa: E402

project = 'physsim_ros'
author = 'physsim_ros maintainers'
project_copyright = '2026 physsim_ros maintainers'
(release,) = re.findall('<version>(.*)</version>', (ROOT / 'package.xml').read_text('utf-8'))
version = release

extensions = ['myst_parser', 'sphinx.ext.apidoc', 'sphinx.ext.autodoc']
exclude_patterns = ['_build']
html_theme = 'furo'
html_title = f'physsim_ros {release}'
# Tables that a phone can show.
html_static_path = ['_static']
html_css_files = ['narrow.css']
html_js_files = ['labels.js']
# Pages come before names of the code, and reference before what else says the word.
html_search_scorer = str(ROOT / 'docs' / 'search_scorer.js')

# `make links`: an address of the reader's own machine; headings on GitHub are made by scripts.
linkcheck_ignore = [r'http://127\.0\.0\.1']
linkcheck_anchors_ignore_for_url = ['https://github.com/']
linkcheck_timeout = 20

# Single backticks in docstrings are names of the code.
default_role = 'literal'
# Headings that links name by their text, as in the repository.
myst_heading_anchors = 3

# Sphinx makes a text of every member: arrays are told by their shapes.
np.set_printoptions(override_repr=lambda array: f'<array of {array.shape}>')

# A page for each module, from its docstrings.
apidoc_modules = [
    {
        'path': '../physsim_ros',
        'destination': 'api',
        'separate_modules': True,
        'module_first': True,
        # They compute with constants of simulation_interfaces, which there is no wheel of.
        'exclude_patterns': ['**/simulation_services/[st]*.py'],
    }
]
autodoc_member_order = 'bysource'
# A name that a front exports is on two pages, of the front and of its file: links may lead to
# either.
suppress_warnings = ['ref.python']
# Packages of ROS that are not there without it, or are no wheels.
autodoc_mock_imports = ['simulation_interfaces', 'tf2_msgs']
# Fronts for users, whose pages have what the files below them define.
FRONTS = ('api/physsim_ros', 'api/physsim_ros.testing')
autodoc_typehints = 'description'
autodoc_typehints_description_target = 'documented'

# Beside its page on the site.
CHEAT_SHEET = 'cheat_sheet.pdf'

# Links of README lead from the repository; those of its pages from here.
MOVED = {
    '](docs/': '](',
    '](CONTRIBUTING.md': '](contributing.md',
    '](CHANGELOG.rst': '](changelog.rst',
}


def amend_source(_app: object, name: str, source: list[str]) -> None:
    """Put README on the first page, modules out of the contents, and words into the index."""
    source[0] = with_entries(name, source[0])
    if name == 'index':
        readme = (ROOT / 'README.md').read_text(encoding='utf-8')
        for old, new in MOVED.items():
            readme = readme.replace(old, new)
        source[0] = f'{readme}\n{source[0]}'
    elif name == 'cheat_sheet':
        link = f'<a href="{CHEAT_SHEET}">{CHEAT_SHEET}</a>'
        source[0] = source[0].replace(f'docs/_build/html/{CHEAT_SHEET}', link)
    elif name == 'api/modules':
        # The theme writes its whole table of contents on each page: with hundreds of modules in
        # it the site takes five times as long.
        source[0] = f':orphan:\n\n{source[0]}'


def skip_exported(
    app: Any,
    what: str,
    _name: str,
    value: object,
    skip: bool,  # noqa: FBT001 - Sphinx's own
    _options: object,
) -> bool:
    """Leave out what a folder exports, which is on the page of the file that defines it."""
    page, module = app.env.docname, str(getattr(value, '__module__', ''))
    exported = module.startswith('physsim_ros') and page != f'api/{module}'
    return skip or (what == 'module' and exported and page not in FRONTS)


def write_cheat_sheet(app: Any, error: Exception | None) -> None:
    """Write the cheat sheet beside its page, to print."""
    if error is None and app.builder.format == 'html':
        write_pdf(Path(app.outdir, CHEAT_SHEET))


def setup(app: Any) -> None:
    """Connect what Sphinx calls for each page and each member, and after the last."""
    app.connect('build-finished', write_cheat_sheet)
    app.connect('source-read', amend_source)
    app.connect('autodoc-skip-member', skip_exported)
