// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

#include <array>
#include <utility>

#include "slam/baseline/amcl.h"
#include "slam/baseline/lidar_odometry_method.h"
#include "slam/baseline/micp.h"
#include "slam/baseline/s_graph_localization_paper.h"
#include "slam/baseline/ukf.h"
#include "slam/localize/s_graph_localization.h"
#include "slam/sgraphs/s_graphs_plus.h"

namespace plumbline::slam {

namespace {

/// Completes the row of a front end that stands alone.
template <class FrontEnd>
MethodRow odometry_alone(OdometryKind kind, FrontEnd LidarOdometryConfig::*front_end, MethodRow row) {
  using Config = LidarOdometryMethodConfig<FrontEnd>;
  row.make = [kind, front_end](const MethodInput& input) {
    const auto told = config_of<Config>(input);
    LidarOdometryConfig config;
    config.kind = kind;
    config.*front_end = told.odometry;
    return make_lidar_odometry_method(input, config, told.map);
  };
  return with_config<Config>(std::move(row));
}

std::unique_ptr<Method> reckon_dead(const MethodInput& input) {
  LidarOdometryConfig config;
  config.kind = OdometryKind::legs;
  return make_lidar_odometry_method(input, config, config_of<DeadReckoningConfig>(input).map);
}

std::unique_ptr<Method> localize_in_plan(const MethodInput& input) {
  return make_s_graph_localization(input, config_of<LocalizationConfig>(input));
}

}  // namespace

MethodTable methods() {
  static const std::array rows = {
      with_config<DeadReckoningConfig>(
          {.name = "odometry", .summary = "dead reckoning of the legs", .make = reckon_dead, .needs_odometry = true}),
      odometry_alone(OdometryKind::vgicp, &LidarOdometryConfig::vgicp,
                     {.name = "vgicp", .summary = "LiDAR odometry: voxelized GICP against a sliding local map"}),
      odometry_alone(OdometryKind::floam, &LidarOdometryConfig::floam,
                     {.name = "floam",
                      .summary = "LiDAR odometry: edges and planes against a feature map, in the style of F-LOAM",
                      .standard = false}),
      odometry_alone(OdometryKind::aloam, &LidarOdometryConfig::aloam,
                     {.name = "aloam",
                      .summary = "LiDAR odometry: scan to scan, then against a feature map, in the style of A-LOAM",
                      .standard = false}),
      with_config<HdlSlamConfig>(
          {.name = "hdl_slam",
           .summary = "keyframe pose graph with floor plane and loop closures, in the style of HDL graph SLAM",
           .make = make_hdl_slam_method,
           .standard = false}),
      with_config<SGraphsConfig>(
          {.name = "s_graphs",
           .summary = "S-Graphs of 2022: walls, rooms from the planes of one keyframe, loops, as printed",
           .make = make_s_graphs_method,
           .standard = false}),
      with_config<SGraphsPlusPaperConfig>(
          {.name = "s_graphs_plus_paper",
           .summary = "S-Graphs+ as printed: RANSAC planes, rooms cut at a fixed distance, the papers' weights",
           .make = make_s_graphs_plus_paper_method,
           .standard = false}),
      with_config<SGraphsPlusConfig>({.name = "s_graphs_plus",
                                      .summary = "S-Graphs+: walls, rooms, floors and loops in one four-layered graph",
                                      .make = make_s_graphs_plus_method}),
      with_config<LocalizationConfig>(
          {.name = "s_graph_localization",
           .summary = "particle filter on the plan's walls and rooms, then a graph against them",
           .needs_plan = true,
           .make = localize_in_plan,
           .needs_odometry = true}),
      with_config<LocalizationPaperConfig>(
          {.name = "s_graph_localization_paper",
           .summary = "plan localization as printed: particles matched by walls of their room, then an S-Graph",
           .needs_plan = true,
           .make = make_s_graph_localization_paper,
           .standard = false,
           .needs_odometry = true}),
      with_config<AmclConfig>(
          {.name = "amcl",
           .summary = "Monte Carlo localization of planar scans on a slice of the plan, in the style of nav2's AMCL",
           .needs_plan = true,
           .make = make_amcl,
           .standard = false,
           .needs_odometry = true}),
      with_config<UkfConfig>(
          {.name = "ukf",
           .summary = "NDT on the plan, smoothed by an unscented filter, in the style of hdl_localization",
           .needs_plan = true,
           .make = make_ukf,
           .standard = false,
           .needs_odometry = true}),
      with_config<MicpConfig>(
          {.name = "micp",
           .summary = "corrections by casting each scan's beams in the plan, in the style of MICP-L",
           .needs_plan = true,
           .make = make_micp,
           .standard = false,
           .needs_odometry = true}),
  };
  return rows;
}

const MethodRow* find_method(std::string_view name, MethodTable table) {
  for (const MethodRow& row : table)
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace plumbline::slam
