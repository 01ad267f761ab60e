// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/metrics.h"

#include <algorithm>
#include <array>

#include "scenarios/metrics/state_names.h"

namespace plumbline::scenarios::score {

namespace {

using Value = std::optional<double>;

template <class Part, class T>
std::function<Value(const MethodScore&)> field(std::optional<Part> MethodScore::*part, T Part::*member) {
  return [part, member](const MethodScore& score) -> Value {
    if (!(score.*part)) return std::nullopt;
    return static_cast<double>((*(score.*part)).*member);
  };
}

template <class Part, class T>
std::function<Value(const MethodScore&)> field(std::optional<Part> MethodScore::*part, std::optional<T> Part::*member) {
  return [part, member](const MethodScore& score) -> Value {
    if (!(score.*part) || !((*(score.*part)).*member)) return std::nullopt;
    return static_cast<double>(*((*(score.*part)).*member));
  };
}

std::vector<MetricRow> make_rows() {
  using S = MethodScore;
  using T = TrajectoryScore;
  using L = LocalizationScore;
  return {
      {"ate_rmse_m", "m", Better::lower,
       "RMS position error of the causal poses (each as first given); the first pose alone places the method's frame",
       field(&S::trajectory, &T::ate_rmse_m)},
      {"ate_aligned_rmse_m", "m", Better::lower,
       "the same after the best rigid alignment (Umeyama, without scale); the metric of SLAM gates",
       field(&S::trajectory, &T::ate_aligned_rmse_m)},
      {"ate_final_rmse_m", "m", Better::lower,
       "RMS position error of the trajectory after the last optimisation, aligned; absent where fewer than 95 % of the "
       "scans have a pose in it",
       field(&S::trajectory, &T::ate_final_rmse_m)},
      {"rpe_1m_rmse_m", "m", Better::lower,
       "RMS translation error of the relative pose over each metre walked, from poses at most 2 m apart",
       field(&S::trajectory, &T::rpe_1m_rmse_m)},
      {"drift_10m_percent", "%", Better::lower,
       "mean translation error over each 10 m walked, as a share of the distance",
       field(&S::trajectory, &T::drift_10m_percent)},
      {"drift_10m_deg_per_m", "deg/m", Better::lower, "mean rotation error over each 10 m walked",
       field(&S::trajectory, &T::drift_10m_deg_per_m)},
      {"coverage", "", Better::higher, "share of the scans with a pose within 10 ms",
       field(&S::trajectory, &T::coverage)},
      {"tracking.lost_share", "", Better::lower, "share of the scans at which the method reported LOST",
       field(&S::tracking, &TrackingScore::lost_share), true},
      {"tracking.degenerate_share", "", Better::neither,
       "share of the scans in which scan matching leaves a direction of the pose unconstrained, as along a bare "
       "corridor",
       field(&S::tracking, &TrackingScore::degenerate_share), true},
      {"map_rmse_m", "m", Better::lower,
       "RMS distance of the map's points to the building as built, each capped at 0.5 m; the final trajectory's "
       "alignment places the map, with its attitudes where the path is straight; a map of a localization stands as it "
       "is",
       field(&S::map, &MapScore::rmse_m)},
      {"map_capped_share", "", Better::lower, "share of the map's points at the cap of 0.5 m",
       field(&S::map, &MapScore::capped_share)},
      {"map_completeness", "", Better::higher,
       "share of the true return points (one per voxel of 0.1 m, as in `truth_surface.ply`) with a map point within 5 "
       "cm",
       field(&S::map, &MapScore::completeness)},
      {"rooms.visited", "", Better::neither, "rooms in which the robot was at least 0.5 m from the outline for 2 s",
       field(&S::rooms, &RoomScore::visited)},
      {"rooms.found", "", Better::neither, "rooms that the method claims", field(&S::rooms, &RoomScore::found)},
      {"rooms.matched", "", Better::higher,
       "found rooms that match a room of the building one to one: outline or four walls with an IoU of at least 0.5, "
       "or both faces of a corridor and a centre within 0.5 m across",
       field(&S::rooms, &RoomScore::matched)},
      {"rooms.precision", "", Better::higher, "matched rooms per found room; absent where none was found",
       field(&S::rooms, &RoomScore::precision)},
      {"rooms.recall", "", Better::higher, "share of the visited rooms that were found",
       field(&S::rooms, &RoomScore::recall)},
      {"walls.precision", "", Better::higher,
       "share of the found walls that match faces of the building's walls, within 3°, 0.10 m and over half of their "
       "length; sides of columns, stairs and furniture match none",
       field(&S::walls, &WallScore::precision)},
      {"walls.recall", "", Better::higher, "share of the faces seen by the LiDAR that a found wall matches",
       field(&S::walls, &WallScore::recall)},
      {"walls.duplicates", "", Better::lower,
       "found walls that lie for more than half on stretches of faces that other found walls were matched with",
       field(&S::walls, &WallScore::duplicates)},
      {"storeys.visited", "", Better::neither, "storeys on whose floor the robot stood for 2 s",
       field(&S::storeys, &StoreyScore::visited)},
      {"storeys.found", "", Better::neither, "floors that the method claims; absent where it claims none",
       field(&S::storeys, &StoreyScore::found)},
      {"storeys.matched", "", Better::higher, "found floors within 0.3 m of the height of a storey, one to one",
       field(&S::storeys, &StoreyScore::matched)},
      {"storeys.precision", "", Better::higher, "matched floors per found floor",
       field(&S::storeys, &StoreyScore::precision)},
      {"storeys.recall", "", Better::higher, "share of the visited storeys that were found",
       field(&S::storeys, &StoreyScore::recall)},
      {"loops.found", "", Better::neither, "loop closures that the method kept", field(&S::loops, &LoopScore::found)},
      {"loops.right", "", Better::higher, "of these, with a relative pose within 0.2 m and 3° of the true one",
       field(&S::loops, &LoopScore::right)},
      {"loops.revisits", "", Better::neither,
       "segments of the path, 1 to 10 m long, that pass within 1 m, on the plan and in height, of a point visited at "
       "least 10 m of path earlier",
       field(&S::loops, &LoopScore::revisits)},
      {"loops.precision", "", Better::higher, "right loop closures per loop closure; absent where there is none",
       field(&S::loops, &LoopScore::precision)},
      {"loops.recall", "", Better::higher, "share of these segments in which a right loop closure ends",
       field(&S::loops, &LoopScore::recall)},
      {"segmentation.precision", "", Better::higher,
       "of the planes of single scans with at least 30 returns, the share that has 80 % of its returns on one surface "
       "of the building [hoover1996]; returns farther than 10 cm from all surfaces, as of mirror images, and those "
       "near "
       "two do not count",
       field(&S::segmentation, &SegmentationScore::precision)},
      {"segmentation.recall", "", Better::higher,
       "of the returns on surfaces with at least 30 returns in a scan, the share in a plane of that surface",
       field(&S::segmentation, &SegmentationScore::recall)},
      {"segmentation.planes_per_surface", "", Better::lower, "planes per such surface, of those that have any",
       field(&S::segmentation, &SegmentationScore::planes_per_surface)},
      {"localization.converged_at_s", "s", Better::lower,
       "time from the first scan to the first single answer (CONVERGED), right or wrong",
       field(&S::localization, &L::converged_at_s)},
      {"localization.converged_at_m", "m", Better::lower, "distance walked until the first single answer",
       field(&S::localization, &L::converged_at_m)},
      {"localization.ape_rmse_m", "m", Better::lower,
       "RMS position error of every pose from the first convergence on, in the plan's frame without alignment, also "
       "while lost",
       field(&S::localization, &L::ape_rmse_m)},
      {"localization.yaw_rmse_deg", "deg", Better::lower, "RMS heading error of the same poses",
       field(&S::localization, &L::yaw_rmse_deg)},
      {"localization.sure_and_wrong", "", Better::lower,
       "1 where the verdict is false_convergence or overconfident, else 0",
       [](const S& score) -> Value {
         if (!score.localization) return std::nullopt;
         return is_sure_and_wrong(score.localization->verdict) ? 1.0 : 0.0;
       },
       true},
      {"localization.hypotheses", "", Better::neither, "pose hypotheses after the last scan",
       field(&S::localization, &L::hypotheses)},
      {"localization.identifiable_at_s", "s", Better::neither,
       "time from which on scans and plan determine the pose, by the building alone",
       field(&S::localization, &L::identifiable_at_s)},
      {"localization.identifiable_at_m", "m", Better::neither, "distance walked until then",
       field(&S::localization, &L::identifiable_at_m)},
      {"localization.twin_error_rmse_m", "m", Better::lower,
       "as `ape_rmse_m`, to the nearest of the true pose and its aliased poses at the start; small beside a large "
       "`ape_rmse_m` means an aliased pose was tracked",
       field(&S::localization, &L::aliased_error_rmse_m)},
      {"localization.true_mass", "", Better::higher,
       "sum of the masses of the last hypotheses within 0.5 m and 10° of the true pose",
       field(&S::localization, &L::true_mass)},
      {"localization.nees", "", Better::neither,
       "mean normalised estimation error squared of (x, y, yaw) while converged and right; 3 where the covariance is "
       "consistent",
       field(&S::localization, &L::nees)},
      {"localization.nees_left_out", "", Better::lower,
       "scans while converged and right that `nees` leaves out, since their covariance is not positive definite",
       field(&S::localization, &L::nees_left_out)},
      {"localization.handover_precision", "", Better::higher,
       "share of the wall patches, matched at the first convergence, whose wall is the right one; absent for methods "
       "that match no walls",
       field(&S::localization, &L::handover_precision)},
      {"localization.failure_at_s", "s", Better::neither,
       "time of the failure on the run's clock; `replay --until` stops there",
       field(&S::localization, &L::failure_at_s)},
      {"localization.kidnap_wrong_s", "s", Better::lower,
       "longest time that a wrong pose was CONVERGED after the robot was set down",
       field(&S::localization, &L::kidnap_wrong_s)},
      {"localization.kidnap_found_s", "s", Better::lower,
       "time from when the robot is set down to the pose that is CONVERGED and right to the end, for at least 5 s and "
       "1 m",
       field(&S::localization, &L::kidnap_found_s)},
      {"localization.kidnap_found_m", "m", Better::lower, "distance walked from there to that pose",
       field(&S::localization, &L::kidnap_found_m)},
  };
}

}  // namespace

namespace {

Tree to_results(const WithFurniture& known) {
  Tree tree = Tree::map();
  tree.set("identifiable", known.identifiable).set("evidence", to_string(known.evidence));
  if (known.at_s) tree.set("at_s", *known.at_s).set("at_m", known.at_m.value());
  return tree.set("aliases", known.aliases);
}

}  // namespace

std::string to_string(Evidence evidence) {
  static constexpr std::array<const char*, 3> names = {"unique", "weak", "ambiguous"};
  return names[static_cast<std::size_t>(evidence)];
}

std::string to_string(Failure failure) {
  static constexpr std::array<const char*, 6> names = {"never_sampled", "depleted",      "twin_preferred",
                                                       "wrong_model",   "tracking_lost", "undecided"};
  return names[static_cast<std::size_t>(failure)];
}

std::span<const MetricRow> metrics() {
  static const std::vector<MetricRow> rows = make_rows();
  return rows;
}

const MetricRow* find_metric(std::string_view name) {
  const auto rows = metrics();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const MetricRow& row) { return row.name == name; });
  return it == rows.end() ? nullptr : &*it;
}

