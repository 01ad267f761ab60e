// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/score_run.h"

#include <algorithm>

#include "bim/config/number_list.h"
#include "bim/digest/digest.h"
#include "scenarios/host/files.h"
#include "scenarios/metrics/metric_kind.h"
#include "scenarios/metrics/storey.h"
#include "scenarios/score/handover.h"
#include "scenarios/score/identifiability.h"
#include "scenarios/score/moment.h"
#include "scenarios/score/walk_end.h"
#include "scenarios/spec/injected_faults.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios::score {

std::vector<Belief> beliefs_of(const MethodRecord& method, const Truth& truth) {
  std::vector<Belief> beliefs;
  const auto pose_at = [&](slam::Nanoseconds stamp) -> std::optional<Pose> {
    const auto it = std::lower_bound(method.causal.begin(), method.causal.end(), stamp,
                                     [](const slam::StampedPose& pose, slam::Nanoseconds t) { return pose.stamp < t; });
    if (it == method.causal.end() || it->stamp != stamp) return std::nullopt;
    return it->X_FR;
  };
  for (const BeliefRecord& belief : method.beliefs)
    beliefs.push_back({belief.stamp, belief.state, pose_at(belief.stamp), belief.hypotheses, belief.particles});
  if (!beliefs.empty()) return beliefs;
  const std::vector<PosePair> pairs = associate(truth, method.causal, {});
  if (pairs.empty()) return beliefs;
  for (std::size_t i = pairs.front().scan; i < truth.scans.size(); ++i)
    beliefs.push_back({truth.scans[i], slam::State::converged, {}, {}, {}});
  for (const PosePair& pair : pairs) {
    Belief& belief = beliefs[pair.scan - pairs.front().scan];
    belief.X_WR = pair.X_FR;
    belief.hypotheses = {{1.0, pair.X_FR, Eigen::Matrix3d::Zero(), "", {}}};
  }
  return beliefs;
}

