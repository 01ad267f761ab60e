// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "bim/geometry/pose.h"
#include "sim/robot/sensors.h"

namespace plumbline::sim {

/// Soft feet sink by 2-4 mm when they land and spring back within 40 ms: taken as still, they make the height creep
/// by millimetres a stride.
struct LegHeightConfig {
  double settle_s = 0.06;       ///< after a landing, until feet are taken as still
  double lost_s = 0.006;        ///< without contact, until a foot counts as lifted: flags flip
  double bandwidth_rad_s = 15;  ///< of height and climb rate following the feet
  double gravity = 9.81;        ///< m/s^2
};

/// Height of the base over where it was first, from the accelerometer and the feet that stand. While any foot has just
/// landed (and others are about to lift) the accelerometer alone carries the height; the feet then found standing hold
/// it until the next landing. No floor is assumed: steps and ramps are climbed foot by foot.
class LegHeight {
 public:
  explicit LegHeight(const LegHeightConfig& config) : config_(config) {}

  /// Advances by dt seconds. q_OR: attitude; sole_m: the feet's lowest points against the base along z of O, m;
  /// rolling: climb rates of feet that stand and roll uphill, m/s.
  void update(const SensorReading& reading, const Eigen::Quaterniond& q_OR, const std::array<double, 4>& sole_m,
              const std::array<double, 4>& rolling, double dt);

  [[nodiscard]] double z() const { return z_; }      ///< m, 0 at the start
  [[nodiscard]] bool held() const { return held_; }  ///< by feet, at the last update

 private:
  struct Foot {
    bool stands = false;
    bool anchored = false;  ///< ground_O is known
    double off_s = 1.0;     ///< since the last contact
    double stood_s = 0.0;   ///< since landing
    double ground_O = 0.0;  ///< height of what it stands on
  };

  void update_contacts(const SensorReading& reading, double dt);
  [[nodiscard]] bool settled() const;
  void follow_feet(const std::array<double, 4>& sole_m, double dt);

  LegHeightConfig config_;
  std::array<Foot, 4> feet_{};
  double z_ = 0.0;
  double climb_ = 0.0;  ///< m/s
  bool held_ = false;
};

}  // namespace plumbline::sim
