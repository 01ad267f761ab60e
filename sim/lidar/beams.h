// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "sim/lidar/footprint.h"
#include "slam/io/lidar_model.h"

namespace plumbline::sim {

/// Central rays of one message and their hits. They stand in tiles of eight columns (firings), laser by laser from
/// the lowest ring on, as the ray scene casts them best; column -1 and one behind the last are the neighbours of the
/// message's ends.
class Beams {
 public:
  static constexpr std::size_t tile_columns = 8;

  /// phase: azimuth of firing 0, 1e-9 degrees.
  Beams(const slam::LidarModel& model, double rpm, std::int64_t phase);

  /// Azimuth of a firing, from 0 to a full turn, 1e-9 degrees.
  [[nodiscard]] std::int64_t azimuth(std::int64_t firing) const;

  /// Casts one message; X_WL has a pose a column. The memory of the last message is used again.
  void cast(std::int64_t first_firing, std::span<const Pose> X_WL, const bim::RayScene& scene);

  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t lasers() const { return model_.lasers.size(); }
  /// The laser of a ring.
  [[nodiscard]] std::size_t laser_of(std::size_t ring) const { return laser_of_ring_[ring]; }
  /// Index of a beam; the beam of the ring above is tile_columns farther.
  [[nodiscard]] std::size_t index(std::int64_t column, std::size_t laser) const {
    const auto c = static_cast<std::size_t>(column + 1);
    const auto ring = static_cast<std::size_t>(model_.lasers[laser].ring);
    return ((c / tile_columns) * lasers() + ring) * tile_columns + c % tile_columns;
  }
  [[nodiscard]] const bim::Ray& ray(std::size_t index) const { return rays_[index]; }
  [[nodiscard]] const bim::Hit& hit(std::size_t index) const { return hits_[index]; }
  [[nodiscard]] Tangents tangents(std::size_t column, std::size_t laser) const;

 private:
  /// An angle by its cosine and sine.
  struct Turn {
    double c = 1.0;
    double s = 0.0;
  };
  struct Head {
    Turn turn;
    Eigen::Matrix3d R_WL;
  };

  [[nodiscard]] Turn turn_of(std::int64_t column, std::size_t laser) const;
  void aim(std::int64_t column, std::int64_t first_firing, const Pose& X_WL);

  const slam::LidarModel& model_;
  std::int64_t turn_per_firing_;  ///< 1e-9 degrees
  std::int64_t phase_;
  std::vector<Turn> laser_turns_;
  std::vector<std::size_t> laser_of_ring_;
  std::size_t columns_ = 0;
  std::vector<Head> heads_;  ///< from column -1 on
  std::vector<bim::Ray> rays_;
  std::vector<bim::Hit> hits_;
};

}  // namespace plumbline::sim