Tree to_results(const MethodScore& score) {
  Tree tree = Tree::map();
  tree.set("verdict", score.verdict);
  if (!score.error.empty()) tree.set("error", score.error);
  if (score.shift != 0) tree.set("shift_ns", score.shift);
  std::vector<std::pair<std::string, Tree>> blocks;
  const auto block_of = [&](const std::string& name) -> Tree& {
    const auto it = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.first == name; });
    return it != blocks.end() ? it->second : blocks.emplace_back(name, Tree::map()).second;
  };
  if (score.localization) {
    block_of("localization").set("state", state_name(score.localization->state));
    if (score.localization->failure) block_of("localization").set("failure", to_string(*score.localization->failure));
    if (score.localization->identifiable)
      block_of("localization").set("identifiable", *score.localization->identifiable);
    if (score.localization->evidence)
      block_of("localization").set("evidence", to_string(*score.localization->evidence));
    if (score.localization->with_furniture)
      block_of("localization").set("with_furniture", to_results(*score.localization->with_furniture));
    if (score.localization->evidence_by_furniture) block_of("localization").set("evidence_by_furniture", true);
  }
  for (const MetricRow& row : metrics()) {
    const Value value = row.value(score);
    if (!value) continue;
    const std::size_t dot = row.name.find('.');
    if (dot == std::string_view::npos)
      tree.set(std::string(row.name), *value);
    else
      block_of(std::string(row.name.substr(0, dot))).set(std::string(row.name.substr(dot + 1)), *value);
  }
  for (auto& [name, block] : blocks) tree.set(name, std::move(block));
  return tree;
}

}  // namespace plumbline::scenarios::score
