// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "sim/lidar/beams.h"
#include "sim/lidar/lidar_config.h"

namespace plumbline::sim {

/// Finds the beams whose footprint an edge may cross. Edges across a ring lie between a beam and its neighbours in it,
/// which are a footprint apart. Rings are many footprints apart, so an edge between two seldom lies in a beam: the
/// upper or lower end of the footprint is cast where the faces that were hit do not decide it.
class EdgeFinder {
 public:
  EdgeFinder(const LidarConfig& config, const bim::RayScene& scene);

  /// Sets at_edge[column * lasers + laser] of the beams that are at an edge; others stay as they are.
  void find(const Beams& beams, std::span<std::uint8_t> at_edge);

 private:
  /// An end of a beam's footprint.
  struct Probe {
    std::size_t beam = 0;  ///< index into Beams
    std::size_t out = 0;   ///< index into at_edge
  };

  [[nodiscard]] bool differ(const Beams& beams, std::size_t a, std::size_t b) const;
  [[nodiscard]] bool breaks_at(const Beams& beams, std::size_t a, std::size_t b) const;
  [[nodiscard]] bool settled(const Beams& beams, std::size_t beam, std::size_t other, const bim::Ray& end) const;
  void find_in_tile(const Beams& beams, std::size_t tile, std::span<std::uint8_t> at_edge);
  void cast_probes(const Beams& beams, std::span<std::uint8_t> at_edge);

  LidarConfig config_;
  const bim::RayScene& scene_;
  std::vector<Probe> probes_;
  std::vector<bim::Ray> rays_;
  std::vector<bim::Hit> hits_;
};

}  // namespace plumbline::sim
