// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/config/visit.h"
#include "slam/localization/as_printed/paper_walls.h"
#include "slam/particles/pose_clusters.h"
#include "slam/plan_method/plan_method.h"
#include "slam/planes/plane_detector.h"

namespace plumbline::slam {

/// The paper gives none of these numbers.
struct PaperFilterConfig {
  int particles = 20000;
  double sigma_azimuth = 0.08;
  double sigma_elevation = 0.08;
  double sigma_offset_m = 0.25;
  double gate = 9.0;
  double outlier = 0.2;
  double trans_per_m = 0.1;
  double rot_per_rad = 0.1;
  double rot_per_m = 0.03;
  double min_trans_m = 0.01;
  double min_rot_rad = 0.005;
  double tilt_rad = 0.2;
  double converged_m = 0.3;
  double converged_rad = 0.15;
  double top_mass = 0.95;
  int updates = 5;
  double travel_m = 1.0;

  template <class V>
  void visit(V& v) {
    v("particles", particles,
      Field{.doc = "particles, laid out evenly over the rooms at the start except close to walls",
            .min = 10,
            .max = 200000,
            .basic = true});
    v("sigma_azimuth", sigma_azimuth,
      Field{.doc = "standard deviation of a plane's azimuth; with the others also the scale of the gate",
            .unit = "rad",
            .min = 1e-4});
    v("sigma_elevation", sigma_elevation,
      Field{.doc = "standard deviation of a plane's elevation", .unit = "rad", .min = 1e-4});
    v("sigma_offset_m", sigma_offset_m,
      Field{.doc = "standard deviation of a plane's distance, about the spacing of the particles", .min = 1e-4});
    v("gate", gate,
      plain_field("squared Mahalanobis distance up to which planes match (eq. 7)", {.min = 0, .basic = true}));
    v("outlier", outlier,
      plain_field("share of planes that are no wall, where every plane counts", {.min = 1e-6, .max = 1}));
    v("trans_per_m", trans_per_m,
      Field{.doc = "standard deviation of translation per metre walked", .unit = "m/m", .min = 0});
    v("rot_per_rad", rot_per_rad,
      Field{.doc = "standard deviation of rotation per radian turned", .unit = "rad/rad", .min = 0});
    v("rot_per_m", rot_per_m,
      Field{.doc = "standard deviation of rotation per metre walked", .unit = "rad/m", .min = 0});
    v("min_trans_m", min_trans_m, Field{.doc = "least standard deviation of a step's translation", .min = 0});
    v("min_rot_rad", min_rot_rad, Field{.doc = "least standard deviation of a step's rotation", .min = 0});
    v("tilt_rad", tilt_rad,
      Field{.doc = "standard deviation of roll and pitch at the start, where they are free", .min = 0});
    v("converged_m", converged_m,
      Field{.doc = "distance of the best particle from the mean of all that counts as converged",
            .min = 0,
            .basic = true});
    v("converged_rad", converged_rad,
      Field{
          .doc = "angle of the best particle from the mean of all that counts as converged", .min = 0, .basic = true});
    v("top_mass", top_mass,
      share_field("mass of one cluster that counts as converged, where convergence is corrected"));
    v("updates", updates, Field{.doc = "updates in a row for which it must hold", .min = 1});
    v("travel_m", travel_m, Field{.doc = "distance walked for which it must hold", .min = 0});
  }
};

/// The particle filter of [shaheer2023, section 3.3], each defect by its switch. Particles stand in I, planes are
/// compared where the switches say.
class PaperFilter {
 public:
  PaperFilter(const PaperFilterConfig& config, const PaperSwitches& switches, const MethodInput& input,
              const PlanIndex& index);

  /// One step: eq. 4-9 and, when all particles agree, the answer.
  void update(const PlanScan& scan, const std::vector<PlaneObservation>& planes, const Pose& X_OR_last);

  [[nodiscard]] const ParticleSet& particles() const { return particles_; }
  [[nodiscard]] bool converged() const { return converged_; }
  /// Particle of the highest weight at the last update (ties: lowest index).
  [[nodiscard]] const LocalParticle& best() const { return best_; }
  /// log of eq. 8 for a robot at X_WR that sees the planes.
  [[nodiscard]] double log_weight(int storey, int room, const Pose& X_WR,
                                  const std::vector<PlaneObservation>& planes) const;

 private:
  /// What of a pose in space a LocalParticle does not hold.
  struct Rest {
    double z = 0.0;  ///< above its storey's floor, m
    double roll = 0.0, pitch = 0.0;
    int room = -1;  ///< the last it was in
  };
  /// A wall in the form and frame in which it is compared.
  struct Landmark {
    AnglePlane form;
    PlaneAxis axis = PlaneAxis::x;
    const PaperWall* wall = nullptr;
  };
  struct Match {
    double distance = 0.0;  ///< squared, Mahalanobis
    Eigen::Vector3d e = Eigen::Vector3d::Zero();
  };
  [[nodiscard]] std::vector<Landmark> landmarks(int storey, int room, const Pose& X_LW) const;
  [[nodiscard]] std::optional<Match> match(int storey, const std::vector<Landmark>& landmarks,
                                           const PlaneObservation& plane, const Pose& X_WR, const Pose& X_LW) const;
  [[nodiscard]] double log_factor(const std::optional<Match>& match) const;
  [[nodiscard]] Eigen::Vector3d sigmas() const {
    return {config_.sigma_azimuth, config_.sigma_elevation, config_.sigma_offset_m};
  }
  void start(const PlanScan& scan, const std::vector<PlaneObservation>& planes);
  void predict(const PlanScan& scan, const Pose& X_OR_last);
  void update_weights(const PlanScan& scan, const std::vector<PlaneObservation>& planes);
  void update_convergence(double walked);
  void resample(std::uint64_t tick);
  void find_room(std::size_t i);
  [[nodiscard]] Pose pose_W(std::size_t i, const PlanScan& scan) const;
  [[nodiscard]] const std::vector<int>& candidates(int storey, int room) const;
  [[nodiscard]] bool on_face(int storey, const PaperWall& wall, const PlaneObservation& plane, const Pose& X_WR) const;
  [[nodiscard]] double sample_yaw(std::size_t i, const PlanScan& scan, const std::vector<PlaneObservation>& planes,
                                  const Stream& stream) const;

  PaperFilterConfig config_;
  PaperSwitches switches_;
  MethodInput input_;
  const PlanIndex& index_;
  std::vector<PaperStorey> storeys_;
  ParticleSet particles_;
  std::vector<Rest> rest_;
  LocalParticle best_;
  bool converged_ = false;
  int converged_updates_ = 0;
  double converged_travel_m_ = 0.0;
};

}  // namespace plumbline::slam
