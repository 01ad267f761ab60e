# SPDX-License-Identifier: Apache-2.0
from types import SimpleNamespace


class KISSConfig:
    def __init__(self):
        self.data = SimpleNamespace(max_range=100.0, min_range=0.0, deskew=True)
        self.mapping = SimpleNamespace(voxel_size=None, max_points_per_voxel=20)
        self.registration = SimpleNamespace(max_num_iterations=500, max_num_threads=0)
