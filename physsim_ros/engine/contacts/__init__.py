# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contacts: which bodies touched in a frame, where, and with which impulse.

`contact` and `side` are two shapes that touch, as they are read from the engine. `contact_report`
sums them over the steps of a frame, `contact_listing` merges those of several shapes; `pair_ids`,
`manifolds` and `sleeping_pairs` are what both work on. Not here: the contact graph (`islands`),
impulses from which the next step starts (`warm_start`), the effect of contacts on bodies
(`stages`). Start with `contact_report`.
"""
