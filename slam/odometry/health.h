// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/config/visit.h"
#include "slam/io/records.h"
#include "slam/registration/registration.h"

namespace plumbline::slam {

struct HealthConfig {
  double min_matched = 0.35;    ///< share of a scan's features that must meet the map
  double max_speed_mps = 4.0;   ///< a step that would need more is no step of the robot ...
  double max_turn_radps = 6.0;  ///< ... nor one that would need this
  int bad_scans = 3;            ///< in a row, after which the odometry is lost
  int good_scans = 10;          ///< in a row, after which it is found again
  int restart_scans = 20;       ///< bad ones in a row, after which a new map is begun

  template <class V>
  void visit(V& v) {
    v("min_matched", min_matched, Field{.doc = "share of features that meet the map", .min = 0, .max = 1});
    v("max_speed_mps", max_speed_mps, Field{.doc = "of a believed step", .min = 0.1});
    v("max_turn_radps", max_turn_radps, Field{.doc = "of a believed step", .min = 0.1});
    v("bad_scans", bad_scans, Field{.doc = "in a row until lost", .min = 1});
    v("good_scans", good_scans, Field{.doc = "in a row until found again", .min = 1});
    v("restart_scans", restart_scans, Field{.doc = "bad ones in a row until a new map", .min = 1});
  }
};

/// Whether scan matching can be believed: scan by scan at once, as a state with hysteresis.
class OdometryHealth {
 public:
  explicit OdometryHealth(const HealthConfig& config) : config_(config) {}

  /// Judges one registration: step, the robot's motion since the scan dt before. True: believe it.
  [[nodiscard]] bool judge(const Registration& registration, const Pose& step, Nanoseconds dt);
  /// Whether a robot can have made this step in the time dt.
  [[nodiscard]] bool possible(const Pose& step, Nanoseconds dt) const;
  [[nodiscard]] bool lost() const { return lost_; }
  /// True once after so many bad scans that the map is of no use.
  [[nodiscard]] bool wants_restart() const { return bad_ > 0 && bad_ % config_.restart_scans == 0; }

 private:
  HealthConfig config_;
  int bad_ = 0, good_ = 0;  ///< in a row
  bool lost_ = false;
};

}  // namespace plumbline::slam
