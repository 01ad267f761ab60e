# SPDX-License-Identifier: Apache-2.0
"""A node of ROS 2 in place of an estimator: publishes each scan and waits for a pose of it. Needs rclpy.

    plumbline run quickstart --method "mine=python3 ros2_bridge.py --answer /odom_estimated"

What is behind it decides whether a run repeats: timers, queues and threads of DDS do not. Say `repeat: true` to find out.
"""
import argparse
import time

import numpy as np
import plumbline_client
import rclpy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, PointCloud2, PointField
from tf2_msgs.msg import TFMessage

FIELDS = (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4), ("time", 18, 7))
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("ring", "<u2"), ("time", "<f4")])


def stamped(message, stamp_ns, frame):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(int(stamp_ns), 10**9)
    message.header.frame_id = frame
    return message


def set_pose(position, orientation, t, q):
    position.x, position.y, position.z = (float(v) for v in t)
    orientation.x, orientation.y, orientation.z, orientation.w = (float(v) for v in q)


def transform(stamp_ns, parent, child, t, q):
    message = stamped(TransformStamped(), stamp_ns, parent)
    message.child_frame_id = child
    set_pose(message.transform.translation, message.transform.rotation, t, q)
    return message


def cloud(scan):
    points = np.zeros(len(scan.points), POINT)
    for axis, values in zip("xyz", scan.points.T):
        points[axis] = values
    points["intensity"], points["ring"], points["time"] = scan.reflectivity, scan.ring, scan.times
    message = stamped(PointCloud2(), scan.stamp_ns, "lidar")
    message.height, message.width, message.is_dense = 1, len(points), True
    message.point_step, message.row_step = POINT.itemsize, points.nbytes
    message.fields = [PointField(name=n, offset=o, datatype=t, count=1) for n, o, t in FIELDS]
    message.data = points.tobytes()
    return message


class Bridge:
    def __init__(self, recording, arguments):
        self.wait_s, self.poses = arguments.wait_s, {}
        rclpy.init()
        self.node = rclpy.create_node("plumbline")
        reliable = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
        kept = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        kinds = {"/points": PointCloud2, "/imu/data": Imu, "/odom": Odometry, "/tf": TFMessage, "/clock": Clock}
        self.topics = {name: self.node.create_publisher(kind, name, reliable) for name, kind in kinds.items()}
        self.fixed = self.node.create_publisher(TFMessage, "/tf_static", kept)
        self.node.create_subscription(Odometry, arguments.answer, self.take, reliable)
        mount = recording.X_RL
        q = plumbline_client.quaternion(mount[:3, :3])
        self.fixed.publish(TFMessage(transforms=[transform(0, "base_link", "lidar", mount[:3, 3], q)]))

    def take(self, message):
        p, q = message.pose.pose.position, message.pose.pose.orientation
        stamp_ns = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        self.poses[stamp_ns] = plumbline_client.matrix((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))

    def publish(self, scan):
        """In order of time; the clock moves on last, so that whoever waits for it has the scan."""
        for record in scan.odometry:
            message = stamped(Odometry(), record["stamp_ns"], "odom")
            message.child_frame_id = "base_link"
            set_pose(message.pose.pose.position, message.pose.pose.orientation, record["t"], record["q"])
            self.topics["/odom"].publish(message)
            frames = [transform(record["stamp_ns"], "odom", "base_link", record["t"], record["q"])]
            self.topics["/tf"].publish(TFMessage(transforms=frames))
        for record in scan.imu:
            message = stamped(Imu(), record["stamp_ns"], "base_link")
            for name in ("angular_velocity", "linear_acceleration"):
                vector = getattr(message, name)
                vector.x, vector.y, vector.z = (float(v) for v in record[name])
            self.topics["/imu/data"].publish(message)
        self.topics["/points"].publish(cloud(scan))
        clock = Clock()
        clock.clock.sec, clock.clock.nanosec = divmod(int(scan.stamp_ns), 10**9)
        self.topics["/clock"].publish(clock)

    def on_scan(self, scan):
        self.publish(scan)
        end = time.monotonic() + self.wait_s
        while time.monotonic() < end:
            rclpy.spin_once(self.node, timeout_sec=0.01)
            near = [s for s in self.poses if abs(s - scan.stamp_ns) <= 10**6]
            if near:
                return self.poses.pop(near[0])
        return None  # no pose of this scan


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--answer", default="/odom_estimated", help="nav_msgs/Odometry, stamped as the scan")
    parser.add_argument("--wait-s", type=float, default=2.0, help="most time for an answer")
    arguments = parser.parse_args()
    plumbline_client.run(lambda recording: Bridge(recording, arguments).on_scan)


main()