namespace {

/// What the methods of a run are scored against.
struct Reference {
  const bim::Plan& as_planned;
  const bim::Plan& as_built;
  const Truth& truth;
  const std::vector<Eigen::Vector3d>& surface_W;
  const SurfaceDistance& distance;
  const bim::BuildingMesh& mesh;
};

/// Whether rooms are known of a storey that the robot was on; where none are, a room found is neither right nor wrong.
bool rooms_are_known(const Reference& reference) {
  const bim::Plan& plan = reference.as_built;
  std::vector<char> walked(plan.storeys.size(), 0);
  for (const slam::StampedPose& pose : reference.truth.poses_W)
    if (const int storey = storey_of_base(plan.storeys, pose.X_FR.t.z()); storey >= 0)
      walked[static_cast<std::size_t>(storey)] = 1;
  return std::any_of(plan.rooms.begin(), plan.rooms.end(), [&](const bim::PlanRoom& room) {
    return room.storey >= 0 && walked[static_cast<std::size_t>(room.storey)] != 0;
  });
}

void score_structure(const MethodRecord& method, const Pose& X_WF, const Reference& reference, MethodScore& score) {
  const slam::Estimate& estimate = method.estimate;
  if (!estimate.map_F.empty() && !reference.surface_W.empty())
    score.map = score_map(estimate.map_F, X_WF, reference.distance, reference.surface_W);
  if (!method.localization && !estimate.floors.empty())
    score.storeys = score_storeys(estimate, X_WF, reference.as_built, reference.truth);
  if (estimate.planes.empty()) return;
  const WallScore walls = score_walls(estimate, X_WF, reference.as_built, reference.surface_W);
  // In a building of which no walls are known, a wall found is neither right nor wrong.
  if (!reference.as_built.faces.empty()) score.walls = walls;
  if (method.localization) return;  // it is given the rooms
  if (!rooms_are_known(reference)) return;
  score.rooms = score_rooms(estimate, X_WF, reference.as_built, walls, reference.truth);
}

/// Absent of an outside trajectory.
std::optional<TrackingScore> tracking_of(const MethodRecord& method) {
  if (method.scans == 0) return std::nullopt;
  const double scans = method.scans;
  return TrackingScore{method.lost_scans / scans, method.degenerate_scans / scans};
}

MethodScore score_slam(const MethodRecord& method, const Reference& reference) {
  MethodScore score;
  score.trajectory = score_trajectory(reference.truth, method.causal, method.estimate.trajectory);
  const bool covered = score.trajectory && score.trajectory->coverage >= TrajectoryRules().min_coverage;
  score.verdict = covered ? "complete" : "lost";
  score.tracking = tracking_of(method);
  if (method.estimate.loops) score.loops = score_loops(*method.estimate.loops, reference.truth);
  if (!method.estimate.segmented.empty())
    score.segmentation =
        score_segmentation(method.estimate.segmented, reference.truth, reference.mesh, reference.distance);
  if (score.trajectory) score_structure(method, score.trajectory->X_WF_final, reference, score);
  return score;
}

MethodScore score_localizer(const MethodRecord& method, const Reference& reference,
                            const std::optional<Identifiability>& identifiability) {
  MethodScore score;
  const std::vector<Belief> beliefs = beliefs_of(method, reference.truth);
  score.verdict = to_string(LocalizationVerdict::lost);
  if (beliefs.empty()) return score;
  score.localization = score_localization(reference.truth, beliefs, identifiability);
  score.localization->handover_precision =
      handover_precision(reference.truth, beliefs, reference.as_planned, reference.as_built);
  score.verdict = to_string(score.localization->verdict);
  if (score.localization->converged_at_s) score_structure(method, Pose(), reference, score);
  return score;
}

/// Whether an estimate of this kind has a metric when all goes well.
bool is_asked_for(std::string_view metric, const MethodRecord& method) {
  const slam::Estimate& estimate = method.estimate;
  if (!is_metric_of(metric, method.localization)) return false;
  if (metric.starts_with("tracking.")) return method.scans > 0;
  if (metric.starts_with("map_")) return !estimate.map_F.empty();
  if (metric.starts_with("walls.") || metric.starts_with("rooms.")) return !estimate.planes.empty();
  if (metric.starts_with("storeys.")) return !estimate.floors.empty();
  if (metric.starts_with("loops.")) return estimate.loops.has_value();
  if (metric.starts_with("segmentation.")) return !estimate.segmented.empty();
  if (metric.starts_with("localization.nees") || metric == "localization.handover_precision")
    return !method.beliefs.empty();
  return true;
}

/// What is asked of an outside estimate: its own gates, else the strictest bound in the good direction of each metric.
/// Bounds on the truth check the scorer and apply to no other method.
std::vector<GateSpec> gates_for_outside(const std::vector<GateSpec>& gates, const MethodRecord& method) {
  if (!method.gates.empty()) return method.gates;
  std::vector<GateSpec> strictest;
  for (const GateSpec& gate : gates) {
    const MetricRow& row = *find_metric(gate.metric);
    const bool good_direction = (row.better == Better::lower && gate.max) || (row.better == Better::higher && gate.min);
    if (!good_direction || gate.method == truth_method || !is_asked_for(gate.metric, method)) continue;
    const auto same = std::find_if(strictest.begin(), strictest.end(),
                                   [&](const GateSpec& other) { return other.metric == gate.metric; });
    if (same == strictest.end())
      strictest.push_back({gate.metric, method.name, gate.max, gate.min});
    else if (gate.max)
      same->max = std::min(*same->max, *gate.max);
    else
      same->min = std::max(*same->min, *gate.min);
  }
  return strictest;
}

std::vector<GateSpec> all_gates(const FinishedRun& run) {
  std::vector<GateSpec> gates = run.scenario.gates;
  for (std::size_t i = run.scenario.methods.size(); i < run.record.methods.size(); ++i) {
    const std::vector<GateSpec> more = gates_for_outside(run.scenario.gates, run.record.methods[i]);
    gates.insert(gates.end(), more.begin(), more.end());
  }
  return gates;
}

std::vector<Eigen::Vector3d> to_double(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const Eigen::Vector3f& p : points) result.emplace_back(p.cast<double>());
  return result;
}

Tree sensors_of(const Scenario& scenario) {
  Tree tree = Tree::map();
  tree.set("lidar", to_tree(scenario.lidar)).set("odometry", to_tree(scenario.odometry));
  Tree off = Tree::list();
  for (const std::string& name : off_defaults(scenario)) off.push(name);
  return tree.set("off_default", off);
}

/// What was built otherwise than planned.
Tree changes_of(const bim::PlannedAndBuilt& site) {
  Tree list = Tree::list();
  for (const bim::Change& change : site.changes)
    list.push(Tree::map().set("op", change.op).set("element", change.element));
  return list;
}

Tree to_results(const IdentifiabilityAnswer& known) {
  Tree tree = Tree::map();
  tree.set("identifiable", known.identifiable);
  if (known.at_s) tree.set("at_s", *known.at_s).set("at_m", known.at_m.value());
  if (known.decided_by)
    tree.set("decided_by", Tree::map()
                               .set("element", known.decided_by->id)
                               .set("missing", known.decided_by->missing)
                               .set("share", known.decided_by->share));
  Tree places = Tree::list();
  for (const AliasesLeft& left : known.places)
    places.push(Tree::map()
                    .set("t_s", left.t_s)
                    .set("distance_m", left.distance_m)
                    .set("aliases", left.aliases)
                    .set("weak", left.marginal));
  return tree.set("places", std::move(places));
}

