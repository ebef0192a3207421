# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Relations that hold for every scene: what two worlds have in common that differ in one respect.

`scenes.py` is the table of scenes, `relations.py` the table of relations, and
`test_relations.py` crosses them. `changes.py` makes one world of another, `films.py` plays them.
A crossing that fails is told in `exceptions.yaml`, with its figure, and a test fails as soon as
it holds; ``python -m test.relations.exceptions`` writes that file anew.
"""
