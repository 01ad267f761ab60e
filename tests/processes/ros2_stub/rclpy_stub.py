# SPDX-License-Identifier: Apache-2.0
"""Stands in for rclpy and the messages that the bridge uses: what is published goes to an estimator in this process, which
answers with the odometry it got last, stamped as the cloud. Importing it puts the modules in place."""
import sys
import types


class Fields:
    """A message: any field, made when it is asked for, as far as it is listed for its class."""
    nested = {}

    def __init__(self, **values):
        for name, kind in self.nested.items():
            setattr(self, name, kind())
        for name, value in values.items():
            setattr(self, name, value)


def message(kind_name, /, **nested):
    return type(kind_name, (Fields,), {"nested": nested})


Number = float
Time = message("Time", sec=int, nanosec=int)
Header = message("Header", stamp=Time, frame_id=str)
Vector = message("Vector", x=Number, y=Number, z=Number)
Quaternion = message("Quaternion", x=Number, y=Number, z=Number, w=Number)
Transform = message("Transform", translation=Vector, rotation=Quaternion)
Pose = message("Pose", position=Vector, orientation=Quaternion)
PoseWithCovariance = message("PoseWithCovariance", pose=Pose)
MESSAGES = {
    "geometry_msgs": [message("TransformStamped", header=Header, child_frame_id=str, transform=Transform)],
    "nav_msgs": [message("Odometry", header=Header, child_frame_id=str, pose=PoseWithCovariance)],
    "rosgraph_msgs": [message("Clock", clock=Time)],
    "sensor_msgs": [
        message("Imu", header=Header, angular_velocity=Vector, linear_acceleration=Vector),
        message("PointCloud2", header=Header, height=int, width=int, is_dense=bool, point_step=int, row_step=int,
                fields=list, data=bytes),
        message("PointField", name=str, offset=int, datatype=int, count=int)],
    "tf2_msgs": [message("TFMessage", transforms=list)],
}


class Node:
    """Remembers what is published; the clock makes the estimator answer, once somebody spins."""

    def __init__(self):
        self.odometry, self.cloud, self.answers, self.last_ns, self.listener = None, None, [], -1, None

    def create_publisher(self, kind, topic, qos):
        return types.SimpleNamespace(publish=lambda sent: self.on_message(kind, topic, sent))

    def create_subscription(self, kind, topic, callback, qos):
        assert (kind.__name__, topic) == ("Odometry", "/odom_estimated"), topic
        self.listener = callback

    def on_message(self, kind, topic, sent):
        assert type(sent) is kind, f"{topic} got a {type(sent).__name__}"
        if topic == "/odom":
            self.odometry = sent
        elif topic == "/points":
            assert sent.width * sent.point_step == sent.row_step == len(sent.data)
            self.cloud = sent
        elif topic == "/clock":
            now = sent.clock.sec * 10**9 + sent.clock.nanosec
            assert now > self.last_ns and self.cloud.header.stamp.nanosec == sent.clock.nanosec
            self.last_ns = now
            answer = MESSAGES["nav_msgs"][0]()
            answer.header.stamp = self.cloud.header.stamp
            answer.pose = self.odometry.pose
            self.answers.append(answer)


def spin_once(node, timeout_sec):
    if node.answers:
        node.listener(node.answers.pop(0))


def module(name, **members):
    sys.modules[name] = types.ModuleType(name)
    vars(sys.modules[name]).update(members)


Kind = types.SimpleNamespace
module("rclpy", init=lambda: None, create_node=lambda name: Node(), spin_once=spin_once)
module("rclpy.qos", QoSProfile=lambda **settings: settings, ReliabilityPolicy=Kind(RELIABLE=1),
       DurabilityPolicy=Kind(TRANSIENT_LOCAL=1))
for package, kinds in MESSAGES.items():
    module(package)
    module(package + ".msg", **{kind.__name__: kind for kind in kinds})
