# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The files for RViz, Foxglove and ros2 launch name what the node has."""

from __future__ import annotations

import ast
import json
from pathlib import Path
import runpy
from typing import Any

from geometry_msgs.msg import PointStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from physsim_ros.ros.parameters import check, SPECS
from physsim_ros.testing import PhysSim
import pytest
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import MarkerArray
import yaml

ROOT = Path(__file__).parents[1]
CONFIG = ROOT / 'config'
LAUNCH = ROOT / 'launch' / 'physsim.launch.py'
PICTURES = {'/physsim/markers', '/physsim/preview'}
# The topics of a body robot/0, and the map.
OF_ROBOTS = {'/physsim/map', '/robot_0/ground_truth', '/robot_0/odom', '/robot_0/scan'}
# Topics that displays of RViz show.
KINDS = {
    'MarkerArray': MarkerArray,
    'LaserScan': LaserScan,
    'Map': OccupancyGrid,
    'Odometry': Odometry,
}


def test_rviz_shows_what_is_published_and_clicks_and_drags_where_it_is_heard(
    physsim: PhysSim,
) -> None:
    physsim.robot('turtlebot3_burger')
    physsim.step()
    manager = yaml.safe_load((CONFIG / 'physsim.rviz').read_text())['Visualization Manager']
    assert manager['Global Options']['Fixed Frame'] == SPECS['frame_id'].default
    published = {each.topic_name: each for each in physsim.node.publishers}
    heard = {each.topic_name: each.msg_type for each in physsim.node.subscriptions}
    shown = {}
    for display in manager['Displays']:
        kind = display['Class'].rpartition('/')[2]
        if kind in KINDS:
            publisher = published[display['Topic']['Value']]
            assert publisher.msg_type is KINDS[kind]
            kept = publisher.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
            assert kept is (display['Topic']['Durability Policy'] == 'Transient Local')
            shown[publisher.topic_name] = kind
    assert set(shown) == PICTURES | OF_ROBOTS
    (point,) = [each for each in manager['Tools'] if each['Class'].endswith('PublishPoint')]
    assert heard[point['Topic']['Value']] is PointStamped
    (drag,) = [
        each for each in manager['Displays'] if each['Class'].endswith('InteractiveMarkers')
    ]
    namespace = drag['Interactive Markers Namespace']
    assert f'{namespace}/update' in published
    assert f'{namespace}/feedback' in heard
    assert any(each['Class'].endswith('Interact') for each in manager['Tools'])


def test_foxglove_shows_what_is_published_and_clicks_where_it_is_heard(physsim: PhysSim) -> None:
    layout = json.loads((CONFIG / 'foxglove.json').read_text())
    panels = layout['configById']
    physsim.robot('turtlebot3_burger')
    physsim.step()
    assert set(leaves(layout['layout'])) == set(panels)
    world = panels['3D!world']
    assert set(world['topics']) == PICTURES | OF_ROBOTS
    assert world['followTf'] == SPECS['frame_id'].default
    published = {each.topic_name for each in physsim.node.publishers}
    assert PICTURES | OF_ROBOTS | {panels['RawMessages!events']['topicPath']} <= published
    plotted = {each['value'].partition('.')[0] for each in panels['Plot!odometry']['paths']}
    assert plotted == {'/robot_0/odom', '/robot_0/ground_truth'}
    heard = {each.topic_name for each in physsim.node.subscriptions}
    assert world['publish']['pointTopic'] in heard


def leaves(layout: Any) -> list[str]:
    """Return the panels of a layout."""
    if isinstance(layout, str):
        return [layout]
    return leaves(layout['first']) + leaves(layout['second'])


def test_the_arguments_of_the_launch_file_are_parameters_of_the_node() -> None:
    tree = ast.parse(LAUNCH.read_text())
    (given,) = [
        ast.literal_eval(statement.value)
        for statement in tree.body
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == 'PARAMETERS'
    ]
    for name, (default, _) in given.items():
        check(Parameter(name, value=default))
        assert name in SPECS


def test_the_launch_file_is_understood_by_ros_2_launch() -> None:
    pytest.importorskip('launch_ros', reason='launch and launch_ros have no wheels')
    description = runpy.run_path(str(LAUNCH))['generate_launch_description']()
    names = {each.name for each in description.get_launch_arguments()}
    others = {'params_file', 'namespace', 'rviz', 'use_sim_time'}
    given = {'world_file', 'sketchpad', 'sketchpad_port', 'viewer', 'record_file'}
    assert names == given | others
