# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Ablation: the laws without each stage of a step in turn; `make ablate`."""
