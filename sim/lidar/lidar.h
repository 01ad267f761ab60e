// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bim/random/stream.h"
#include "bim/rays/ray_scene.h"
#include "sim/lidar/lidar_config.h"
#include "sim/lidar/room_lookup.h"
#include "sim/lidar/surface.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::sim {

/// Ground truth of one message's returns, for scoring only; index as in slam::Scan. With two returns a beam the
/// labels belong to the stronger one.
struct ReturnLabels {
  std::vector<std::int32_t> element;     ///< element id, -1 no return, or one of dust or rain
  std::vector<std::int32_t> triangle;    ///< of the mesh that is seen (without optics: less panes), -1 no return
  std::vector<std::int32_t> room;        ///< index into Building::rooms, -1 in none
  std::vector<std::uint8_t> path;        ///< what happened to the light, see light_path
  std::vector<Eigen::Vector3d> point_W;  ///< where it was given back, m, without noise; zero without a return
};

/// One message as it was fired. Reuse one object across calls; its memory is kept.
struct Sweep {
  std::vector<slam::Vlp16Packet> packets;   ///< none of a model that sends no Velodyne packets
  std::vector<std::uint16_t> azimuth_cdeg;  ///< of the head at each firing's start
  std::vector<double> azimuth;              ///< the same before rounding, rad
  std::vector<slam::ReturnWord> words;      ///< firing by firing in order of the channels
  std::vector<slam::ReturnWord> last;       ///< the last returns in mode dual
  ReturnLabels labels;
};

/// Emulated spinning LiDAR: real firing order and times, a pose per firing (rolling shutter), the beam's footprint
/// (mixed pixels, two returns), panes and mirrors, ranges in the model's unit, noise by range, a bias per unit and per
/// laser, dropouts by incidence, reflectivity and range, systematic range errors, returns of dust and rain. Each is a
/// switch of LidarConfig.
class Lidar {
 public:
  /// rpm from 300 to 1200. Surfaces by element; elements beyond them reflect config.reflectivity. Without rooms labels
  /// name none. Scene and rooms must outlive the sensor. Throws InputError on other speeds.
  Lidar(LidarPreset preset, double rpm, Seed seed, const bim::RayScene& scene);
  Lidar(const LidarConfig& config, double rpm, Seed seed, const bim::RayScene& scene,
        std::vector<Surface> surfaces = {}, const RoomLookup* rooms = nullptr);
  ~Lidar();

  /// Fires one message. first_firing counts firings since the start; X_WL has one pose a firing (whole packets: any
  /// multiple of 24 does for every model), each at that firing's start. Azimuth and noise depend on the firing number
  /// only. Not for two threads at once.
  void sweep(std::int64_t first_firing, std::span<const Pose> X_WL, Sweep& sweep) const;
  [[nodiscard]] Sweep sweep(std::int64_t first_firing, std::span<const Pose> X_WL) const;

  [[nodiscard]] const slam::LidarModel& model() const;
  /// The scan a driver makes of a sweep; arguments as in slam::decode_message().
  [[nodiscard]] slam::Scan decode(std::int64_t first_firing, const Sweep& sweep, bool vertical_offsets = true) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::sim
