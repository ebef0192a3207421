# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Programs of `tools/` find what they use of the package: nothing else imports them."""

from importlib import import_module
from pkgutil import walk_packages

import pytest
import tools

MODULES = [name for _, name, _ in walk_packages(tools.__path__, 'tools.')]
# They run when they are imported; IR-SIM has an environment of its own.
PROGRAMS = ('__main__', 'irsim_world')


@pytest.mark.parametrize('name', [each for each in MODULES if not each.endswith(PROGRAMS)])
def test_a_module_is_imported(name: str) -> None:
    assert import_module(name).__name__ == name


def test_the_gallery_draws_nothing_where_a_name_is_that_of_no_picture() -> None:
    with pytest.raises(SystemExit, match='no picture typo'):
        import_module('tools.gallery.__main__').main(['page', 'typo'])
