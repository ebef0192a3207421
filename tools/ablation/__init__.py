# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Ablation: each stage of a step off in turn, against short scenes; `make ablate`."""
