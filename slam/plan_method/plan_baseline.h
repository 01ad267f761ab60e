// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/method.h"
#include "slam/io/stopwatch.h"
#include "slam/particles/particles.h"
#include "slam/plan_map/plan_index.h"
#include "slam/plan_method/corrected_trajectory.h"
#include "slam/plan_method/prior_yaw.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

/// When a localization in a plan is asked again, and what it shows of itself.
struct PlanBaselineConfig {
  double update_m = 0.25;
  double update_rad = 0.2;
  int particles_shown = 500;
  double mass_shown = 0.02;
  double yaw_drift = told_yaw_drift;
  PlanIndexConfig index = {};

  template <class V>
  void visit(V& v) {
    v("update_m", update_m, Field{.doc = "way walked between two updates", .min = 0});
    v("update_rad", update_rad, Field{.doc = "or angle turned", .min = 0});
    v("particles_shown", particles_shown, Field{.doc = "most that an Output carries", .min = 1, .max = 500});
    v("mass_shown", mass_shown, Field{.doc = "least of a hypothesis in an Output", .min = 0, .max = 1});
    v("yaw_drift", yaw_drift, Field{.doc = "rad/s by which the told yaw grows stale", .min = 0});
    v("index", index);
  }
};

/// One scan to localize by.
struct PlanScan {
  DeskewedScan deskewed;
  Pose X_OR;                         ///< odometry at its stamp
  Pose2 u;                           ///< motion since the last scan an update saw, nothing at the first
  Eigen::Quaterniond q_HR;           ///< roll and pitch, from gravity
  std::optional<double> told_yaw_I;  ///< the told yaw carried along by the odometry
  double told_yaw_sigma = 0.0;       ///< rad
  std::uint64_t tick = 0;            ///< counts the updates, from 1
};

/// A place believed in, at the stamp of the scan last taken in.
struct PlanPlace {
  double mass = 1.0;
  int storey = 0;  ///< index into PlanIndex::storeys
  Pose X_IR;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, yaw) in I
  std::vector<WallMatch> walls = {};                         ///< shown with the scan they were found in
};

struct PlanBelief {
  State state = State::searching;
  std::optional<Pose> X_IR;  ///< the single answer, if there is one
  std::vector<PlanPlace> places;
  ParticleSet particles;
};

/// What localizations in a plan have in common beside the localizing: when a scan is looked at, the plan in its own
/// frame I, poses between updates by odometry, and the trajectory and map at the end. The methods of comparison derive
/// from it; a pose once given is kept up by odometry until there is another.
class PlanBaseline : public Method {
 public:
  /// Throws InputError when there is no plan, no such storey, or no room in it.
  PlanBaseline(std::string_view name, const MethodInput& input, const PlanBaselineConfig& config,
               const MapCloudConfig& map);

  void on_odometry(const Odometry& odometry) override { motion_.add(odometry); }
  [[nodiscard]] Output on_scan(const Scan& scan) final;
  [[nodiscard]] Estimate finish() final;

 protected:
  /// Takes in a scan; its stages go into the output's digests and times.
  [[nodiscard]] virtual PlanBelief update(const PlanScan& scan, Output& output) = 0;

  [[nodiscard]] const PlanIndex& index() const { return index_; }
  [[nodiscard]] const MethodInput& input() const { return input_; }
  /// A robot that stands upright on its storey's floor, its body tilted as gravity says.
  [[nodiscard]] Pose standing(int storey, const Pose2& X_IH, const Eigen::Quaterniond& q_HR) const;

 private:
  [[nodiscard]] bool is_due(const Pose& X_OR) const;
  [[nodiscard]] PlanScan prepared(const Scan& scan, const Pose& X_OR) const;
  void say_where(const Pose& X_OR, Output& output) const;

  MethodInput input_;
  PlanBaselineConfig config_;
  PlanIndex index_;
  MotionBuffer motion_;
  PlanBelief belief_;
  std::optional<Pose> X_IO_;  ///< by the last single answer
  std::optional<Pose> X_OR_start_, X_OR_update_;
  std::uint64_t tick_ = 0;
  Trail trail_;
  MapCloudConfig map_config_;
  MapCloudRecorder cloud_;  ///< in O until the end
  std::vector<Nanoseconds> cloud_stamps_;
};

/// Notes the time since the last stage and starts the next one.
void note_stage(std::string_view stage, Stopwatch& watch, Output& output);

}  // namespace plumbline::slam
