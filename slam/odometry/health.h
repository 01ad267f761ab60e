// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/io/records.h"
#include "slam/registration/registration.h"

namespace plumbline::slam {

struct HealthConfig {
  double min_matched = 0.35;
  double max_speed_mps = 4.0;
  double max_turn_radps = 6.0;
  int bad_scans = 3;
  int good_scans = 10;
  int restart_scans = 20;

  template <class V>
  void visit(V& v) {
    v("min_matched", min_matched, share_field("least share of a scan's features that must match the map"));
    v("max_speed_mps", max_speed_mps, Field{.doc = "largest speed of a plausible step", .min = 0.1});
    v("max_turn_radps", max_turn_radps, Field{.doc = "largest turn rate of a plausible step", .min = 0.1});
    v("bad_scans", bad_scans, Field{.doc = "bad scans in a row after which the odometry is lost", .min = 1});
    v("good_scans", good_scans, Field{.doc = "good scans in a row after which it has recovered", .min = 1});
    v("restart_scans", restart_scans, Field{.doc = "bad scans in a row after which a new map starts", .min = 1});
  }
};

/// Whether scan matching is trusted: for each scan at once, and as a state with hysteresis.
class OdometryHealth {
 public:
  explicit OdometryHealth(const HealthConfig& config) : config_(config) {}

  /// Assesses one registration. step: the robot's motion since the scan dt before. True: accept it.
  [[nodiscard]] bool assess(const Registration& registration, const Pose& step, Nanoseconds dt);
  /// Whether a robot can have made this step in the time dt.
  [[nodiscard]] bool is_plausible_step(const Pose& step, Nanoseconds dt) const;
  [[nodiscard]] bool lost() const { return lost_; }
  /// True once after so many bad scans that the map is of no use.
  [[nodiscard]] bool wants_restart() const { return bad_ > 0 && bad_ % config_.restart_scans == 0; }

 private:
  HealthConfig config_;
  int bad_ = 0, good_ = 0;  ///< in a row
  bool lost_ = false;
};

}  // namespace plumbline::slam
