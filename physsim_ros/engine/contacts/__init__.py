# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contacts: which bodies touched in a frame, where, and with which impulse.

`touches` are the contacts that begin in a step. `contact_report` sums contacts over the steps of a
frame, `contact_listing` merges those of several shapes; both work on `pair_ids` and `manifolds`.
Not here: the contact graph (`graph_search`), impulses from which the next step starts
(`warm_start`), the effect of contacts on bodies (`stages`). Start with `contact_report`.
"""
