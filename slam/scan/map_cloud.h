// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/plane.h"
#include "bim/geometry/pose.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

struct MapCloudConfig {
  double spacing_m = 0.75;
  double min_range_m = 0.5;
  double max_range_m = 25.0;
  double voxel_m = 0.05;
  int min_neighbours = 0;
  double dense_m = 4.0;

  template <class V>
  void visit(V& v) {
    v("spacing_m", spacing_m, Field{.doc = "distance walked between scans that enter the map", .min = 0.0});
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that enters the map", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that enters the map", .min = 0.0});
    v("voxel_m", voxel_m, Field{.doc = "voxel size of the map that is scored", .min = 0.005, .basic = true});
    // Beams split by an edge or scattered by a curved mirror.
    v("min_neighbours", min_neighbours,
      Field{.doc = "least number of occupied voxels around a map point, of 124; else it is an outlier", .min = 0});
    v("dense_m", dense_m, Field{.doc = "range beyond which proportionally fewer neighbours are required", .min = 0});
  }
};

/// One scan of a map: thinned points in R, so that the map can be drawn from corrected poses at the end.
struct CloudKeyframe {
  Pose X_FR;  ///< F is M or W
  std::vector<Eigen::Vector3f> points_R;
  std::vector<std::uint8_t> lasers;  ///< of each point; empty where they are not kept
};

/// Returns in the range gate, one mean point a voxel.
[[nodiscard]] std::vector<Eigen::Vector3f> thin_scan(const DeskewedScan& scan, const MapCloudConfig& config);

/// The same for each laser by itself, in the order of its returns: one mean point for those in a row within a voxel.
[[nodiscard]] CloudKeyframe thin_rings(const DeskewedScan& scan, const Pose& X_FR, const MapCloudConfig& config);

/// All keyframes in F, one mean point a voxel, ordered by voxel, without strays. Points on a floor or ceiling are
/// never strays: these are hit at a slant, where rings lie far apart. levels: those planes in F.
[[nodiscard]] std::vector<Eigen::Vector3f> map_cloud(std::span<const CloudKeyframe> keyframes,
                                                     const MapCloudConfig& config, std::span<const Plane> levels = {});

inline constexpr float farthest_map_point_m = 5e4F;  ///< that thin_map() takes

/// A map of others as map_cloud() gives ours: one mean point a voxel, so that what was seen more often does not count
/// more. One of which less than a hundredth of the points share a voxel stays as it is.
[[nodiscard]] std::vector<Eigen::Vector3f> thin_map(const std::vector<Eigen::Vector3f>& points_F,
                                                    double voxel_m = MapCloudConfig().voxel_m);

[[nodiscard]] std::size_t point_count(std::span<const CloudKeyframe> keyframes);

/// Drops the second of each two.
template <class T>
void keep_every_other(std::vector<T>& all) {
  for (std::size_t i = 1; 2 * i < all.size(); ++i) all[i] = std::move(all[2 * i]);
  all.resize((all.size() + 1) / 2);
}

/// Keeps a scan each time the robot has gone spacing_m since the last one kept.
class MapCloudRecorder {
 public:
  explicit MapCloudRecorder(const MapCloudConfig& config) : config_(config) {}

  /// True when the scan was kept.
  bool add(const DeskewedScan& scan, const Pose& X_FR);
  /// Keeps it wherever it is.
  void keep(const DeskewedScan& scan, const Pose& X_FR);
  [[nodiscard]] std::span<const CloudKeyframe> keyframes() const { return keyframes_; }
  [[nodiscard]] std::vector<Eigen::Vector3f> cloud() const { return map_cloud(keyframes_, config_); }

 private:
  MapCloudConfig config_;
  std::vector<CloudKeyframe> keyframes_;
};

}  // namespace plumbline::slam
