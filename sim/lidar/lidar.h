// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bim/rays/scene.h"
#include "sim/lidar/config.h"
#include "slam/io/vlp16.h"

namespace plumbline::sim {

/// Ground truth of one message's returns, for scoring only; index as in slam::Scan.
struct ReturnLabels {
  std::vector<std::int32_t> element;     ///< element id, -1 no return
  std::vector<Eigen::Vector3d> point_W;  ///< noise-free hit point, zero without a return
};

struct Sweep {
  std::vector<slam::Vlp16Packet> packets;
  ReturnLabels labels;
};

/// Emulated VLP-16: real firing order and times, a pose per firing (rolling shutter), 2 mm ranges, noise by range, a
/// bias per unit and per laser, dropouts by incidence and range. One return a beam, from the nearest face: no mixed
/// pixels, glass or rain in this version.
class Lidar {
 public:
  /// rpm from 300 to 1200. The scene must outlive the sensor. Throws InputError on other speeds and on the preset
  /// `full`, which is not in this version.
  Lidar(LidarPreset preset, double rpm, std::uint64_t seed, const bim::RayScene& scene);
  Lidar(const LidarConfig& config, double rpm, std::uint64_t seed, const bim::RayScene& scene);
  ~Lidar();

  /// Fires one message. first_firing counts firings since the start; X_WL has one pose a firing (1,824, or any
  /// multiple of 24), each at that firing's start. Azimuth and noise depend on the firing number only.
  [[nodiscard]] Sweep sweep(std::int64_t first_firing, std::span<const Pose> X_WL) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::sim
