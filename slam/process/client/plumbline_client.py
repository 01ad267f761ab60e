# SPDX-License-Identifier: Apache-2.0
"""Runs an estimator as a process of plumbline. Needs numpy alone.

    import plumbline_client

    def start(recording):                # once; returns what answers scans
        def on_scan(scan):
            return pose                  # 4x4: the robot in a frame of your own, or None while it is unknown
        return on_scan

    plumbline_client.run(start)

Then: plumbline run quickstart.yaml --method "mine=python3 my_slam.py"
"""
import json
import mmap
import os
import socket
import struct
import sys
import traceback

import numpy as np

MAGIC = 0x31424C50
PROTOCOL = 2
HELLO, STEP, FINISH, HELLO_OK, OUTPUT, ESTIMATE, LOG, FAIL = 1, 2, 3, 0x81, 0x82, 0x83, 0x84, 0x8F
STATES = ("SEARCHING", "AMBIGUOUS", "CONVERGED", "LOST")
SEARCHING, AMBIGUOUS, CONVERGED, LOST = range(4)

_IMU = np.dtype([("stamp_ns", "<i8"), ("angular_velocity", "<f8", 3), ("linear_acceleration", "<f8", 3)])
_POSE = np.dtype([("stamp_ns", "<i8"), ("t", "<f8", 3), ("q", "<f8", 4)])
_SLOTS = (("range", "<f8", 1), ("point", "<f8", 3), ("reflectivity", "<f4", 1), ("offset_ns", "<i4", 1))
_HYPOTHESIS = struct.Struct("<14d")


def matrix(t, q):
    """4x4 of a position and a quaternion x, y, z, w."""
    x, y, z, w = q
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = t
    return pose


