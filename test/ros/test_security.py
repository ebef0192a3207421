# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The policy of SROS 2 allows the node what it needs, and nothing else."""

from __future__ import annotations

from collections.abc import Callable
from xml.etree import ElementTree as ET

from physsim_ros.testing import PhysSim
import pytest
from rclpy.action import get_action_server_names_and_types_by_node

from .built_interfaces import import_built
from ..outside import ROOT

# rclpy publishes logs; the others are in the contract, and of later versions.
NOT_OF_THE_NODE = {'/rosout', '/physsim/timeline', '/physsim/instead'}
SIMULATION = '/physsim/simulation/'


def allowed(enclave: str) -> dict[tuple[str, str], set[str]]:
    """Return the names that an enclave allows, by tag and kind of use."""
    tree = ET.parse(ROOT / 'config' / 'sros2' / 'policy.xml')  # noqa: S314 - our own
    (profile,) = tree.findall(f".//enclave[@path='/physsim/{enclave}']/profiles/profile")
    names: dict[tuple[str, str], set[str]] = {}
    for group in profile:
        ((use, permission),) = group.attrib.items()
        assert permission == 'ALLOW'
        texts = [each.text or '' for each in group]
        names[group.tag, use] = {text.replace('~', '/physsim') for text in texts}
    return names


def unused(physsim: PhysSim) -> set[str]:
    """Check that the world may do what it does, and return what else it may."""
    node = physsim.node
    # Names of services are not resolved; those of parameters begin with the node's.
    services = {
        f'/physsim/{each.srv_name.removeprefix("~/").removeprefix("physsim/")}'
        for each in node.services
    }
    actions = get_action_server_names_and_types_by_node(node, node.get_name(), '/')
    does = {
        ('services', 'reply'): services,
        ('actions', 'execute'): {name for name, _ in actions},
        ('topics', 'publish'): {each.topic_name for each in node.publishers},
        ('topics', 'subscribe'): {each.topic_name for each in node.subscriptions},
    }
    may = allowed('world')
    assert may.keys() == does.keys()
    for use, names in does.items():
        assert names <= may[use]
    return {name for use, names in does.items() for name in may[use] - names}


def test_the_world_may_do_what_it_does_and_no_more(physsim: PhysSim) -> None:
    others = unused(physsim) - NOT_OF_THE_NODE
    assert {name for name in others if not name.startswith(SIMULATION)} == set()


@pytest.mark.slow
def test_with_the_standard_services_it_does_all_that_it_may(
    request: pytest.FixtureRequest, start: Callable[..., PhysSim]
) -> None:
    import_built('simulation_interfaces', request)
    physsim = start()
    assert unused(physsim) - NOT_OF_THE_NODE == set()


def test_an_operator_may_ask_and_a_spectator_may_only_read() -> None:
    world, operator, spectator = map(allowed, ('world', 'operator', 'spectator'))
    assert operator['services', 'request'] == world['services', 'reply']
    assert operator['actions', 'call'] == world['actions', 'execute']
    streams = world['topics', 'publish'] - {'/rosout'}
    assert operator['topics', 'subscribe'] == spectator['topics', 'subscribe'] == streams
    own = {'/parameter_events', '/rosout'}
    assert operator['topics', 'publish'] == world['topics', 'subscribe'] | own
    assert spectator['topics', 'publish'] == own
    readers = ('describe_', 'get_', 'list_')
    services = world['services', 'reply']
    assert spectator['services', 'request'] == {
        each for each in services if each.rpartition('/')[2].startswith(readers)
    }
