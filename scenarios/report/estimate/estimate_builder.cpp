// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_builder.h"

#include <algorithm>
#include <set>
#include <utility>

#include "scenarios/metrics/reference_score.h"
#include "scenarios/metrics/storey.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/belief_builder.h"
#include "scenarios/report/estimate/answer_sentence.h"
#include "scenarios/report/estimate/estimate_files.h"
#include "scenarios/report/estimate/map_points.h"
#include "scenarios/report/estimate/reference_errors.h"
#include "scenarios/report/estimate/thinned_path.h"
#include "scenarios/report/hypothesis_history.h"

namespace plumbline::scenarios {

namespace {

std::vector<ReportSample> samples_of_path(const std::vector<slam::StampedPose>& poses, const EstimateFiles& files,
                                          const std::vector<bim::PlanStorey>& storeys) {
  std::vector<ReportSample> samples;
  for (const slam::StampedPose& pose : poses) {
    const Pose& X_FR = pose.X_FR;
    ReportSample& sample = samples.emplace_back();
    sample.t_s = slam::seconds(pose.stamp - files.scans.front());
    sample.x = X_FR.t.x();
    sample.y = X_FR.t.y();
    sample.yaw = X_FR.yaw();
    sample.storey = score::storey_of_base(storeys, X_FR.t.z());
    sample.lost = said_lost(files.method, pose.stamp);
    sample.judged = false;
  }
  return samples;
}

/// The storey of the path at a time.
int storey_at(const std::vector<ReportSample>& samples, double t_s) {
  const auto next = std::lower_bound(samples.begin(), samples.end(), t_s,
                                     [](const ReportSample& sample, double t) { return sample.t_s < t; });
  return next == samples.end() ? samples.back().storey : next->storey;
}

/// The path after the last optimisation, where it is another one than that first given.
std::vector<ReportSample> corrected_path(const EstimateFiles& files, const std::vector<bim::PlanStorey>& storeys) {
  constexpr double least_m = 0.05;  // a line's width
  const std::vector<slam::StampedPose>&given = files.method.causal, &corrected = files.method.estimate.trajectory;
  bool differs = corrected.size() != given.size();
  for (std::size_t i = 0; !differs && i < given.size(); ++i)
    differs = (given[i].X_FR.t - corrected[i].X_FR.t).norm() > least_m;
  if (!differs) return {};
  std::vector<ReportSample> samples = samples_of_path(corrected, files, storeys);
  for (ReportSample& sample : samples) sample.lost = false;
  return samples;
}

void add_found(const slam::Estimate& estimate, const std::vector<bim::PlanStorey>& storeys, ReportMethod& shown) {
  for (const slam::PlaneNode& plane : estimate.planes)
    shown.walls.push_back({plane.p0, plane.p1, score::storey_of_height(storeys, 0.5 * (plane.z0 + plane.z1))});
  for (const slam::RoomNode& node : estimate.rooms) {
    ReportRoom& room = shown.rooms.emplace_back();
    room.polygon_W = node.polygon_F;
    room.matched = true;
    room.storey = score::storey_of_height(storeys, score::height_of_room(estimate, node).value_or(0.0));
  }
}

/// The heaviest hypothesis, or nothing.
const slam::Hypothesis* heaviest(const BeliefRecord& belief) {
  const auto most = std::max_element(belief.hypotheses.begin(), belief.hypotheses.end(),
                                     [](const auto& a, const auto& b) { return a.mass < b.mass; });
  return most == belief.hypotheses.end() ? nullptr : &*most;
}

/// Where the heaviest hypothesis is, at a time or next after it.
ReportPlace believed_place(const MethodRecord& method, const std::vector<bim::PlanStorey>& storeys,
                           slam::Nanoseconds stamp) {
  auto at = std::lower_bound(method.beliefs.begin(), method.beliefs.end(), stamp,
                             [](const BeliefRecord& belief, slam::Nanoseconds t) { return belief.stamp < t; });
  for (; at != method.beliefs.end(); ++at)
    if (const slam::Hypothesis* most = heaviest(*at))
      return {most->X_WR.t.head<2>(), score::storey_of_base(storeys, most->X_WR.t.z())};
  return {};
}

/// Hypotheses of a localization, none of which is known to be the right one.
void add_localization(const EstimateFiles& files, const bim::Plan& plan, ReportMethod& shown) {
  constexpr std::size_t shown_places = 6;  // curves that stay apart
  const MethodRecord& method = files.method;
  BeliefContext context;
  context.origin = files.scans.front();
  context.place = [&](slam::Nanoseconds stamp) { return believed_place(method, plan.storeys, stamp); };
  add_beliefs(method, context, shown);
  add_matched_walls(method, plan, context, shown);
  score::Truth motion;
  motion.poses_W = method.estimate.trajectory;
  if (motion.poses_W.empty()) motion.poses_W.push_back({files.scans.front(), Pose()});
  HypothesisHistories histories = hypothesis_histories(method.beliefs, motion, shown_places, false);
  shown.hypotheses_left_out = histories.left_out;
  const double origin_s = slam::seconds(files.scans.front());
  const auto since_first = [&](std::vector<Eigen::Vector2d>& points) {
    for (Eigen::Vector2d& p : points) p.x() -= origin_s;
  };
  for (HypothesisHistory& history : histories.shown) since_first(history.points);
  since_first(histories.others);
  shown.histories = std::move(histories.shown);
  shown.other_hypotheses = std::move(histories.others);
}

/// Storeys that the method was on or may be on at the end, from the lowest up.
std::vector<ReportStorey> shown_storeys(const EstimateFiles& files, const bim::Plan& plan,
                                        const std::vector<ReportSample>& samples) {
  std::set<int> on;
  for (const ReportSample& sample : samples) on.insert(sample.storey);
  if (!files.method.beliefs.empty())
    for (const slam::Hypothesis& hypothesis : files.method.beliefs.back().hypotheses)
      on.insert(score::storey_of_base(plan.storeys, hypothesis.X_WR.t.z()));
  if (on.empty()) on.insert(0);
  std::vector<ReportStorey> storeys;
  for (const int index : on) {
    ReportStorey& storey = storeys.emplace_back();
    storey.index = index;
    storey.name = plan.storeys[static_cast<std::size_t>(index)].name;
  }
  const auto height = [&](const ReportStorey& storey) {
    return plan.storeys[static_cast<std::size_t>(storey.index)].elevation_m;
  };
  std::stable_sort(storeys.begin(), storeys.end(),
                   [&](const ReportStorey& a, const ReportStorey& b) { return height(a) < height(b); });
  return storeys;
}

/// The points of the map under each storey's plan, those that lie on it.
void lay_map(const std::vector<Eigen::Vector3f>& map_F, ReportInput& input) {
  if (map_F.empty()) return;
  MapBox box = bounds(input);
  if (!input.has_plan) {
    const MapBox of_points = box_of_points(map_F);
    box.add(of_points.min);
    box.add(of_points.max);
    input.extent = {box.min, box.max};
  }
  for (ReportStorey& storey : input.storeys) {
    std::vector<Eigen::Vector3f> here;
    for (const Eigen::Vector3f& p : map_F)
      if (input.storeys.size() == 1 || score::storey_of_height(input.plan.storeys, p.z()) == storey.index)
        here.push_back(p);
    storey.below_paths += draw_map_points(here, box, input.has_plan);
  }
}

Tree path_numbers(const std::vector<slam::StampedPose>& poses) {
  const score::PathScore path = score::score_path(poses);
  Tree tree = Tree::map();
  tree.set("poses", static_cast<std::int64_t>(path.poses)).set("duration_s", path.duration_s);
  tree.set("length_m", path.length_m).set("vertical_m", path.vertical_m);
  return path.straightness ? tree.set("straightness", *path.straightness) : tree;
}

/// Hypotheses at the end of a localization that has no single answer.
bool mark_hypotheses(const MethodRecord& method, ReportInput& input) {
  constexpr std::size_t most = 20;
  if (method.beliefs.empty() || method.beliefs.back().state == slam::State::converged) return false;
  std::vector<slam::Hypothesis> last = method.beliefs.back().hypotheses;
  std::stable_sort(last.begin(), last.end(), [](const auto& a, const auto& b) { return a.mass > b.mass; });
  last.resize(std::min(most, last.size()));
  for (ReportStorey& storey : input.storeys)
    for (const slam::Hypothesis& hypothesis : last)
      if (score::storey_of_base(input.plan.storeys, hypothesis.X_WR.t.z()) == storey.index)
        storey.below_paths += draw_hypothesis_mark(hypothesis.X_WR, hypothesis.mass);
  return !last.empty();
}

/// What results.json has of a run: gates, and every number of the method.
Tree results_by_score(const EstimateFiles& files) {
  const MethodRecord& method = files.method;
  Tree numbers = Tree::map(), results = Tree::map();
  if (files.scores) {
    numbers = files.scores->numbers;
    Tree gates = Tree::list();
    for (const score::GateResult& gate : files.scores->gates) gates.push(score::to_results(gate));
    results.set("gates", std::move(gates));
  } else if (!method.causal.empty()) {
    numbers.set("causal", path_numbers(method.causal));
    if (!method.estimate.trajectory.empty()) numbers.set("final", path_numbers(method.estimate.trajectory));
  }
  return results.set("methods", Tree(Tree::Map{{method.name, std::move(numbers)}}));
}

/// The plan that the method had, or none.
void take_plan(EstimateFiles& files, ReportInput& input) {
  input.has_plan = files.plan.has_value();
  if (!files.plan) {
    input.plan.storeys = {{}};
    return;
  }
  input.plan = files.plan->plan;
  input.obstacles = std::move(files.plan->obstacles);
  input.flights = std::move(files.plan->flights);
}

/// The paths of the method and of the reference. Returns one in how many poses of the method is drawn.
std::size_t take_paths(const EstimateFiles& files, ReportInput& input, ReportMethod& shown) {
  const MethodRecord& method = files.method;
  std::vector<ReportSample> samples = samples_of_path(method.causal, files, input.plan.storeys);
  std::vector<ReportSample> reference =
      lay_reference(files.reference, method, files.reference_kind, {files.scans.front(), files.scans.back()}, samples);
  for (ReportSample& sample : reference) sample.storey = storey_at(samples, sample.t_s);
  const auto thin = [](const std::vector<ReportSample>& path, std::vector<ReportSample>& drawn, PathBreaks& breaks) {
    const std::size_t every = drawn_one_in(path.size());
    breaks = breaks_of(path, every);
    drawn = thinned_path(path, every);
    return every;
  };
  thin(reference, input.truth, input.truth_breaks);
  thin(corrected_path(files, input.plan.storeys), shown.corrected, shown.corrected_breaks);
  return thin(samples, shown.samples, shown.breaks);
}

/// The method as maps and plots show it.
ReportMethod take_method(const EstimateFiles& files, EstimatePage& page) {
  ReportInput& input = page.input;
  ReportMethod shown;
  shown.name = files.method.name;
  shown.localization = files.method.localization;
  shown.judged = false;
  shown.lost_drawn = true;
  page.thinned = take_paths(files, input, shown);
  add_found(files.method.estimate, input.plan.storeys, shown);
  if (shown.localization) add_localization(files, input.plan, shown);
  for (const ReportState& state : shown.states)
    if (!shown.converged_s && state.state == slam::State::converged) shown.converged_s = state.t_s;
  return shown;
}

}  // namespace

EstimatePage read_estimate_page(const std::string& dir, const std::optional<NewScore>& fresh) {
  EstimateFiles files = read_estimate_files(dir, fresh);
  const MethodRecord& method = files.method;
  const bool knows_scans = !files.scans.empty();
  if (!knows_scans) files.scans.push_back(0);  // of a method that crashed before its first
  EstimatePage page;
  ReportInput& input = page.input;
  input.truth_name = files.reference_kind.in_plan_frame ? "reference" : "reference, aligned to the estimate";
  take_plan(files, input);
  page.spans = state_spans(method, files.scans);
  input.methods.push_back(take_method(files, page));
  input.storeys = shown_storeys(files, input.plan, input.methods.front().samples);
  input.results = results_by_score(files);
  lay_map(method.estimate.map_F, input);
  page.has_numbers = files.scores || !method.causal.empty();
  page.has_map = !method.estimate.map_F.empty();
  page.has_marks = mark_hypotheses(method, input);
  constexpr double marks_across = 60.0;
  const MapBox box = bounds(input);
  input.mark_scale = std::max(1.0, (box.max - box.min).norm() / marks_across);
  page.answer = answer_sentence(method, page.spans);
  page.state = final_state(method, page.spans);
  page.by_reference = reference_sentence(files);
  page.reference = files.reference_kind;
  page.pauses = scan_pauses(files.scans);
  page.first_scan = files.scans.front();
  if (knows_scans)
    for (const slam::Nanoseconds stamp : files.scans)
      page.scans_s.push_back(slam::seconds(stamp - files.scans.front()));
  page.facts = std::move(files.facts);
  return page;
}

}  // namespace plumbline::scenarios