def quaternion(rotation):
    """x, y, z, w of norm 1 of a rotation matrix."""
    r = np.asarray(rotation, dtype=float)
    k = np.array([
        [r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
        [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
        [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]],
    ])
    _, vectors = np.linalg.eigh(k)
    q = vectors[:, -1]
    return q if q[3] >= 0 else -q


class Recording:
    """What is known before the first scan."""

    def __init__(self, hello):
        self.hello = hello
        self.seed = int(hello["seed"])
        self.X_RL = matrix(hello["X_RL"][:3], hello["X_RL"][3:])  # mount: the LiDAR in the robot
        self.sensor_height_m = hello["sensor_height_m"]
        self.has_odometry = hello["has_odometry"]
        self.prior = hello["prior"]  # of a localization: yaw_W, yaw_sigma, storey
        self.plan = hello["plan"]  # of a localization: storeys, faces, rooms, solids

    def robot_pose(self, lidar_pose):
        """The robot's pose, from that of the LiDAR in the frame of its first scan, as LiDAR odometry gives it."""
        return self.X_RL @ _checked(lidar_pose) @ np.linalg.inv(self.X_RL)


class Scan:
    """One turn of the LiDAR, and what else was measured since the scan before. Copy what you keep."""

    def __init__(self, payload):
        self.stamp_ns, imus, odometries, slots, self.rings, _, _ = struct.unpack_from("<qIIIHHQ", payload)
        self.columns = slots // max(1, self.rings)
        at = 32
        self.imu = np.frombuffer(payload, _IMU, imus, at)  # stamp_ns, angular_velocity, linear_acceleration, in R
        at += imus * _IMU.itemsize
        self.odometry = np.frombuffer(payload, _POSE, odometries, at)  # stamp_ns, t, q: the robot in O
        at += odometries * _POSE.itemsize
        self.slots = {}  # range, point, reflectivity, offset_ns of all firings, column by column; range 0: none
        for name, kind, width in _SLOTS:
            values = np.frombuffer(payload, kind, slots * width, at)
            self.slots[name] = values.reshape(-1, width) if width > 1 else values
            at += values.nbytes
        self._hit = self.slots["range"] > 0

    @property
    def points(self):
        """N x 3, m, in the LiDAR's frame at each return's own time."""
        return self.slots["point"][self._hit]

    @property
    def times(self):
        """N, s, of each return relative to the scan's stamp: 0 is the end of the scan."""
        return self.slots["offset_ns"][self._hit] * 1e-9

    @property
    def relative_times(self):
        """N, 0 at the first return of the scan to 1 at its last; of length 0 where all returns have one time, since there
        is nothing to deskew then."""
        times = self.times
        turn = times.max() - times.min() if len(times) else 0.0
        return (times - times.min()) / turn if turn > 0 else np.zeros(0)

    @property
    def ring(self):
        return np.flatnonzero(self._hit) % max(self.rings, 1)

    @property
    def reflectivity(self):
        return self.slots["reflectivity"][self._hit]

    def odometry_pose(self):
        """4x4 of the last odometry up to the scan, or None."""
        return matrix(self.odometry[-1]["t"], self.odometry[-1]["q"]) if len(self.odometry) else None


class Answer:
    """More than a pose: state, and of a localization hypotheses as (mass, 4x4 in W, 3x3 covariance of x, y, yaw)."""

    def __init__(self, pose=None, state=CONVERGED, hypotheses=(), particles=()):
        self.state = STATES.index(state) if state in STATES else state  # by its name, or a constant of above
        self.pose, self.hypotheses, self.particles = pose, hypotheses, particles

    def pack(self, stamp_ns):
        if self.state not in range(4):
            raise ValueError(f"a state must be SEARCHING, AMBIGUOUS, CONVERGED or LOST, not {self.state!r}")
        numbers = [0.0] * 6 + [1.0] if self.pose is None else _numbers(self.pose)
        particles = np.asarray(self.particles, "<f4")
        if particles.size and (particles.ndim != 2 or particles.shape[1] != 4 or len(particles) > 500):
            raise ValueError("particles must be N x 4: x, y, yaw and weight, at most 500; not of shape "
                             f"{particles.shape}")
        out = struct.pack("<qBBHI7d", stamp_ns, self.pose is not None, self.state, len(self.hypotheses),
                          len(particles), *numbers)
        for hypothesis in self.hypotheses:
            mass, pose, covariance = _parts(hypothesis, "a hypothesis", "mass", "4x4", "3x3 covariance of x, y, yaw")
            c = np.asarray(covariance, dtype=float)
            if c.shape != (3, 3):
                raise ValueError(f"the covariance of a hypothesis must be 3x3, of x, y and yaw, not of shape {c.shape}")
            if not np.allclose(c, c.T):
                raise ValueError("the covariance of a hypothesis must be symmetric")
            out += _HYPOTHESIS.pack(mass, *_numbers(pose), c[0, 0], c[0, 1], c[0, 2], c[1, 1], c[1, 2], c[2, 2])
        return out + particles.tobytes()


def _parts(given, what, *names):
    """As many values as there are names."""
    if not isinstance(given, (tuple, list)) or len(given) != len(names):
        raise TypeError(f"{what} must be ({', '.join(names)}), not a {type(given).__name__}"
                        + (f" of {len(given)}" if isinstance(given, (tuple, list)) else ""))
    return given


def _checked(pose):
    """The pose as 4x4, or what is wrong with it."""
    try:
        matrix_ = np.asarray(pose, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"a pose must be a 4x4 matrix, None or an Answer, not a {type(pose).__name__}") from None
    if matrix_.shape != (4, 4):
        raise ValueError(f"a pose must be a 4x4 matrix, None or an Answer, not of shape {matrix_.shape}")
    if not np.isfinite(matrix_).all():
        raise ValueError("a pose must be finite; this one has not-a-number or infinity in it")
    turn = matrix_[:3, :3]
    if not np.allclose(matrix_[3], [0, 0, 0, 1], atol=1e-6):
        raise ValueError(f"the last row of a pose must be 0 0 0 1, not {matrix_[3]}; is it transposed?")
    if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-3) or np.linalg.det(turn) < 0:
        raise ValueError("the upper left 3x3 of a pose must be a rotation; this one scales, shears or mirrors")
    return matrix_


def _numbers(pose):
    pose = _checked(pose)
    return [*pose[:3, 3], *quaternion(pose[:3, :3])]


