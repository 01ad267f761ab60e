// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "bim/config/visit.h"
#include "slam/plan_map/localization_scan.h"
#include "slam/plan_map/plan_index.h"

namespace plumbline::slam {

/// How two places are held against each other by everything one scan saw.
struct ContestConfig {
  double sigma_m = 0.05;          ///< range noise, registration and plan tolerance, across the face
  double gate_m = 0.12;           ///< a beam for which both places predict the same within this says nothing
  double min_incidence = 0.2;     ///< cosine below which a grazing beam's residual no longer shrinks
  double short_cap = 2.0;         ///< of the negative log-likelihood of a beam cut short: clutter does that
  double long_cap = 4.5;          ///< of one that goes through what the plan has there
  double weight = 0.05;           ///< of one beam: neighbours share their errors, and so do views 0.2 m apart
  double edge_m = 0.05;           ///< an edge of the plan may stand this much to the side,
  double edge_rad = 0.0015;       ///< and this much in direction
  double cause_cap = 8.0;         ///< of all that one cause explains, however often it is seen: a wall that was not
                                  ///< built, something that stands before a face or where the plan has nothing
  double thing_m = 1.0;           ///< size of such a thing where the plan has nothing
  double opening_depth_m = 0.35;  ///< a beam that ends this little behind a planned opening met its leaf or pane

  template <class V>
  void visit(V& v) {
    v("sigma_m", sigma_m, Field{.doc = "range noise, registration and plan tolerance, across the face", .min = 1e-6});
    v("gate_m", gate_m,
      Field{.doc = "a beam for which both places predict the same within this says nothing", .min = 0});
    v("min_incidence", min_incidence,
      Field{.doc = "cosine below which a grazing beam's residual no longer shrinks", .min = 0, .max = 1});
    v("short_cap", short_cap, Field{.doc = "of the negative log-likelihood of a beam cut short", .min = 0});
    v("long_cap", long_cap, Field{.doc = "of one that goes through what the plan has there", .min = 0});
    v("weight", weight, Field{.doc = "of one beam; neighbours and near views share their errors", .min = 0});
    v("edge_m", edge_m, Field{.doc = "an edge of the plan may stand this much to the side", .min = 0});
    v("edge_rad", edge_rad, Field{.doc = "and this much in direction", .min = 0});
    v("cause_cap", cause_cap,
      Field{.doc = "of all that one wall not built or one thing not planned explains, however often it is seen",
            .min = 0});
    v("thing_m", thing_m, Field{.doc = "size of a thing that stands where the plan has nothing", .min = 0.01});
    v("opening_depth_m", opening_depth_m,
      Field{.doc = "a beam that ends this little behind a planned opening met its leaf or pane", .min = 0});
  }
};

/// What the plan has in the way of four beams.
struct SightBlock {
  Float4 expected = all(0.0F);    ///< horizontal range, m; where nothing is hit, how far was looked
  Float4 incidence = all(1.0F);   ///< cosine at the face hit, at least min_incidence; 1 where nothing is hit
  Mask4 segment{-1, -1, -1, -1};  ///< hit, -1: none
};

/// What the plan has in the way of each beam of View::sweep at one pose. In single precision: 0.01 mm in a plan of
/// 100 m.
struct Sight {
  const StoreyIndex* storey = nullptr;
  Eigen::Matrix2d R_IH = Eigen::Matrix2d::Identity();
  Eigen::Vector2d sensor_I = Eigen::Vector2d::Zero();
  int cell = -1;                     ///< of the storey's grid, with the sensor
  std::vector<SightBlock> blocks;    ///< as those of the sweep
  mutable std::vector<Float4> cost;  ///< of what the beams met instead, once asked for; negative: not yet
};
[[nodiscard]] Sight sight(const StoreyIndex& storey, const Pose2& X_IH, const View& view, const ContestConfig& config);

/// What a place would have to be wrong about for what was seen there, the least that it could be: a wall or solid that
/// was not built, something before a face, something where the plan has nothing.
struct Cause {
  enum class Kind { not_built, before_face, unplanned };
  Kind kind = Kind::unplanned;
  int x = 0, y = 0;  ///< PlanSegment::element; segment; cell of ContestConfig::thing_m in I

  friend auto operator<=>(const Cause&, const Cause&) = default;
};

/// What speaks against a place, by what would explain it.
class Objections {
 public:
  void add(const Cause& cause, double log_likelihood) { sums_[cause] += log_likelihood; }
  void add(const Objections& more, double scale);
  void clear() { sums_.clear(); }
  /// No cause counts for more than the cap.
  [[nodiscard]] double total(double cap) const;

 private:
  std::map<Cause, double> sums_;
};

/// What one scan says of two places.
struct Contest {
  Objections against_a, against_b;
  double ratio = 0.0;  ///< log-likelihood ratio of a to b, no cause capped
};
/// Only beams for which the two predict something else speak, so that clutter and a plan that is off say nothing where
/// the places are alike. A beam next to an edge of the plan may meet either side of it.
[[nodiscard]] Contest contest(const View& view, const Sight& a, const Sight& b, const ContestConfig& config);

}  // namespace plumbline::slam