Tree both_to_results(const Identifiability& known) {
  Tree tree = to_results(static_cast<const IdentifiabilityAnswer&>(known));
  if (known.with_furniture) tree.set("with_furniture", to_results(*known.with_furniture));
  return tree;
}

/// What methods with a plan were told, and what the world was.
Tree told_of(const FinishedRun& run) {
  const Tree scenario = to_tree(run.scenario);
  Tree tree = Tree::map();
  return tree.set("plan_furniture", scenario.find("plan")->find("furniture")->as_string())
      .set("world_furniture", scenario.find("world")->find("furniture")->as_string());
}

/// A robot that was in the air is set down where the scans begin anew.
Truth truth_of(const FinishedRun& run) {
  Truth truth{run.record.truth_W, run.scans, std::nullopt};
  if (!run.scenario.kidnap) return truth;
  const double gap_s = 0.5 * run.scenario.kidnap->away_s;
  for (std::size_t i = 1; i < run.scans.size() && !truth.set_down; ++i)
    if (slam::seconds(run.scans[i] - run.scans[i - 1]) > gap_s) truth.set_down = run.scans[i];
  return truth;
}

}  // namespace

bool RunScore::passed() const {
  return std::all_of(gates.begin(), gates.end(), [](const GateResult& gate) { return gate.passed; }) &&
         std::none_of(methods.begin(), methods.end(), [](const MethodScore& m) { return m.verdict == "crashed"; });
}

RunScore score_run(const FinishedRun& run) {
  RunScore score;
  score.truth = truth_of(run);
  score.digest = hex64(digest_of(run.record.digests));
  score.duration_s = slam::seconds(run.scans.back());
  score.distance_m = score.truth.walked().back();

  const std::vector<Eigen::Vector3d> surface_W = to_double(run.record.surface_W);
  const RunBuilding& building = *run.building;
  const SurfaceDistance distance(building.mesh_as_built(), MapRules().cap_m);
  const Reference reference{*building.plan_as_planned(), building.plan_as_built(), score.truth, surface_W, distance,
                            building.mesh_as_built()};
  const bool localizes = std::any_of(run.record.methods.begin(), run.record.methods.end(),
                                     [](const MethodRecord& m) { return m.localization && !m.crashed; });
  if (localizes) score.identifiability = identifiability_of(run, score.truth.before());
  for (const MethodRecord& method : run.record.methods) {
    MethodScore one;
    if (method.crashed)
      one.verdict = "crashed";
    else
      one = method.localization ? score_localizer(method, reference, score.identifiability)
                                : score_slam(method, reference);
    one.name = method.name;
    one.error = method.error;
    one.shift = method.shift;
    score.methods.push_back(std::move(one));
  }
  score.gates = judge_gates(all_gates(run), score.methods, run.record.failure.empty());
  for (GateResult& gate : score.gates)
    if (!gate.passed) gate.see = moment_link(run, score, gate);
  return score;
}

std::string write_results(const FinishedRun& run, const RunScore& score) {
  Tree tree = Tree::map();
  tree.set("plumbline", PLUMBLINE_VERSION).set("scenario", run.scenario.name);
  tree.set("seed", std::to_string(run.scenario.seed)).set("digest", score.digest);
  tree.set("duration_s", score.duration_s).set("distance_m", score.distance_m);
  if (!run.record.failure.empty()) tree.set("failure", run.record.failure);
  Tree altered = Tree::list();
  for (const std::string& name : run.altered) altered.push(name);
  if (!run.altered.empty()) tree.set("unchecked", std::move(altered));
  tree.set("walk", to_results(run.walk, warnings_of_walk(run)));
  if (const auto& moved = run.building->as_planned().moved_by)
    tree.set("building", Tree::map().set("moved_by_m", number_list(*moved)));
  tree.set("sensors", sensors_of(run.scenario));
  Tree injected = Tree::list();
  for (const std::string& fault : injected_faults(run.scenario)) injected.push(fault);
  if (!injected.as_list().empty()) tree.set("injected", std::move(injected));
  if (run.building->plans_movables() || run.building->deviates()) tree.set("told", told_of(run));
  if (run.building->deviates()) tree.set("as_built", changes_of(run.building->variants()));
  if (score.identifiability) tree.set("identifiability", both_to_results(*score.identifiability));
  Tree gates = Tree::list();
  for (const GateResult& gate : score.gates) gates.push(to_results(gate));
  tree.set("gates", gates);
  Tree methods = Tree::map();
  for (const MethodScore& method : score.methods) methods.set(method.name, to_results(method));
  return write_json(tree.set("methods", methods)) + "\n";
}

void write_scores(const std::string& dir, const FinishedRun& run, const RunScore& score) {
  write_file(dir + "/junit.xml", write_junit(run.scenario.name, score.gates, score.methods, run.record.failure));
  write_file(dir + "/results.json", write_results(run, score));
}

}  // namespace plumbline::scenarios::score
