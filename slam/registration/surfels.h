// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/scan/motion.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

struct SurfelConfig {
  double min_range_m = 0.5;
  double max_range_m = 200.0;
  double voxel_m = 0.2;
  double radius_m = 0.3;
  double ring_gap_per_m = 0.3;
  double max_thickness_m = 0.05;
  int min_neighbours = 8;

  template <class V>
  void visit(V& v) {
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1.0});
    v("voxel_m", voxel_m,
      Field{.doc = "voxel size at which a scan is thinned to one surfel each", .min = 0.01, .basic = true});
    v("radius_m", radius_m, Field{.doc = "largest distance of neighbours on the same ring", .min = 0.01});
    // On the floor, rings are 1.2 m apart at 4 m.
    v("ring_gap_per_m", ring_gap_per_m,
      Field{.doc = "largest distance of neighbours on the next rings, per metre of range", .unit = "m/m", .min = 0.0});
    v("max_thickness_m", max_thickness_m,
      Field{.doc = "standard deviation across a neighbourhood above which it is no surface", .min = 0.001});
    v("min_neighbours", min_neighbours, Field{.doc = "least number of neighbours of a surfel", .min = 4});
  }
};

/// A Gaussian of the scan's surface, regularised to a plane: its covariance is in_plane^2 (I - n n^T) + across^2 n n^T.
struct Surfel {
  Eigen::Vector3d mean_R;
  Eigen::Vector3d normal_R;   ///< unit
  float time_s = 0.0F;        ///< of its returns after the scan's stamp
  bool faces_sensor = false;  ///< the normal points to the side that was seen; false: its sign is free
};
/// Turns the normal to the sensor, unless the surface is seen at such a grazing angle that its side is not sure.
void face(Surfel& surfel, const Eigen::Vector3d& sensor_R);

/// Whether a scan has few rings, but some: its neighbours are sought in the ring image then, and its edges along rings.
[[nodiscard]] bool has_ring_image(const DeskewedScan& scan);

/// Surfels of a scan. Of few rings: one raw return a voxel, its neighbours in the ring image, their scatter; in firing
/// order. Of many rings or without any: one a voxel, from its returns and those of the voxels round it.
[[nodiscard]] std::vector<Surfel> make_surfels(const DeskewedScan& scan, const SurfelConfig& config);

/// Surfels of a scan, and points without one, at most one a voxel.
struct Surfaces {
  std::vector<Surfel> surfels;
  std::vector<Eigen::Vector3d> rough_R;
};
/// Rough points of few rings are those that stand up and face the sensor or stand alone, as leaves, posts and far walls
/// do: rings on the ground, and a wall's last returns at a grazing angle, go along with the robot. Those of many rings
/// or of none lie in no plane and no line of sight.
[[nodiscard]] Surfaces find_surfaces(const DeskewedScan& scan, const SurfelConfig& config);

/// Gaussian voxel map in M: each voxel pools the surfels that fell into it, those of either side of a surface apart.
class SurfelMap {
 public:
  struct Voxel {
    double n = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();      ///< of means, M
    Eigen::Matrix3d normals = Eigen::Matrix3d::Zero();  ///< of n n^T
    Eigen::Vector3d facing = Eigen::Vector3d::Zero();   ///< of the normals that face the sensor
    int side = 0;                                       ///< 0: unknown, else of a plane
    int next = -1;                                      ///< slot of what the same voxel holds of another side
  };

  explicit SurfelMap(double voxel_m) : voxel_m_(voxel_m) {}

  void add(std::span<const Surfel> surfels, const Pose& X_MR) { pool(surfels, X_MR, 1.0); }
  /// Takes back what add() gave with the same arguments.
  void remove(std::span<const Surfel> surfels, const Pose& X_MR) { pool(surfels, X_MR, -1.0); }
  /// Voxel for a surfel at p_M: the one that holds it or else the neighbours behind the three nearer faces, nearest
  /// face first (ties: x, y, z), the first whose surfels agree with the normal: mean of (n . n_i)^2 >=
  /// min_normal_agreement. Of the two sides of a surface it is the one that the normal faces or, where that is not
  /// known, the one that more surfels made; surfels of unknown side belong to both. None when none agrees. Without the
  /// neighbours a floor that lies on a voxel face would come and go; without the sides it would be taken for the
  /// ceiling below.
  [[nodiscard]] std::optional<Voxel> find(const Eigen::Vector3d& p_M, const Eigen::Vector3d& normal_M,
                                          bool faces_sensor, double min_normal_agreement) const;
  [[nodiscard]] double voxel_m() const { return voxel_m_; }
  /// Whether most voxels were emptied by remove(); their slots stay.
  [[nodiscard]] bool holds_many_empty() const {
    constexpr std::size_t few = 10'000, share = 4;
    return voxels_.size() > few && voxels_.size() > share * live_;
  }

 private:
  /// Slot for surfels of this side.
  [[nodiscard]] std::size_t slot_of(const VoxelKey& key, int side);
  void pool(std::span<const Surfel> surfels, const Pose& X_MR, double sign);

  double voxel_m_;
  VoxelIndex index_;
  std::vector<Voxel> voxels_;
  std::vector<int> first_;  ///< slot in voxels_, by that in index_
  std::size_t live_ = 0;    ///< voxels that hold surfels
};

}  // namespace plumbline::slam
