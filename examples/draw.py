# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pause the running world, draw a drawing in it, print the answers to each stroke, and play."""

import argparse
import sys

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from physsim_ros.files import BadDrawing, load_drawing
import rclpy
from rclpy.duration import Duration
from std_srvs.srv import Trigger

# Between two strokes by their stamps [s]: above the range of `regroup`, so each is read by itself.
PAUSE = 11.0

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('drawing', help='a JSON file, or the name of a shipped drawing')
parser.add_argument('--at', type=float, nargs=2, default=(0, 0), help='where its origin goes [m]')
options = parser.parse_args()
try:
    strokes = load_drawing(options.drawing)
except BadDrawing as refusal:
    sys.exit(f'draw.py: {refusal}')

rclpy.init()
node = rclpy.create_node('draw')
events = []
heard = node.create_subscription(DiagnosticStatus, '/physsim/events', events.append, 1000)
pen = node.create_publisher(Path, '/physsim/stroke', 10)
clients = {name: node.create_client(Trigger, f'/physsim/{name}') for name in ('pause', 'play')}


def call(service):
    """Call a service, again each second: a client is not answered before it is discovered."""
    for _ in range(30):
        future = clients[service].call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        if future.done():
            return
    sys.exit('draw.py: there is no world at /physsim')


def answer():
    """Return the next event about a stroke."""
    while True:
        while not events:
            rclpy.spin_once(node)
        if (event := events.pop(0)).name == '~/stroke':
            return event


# The world answers when it has discovered this node's ends, which were created before the clients.
call('pause')
while not (pen.get_subscription_count() and heard.get_publisher_count()):
    rclpy.spin_once(node, timeout_sec=0.1)
began = node.get_clock().now()
refused = 0
for number, (name, points) in enumerate(strokes):
    stroke = Path()
    for sample, (x, y) in enumerate(points[:, :2] + options.at):
        pose = PoseStamped()
        pose.header.stamp = (began + Duration(seconds=PAUSE * number, nanoseconds=sample)).to_msg()
        pose.pose.position.x, pose.pose.position.y = x, y
        stroke.poses.append(pose)
    pen.publish(stroke)
    # The first answer has the reading, and the number of answers that follow.
    answers = [answer()]
    values = {pair.key: pair.value for pair in answers[0].values}
    answers += [answer() for _ in range(int(values.get('requests', 0)))]
    for each in answers:
        print(f'{name or number}: {each.message}')
    refused += any(each.level != DiagnosticStatus.OK for each in answers)
call('play')
rclpy.shutdown()
sys.exit(f'draw.py: {refused} of {len(strokes)} strokes were refused' if refused else 0)
