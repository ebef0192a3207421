# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The policy of SROS 2 allows the node what it needs, and nothing else."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from physsim_ros.testing import PhysSim

from ..outside import ROOT

# rclpy publishes logs; the others are in the contract, and of later versions.
NOT_OF_THE_NODE = {'/rosout', '/physsim/timeline', '/physsim/instead'}


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


def test_the_world_may_do_what_it_does_and_no_more(physsim: PhysSim) -> None:
    node = physsim.node
    # Names of services are not resolved; those of parameters begin with the node's.
    services = {
        f'/physsim/{each.srv_name.removeprefix("~/").removeprefix("physsim/")}'
        for each in node.services
    }
    does = {
        ('services', 'reply'): services,
        ('topics', 'publish'): {each.topic_name for each in node.publishers},
        ('topics', 'subscribe'): {each.topic_name for each in node.subscriptions},
    }
    may = allowed('world')
    assert may.keys() == does.keys()
    for use, names in does.items():
        assert names <= may[use]
        assert may[use] - names <= NOT_OF_THE_NODE


def test_an_operator_may_ask_and_a_spectator_may_only_read() -> None:
    world, operator, spectator = map(allowed, ('world', 'operator', 'spectator'))
    assert operator['services', 'request'] == world['services', 'reply']
    streams = world['topics', 'publish'] - {'/rosout'}
    assert operator['topics', 'subscribe'] == spectator['topics', 'subscribe'] == streams
    own = {'/parameter_events', '/rosout'}
    assert operator['topics', 'publish'] == world['topics', 'subscribe'] | own
    assert spectator['topics', 'publish'] == own
    for service in spectator['services', 'request']:
        assert service.rpartition('/')[2].startswith(('describe_', 'get_', 'list_'))
