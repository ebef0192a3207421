# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Spawn bodies in bursts with Cyclone DDS, and read every stream: all answers are to come."""

# Without deferred annotations, which cyclonedds does not resolve.
from dataclasses import dataclass, field
import json
import os
import sys
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.pub import DataWriter, Publisher
from cyclonedds.sub import DataReader, Subscriber
from cyclonedds.topic import Topic
from cyclonedds.util import duration

# Many times what is expected, on a machine that is busy with other tests [s].
PATIENCE = 90.0
# Like ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST: the first 32 participants of this machine.
LOCALHOST = """
<CycloneDDS><Domain>
  <General>
    <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
  </General>
  <Discovery>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
    <Peers><Peer address="127.0.0.1"/></Peers>
  </Discovery>
</Domain></CycloneDDS>
"""

# The messages, as ROS 2 names them on DDS.


@dataclass
class Time(IdlStruct, typename='builtin_interfaces::msg::dds_::Time_'):
    sec: types.int32 = 0
    nanosec: types.uint32 = 0


@dataclass
class Duration(IdlStruct, typename='builtin_interfaces::msg::dds_::Duration_'):
    sec: types.int32 = 0
    nanosec: types.uint32 = 0


@dataclass
class Header(IdlStruct, typename='std_msgs::msg::dds_::Header_'):
    stamp: Time = field(default_factory=Time)
    frame_id: str = ''


@dataclass
class Color(IdlStruct, typename='std_msgs::msg::dds_::ColorRGBA_'):
    r: types.float32 = 0.0
    g: types.float32 = 0.0
    b: types.float32 = 0.0
    a: types.float32 = 0.0


@dataclass
class Vector(IdlStruct, typename='geometry_msgs::msg::dds_::Vector3_'):
    x: types.float64 = 0.0
    y: types.float64 = 0.0
    z: types.float64 = 0.0


@dataclass
class Point(IdlStruct, typename='geometry_msgs::msg::dds_::Point_'):
    x: types.float64 = 0.0
    y: types.float64 = 0.0
    z: types.float64 = 0.0


@dataclass
class Quaternion(IdlStruct, typename='geometry_msgs::msg::dds_::Quaternion_'):
    x: types.float64 = 0.0
    y: types.float64 = 0.0
    z: types.float64 = 0.0
    w: types.float64 = 1.0


@dataclass
class Pose(IdlStruct, typename='geometry_msgs::msg::dds_::Pose_'):
    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass
class Transform(IdlStruct, typename='geometry_msgs::msg::dds_::Transform_'):
    translation: Vector
    rotation: Quaternion


@dataclass
class Twist(IdlStruct, typename='geometry_msgs::msg::dds_::Twist_'):
    linear: Vector
    angular: Vector


@dataclass
class Wrench(IdlStruct, typename='geometry_msgs::msg::dds_::Wrench_'):
    force: Vector
    torque: Vector


@dataclass
class PoseArray(IdlStruct, typename='geometry_msgs::msg::dds_::PoseArray_'):
    header: Header
    poses: types.sequence[Pose]


@dataclass
class States(IdlStruct, typename='sensor_msgs::msg::dds_::MultiDOFJointState_'):
    header: Header
    joint_names: types.sequence[str]
    transforms: types.sequence[Transform]
    twist: types.sequence[Twist]
    wrench: types.sequence[Wrench]


@dataclass
class Image(IdlStruct, typename='sensor_msgs::msg::dds_::CompressedImage_'):
    header: Header = field(default_factory=Header)
    encoding: str = ''
    data: types.sequence[types.uint8] = field(default_factory=list)


@dataclass
class Coordinate(IdlStruct, typename='visualization_msgs::msg::dds_::UVCoordinate_'):
    u: types.float32
    v: types.float32


@dataclass
class Mesh(IdlStruct, typename='visualization_msgs::msg::dds_::MeshFile_'):
    filename: str = ''
    data: types.sequence[types.uint8] = field(default_factory=list)


