# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A domain of ROS belongs to one test at a time, of all processes of a machine."""

import subprocess
import sys

from physsim_ros.testing.domain import DOMAINS, own_domain

from ..source_tree import ROOT

PROGRAM = 'from physsim_ros.testing.domain import own_domain\nwith own_domain() as it: print(it)'


def test_domains_are_given_to_one_at_a_time():
    with own_domain() as one, own_domain() as other:
        assert one != other
        assert {one, other} <= set(DOMAINS)
    # In another process too.
    with own_domain() as mine:
        command = [sys.executable, '-c', PROGRAM]
        assert int(subprocess.check_output(command, text=True, cwd=ROOT)) != mine


def test_a_domain_comes_back():
    given = []
    for _ in range(150):
        with own_domain() as domain:
            given.append(domain)
    assert len(set(given)) < len(given)
