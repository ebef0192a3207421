# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The manifest names what the package needs of ROS."""

import ast
from xml.etree import ElementTree as ET

import pytest

from ..source_tree import ROOT

pytestmark = pytest.mark.linter


def test_the_manifest_names_every_ros_package_that_is_imported():
    manifest = ET.parse(ROOT / 'package.xml').getroot()  # noqa: S314  our own file
    declared = {element.text for element in manifest.iter('exec_depend')}
    imported = set()
    for path in (*ROOT.glob('physsim_ros/**/*.py'), *ROOT.glob('launch/*.py')):
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                imported.add(node.module.split('.')[0])
    of_ros = {
        name
        for name in imported
        if name in {'launch', 'launch_ros', 'rclpy', 'std_srvs'}
        or name.endswith(('_msgs', '_interfaces'))
    }

    assert of_ros == {name for name in declared if not name.startswith('python3-')}
