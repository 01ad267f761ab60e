// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bim/rays/ray_scene.h"
#include "scenarios/localizability/place_index.h"
#include "slam/io/records.h"

namespace plumbline::scenarios {

struct IdentifyInput {
  const bim::RayScene* as_planned = nullptr;
  const bim::RayScene* as_built = nullptr;
  std::vector<IdentifyStorey> storeys;  ///< those a robot with this prior may be on
  bool yaw_known = false;
  int threads = 1;
};

struct TruthSample {
  double t_s = 0.0;
  Pose X_WR;
  double sensor_z_W = 0.66;  ///< height of the levelled sensor
};

/// A start pose that could not be told from the true one so far. twin maps true poses to the twin's: X_twin = twin *
/// X_WR.
struct Twin {
  Pose twin;
  double llr = 0.0;
};

struct IdentifyStep {
  double t_s = 0.0;
  double distance_m = 0.0;
  std::vector<Twin> alive;  ///< all with llr <= drop_llr, ordered by where they were found
};

/// The element that told the last twin from the truth: most of the log-likelihood ratio comes from beams to it.
struct DecidingFeature {
  bool missing = false;  ///< it would be seen from the twin, and is not; else it is seen, and would not be
  int element = -1;      ///< of the planned mesh where missing, else of the one as built
  double share = 0.0;    ///< of the positive evidence
};

/// What any estimator could have known, seed and method aside.
struct RunIdentifiability {
  std::vector<IdentifyStep> steps;
  std::optional<DecidingFeature> decided_by;  ///< absent when the first look sufficed or nothing did
  bool identifiable = false;                  ///< no twin is alive at the end
  std::optional<double> identifiable_at_s;    ///< first time from which on none is
  std::optional<double> identifiable_at_m;

  /// First time from which on every twin that is left is at least weak (llr >= weak_llr), absent when never.
  [[nodiscard]] std::optional<double> tellable_from_s() const;
  /// Poses that cannot be told from X_WR at time t, the true one left out.
  [[nodiscard]] std::vector<Pose> ambiguity_set(double t_s, const Pose& X_WR) const;
};

/// Follows every start pose that looks like the true one along the run [facts: localization 3.2].
[[nodiscard]] RunIdentifiability identify_run(const IdentifyInput& input, const std::vector<TruthSample>& truth);

}  // namespace plumbline::scenarios