@dataclass
class Marker(IdlStruct, typename='visualization_msgs::msg::dds_::Marker_'):
    header: Header = field(default_factory=Header)
    ns: str = ''
    number: types.int32 = 0
    kind: types.int32 = 0
    action: types.int32 = 0
    pose: Pose = field(default_factory=Pose)
    scale: Vector = field(default_factory=Vector)
    color: Color = field(default_factory=Color)
    lifetime: Duration = field(default_factory=Duration)
    frame_locked: bool = False
    points: types.sequence[Point] = field(default_factory=list)
    colors: types.sequence[Color] = field(default_factory=list)
    texture_resource: str = ''
    texture: Image = field(default_factory=Image)
    uv_coordinates: types.sequence[Coordinate] = field(default_factory=list)
    text: str = ''
    mesh_resource: str = ''
    mesh_file: Mesh = field(default_factory=Mesh)
    mesh_use_embedded_materials: bool = False


@dataclass
class MarkerArray(IdlStruct, typename='visualization_msgs::msg::dds_::MarkerArray_'):
    markers: types.sequence[Marker]


@dataclass
class KeyValue(IdlStruct, typename='diagnostic_msgs::msg::dds_::KeyValue_'):
    key: str
    value: str


@dataclass
class Status(IdlStruct, typename='diagnostic_msgs::msg::dds_::DiagnosticStatus_'):
    level: types.uint8
    name: str
    message: str
    hardware_id: str
    values: types.sequence[KeyValue]


STREAMS = {'poses': PoseArray, 'states': States, 'contacts': States, 'markers': MarkerArray}


def main() -> None:
    partition, bursts, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    os.environ['CYCLONEDDS_URI'] = LOCALHOST
    participant = DomainParticipant(int(os.environ['ROS_DOMAIN_ID']))
    inside = Qos(Policy.Partition([partition]))
    reliable = Policy.Reliability.Reliable(duration(seconds=1))
    lossless = Qos(reliable, Policy.History.KeepAll)
    subscriber = Subscriber(participant, inside)
    publisher = Publisher(participant, inside)

    def read(name: str, kind: type, qos: Qos) -> DataReader:
        return DataReader(subscriber, Topic(participant, f'rt/physsim/{name}', kind), qos=qos)

    events = read('events', Status, lossless)
    last = Qos(reliable, Policy.History.KeepLast(5))
    streams = {name: read(name, kind, last) for name, kind in STREAMS.items()}
    spawn = DataWriter(publisher, Topic(participant, 'rt/physsim/spawn', Marker), qos=lossless)
    deadline = time.monotonic() + PATIENCE
    while not spawn.get_matched_subscriptions() or not all(
        reader.get_matched_publications() for reader in (events, *streams.values())
    ):
        if time.monotonic() > deadline:
            sys.exit('the world is not there')
    # From the first moment on: an answer that comes too soon after discovery is one as well.
    answered: list[str] = []
    messages = dict.fromkeys(STREAMS, 0)
    for burst in range(bursts):
        for number in range(count):
            marker = Marker(ns=f'burst{burst}', number=number, kind=2, scale=Vector(0.2, 0.2, 0.2))
            marker.pose.position.x = number * 0.5
            marker.pose.position.y = burst * 0.5
            spawn.write(marker)
        while len(answered) < count * (burst + 1) and time.monotonic() < deadline:
            answered += [status.hardware_id for status in events.take(count)]
            for name, reader in streams.items():
                messages[name] += len(reader.take(10))
    names = [f'burst{burst}/{number}' for burst in range(bursts) for number in range(count)]
    result = {'missing': sorted({*names} - {*answered}), 'in_order': answered == names}
    print('RESULT ' + json.dumps(result | {'messages': messages}))  # noqa: T201 - the answer


if __name__ == '__main__':
    main()
