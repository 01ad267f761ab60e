// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

#include <utility>
#include <vector>

#include "slam/baselines/amcl/amcl.h"
#include "slam/baselines/hdl_slam_paper/hdl_slam_paper.h"
#include "slam/baselines/kiss_icp/kiss_icp.h"
#include "slam/baselines/lego_loam/lego_loam.h"
#include "slam/baselines/lidar_odometry/lidar_odometry_method.h"
#include "slam/baselines/micp/micp.h"
#include "slam/baselines/mloam/mloam.h"
#include "slam/baselines/pcl_registration/pcl_registration.h"
#include "slam/baselines/ukf/ukf.h"
#include "slam/localization/as_printed/s_graph_localization_paper.h"
#include "slam/localization/pipeline.h"
#include "slam/mapping/s_graphs_plus.h"

namespace plumbline::slam {

namespace {

/// Completes the row of a front end that stands alone; Own is its config with the defaults of this row.
template <class Own, class FrontEnd>
MethodRow odometry_alone(OdometryKind kind, FrontEnd LidarOdometryConfig::*front_end, MethodRow row) {
  using Config = LidarOdometryMethodConfig<Own>;
  row.make = [kind, front_end](const MethodInput& input) {
    const auto given = config_of<Config>(input);
    LidarOdometryConfig config;
    config.kind = kind;
    config.*front_end = given.odometry;
    return make_lidar_odometry_method(input, config, given.map);
  };
  return with_config<Config>(std::move(row));
}

std::unique_ptr<Method> make_dead_reckoning(const MethodInput& input) {
  LidarOdometryConfig config;
  config.kind = OdometryKind::legs;
  return make_lidar_odometry_method(input, config, config_of<DeadReckoningConfig>(input).map);
}

/// Completes a row of KISS-ICP; Own is its config with the defaults of this row.
template <class Own>
MethodRow kiss_icp(MethodRow row) {
  row.make = [](const MethodInput& input) { return make_kiss_icp(input, config_of<Own>(input)); };
  row.standard = false;
  row.uses_odometry = false;
  return with_config<Own>(std::move(row));
}

template <class Config, auto make>
std::unique_ptr<Method> make_by(const MethodInput& input) {
  return make(input, config_of<Config>(input));
}

/// Completes the row of a method that localizes in a plan; Own is its config with the defaults of this row.
template <class Own, class Config>
MethodRow localization(std::unique_ptr<Method> (*make)(const MethodInput&, const Config&), MethodRow row) {
  row.make = [make](const MethodInput& input) { return make(input, config_of<Own>(input)); };
  row.needs_plan = true;
  return with_config<Own>(std::move(row));
}

std::vector<MethodRow> localizations() {
  return {
      localization<LocalizationConfig>(
          make_s_graph_localization,
          {.name = "s_graph_localization",
           .summary = "particle filter and pose hypotheses on the plan's walls and rooms, then tracking by a graph"}),
      localization<LocalizationNoRoomsConfig>(
          make_s_graph_localization,
          {.name = "s_graph_localization_no_rooms",
           .summary = "s_graph_localization without the room factor: tracked by single walls",
           .standard = false,
           .variant = true}),
      localization<LocalizationPaperConfig>(
          make_s_graph_localization_paper,
          {.name = "s_graph_localization_paper",
           .summary = "plan localization as published: particles matched by walls of their room, then an S-Graph",
           .standard = false}),
      localization<LocalizationWithoutRoomsConfig>(
          make_s_graph_localization_paper,
          {.name = "s_graph_localization_paper_no_rooms",
           .summary = "s_graph_localization_paper without the topological factor: matched by all walls",
           .standard = false,
           .variant = true}),
      localization<AmclConfig>(
          make_amcl,
          {.name = "amcl",
           .summary = "Monte Carlo localization of planar scans on a slice of the plan, in the style of nav2's AMCL",
           .standard = false}),
      localization<AmclTunedConfig>(make_amcl,
                                    {.name = "amcl_tuned",
                                     .summary = "amcl with less noise and more particles than nav2's defaults",
                                     .standard = false,
                                     .variant = true}),
      localization<UkfConfig>(
          make_ukf, {.name = "ukf",
                     .summary = "NDT on the plan, smoothed by an unscented filter, in the style of hdl_localization",
                     .standard = false}),
      localization<MicpConfig>(
          make_micp,
          {.name = "micp",
           .summary = "pose corrections by casting each scan's beams in the plan's mesh, in the style of MICP-L",
           .standard = false}),
  };
}

std::vector<MethodRow> odometry_and_slam() {
  return {
      with_config<DeadReckoningConfig>({.name = "odometry",
                                        .summary = "dead reckoning by leg odometry",
                                        .make = make_dead_reckoning,
                                        .needs_odometry = true}),
      odometry_alone<CoarseVgicpConfig>(
          OdometryKind::vgicp, &LidarOdometryConfig::vgicp,
          {.name = "vgicp",
           .summary = "LiDAR odometry: VGICP against a local map, voxels of 0.5 m; uses odometry if given"}),
      odometry_alone<VgicpConfig>(OdometryKind::vgicp, &LidarOdometryConfig::vgicp,
                                  {.name = "vgicp_tuned",
                                   .summary = "vgicp with voxels of 0.2 m and vertical edges, as in the graph methods",
                                   .standard = false,
                                   .variant = true}),
      odometry_alone<loam::FloamConfig>(
          OdometryKind::floam, &LidarOdometryConfig::floam,
          {.name = "floam",
           .summary = "LiDAR odometry: edges and planes against a feature map, in the style of F-LOAM",
           .standard = false}),
      odometry_alone<loam::AloamConfig>(
          OdometryKind::aloam, &LidarOdometryConfig::aloam,
          {.name = "aloam",
           .summary = "LiDAR odometry: scan to scan, then against a feature map, in the style of A-LOAM",
           .standard = false}),
      kiss_icp<KissIcpConfig>(
          {.name = "kiss_icp", .summary = "LiDAR odometry: point-to-point ICP with an adaptive threshold, KISS-ICP"}),
      kiss_icp<KissIcpIndoorConfig>({.name = "kiss_icp_indoor",
                                     .summary = "kiss_icp with finer voxels and all points of the map, for rooms",
                                     .variant = true}),
      with_config<LegoLoamConfig>({.name = "lego_loam",
                                   .summary = "LiDAR alone: LeGO-LOAM",
                                   .make = make_by<LegoLoamConfig, make_lego_loam>,
                                   .standard = false,
                                   .uses_odometry = false}),
      with_config<LegoLoamIndoorConfig>(
          {.name = "lego_loam_indoor",
           .summary = "lego_loam that is corrected by its map where rooms show little of the floor, too",
           .make = make_by<LegoLoamIndoorConfig, make_lego_loam>,
           .standard = false,
           .uses_odometry = false,
           .variant = true}),
      with_config<MloamConfig>({.name = "mloam",
                                .summary = "LiDAR alone: M-LOAM for one LiDAR",
                                .make = make_by<MloamConfig, make_mloam>,
                                .standard = false,
                                .uses_odometry = false}),
      with_config<PclGicpMethodConfig>(
          {.name = "pcl_gicp",
           .summary = "LiDAR odometry: PCL's own GICP against the latest keyframes, started by odometry",
           .make = make_by<PclGicpMethodConfig, make_pcl_gicp_method>,
           .standard = false}),
      with_config<PclNdtMethodConfig>(
          {.name = "pcl_ndt",
           .summary = "LiDAR odometry: PCL's own NDT against the latest keyframes, started by odometry",
           .make = make_by<PclNdtMethodConfig, make_pcl_ndt_method>,
           .standard = false}),
      with_config<HdlSlamPaperConfig>({.name = "hdl_slam_paper",
                                       .summary = "LiDAR alone: HDL graph SLAM, reimplemented with its authors' indoor "
                                                  "settings, GICP to single keyframes, a floor, loops",
                                       .make = make_by<HdlSlamPaperConfig, make_hdl_slam_paper>,
                                       .standard = false,
                                       .uses_odometry = false}),
      with_config<HdlSlamPaperNdtConfig>({.name = "hdl_slam_paper_ndt",
                                          .summary = "hdl_slam_paper with NDT, which its code has by default",
                                          .make = make_by<HdlSlamPaperNdtConfig, make_hdl_slam_paper>,
                                          .standard = false,
                                          .uses_odometry = false,
                                          .variant = true}),
      with_config<KeyframeGraphConfig>(
          {.name = "keyframe_graph",
           .summary = "pose graph of our front end: s_graphs_plus without walls, rooms and floor layer; its "
                      "odometry, with leg odometry where given, floor planes, loops",
           .make = make_keyframe_graph_method,
           .standard = false,
           .former = "hdl_slam",
           .seed_name = "hdl_slam"}),
      with_config<SGraphsConfig>(
          {.name = "s_graphs",
           .summary = "s_graphs_plus_all_walls without floors; rooms from the walls of one keyframe",
           .make = make_s_graphs_method,
           .standard = false}),
      with_config<SGraphs2022Config>({.name = "s_graphs_2022",
                                      .summary = "s_graphs with the room rules of the 2022 program",
                                      .make = make_s_graphs_2022_method,
                                      .standard = false,
                                      .variant = true}),
      with_config<SGraphsPlusAllWallsConfig>(
          {.name = "s_graphs_plus_all_walls",
           .summary = "S-Graphs+ with the papers' planes, cut and weights, but rooms of all walls, on our front end",
           .make = make_s_graphs_plus_all_walls_method,
           .standard = false,
           .former = "s_graphs_plus_paper",
           .seed_name = "s_graphs_plus_paper"}),
      with_config<SGraphsPlusPrintedConfig>({.name = "s_graphs_plus_printed",
                                             .summary = "s_graphs_plus_all_walls with rooms as published: one "
                                                        "keyframe's planes, matched by centre, one factor per "
                                                        "observation",
                                             .make = make_s_graphs_plus_printed_method,
                                             .standard = false,
                                             .variant = true}),
      with_config<SGraphsPlusConfig>({.name = "s_graphs_plus",
                                      .summary = "S-Graphs+: walls, rooms, floors and loops in one four-layered graph",
                                      .make = make_s_graphs_plus_method}),
  };
}

}  // namespace

MethodTable methods() {
  static const std::vector<MethodRow> rows = [] {
    std::vector<MethodRow> all = odometry_and_slam();
    for (MethodRow& row : localizations()) all.push_back(std::move(row));
    return all;
  }();
  return rows;
}

}  // namespace plumbline::slam
