# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Encoders: frames become messages.

Messages with a part for each body, joint or contact are written as bytes (`cdr`): arrays of NumPy
are copied into a template, without an object for each part, which took 40 times as long. The bytes
are those that rclpy would write, except for padding. All other messages are objects of rclpy. Not
here: topics and QoS (`ros.publishers`). Start with `streams`; a new stream is an encoder here and
a line in `ros.publishers.publishers`.
"""
