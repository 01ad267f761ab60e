# SPDX-License-Identifier: Apache-2.0
"""Point-to-point ICP of each scan against the last keyframe's points. An example, not a good odometry."""
import numpy as np
import plumbline_client


def thinned(points, size):
    """One point a voxel."""
    _, first = np.unique(np.floor(points / size).astype(int), axis=0, return_index=True)
    return points[np.sort(first)]


def nearest(points, targets):
    """Index of and distance to the nearest target of each point."""
    squares = (points**2).sum(1)[:, None] - 2 * points @ targets.T + (targets**2).sum(1)
    index = squares.argmin(1)
    return index, np.sqrt(np.maximum(squares[np.arange(len(points)), index], 0))


def fit(points, targets):
    """Rigid motion that brings points onto targets [Kabsch]."""
    a, b = points.mean(0), targets.mean(0)
    u, _, vt = np.linalg.svd((points - a).T @ (targets - b))
    turn = vt.T @ np.diag([1, 1, np.linalg.det(vt.T @ u.T)]) @ u.T
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, b - turn @ a
    return pose


def start(recording):
    keyframe, at_keyframe = None, np.eye(4)  # points in the LiDAR's first frame, and the pose they were seen from
    pose, step = np.eye(4), np.eye(4)

    def on_scan(scan):
        nonlocal keyframe, at_keyframe, pose, step
        points = thinned(scan.points, 0.4)
        if keyframe is None:
            keyframe = points
            return recording.robot_pose(pose)
        guess = pose @ step
        for gate in (1.0, 1.0, 0.5, 0.5, 0.3, 0.3, 0.3):
            moved = points @ guess[:3, :3].T + guess[:3, 3]
            index, distance = nearest(moved, keyframe)
            near = distance < gate
            if near.sum() < 20:
                break
            guess = fit(moved[near], keyframe[index[near]]) @ guess
        step, pose = np.linalg.inv(pose) @ guess, guess
        if np.linalg.norm(pose[:3, 3] - at_keyframe[:3, 3]) > 0.5:
            keyframe, at_keyframe = points @ pose[:3, :3].T + pose[:3, 3], pose
        return recording.robot_pose(pose)

    return on_scan


plumbline_client.run(start)
