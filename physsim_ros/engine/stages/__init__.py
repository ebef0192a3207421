# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Stages of a step, one file each: a problem, the method by its name, its source and its cost.

Not here: the order of stages (`pipeline`), joints (`joints`), continuous collision (`ccd`) and the
contact report (`contacts`). A stage reads the step context and no privates of another. Start with
`half_step`, then `first_touch`; a new stage is a file here and a line in `pipeline`.
"""