class _Stream:
    def __init__(self):
        if "PLUMBLINE_FD" not in os.environ:
            raise SystemExit("plumbline_client: started by hand; plumbline conformance COMMAND tries it, and\n"
                             "plumbline run quickstart --method NAME=COMMAND runs it")
        self.socket = socket.socket(fileno=int(os.environ["PLUMBLINE_FD"]))
        self.memory = None

    def share(self, size):
        """Maps the memory that plumbline shares, if it does: scans are not copied then. Whether it is there."""
        try:
            if size and os.fstat(4).st_size == size:
                self.memory = memoryview(mmap.mmap(4, size, prot=mmap.PROT_READ))
        except OSError:
            pass
        return self.memory is not None

    def receive(self):
        head = self._read(16)
        if head is None:
            return None, None
        magic, kind, half, size = struct.unpack("<IHHQ", head)
        if magic != MAGIC:
            raise RuntimeError("this is no message of plumbline")
        if half:
            begin = (half - 1) * (len(self.memory) // 2)
            return kind, self.memory[begin:begin + size]
        return kind, self._read(size)

    def send(self, kind, payload):
        self.socket.sendall(struct.pack("<IHHQ", MAGIC, kind, 0, len(payload)) + payload)

    def _read(self, size):
        data = bytearray(size)
        view, got = memoryview(data), 0
        while got < size:
            count = self.socket.recv_into(view[got:])
            if count == 0:
                return None
            got += count
        return data


def _estimate(poses, points):
    trajectory = np.zeros(len(poses), _POSE)
    for row, stamped in zip(trajectory, poses):
        stamp_ns, pose = _parts(stamped, "a pose of the trajectory", "stamp_ns", "4x4")
        numbers = _numbers(pose)
        row["stamp_ns"], row["t"], row["q"] = stamp_ns, numbers[:3], numbers[3:]
    cloud = np.ascontiguousarray(np.asarray(points, "<f4").reshape(-1, 3))
    return struct.pack("<QQQ", 0, len(trajectory), len(cloud)) + trajectory.tobytes() + cloud.tobytes()


def run(start, finish=None):
    """start(Recording) returns on_scan(Scan), which returns a 4x4 pose, None or an Answer. finish(), if given, returns
    (poses, points): a corrected trajectory [(stamp_ns, 4x4)] and a map N x 3; else the poses given scan by scan stand."""
    stream = _Stream()
    poses = []
    on_scan = None
    try:
        while True:
            kind, payload = stream.receive()
            if kind is None:
                return
            if kind == HELLO:
                hello = json.loads(bytes(payload))
                on_scan = start(Recording(hello))
                if not callable(on_scan):
                    raise TypeError("start() must return the function that answers scans; does it end in return on_scan?")
                answer = {"protocol": PROTOCOL, "shared_memory": stream.share(hello.get("shared_memory_bytes"))}
                stream.send(HELLO_OK, json.dumps(answer).encode())
            elif kind == STEP:
                scan = Scan(payload)
                answer = on_scan(scan)
                if not isinstance(answer, Answer):
                    answer = Answer(answer)
                if answer.pose is not None:
                    poses.append((scan.stamp_ns, _checked(answer.pose).copy()))
                stream.send(OUTPUT, answer.pack(scan.stamp_ns))
            elif kind == FINISH:
                final, points = _parts(finish(), "what finish() returns", "poses", "points") if finish else (poses, ())
                stream.send(ESTIMATE, _estimate(final, points))
    except BrokenPipeError:
        return
    except Exception:
        raise SystemExit(_give_up(stream))


def _give_up(stream):
    """The whole trace where the process prints to, one line to plumbline."""
    traceback.print_exc()
    kind, error, trace = sys.exc_info()
    own = [frame for frame in traceback.extract_tb(trace) if frame.filename != __file__]
    where = f" ({os.path.basename(own[-1].filename)}, line {own[-1].lineno})" if own else ""  # none: an answer is at fault
    text = f"{kind.__name__}: {error}{where}"
    stream.send(FAIL, text.replace("\n", " ").encode())
    return 1
