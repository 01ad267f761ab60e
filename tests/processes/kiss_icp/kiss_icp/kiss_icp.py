# SPDX-License-Identifier: Apache-2.0
"""Point-to-point ICP on the last keyframe after deskewing to the end of the scan; refuses what the public one's binding
refuses."""
import numpy as np


def exp_step(step, share):
    """The share of a small planar motion."""
    yaw = share * np.arctan2(step[1, 0], step[0, 0])
    return yaw, np.outer(share, step[:3, 3])


class KissICP:
    def __init__(self, config):
        assert config.mapping.voxel_size is not None, "voxel_size is not set"
        self.config, self.last_pose, self.last_delta, self.map = config, np.eye(4), np.eye(4), None

    def register_frame(self, frame, timestamps):
        for array in (frame, timestamps):
            if not isinstance(array, np.ndarray) or array.dtype != np.float64:
                raise TypeError("incompatible function arguments: an array of float64 is needed")
        if frame.ndim != 2 or frame.shape[1] != 3:
            raise TypeError("incompatible function arguments: points must be N x 3")
        if len(timestamps) not in (0, len(frame)):
            raise IndexError("timestamps must be as many as points")
        points = self._deskewed(frame, timestamps)
        reach = np.linalg.norm(points, axis=1)
        points = points[(reach < self.config.data.max_range) & (reach > self.config.data.min_range)]
        if len(points) < 20:
            return points, points
        _, first = np.unique(np.floor(points / (1.5 * self.config.mapping.voxel_size)).astype(int), axis=0,
                             return_index=True)
        pose = self._aligned(points[first], self.last_pose @ self.last_delta)
        self.last_delta, self.last_pose = np.linalg.inv(self.last_pose) @ pose, pose
        if self.map is None or np.linalg.norm(self.at[:3, 3] - pose[:3, 3]) > 0.5:
            self.map, self.at = points[first] @ pose[:3, :3].T + pose[:3, 3], pose
        return points, points[first]

    def _deskewed(self, points, timestamps):
        if len(timestamps) == 0 or not self.config.data.deskew:
            return points
        share = (timestamps - timestamps.min()) / (timestamps.max() - timestamps.min()) - 1.0
        yaw, shift = exp_step(self.last_delta, share)
        c, s = np.cos(yaw), np.sin(yaw)
        x, y, z = points.T
        return np.stack([c * x - s * y, s * x + c * y, z], axis=1) + shift

    def _aligned(self, points, guess):
        if self.map is None:
            return guess
        for gate in (1.0, 0.6, 0.4, 0.3, 0.3, 0.3, 0.3, 0.3):
            moved = points @ guess[:3, :3].T + guess[:3, 3]
            squares = (moved**2).sum(1)[:, None] - 2 * moved @ self.map.T + (self.map**2).sum(1)
            index = squares.argmin(1)
            near = squares[np.arange(len(moved)), index] < gate**2
            if near.sum() < 20:
                return guess
            a, b = moved[near], self.map[index[near]]
            u, _, vt = np.linalg.svd((a - a.mean(0)).T @ (b - b.mean(0)))
            turn = vt.T @ np.diag([1, 1, np.linalg.det(vt.T @ u.T)]) @ u.T
            fit = np.eye(4)
            fit[:3, :3], fit[:3, 3] = turn, b.mean(0) - turn @ a.mean(0)
            guess = fit @ guess
        return guess
