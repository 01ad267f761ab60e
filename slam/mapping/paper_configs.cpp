// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "slam/mapping/s_graphs_plus.h"

namespace plumbline::slam {

namespace {

/// Standard deviation that an information of the papers' code is.
double sigma(double information) { return 1.0 / std::sqrt(information); }

WallLayerConfig printed_walls() {
  WallLayerConfig walls;
  walls.association = Association::angles;
  walls.max_gap_m = std::sqrt(0.5);  // "plane_points_dist", squared
  walls.information = 0.1;
  walls.min_observations = 1;
  walls.min_top_m = 0.0;
  walls.min_length_m = 0.0;
  walls.duplicate_sigma_rad = walls.duplicate_sigma_m = sigma(0.1);
  return walls;
}

RoomLayerConfig printed_rooms() {
  RoomLayerConfig rooms;
  rooms.free_space.cell_m = 0.2;
  rooms.free_space.max_range_m = 5.0;
  rooms.free_space.wall_hits = 1'000'000;  // free space does not use planes
  rooms.clusters.cut = Cut::fixed;
  rooms.rooms.reach_m = 1.0;
  rooms.rooms.entered_only = false;
  rooms.rooms.polygons = false;
  rooms.sigma_m = sigma(0.1);
  rooms.two_wall_sigma_m = sigma(0.01);
  return rooms;
}

}  // namespace

SGraphsPlusAllWallsConfig::SGraphsPlusAllWallsConfig() {
  plane_source = PlaneSource::ransac;
  ransac.source = RansacSource::pcl;
  pose_weights = PoseWeights::fitness;
  keyframe_distance_m = 2.0;
  keyframe_angle_rad = 2.0;
  incremental.batch = true;
  walls = printed_walls();
  rooms = printed_rooms();
  map.spacing_m = 2.0;
  map.min_neighbours = 0;
  mirror_ghosts.remove = false;
  laser_range_calibration.correct = false;
  planes.laser_sigma_m = 0.0;
  level_agreement.drop = false;
  floors.room_sigma_m = sigma(1e-4);
  loop.radius_m = 1.0;
  loop.min_walked_m = 3.0;
  loop.min_since_last_m = 5.0;
  optimizer.huber = 1.0;
  optimizer.loop_huber = 1.0;
}

SGraphsConfig::SGraphsConfig() {
  rooms.source = RoomSource::keyframe;
  parts.floors = false;
}

SGraphsPlusPrintedConfig::SGraphsPlusPrintedConfig() { rooms.source = RoomSource::keyframe_clusters; }

SGraphs2022Config::SGraphs2022Config() {
  walls.angles_gate = 0.2;
  walls.angles_gate_few = 0.2;
  walls.information = 1.0;
  rooms.keyframe_rooms.rule = KeyframeRoomRule::end_points;
  rooms.sigma_m = sigma(0.01);
  rooms.two_wall_sigma_m = sigma(0.01);
}

}  // namespace plumbline::slam
